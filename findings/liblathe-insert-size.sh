#!/bin/bash
# PyPI liblathe 0.0.7: the outline of an insert, by which a path is kept off the part, has the inscribed circle of its code as the length of its sides: TNMG16 is a triangle with sides of 9.525 instead of 16.5, DCMT07 has sides of 6.35 instead of 7.75.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check liblathe==0.0.7 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from math import hypot, pi, sin, tan

from liblathe.tool.tool import Tool


def outline(code):
    """Sides of the insert and the diameter of the circle inside, 4 times its area over its girth."""
    ends = [(side.start.X, side.start.Z, side.end.X, side.end.Z) for side in Tool(code).get_segmentgroup().getSegments()]
    lengths = [hypot(x2 - x1, z2 - z1) for x1, z1, x2, z2 in ends]
    area = abs(sum(x1 * z2 - x2 * z1 for x1, z1, x2, z2 in ends)) / 2
    return round(lengths[0], 3), round(4 * area / sum(lengths), 3)


print("liblathe 0.0.7, side and inscribed circle")
for code, circle, side, seen in (
    ("TNMG160404R", 9.525, 9.525 * tan(pi / 3), (9.525, 5.499)),
    ("DCMT070204R", 6.35, 6.35 / sin(55 * pi / 180), (6.35, 5.202)),
    ("VBMT160404R", 9.525, 9.525 / sin(35 * pi / 180), (9.525, 5.463)),
):
    print(f"{code}: {outline(code)}, by its code {side:.2f} and {circle}")
    assert outline(code) == seen, "changed"
END_OF_SCRIPT
python/bin/python run.py
