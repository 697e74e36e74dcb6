#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: #5403 tells the Z offset of the tool in the spindle, in force or not: 10 without G43 and behind G49.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
printf 'T8 P8 D8.0 Z10.0 ;end mill\n' > tools.tbl
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; a tool with Z10 in the table, its offset read into X"
seen() { paths "G20 T8 M6\n$1\nG0 X#5403" | tail -1; }
expect "no G43" "$(seen "")" "STRAIGHT_TRAVERSE(10.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000"
expect "G43" "$(seen "G43")" "STRAIGHT_TRAVERSE(10.0000, 0.0000, -10.0000, 0.0000, 0.0000, 0.0000"
expect "G43, then G49" "$(seen "G43\nG49")" "STRAIGHT_TRAVERSE(10.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000"
