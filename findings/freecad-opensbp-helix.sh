#!/bin/bash
# FreeCAD 0.20.2, opensbp_post (ShopBot): a helix loses its Z, and the depth counts as reached: a bore by three turns down to -3 is three circles at the top, and the move at that depth behind it stays there, too.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_freecad"
blocks() { post opensbp "" "$@" | grep -E '^(J|M|CG)|Error' | paste -sd' '; }
echo "FreeCAD 0.20.2, opensbp_post"
expect "G1 X10 Z-3 and G2 at that depth" "$(blocks "G0 X0 Y0 Z0" "G1 X10 Y0 Z-3 F10" "G2 X20 Y0 I5 J0 Z-3" "G1 X30 Z-3")" "MS,10.000000,10.000000 M3,10.0000,,-3.0000 CG,,20.0000,0.0000,5.0000,0.0000,T,1 MX,30.0000"
expect "three turns to Z-3, G1 X10 Z-3" "$(blocks "G0 X0 Y0 Z0" "G1 X1 F10" "G2 X1 Y0 I5 J0 Z-1" "G2 X1 Y0 I5 J0 Z-2" "G2 X1 Y0 I5 J0 Z-3" "G1 X10 Z-3")" "MS,10.000000, MX,1.0000 CG,,1.0000,0.0000,5.0000,0.0000,T,1 CG,,1.0000,0.0000,5.0000,0.0000,T,1 CG,,1.0000,0.0000,5.0000,0.0000,T,1 MX,10.0000"
