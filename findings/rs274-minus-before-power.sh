#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: the minus of a number belongs to the number, so [-2**2] is 4; [0-2**2] is -4.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
echo "rs274 of linuxcnc-uspace 2.9.0~pre1"
expect "[-2**2] as X, [0-2**2] as Y" "$(paths 'G0 X[-2**2] Y[0-2**2]')" "STRAIGHT_TRAVERSE(4.0000, -4.0000, 0.0000, 0.0000, 0.0000, 0.0000"
