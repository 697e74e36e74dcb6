#!/bin/bash
# LinuxCNC 2.9.0~pre1, ohex.ngc and oquad.ngc of its ngcgui_lib: "3climb" runs counter-clockwise round the outside with M3, which is conventional milling; ihex.ngc, inside, does climb.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cp unpacked/usr/share/linuxcnc/ncfiles/ngcgui_lib/{,utilitysubs/}*.ngc .
echo "rs274 of linuxcnc-uspace 2.9.0~pre1, tool 8 under M3, direction 3"
sides() { paths "G20 G17\nT8 M6\n$1" | sed -nE 's/STRAIGHT_FEED\(([-0-9.]+), ([-0-9.]+), -5.*/(\1, \2)/p' | head -3 | xargs; }
hexagon="call [8] [1000] [100] [3] [40] [5] [5] [10] [0] [1] [0] [0] [0] [0] [0] [0] [0]"
expect "ihex, a hexagon of 40 from within: ends of its sides" "$(sides "o<ihex> $hexagon")" "(9.2376, 16.0000) (-9.2376, 16.0000) (-18.4752, -0.0000)"
expect "ohex, the same from without" "$(sides "o<ohex> $hexagon")" "(15.0111, 22.0000) (-11.5470, 24.0000) (-26.5581, 2.0000)"
expect "oquad, 100 by 60 from without" "$(sides "o<oquad> call [8] [1000] [3] [100] [5] [5] [10] [0] [0] [0] [100] [0] [100] [60] [0] [60] [1] [0] [0] [0] [0] [0] [0] [0]")" \
    "(100.0000, -4.0000) (104.0000, 60.0000) (0.0000, 64.0000)"
grep -hE '^ *#<dir>.*climb' ohex.ngc oquad.ngc | tr -s ' '
