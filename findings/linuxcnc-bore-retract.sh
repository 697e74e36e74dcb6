#!/bin/bash
# LinuxCNC 2.9.0~pre1, id.ngc of its ngcgui_lib for lathes: lifts off the wall by 0.010 on the diameter in any units: in mm the boring bar runs back at rapid 0.005 mm beside what it has cut, in inches 0.127 mm.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cp unpacked/usr/share/linuxcnc/ncfiles/ngcgui_lib/lathe/id.ngc .
printf 'T8 P8 D0.0 ;boring bar\n' > tools.tbl
# Prints the radius of the only cut, and that of the way back.
radii() { paths "$1 G18\n$2" | sed -nE 's/^STRAIGHT_(FEED|TRAVERSE)\(([0-9.]+), 0.0000, (-[0-9.]+),.*/\1 \2/p' | xargs; }
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; the cut, and the way off the wall at its end"
expect "bore of 24 to 25 mm" "$(radii G21 "o<id> call [24] [25] [1] [0] [2] [-15] [80] [50] [1500] [8] [9]")" "FEED 12.5000 TRAVERSE 12.4950"
expect "bore of 0.5 to 0.6 inch (in inches)" "$(radii G20 "o<id> call [0.5] [0.6] [0.1] [0] [0.1] [-0.6] [80] [2] [1500] [8] [9]")" "FEED 0.3000 TRAVERSE 0.2950"
