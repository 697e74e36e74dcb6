#!/bin/bash
# LibreCAD 2.2.0, its DXF input: a SPLINE whose knots are not clamped begins with a line from the origin, one by fit points alone is left out; of an LWPOLYLINE seen from below (extrusion 0, 0, -1) the corners are mirrored and the bulges are not, so that arcs bow to the other side, and an INSERT from below stays where it is.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_debian"
unpack_debian librecad=2.2.0-1
libraries="$PWD/unpacked/usr/lib/x86_64-linux-gnu"
cat > run.py <<'END_OF_SCRIPT'
import re
import subprocess
import zlib

BELOW = " 210 0 220 0 230 -1"
BLOCK = "0 BLOCK 8 0 2 B 70 0 10 0 20 0 30 0 3 B 0 LINE 8 0 10 0 20 0 11 20 21 0 0 ENDBLK 8 0"
CORNERS = " 10 100 20 100 10 100 20 110 10 120 20 110 10 120 20 100"


def spline(knots):
    return "0 SPLINE 8 0 70 8 71 3 72 8 73 4 74 0 " + " ".join(f"40 {knot}" for knot in knots) + CORNERS


def polyline(begin, end):
    return f"0 LWPOLYLINE 8 0 90 2 70 0 10 {begin} 20 100 42 0.41421356 10 {end} 20 110"


def drawn(entities):
    """First, middle and last point of what LibreCAD prints, millimetres with y up, sheet of 297."""
    groups = f"0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 BLOCKS {BLOCK} 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    with open("drawing.dxf", "w") as file:
        file.write("\n".join(groups.split()) + "\n")
    subprocess.run(["unpacked/usr/bin/librecad", "dxf2pdf", "drawing.dxf"], check=True, capture_output=True, timeout=60)
    streams = re.findall(rb"stream\r?\n(.*?)endstream", open("drawing.pdf", "rb").read(), re.DOTALL)
    page = zlib.decompress(streams[0]).decode("latin-1")
    points = re.findall(r"^(\S+) (\S+) [ml]$", page[page.index("W* n") :], re.MULTILINE)
    places = [(round(float(x) * 25.4 / 1200), round(297 - float(y) * 25.4 / 1200) + 0) for x, y in points]
    return [places[0], places[len(places) // 2], places[-1]] if places else []


print("LibreCAD 2.2.0: first, middle and last point")
for what, entities, seen in (
    ("SPLINE, knots 0 0 0 0 1 1 1 1", spline((0, 0, 0, 0, 1, 1, 1, 1)), [(100, 100), (110, 107), (120, 100)]),
    ("SPLINE, knots 0 to 7 (from 103, 108 to 117, 108)", spline(range(8)), [(0, 0), (108, 109), (120, 100)]),
    ("SPLINE through three points", "0 SPLINE 8 0 70 8 71 3 72 0 73 0 74 3 11 100 21 100 11 110 21 110 11 120 21 100", []),
    ("LWPOLYLINE, a quarter from 100 to 110", polyline(100, 110), [(100, 100), (107, 103), (110, 110)]),
    ("the same from below, -100 to -90 (by 93, 103)", polyline(-100, -90) + BELOW, [(100, 100), (97, 107), (90, 110)]),
    ("INSERT of a line to 20 at 100", "0 INSERT 8 0 2 B 10 100 20 100", [(100, 100), (120, 100), (120, 100)]),
    ("the same from below, at -100 (from 100 to 80)", "0 INSERT 8 0 2 B 10 -100 20 100" + BELOW, [(-100, 100), (-80, 100), (-80, 100)]),
):
    found = drawn(entities)
    print(f"{what}: {found}")
    assert found == seen, "changed"
END_OF_SCRIPT
export HOME="$PWD" XDG_RUNTIME_DIR="$PWD" LD_LIBRARY_PATH="$libraries" QT_QPA_PLATFORM=offscreen QT_PLUGIN_PATH="$libraries/qt5/plugins"
/usr/bin/python3 run.py
