#!/bin/bash
# PyPI vpype-dxf 0.2.0: an ELLIPSE becomes a whole circle of radius 1, whatever its axes and ends; a 3D POLYLINE raises AttributeError; arcs and a POLYLINE in the plane are right.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check vpype-dxf==0.2.0 vpype==1.15.0 ezdxf==1.4.5 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from math import pi

import ezdxf
import vpype_cli


def extent(draw):
    """The least and greatest x and y of what is read, the y of the drawing downwards."""
    drawing = ezdxf.new("R2010", units=4)
    draw(drawing.modelspace())
    drawing.saveas("drawing.dxf")
    (line,) = vpype_cli.execute("dread -q 0.05mm drawing.dxf").layers[1].lines
    millimetres = line * 25.4 / 96
    return [round(float(value), 1) + 0.0 for part in (millimetres.real, millimetres.imag) for value in (part.min(), part.max())]


for what, draw, seen in (
    ("quarter of radius 10 about (60, 20)", lambda space: space.add_arc((60, 20), 10, 0, 90), [60, 70, -30, -20]),
    ("quarter of an ellipse of 10 by 5 about (60, 20)", lambda space: space.add_ellipse((60, 20), (10, 0), 0.5, 0, pi / 2), [59, 61, -21, -19]),
    ("whole ellipse of 40 by 20 about (60, 20)", lambda space: space.add_ellipse((60, 20), (40, 0), 0.5), [59, 61, -21, -19]),
    ("POLYLINE in the plane", lambda space: space.add_polyline2d([(0, 0), (10, 5)]), [0, 10, -5, 0]),
):
    found = extent(draw)
    print(f"vpype-dxf 0.2.0, {what}:", found)
    assert found == seen, "changed"
try:
    extent(lambda space: space.add_polyline3d([(0, 0, 0), (10, 5, 0)]))
except AttributeError as error:
    print("3D POLYLINE:", error)
else:
    raise SystemExit("changed")
END_OF_SCRIPT
python/bin/python run.py
