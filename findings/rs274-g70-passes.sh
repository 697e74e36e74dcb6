#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: G70 with D1 E0.5 P3 leaves 0.8333, 0.6667 and 0.5 of stock: D is where the first pass comes from, not a pass of its own.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
contour='o100 sub\nG0 X10 Z0\nG1 Z-10\no100 endsub'
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; a cylinder of radius 10"
expect "X of the cuts, G70 D1 E0.5 P3" "$(paths "G20 G18 G8 F10\n$contour\nG0 X20 Z1\nG70 Q100 X20 Z1 D1 E0.5 P3" | sed -nE 's/STRAIGHT_FEED\(([0-9.]+).*-10.*/\1/p' | xargs)" "10.8333 10.6667 10.5000"
