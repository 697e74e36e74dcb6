#!/bin/bash
# PyPI gerbonara 1.5.0: of a drill file (Excellon), a slot in the usual form X30Y5G85X40Y5 is an unknown statement, and an arc in a route raises NameError; straight routes are read.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check gerbonara==1.5.0 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from gerbonara.excellon import ExcellonFile

PROGRAMS = {
    "straight route": "G00X0.0Y20.0\nM15\nG01X10.0Y20.0\nM16\nG05",
    "slot": "X30.0Y5.0G85X40.0Y5.0",
    "arc": "G00X0.0Y20.0\nM15\nG02X20.0Y20.0A10.0\nM16\nG05",
}
seen = {}
for name, body in PROGRAMS.items():
    try:
        file = ExcellonFile.from_string(f"M48\nMETRIC\nT1C1.000\n%\nG90\nG05\nT1\n{body}\nM30\n")
        seen[name] = f"{len(file.objects)} read"
    except SyntaxError as fault:
        seen[name] = type(fault.__cause__).__name__
    print(f"gerbonara 1.5.0, {name}: {seen[name]}")
assert seen == {"straight route": "1 read", "slot": "ValueError", "arc": "NameError"}, "changed"
END_OF_SCRIPT
python/bin/python run.py
