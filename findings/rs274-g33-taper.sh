#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: the K of G33 is the lead along the path, not along Z: a taper of 45 degrees with K2 has a lead of 1.414 along Z; the run-out of G76 keeps its P along Z, 4.472 along a path of X2 Z-1.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"

# Prints the leads per turn that the spindle is coupled with, each with the feed that follows.
leads() {
    paths "$1" > /dev/null
    unpacked/usr/bin/rs274 -g -v parameters.var -t tools.tbl program.ngc < /dev/null 2>&1 | sed -nE 's/.*START_SPEED_FEED_SYNC\(([0-9.]+),.*/lead \1/p; s/.*STRAIGHT_FEED\(([-0-9.]+), 0.0000, ([-0-9.]+),.*/to X\1 Z\2/p' | xargs
}
echo "rs274 of linuxcnc-uspace 2.9.0~pre1"
expect "G33 K2 by Z-10" "$(leads 'G20 G18 G8 S100 M3\nG0 X0 Z0\nG33 Z-10 K2')" "lead 2.000000 to X0.0000 Z-10.0000"
expect "G33 K2 by X10 Z-10" "$(leads 'G20 G18 G8 S100 M3\nG0 X0 Z0\nG33 X10 Z-10 K2')" "lead 2.000000 to X10.0000 Z-10.0000"
expect "G76 P2, run-out by X2 Z-1, first pass" "$(leads 'G20 G18 G8 S100 M3\nG0 X10 Z0\nG76 P2 Z-10 I-1 J1 K2 E1 L2' | cut -d' ' -f1-10)" "lead 2.000000 to X8.0000 Z-9.0000 lead 4.472136 to X10.0000 Z-10.0000"
