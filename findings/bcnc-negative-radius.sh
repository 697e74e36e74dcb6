#!/bin/bash
# PyPI bCNC 0.9.16: an arc with a negative R is drawn as the line between its ends; with the same R without the minus it is an arc.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check --no-deps bCNC==0.9.16 numpy==2.4.6 svgelements==1.9.6 2> /dev/null
PYTHONPATH=$(echo venv/lib/python3*/site-packages/bCNC):$(echo venv/lib/python3*/site-packages/bCNC/lib) venv/bin/python - <<'END'
import builtins

builtins._ = builtins.N_ = str
from CNC import CNC


def highest(block: str) -> float:
    machine = CNC()
    machine.initPath()
    for text in ("G90 G0 X0 Y0", block):
        machine.motionStart(CNC.parseLine(text))
        points = machine.motionPath()
        machine.motionEnd()
    return max(point[1] for point in points)


short, long = highest("G2 X10 Y0 R8"), highest("G2 X10 Y0 R-8")
print(f"bCNC 0.9.16, from X0 Y0: G2 X10 Y0 R8 reaches Y{short:.2f}; R-8 reaches Y{long:.2f} (right: Y14.24)")
assert 1.7 < short < 1.8 and long == 0
END
