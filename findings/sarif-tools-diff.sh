#!/bin/bash
# PyPI sarif-tools 3.0.5: diff counts results by rule and message, whatever their file: a fault gone from one file and new in another is "no changes"; --check error passes even where errors were added.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check sarif-tools==3.0.5 2> /dev/null
# Writes NAME.sarif with one error of rule r per file that follows; its fingerprints tell them apart.
log() {
    local name=$1 results='' file; shift
    for file; do
        results+=${results:+,}'{"ruleId":"r","level":"error","message":{"text":"too deep"},"partialFingerprints":{"at/v1":"'$file'"},
            "locations":[{"physicalLocation":{"artifactLocation":{"uri":"'$file'"},"region":{"startLine":3}}}]}'
    done
    printf '{"version":"2.1.0","runs":[{"tool":{"driver":{"name":"t"}},"results":[%s]}]}' "$results" > "$name.sarif"
}
log before first.nc; log other second.nc; log both first.nc second.nc
seen=$(for after in other both; do
    code=0; told=$(venv/bin/sarif --check error diff before.sarif "$after.sarif" 2> /dev/null) || code=$?
    printf '%s: %s, exit code %s\n' "$after" "$(grep '^error' <<< "$told")" "$code"
done)
printf 'sarif-tools 3.0.5, an error in first.nc before; then in second.nc instead, and in both:\n%s\n' "$seen"
test "$seen" = "other: error level: +0 -0 no changes, exit code 0
both: error level: +0 +0, exit code 0"
