#!/bin/bash
# PyPI dxfwrite 1.2.2: an elliptic arc ends a step short of its end angle (a quarter of 20 by 10 at 87.75 degrees, 0.785 beside its end); a clothoid 100 long with A 25 ends 1225 away, one with A 100 where it should; a spline through three points raises ZeroDivisionError, through four it is drawn.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check dxfwrite==1.2.2 ezdxf==1.4.5 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from math import hypot

import ezdxf
from dxfwrite import DXFEngine


def end_of(curve):
    drawing = DXFEngine.drawing("curve.dxf")
    drawing.add(curve)
    drawing.save()
    polyline = ezdxf.readfile("curve.dxf").modelspace().query("POLYLINE").first
    return tuple(round(value, 3) for value in polyline.vertices[-1].dxf.location)[:2]


quarter = end_of(DXFEngine.ellipse((0, 0), 20, 10, startangle=0, endangle=90, segments=40))
print("dxfwrite 1.2.2, a quarter of an ellipse that ends at (0, 10):", quarter)
assert quarter == (0.785, 9.992), "changed"
for parameter, seen in ((100, 98.89), (25, 1224.9)):
    distance = hypot(*end_of(DXFEngine.clothoid((0, 0), 0, 100, parameter, segments=20)))
    print(f"a clothoid 100 long with A {parameter}, distance of its ends:", round(distance, 2))
    assert abs(distance - seen) < 0.1, "changed"
points = [(0, 0), (10, 10), (20, 0), (30, 10)]
assert end_of(DXFEngine.spline(points, segments=20)) == (30, 10), "changed"
try:
    end_of(DXFEngine.spline(points[:3], segments=20))
except ZeroDivisionError as error:
    print("a spline through three points:", repr(error))
else:
    raise SystemExit("changed")
END_OF_SCRIPT
python/bin/python run.py
