#!/bin/bash
# dxf2gcode 20191025: a block that is mirrored and turned by 30 degrees is turned by -30: it is turned before it is mirrored; (-8.66, -5) is right.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_dxf2gcode"
echo "dxf2gcode 20191025, a block with a line from (0, 0) to (10, 0)"
block="0 BLOCK 8 0 2 B 70 0 10 0 20 0 30 0 3 B 0 LINE 8 0 10 0 20 0 30 0 11 10 21 0 31 0 0 ENDBLK 8 0"
insert="0 INSERT 8 0 2 B 10 0 20 0 30 0"
expect_elements "turned by 30 degrees" "$insert 41 1 42 1 43 1 50 30" "0.00 0.00 to 8.66 5.00" "$block"
expect_elements "mirrored by a scale of -1 in X, and turned by 30 degrees" "$insert 41 -1 42 1 43 1 50 30" "0.00 0.00 to -8.66 5.00" "$block"
