#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: AND does not go before OR: both have one rank, from left to right, so that [1 OR 0 AND 0] is 0.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
echo "rs274 of linuxcnc-uspace 2.9.0~pre1"
expect "X[1 OR 0 AND 0] Y[1 OR [0 AND 0]]" "$(paths 'G0 X[1 OR 0 AND 0] Y[1 OR [0 AND 0]]')" "STRAIGHT_TRAVERSE(0.0000, 1.0000, 0.0000, 0.0000, 0.0000, 0.0000"
