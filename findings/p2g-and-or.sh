#!/bin/bash
# PyPI p2g 0.3.10: `x > 0 and y > 0` tests y alone, `x > 0 or y > 0` tests x alone.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check p2g==0.3.10 2> /dev/null
cat > program.py <<'END'
import p2g


def main():
    x = p2g.Var(1)
    y = p2g.Var(2)
    if x > 0 and y > 0:
        x = 3
    if x > 0 or y > 0:
        y = 4
END
venv/bin/p2g --function=main program.py program.nc
printf 'p2g 0.3.10\n'; cat program.nc
test "$(grep -oE 'IF \[.*\]' program.nc | cut -d' ' -f1-4 | tr -d '\n')" = 'IF [#101 LE 0.]IF [#100 LE 0.]'
