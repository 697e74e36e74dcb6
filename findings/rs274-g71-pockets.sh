#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: G71 roughs the pockets of the contour, too; G71.1 passes them over, in its last cut along the contour as well.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
contour='o100 sub\nG0 X10 Z0\nG1 Z-5\nX6 Z-8\nZ-12\nX10 Z-14\nZ-20\nX20\no100 endsub'
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; a bar of 20 with a groove from 10 down to 6, passes of 4: number of cuts at X8, at X6"
for code in G71 G71.1; do
    moves=$(paths "G20 G18 G8 F10\n$contour\nG0 X20 Z1\n$code Q100 X20 Z1 D0 R0.5 I4")
    counts="$(grep -c 'FEED(8.0000' <<< "$moves" || true) $(grep -c 'FEED(6.0000' <<< "$moves" || true)"
    expect "$code" "$counts" "$(test $code = G71 && echo '3 2' || echo '0 0')"
done
