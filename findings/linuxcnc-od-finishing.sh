#!/bin/bash
# LinuxCNC 2.9.0~pre1, od.ngc of its ngcgui_lib for lathes: asks for a final cut and a finishing tool, and uses neither: the roughing tool takes the last full cut.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cp unpacked/usr/share/linuxcnc/ncfiles/ngcgui_lib/lathe/od.ngc .
printf 'T1 P1 ;roughing\nT2 P2 ;finishing\n' > tools.tbl
# Prints the tools and the radii of the cuts from diameter 30 to 20 by 2, for a final cut.
cuts() {
    printf '%b\nM2\n' "G21 G18\nG0 X40 Z5\no<od> call [30] [20] [2] [$1] [100] [50] [1500] [-20] [2] [1] [2] [9]" > program.ngc
    unpacked/usr/bin/rs274 -g -v parameters.var -t tools.tbl program.ngc < /dev/null 2>&1 |
        sed -nE 's/.*SELECT_TOOL\(([0-9]+)\).*/T\1/p; s/.*STRAIGHT_FEED\(([0-9.]+), .*/\1/p' | xargs
}
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; diameter 30 to 20 by 2, T1 roughs, T2 finishes"
expect "tools and radii of the cuts, final cut 0.2" "$(cuts 0.2)" "T1 14.0000 13.0000 12.0000 11.0000 10.0000"
expect "tools and radii of the cuts, final cut 0" "$(cuts 0)" "T1 14.0000 13.0000 12.0000 11.0000 10.0000"
