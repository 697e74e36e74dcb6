#!/bin/bash
# PyPI compas 2.15.1: an Arc from 350 to 10 degrees runs back over 180 degrees and has a negative length; from 350 to 370 it is refused, so that no arc can lead through 0.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check compas==2.15.1 2> /dev/null
python/bin/python -W ignore - <<'END'
from math import radians

from compas.geometry import Arc

arc = Arc(radius=5, start_angle=radians(350), end_angle=radians(10))
middle = arc.point_at(0.5)
found = (round(arc.length, 3), round(middle.x, 3), round(middle.y, 3))
try:
    beyond = Arc(radius=5, start_angle=radians(350), end_angle=radians(370)).length
except ValueError as error:
    beyond = str(error)
print(f"compas 2.15.1, radius 5: length and middle from 350 to 10 degrees {found}, to 370: {beyond}")
assert found == (-29.671, -5, 0) and beyond == "End angle must satisfy 0 <= angle <= 2 * pi.", "changed"
END
