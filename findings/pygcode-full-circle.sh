#!/bin/bash
# PyPI pygcode 0.2.1: `G2 I5`, a full circle, raises NameError in linearize_arc; so does every arc without a named method.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pygcode==0.2.1 2> /dev/null
venv/bin/python - <<'END'
from pygcode import Line
from pygcode.machine import Position
from pygcode.transform import ArcLinearizeMid, linearize_arc

start = Position(X=0, Y=0, Z=0)
half = list(linearize_arc(Line("G2 X10 Y0 I5").block.gcodes[0], start, method_class=ArcLinearizeMid))
print("pygcode 0.2.1: half a circle becomes", len(half), "lines")
for block, options in (("G2 I5", {"method_class": ArcLinearizeMid}), ("G2 X10 Y0 I5", {})):
    try:
        list(linearize_arc(Line(block).block.gcodes[0], start, **options))
    except NameError as error:
        print(block, options, "raises:", error)
    else:
        raise SystemExit(f"{block} no longer raises")
END
