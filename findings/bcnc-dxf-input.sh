#!/bin/bash
# PyPI bCNC 0.9.16, its DXF input: a polyline in a block of scale 2 is moved by 2 instead of scaled, and in a mirrored one by -1; the base point of a block is not taken off; ARC, CIRCLE and LWPOLYLINE seen from below (extrusion 0, 0, -1) stay where they are; a SPLINE whose knots are not clamped runs from its first control point to its last.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check --no-deps bCNC==0.9.16 numpy==2.4.6 svgelements==1.9.6 2> /dev/null
cat > run.py <<'END'
import builtins
import re

builtins._ = builtins.N_ = str
from CNC import GCode

BELOW = " 210 0 220 0 230 -1"
POLYLINE = "0 LWPOLYLINE 8 0 90 2 70 0 10 10 20 0 10 20 20 5"


def inserted(base, scale):
    block = f"0 BLOCK 8 0 2 B 70 0 10 {base} 20 0 30 0 3 B {POLYLINE} 0 ENDBLK 8 0"
    return f"0 INSERT 8 0 2 B 10 100 20 50 30 0 41 {scale} 42 {abs(scale)} 43 1", block


def spline(knots):
    corners = "10 0 20 0 30 0 10 0 20 10 30 0 10 20 20 10 30 0 10 20 20 0 30 0"
    return "0 SPLINE 8 0 70 8 71 3 72 8 73 4 74 0 " + " ".join(f"40 {knot}" for knot in knots) + " " + corners, ""


def cut(entities, blocks):
    """First and last point of the G-code that bCNC makes of a drawing."""
    layers = "0 SECTION 2 TABLES 0 TABLE 2 LAYER 70 1 0 LAYER 2 0 70 0 62 7 0 ENDTAB 0 ENDSEC"
    groups = f"0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 9 $INSUNITS 70 4 0 ENDSEC {layers} 0 SECTION 2 BLOCKS {blocks} 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    with open("drawing.dxf", "w") as file:
        file.write("\n".join(groups.split()) + "\n")
    program = GCode()
    program.importDXF("drawing.dxf")
    words = [re.search(r"x(\S+) y(\S+)", line) for block in program.blocks for line in block]
    points = [(round(float(word[1]), 1), round(float(word[2]), 1)) for word in words if word]
    return points[0], points[-1]


print("bCNC 0.9.16: first and last point")
for what, drawing, seen in (
    ("LWPOLYLINE", (POLYLINE, ""), ((10, 0), (20, 5))),
    ("INSERT at (100, 50)", inserted(0, 1), ((110, 50), (120, 55))),
    ("INSERT, scale 2", inserted(0, 2), ((112, 52), (122, 57))),
    ("INSERT, mirrored", inserted(0, -1), ((109, 50), (119, 55))),
    ("INSERT, base point at x = 10", inserted(10, 1), ((110, 50), (120, 55))),
    ("LWPOLYLINE from below", (POLYLINE + BELOW, ""), ((10, 0), (20, 5))),
    ("ARC from below, x = 30", ("0 ARC 8 0 10 30 20 0 30 0 40 10 50 0 51 90" + BELOW, ""), ((30, 10), (40, 0))),
    ("CIRCLE from below, x = 30", ("0 CIRCLE 8 0 10 30 20 0 30 0 40 10" + BELOW, ""), ((40, 0), (40, 0))),
    ("SPLINE, knots 0 0 0 0 1 1 1 1", spline((0, 0, 0, 0, 1, 1, 1, 1)), ((0, 0), (20, 0))),
    ("SPLINE, knots 0 to 7, from (3.3, 8.3) to (16.7, 8.3)", spline(range(8)), ((0, 0), (20, 0))),
):
    found = cut(*drawing)
    print(f"{what}: {found}")
    assert found == seen, "changed"
END
packages=$(echo python/lib/python3*/site-packages/bCNC)
PYTHONPATH="$packages:$packages/lib" python/bin/python -W ignore run.py
