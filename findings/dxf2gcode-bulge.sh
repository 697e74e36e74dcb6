#!/bin/bash
# dxf2gcode 20191025: the bulge of a vertex bends the segment that ends there, not the one that begins there: a slot of straight sides and round ends becomes another shape.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_dxf2gcode"
echo "dxf2gcode 20191025"
vertices="10 0 20 0 42 0 10 20 20 0 42 1 10 20 20 10 42 0 10 0 20 10 42 1"
expect_elements "LWPOLYLINE, a slot: lines at y = 0 and y = 10, half circles of radius 5 at x = 0 and x = 20" "0 LWPOLYLINE 8 0 90 4 70 1 $vertices" \
    "0.00 0.00 to 0.00 10.00 by -180 degrees
0.00 10.00 to 20.00 10.00 by -180 degrees
20.00 10.00 to 20.00 0.00
20.00 0.00 to 0.00 0.00 by -180 degrees"
