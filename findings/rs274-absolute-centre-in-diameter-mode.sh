#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: under G7 with absolute centres (G90.1) the X of a block is a diameter, its I a radius: the centre X20 is I10.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; an arc from X20 Z0 to X20 Z-10, its centre at Z-5: end Z and X, centre Z and X, in radii"
for i in 10 20; do
    expect "G7 G90.1, I$i" "$(paths "G20 G18 G7 G90.1 F10\nG0 X20 Z0\nG2 X20 Z-10 I$i K-5" | tail -1)" "ARC_FEED(-10.0000, 10.0000, -5.0000, $i.0000, -1, 0.0000, 0.0000, 0.0000, 0.0000"
done
