#!/bin/bash
# dxf2gcode 20191025: an arc drawn from below (extrusion 0, 0, -1) is not mirrored: it is cut at x = 20, where the drawing has it at x = -20.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_dxf2gcode"
echo "dxf2gcode 20191025"
expect_elements "ARC about (20, 0), radius 10, 0 to 90 degrees, extrusion (0, 0, -1)" \
    "0 ARC 8 0 10 20 20 0 30 0 40 10 210 0 220 0 230 -1 50 0 51 90" "30.00 0.00 to 20.00 10.00 by 90 degrees"
