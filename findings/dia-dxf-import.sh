#!/bin/bash
# dia 0.97.3, its DXF input: an LWPOLYLINE is left out without a word, an INSERT is drawn where its block was defined, and a quarter of an ELLIPSE becomes a whole one of other axes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_dia"

# Reads a drawing of one entity (its groups are the second argument), prints the shapes as SVG (20 for 1), and fails unless they are what the finding says.
expect_shape() {
    printf '0 SECTION 2 BLOCKS %s 0 ENDSEC 0 SECTION 2 ENTITIES %s 0 ENDSEC 0 EOF' "${4:-}" "$2" | tr -s ' ' '\n' > drawing.dxf
    echo >> drawing.dxf
    convert_by_dia drawing.dxf drawing.svg
    seen=$(grep -oE ' (d|cx|cy|rx|ry|x1|x2|y1|y2|points)="[^"]*"' drawing.svg | xargs)
    echo "$1: ${seen:-nothing}"
    test "$seen" = "$3" || { echo "changed; was: $3"; exit 1; }
}
block="0 BLOCK 8 0 2 B 70 0 10 0 20 0 3 B 0 CIRCLE 8 0 10 10 20 0 40 5 0 ENDBLK 8 0"
echo "dia 0.97.3, DXF to SVG"
expect_shape "LINE to (10, 5)" "0 LINE 8 0 10 0 20 0 11 10 21 5" "x1=0 y1=-0 x2=200 y2=-100"
expect_shape "LWPOLYLINE to (10, 5)" "0 LWPOLYLINE 8 0 90 2 70 0 10 0 20 0 10 10 20 5" ""
expect_shape "INSERT at (100, 50) of a circle at (10, 0)" "0 INSERT 8 0 2 B 10 100 20 50" "cx=200 cy=0 rx=100 ry=100" "$block"
expect_shape "ELLIPSE about (0, 0), axes 10 and 5, a quarter" "0 ELLIPSE 8 0 10 0 20 0 30 0 11 10 21 0 31 0 40 0.5 41 0 42 1.5707963" "cx=-5 cy=-50 rx=5 ry=50"
