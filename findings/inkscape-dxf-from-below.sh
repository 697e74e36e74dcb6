#!/bin/bash
# Inkscape 1.2.2, its DXF input: a polyline seen from below (extrusion 0, 0, -1) is mirrored, its bulges are not: its arcs bow to the other side; an ELLIPSE is mirrored, though its numbers are world ones. A message says that something may be wrong.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_inkscape"

# Reads a drawing of one entity (its groups are the second argument), prints its path in mm with y up, and fails unless it is what the finding says.
expect_path() {
    printf '0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 ENTITIES %s 0 ENDSEC 0 EOF' "$2" | tr ' ' '\n' > drawing.dxf
    echo >> drawing.dxf
    extension dxf_input --scalemethod=manual --scale=1.0 --xmin=0 --ymin=0 --gcodetoolspoints=false --encoding=latin_1 --font=Arial drawing.dxf > drawing.svg 2> messages
    seen=$(python/bin/python - <<'END'
import re

draw = re.findall(r'<path d="M ([-\d.]+),([-\d.]+) A ([-\d.]+),([-\d.]+) \S+ (\d),? (\d) ([-\d.]+),([-\d.]+)', open("drawing.svg").read())
begin_x, begin_y, _, _, _, sweep, end_x, end_y = map(float, draw[-1])
place = lambda x, y: f"({round(x * 25.4 / 96)}, {round(297 - y * 25.4 / 96)})"
print(place(begin_x, begin_y), "to", place(end_x, end_y), "clockwise" if sweep else "counter-clockwise")
END
    )
    echo "$1: $seen"
    test "$seen" = "$3" || { echo "changed; was: $3"; exit 1; }
}
below="210 0 220 0 230 -1"
echo "Inkscape 1.2.2, dxf_input"
expect_path "ARC of radius 10 about 20 from 0 to 90 degrees, from above" "0 ARC 8 0 10 20 20 0 40 10 50 0 51 90" "(30, 0) to (20, 10) counter-clockwise"
expect_path "the same from below (right)" "0 ARC 8 0 10 20 20 0 40 10 50 0 51 90 $below" "(-20, 10) to (-30, 0) counter-clockwise"
expect_path "half a circle by a bulge from 20 to 30, from above" "0 LWPOLYLINE 8 0 90 2 70 0 10 20 20 0 42 1 10 30 20 0" "(20, 0) to (30, 0) counter-clockwise"
expect_path "the same from below (clockwise is right)" "0 LWPOLYLINE 8 0 90 2 70 0 10 20 20 0 42 1 10 30 20 0 $below" "(-20, 0) to (-30, 0) counter-clockwise"
expect_path "ELLIPSE, axes 20 and 10, a quarter, from below (it begins at 20, 0)" "0 ELLIPSE 8 0 10 0 20 0 30 0 11 20 21 0 31 0 40 0.5 41 0 42 1.5707963 $below" "(-20, 0) to (0, -10) counter-clockwise"
