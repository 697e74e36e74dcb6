#!/bin/bash
# PyPI p2g 0.3.10: `x - (y + 1)` becomes `#100 - #101 + 1.`: brackets behind an operator of the same rank are lost; `2 * (x + y)` keeps them.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check p2g==0.3.10 2> /dev/null
cat > program.py <<'END'
import p2g


def main():
    x = p2g.Var(1)
    y = p2g.Var(2)
    a = p2g.Var(x - (y + 1))
    b = p2g.Var(10 / (x / y))
    c = p2g.Var(2 * (x + y))
END
venv/bin/p2g --function=main program.py program.nc
printf 'p2g 0.3.10\n'; cat program.nc
grep -qF '#102= #100 - #101 + 1. ' program.nc
grep -qF '#103= 10. / #100 / #101 ' program.nc
grep -qF '#104= [#100 + #101] * 2. ' program.nc
