#!/bin/bash
# LinuxCNC 2.9.0~pre1, radius.ngc of its macros for lathes (macros/lathe): takes eleven values, and names nine fields for QtVCP, which passes them in their order: with "front outside" nothing is cut, with "back outside" the number of the tool is Z, and the arc has no radius, which is an error.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cp unpacked/usr/share/linuxcnc/ncfiles/macros/lathe/radius.ngc .
printf 'T1 P1 D0.0 ;sharp\n' > tools.tbl
moves() { paths "G21 G18 G8\nG0 X14 Z2\no<radius> call $1" | sed -nE 's/^STRAIGHT_FEED\(([-0-9.]+), 0.0000, ([-0-9.]+).*/X\1 Z\2/p; s/^ARC_FEED.*/arc/p' | paste -sd';'; }
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; $(grep -o 'MACROCOMMAND.*' radius.ngc)"
expect "20, 100, 1, Z0, tool 1, radius 1, front outside" "$(moves "[20] [100] [1] [0] [1] [1] [1] [0] [0]")" ""
expect "20, 100, 1, Z0, tool 1, radius 1, back outside" "$(moves "[20] [100] [1] [0] [1] [1] [0] [0] [1]")" "X10.0000 Z1.0000"
expect "radius 1 as the eighth of eleven, Z0 as the fifth" "$(moves "[20] [100] [1] [0] [0] [1] [0] [1] [1] [0] [0]")" "X9.0000 Z0.0000;arc;X14.0000 Z-1.0000"
