#!/bin/bash
# PyPI pygcode 0.2.1, pygcode-norm --canned_expand: under G99 the tool leaves the first hole for the initial height, and is fed into the next one from there; G82 raises NameError.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check pygcode==0.2.1 2> /dev/null
printf 'G21 G90 G94 G17\nG0 X0 Y0 Z10\nG99\nG81 X5 Y5 Z-3 R2 F100\nX10\nG80\nM2\n' > holes.ngc
seen=$(python/bin/pygcode-norm --canned_expand holes.ngc | grep -vE '^\(' | xargs)
echo "pygcode 0.2.1, two holes from Z10 with G99, R2, Z-3: $seen"
test "$seen" = "G21 G90 G94 G17 G00 X0 Y0 Z10 G99 F100 G00 X5 Y5 Z2 G01 Z-3 G00 Z10 G00 X10 Y5 G01 Z-3 G00 Z2 G80 M02"
sed -i 's/G81/G82/; s/R2/R2 P1/' holes.ngc
seen=$(python/bin/pygcode-norm --canned_expand holes.ngc 2>&1 > /dev/null | tail -1)
echo "the same with G82 and a dwell: $seen"
test "$seen" = "NameError: name 'GCodeDwell' is not defined"
