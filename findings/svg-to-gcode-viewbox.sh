#!/bin/bash
# PyPI svg-to-gcode 1.5.4: the viewBox plays no part: a line from 10 to 20 mm, drawn in tenths, is cut from X100 to X200, at Y0 instead of Y90; a rotation about a point raises TypeError, one about the origin is right.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check svg-to-gcode==1.5.4 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from svg_to_gcode.svg_parser import parse_string


def ends(size, path):
    drawing = f'<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 {size} {size}">{path}</svg>'
    (line,) = parse_string(drawing)
    return [(round(point.x, 3) + 0.0, round(point.y, 3) + 0.0) for point in (line.start, line.end)]


for size, path, seen in (
    (100, '<path d="M10 10L20 10"/>', [(10, 90), (20, 90)]),
    (1000, '<path d="M100 100L200 100"/>', [(100, 0), (200, 0)]),
    (100, '<path transform="rotate(90)" d="M10-10L20-10"/>', [(10, 90), (10, 80)]),
):
    found = ends(size, path)
    print(f"svg-to-gcode 1.5.4, 100 mm of {size} units, {path}:", found)
    assert found == seen, "changed"
try:
    ends(100, '<path transform="rotate(90 50 50)" d="M10 10L20 10"/>')
except TypeError as error:
    print("rotate(90 50 50):", error)
else:
    raise SystemExit("changed")
END_OF_SCRIPT
python/bin/python run.py
