#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: an arc may be the first move behind G41, and becomes another arc: R10 about (10, 0) runs with R12 about (12, 0).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
echo "rs274 of linuxcnc-uspace 2.9.0~pre1"
seen=$(paths 'G41.1 D8\nG2 X20 Y0 R10 F100\nG1 X40\nG40 G1 X50 Y20' | head -1)
expect "G41.1 D8, then G2 X20 Y0 R10 from (0, 0)" "$seen" "ARC_FEED(23.3137, 4.0000, 12.0000, -0.0000, -1, 0.0000, 0.0000, 0.0000, 0.0000"
