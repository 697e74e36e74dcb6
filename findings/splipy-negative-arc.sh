#!/bin/bash
# PyPI splipy 1.10.1: circle_segment with -90 degrees begins at -90 and ends at 0, counter-clockwise like one with 90 degrees: a negative angle does not turn it round.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check splipy==1.10.1 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from math import pi

from splipy.curve_factory import circle_segment

for degrees, expected in ((90, [[10, 0], [0, 10]]), (-90, [[0, -10], [10, 0]])):
    arc = circle_segment(degrees / 180 * pi, 10)
    ends = [[round(float(value), 9) + 0.0 for value in arc(place)] for place in (arc.start(0), arc.end(0))]
    print(f"splipy 1.10.1, circle_segment by {degrees} degrees, from and to:", ends)
    assert ends == expected, "changed"
END_OF_SCRIPT
python/bin/python run.py
