#!/bin/bash
# LinuxCNC 2.9.0~pre1, taper-od.ngc of its ngcgui_lib for lathes: an angle of 10 turns a cone of 5.04 degrees to the axis: the diameter grows by tan 10, not the radius.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cp unpacked/usr/share/linuxcnc/ncfiles/ngcgui_lib/lathe/taper-od.ngc .
printf 'T1 P1 D0.0 ;sharp\n' > tools.tbl
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; from diameter 20 at Z0 to Z-10"
call='o<taper-od> call [1500] [100] [5] [0] [-10] [20]'
moves() { paths "G20 G18\nG0 X30 Z10\n$call [$1] [1] [9]" | sed -nE 's/STRAIGHT_FEED\(([-0-9.]+), 0.0000, (-10.0000|0.0000).*/\1 at \2/p' | head -2 | xargs; }
expect "radius of the cut, angle 10" "$(moves 10)" "10.0000 at 0.0000 10.8816 at -10.0000"
expect "radius of the cut, angle 45" "$(moves 45)" "10.0000 at 0.0000 15.0000 at -10.0000"
