#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: EQ has a tolerance of 0.0001 and LT has none, so that two numbers can be equal and less at once.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
echo "rs274 of linuxcnc-uspace 2.9.0~pre1"
expect "[1 EQ 1.00005] as X, [1 LT 1.00005] as Y" "$(paths 'G0 X[1 EQ 1.00005] Y[1 LT 1.00005]')" "STRAIGHT_TRAVERSE(1.0000, 1.0000, 0.0000, 0.0000, 0.0000, 0.0000"
