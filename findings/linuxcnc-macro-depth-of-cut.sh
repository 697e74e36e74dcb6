#!/bin/bash
# LinuxCNC 2.9.0~pre1, its macros for lathes (macros/lathe): the depth of cut of turning.ngc is on the diameter, that of boring.ngc on the radius: with 2, a cut outside takes 1 per side, a cut inside 2.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cp unpacked/usr/share/linuxcnc/ncfiles/macros/lathe/{turning,boring}.ngc .
printf 'T1 P1 D0.0 ;sharp\n' > tools.tbl
# Fields: finish diameter, speed, depth of cut, feed, finish length, radius, angle, tool (and greatest speed of the spindle).
cuts() { paths "G21 G18 G8\nG0 X$1 Z2\n$2" | sed -nE 's/STRAIGHT_FEED\(([0-9.]+), 0.0000, -10.*/\1/p' | awk 'NR % 2' | xargs; }
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; depth of cut 2"
expect "radii of the cuts, turning from 28 to 20" "$(cuts 14 "o<turning> call [20] [100] [2] [0.1] [-10] [0] [0] [1] [1500]")" "13.0000 12.0000 11.0000 10.0000"
expect "radii of the cuts, boring from 20 to 28" "$(cuts 10 "o<boring> call [28] [100] [2] [0.1] [-10] [0] [0] [1]")" "12.0000 14.0000"
