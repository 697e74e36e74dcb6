#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: #5420, the current position, is not given programmed or offset while G41 is in force: reading it is an error.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
echo "rs274 of linuxcnc-uspace 2.9.0~pre1"
expect "without G41" "$(paths 'G1 X20 F100\n#1=#5420\nG0 X[#1+1]' | tail -1)" "STRAIGHT_TRAVERSE(21.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000"
expect "in G41" "$(paths 'G41.1 D8\nG1 X20 F100\nG1 X40\n#1=#5420\nG0 X#1' | tail -1)" "Cannot read current position with cutter radius compensation on"
