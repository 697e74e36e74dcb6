#!/bin/bash
# LinuxCNC 2.9.0~pre1, helix.ngc of its ngcgui_lib: cutting a circle from without is refused, "duplicate O-word label", so hole_circle.ngc cuts from within alone.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cp unpacked/usr/share/linuxcnc/ncfiles/ngcgui_lib/{,utilitysubs/}*.ngc .
echo "rs274 of linuxcnc-uspace 2.9.0~pre1, tool 8, a circle of 20"
circle() {
    printf 'G20 G17\nT8 M6\no<helix> call [8] [1000] [100] [3] [%s] [5] [5] [10] [0] [0] [20] [0] [0] [0] [0] [0] [0] [0]\nM2\n' "$1" > program.ngc
    unpacked/usr/bin/rs274 -g -v parameters.var -t tools.tbl program.ngc < /dev/null 2>&1 | grep -oE 'ARC_FEED\([-0-9., ]*-5.0000|duplicate O-word label' | head -1
}
expect "from within: its first half turn" "$(circle 1)" "ARC_FEED(6.0000, -0.0000, 0.0000, -0.0000, 1, -5.0000"
expect "from without" "$(circle 0)" "duplicate O-word label"
