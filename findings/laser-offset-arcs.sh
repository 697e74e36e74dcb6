#!/bin/bash
# PyPI laser-offset 0.7.0: arcs of a polyline (bulges) bow to the other side, so that a slot and its cuts become hourglasses, while the same slot of lines and arcs is right; each drawing comes out mirrored in Y, and one in inch is cut 0.1 inch beside its outline where 0.1 mm was asked.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check laser-offset==0.7.0 click==8.1.8 ezdxf==1.4.5 2> /dev/null
mkdir drawings cuts
cat > draw.py <<'END_OF_SCRIPT'
import ezdxf

slot = ezdxf.new("R2000", units=4)
slot.modelspace().add_lwpolyline([(0, 30), (20, 30, 0, 0, 1), (20, 40), (0, 40, 0, 0, 1)], close=True)
slot.saveas("drawings/polyline.dxf")
parts = ezdxf.new("R2000", units=4)
for start, end in (((0, 30), (20, 30)), ((20, 40), (0, 40))):
    parts.modelspace().add_line(start, end)
for center, start, end in (((20, 35), 270, 90), ((0, 35), 90, 270)):
    parts.modelspace().add_arc(center, 5, start, end)
parts.saveas("drawings/parts.dxf")
inch = ezdxf.new("R2000", units=1)
inch.modelspace().add_circle((1, 1), 1)
inch.saveas("drawings/inch.dxf")
END_OF_SCRIPT
python/bin/python draw.py
python/bin/laser_offset drawings cuts 200 > /dev/null
cat > run.py <<'END_OF_SCRIPT'
import ezdxf

first = {}
for name in ("polyline", "parts"):
    outline = ezdxf.readfile(f"cuts/{name}.dxf").modelspace().query("LWPOLYLINE").first
    first[name] = [tuple(float(round(value, 3)) + 0.0 for value in point) for point in outline.get_points("xyb")][:4]
    print(f"laser-offset 0.7.0, slot from y = 30 to 40 as {name}, its corners with their bulges:", first[name])
radii = sorted(round(circle.dxf.radius, 3) for circle in ezdxf.readfile("cuts/inch.dxf").modelspace().query("CIRCLE"))
print("a circle of 1 inch cut with a beam of 200 micrometres, radii in inch:", radii)
assert first["polyline"] == [(0, -30, 0), (20, -30, 1), (20, -40, 0), (0, -40, 1)], "changed"
assert first["parts"] == [(0, -30, 0), (20, -30, -1), (20, -40, 0), (0, -40, -1)], "changed"
assert radii == [0.9, 1, 1.1], "changed"
END_OF_SCRIPT
python/bin/python run.py
