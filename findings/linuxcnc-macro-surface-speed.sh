#!/bin/bash
# LinuxCNC 2.9.0~pre1, its macros for lathes (macros/lathe) where inches are in force: 300 feet per minute (91.44 m/min) becomes S91440 in turning, facing, chamfer and threading, and S984 in boring, all under G96 with G21, where S is in m/min.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cp unpacked/usr/share/linuxcnc/ncfiles/macros/lathe/*.ngc .
printf 'T1 P1 D0.0 ;sharp\n' > tools.tbl
speed() {
    printf '%b\nM2\n' "G20 G18 G8\nG0 X0.6 Z0.2\no<$1" > program.ngc
    unpacked/usr/bin/rs274 -g -v parameters.var -t tools.tbl program.ngc < /dev/null 2>&1 |
        sed -nE 's/.*SET_SPINDLE_SPEED\(0, ([0-9.]+)\).*/\1/p; s/.*CANON_UNITS_MM.*/mm/p' | uniq | head -2 | xargs
}
echo "rs274 of linuxcnc-uspace 2.9.0~pre1; units and speed for 300 feet per minute"
expect "turning" "$(speed "turning> call [1] [300] [.1] [.004] [-.4] [0] [0] [1] [1500]")" "mm 91440.0000"
expect "facing" "$(speed "facing> call [0] [300] [.1] [.004] [-.1] [0] [1] [1500]")" "mm 91440.0000"
expect "chamfer" "$(speed "chamfer> call [1] [300] [.1] [0] [1] [.05] [1] [0] [0] [1500]")" "mm 91440.0000"
expect "threading" "$(speed "threading> call [1] [300] [1] [.05] [-1] [0] [1]")" "mm 91440.0000"
expect "boring" "$(speed "boring> call [1] [300] [.1] [.004] [-.4] [0] [0] [1]")" "mm 984.0000"
