#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: G71 leaves the tool at the end of the contour, not where it began: the next rapid starts there.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
contour='o100 sub\nG0 X10 Z0\nG1 Z-10\nX20 Z-20\no100 endsub'
moves=$(paths "G20 G18 G8 F10\n$contour\nG0 X26 Z1\nG71 Q100 X26 Z1 D0 R0.5 I4\nG0 X#5420 Z#5422")
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; a contour from X10 Z0 to X20 Z-20"
expect "before G71" "$(head -1 <<< "$moves")" "STRAIGHT_TRAVERSE(26.0000, 0.0000, 1.0000, 0.0000, 0.0000, 0.0000"
expect "behind G71" "$(tail -1 <<< "$moves")" "STRAIGHT_TRAVERSE(26.0000, 0.0000, -20.0000, 0.0000, 0.0000, 0.0000"
