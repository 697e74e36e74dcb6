#!/bin/bash
# FreeCAD 0.20.2, grbl_post --translate_drill: G81 is fed all the way from the initial height, not from R on; G73 is left as it is, which Grbl does not know.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_freecad"
drill() { post grbl --translate_drill "G0 X0 Y0 Z50" "$@" "G80" | grep -E '^G[0-9]+ .*[XZ]' | tail -n +2 | xargs; }
echo "FreeCAD 0.20.2, grbl_post --translate_drill, from Z50"
expect "G98 G81 Z-3 R1" "$(drill "G98" "G81 X10 Y5 Z-3 R1 F2")" "G0 X10.000 Y5.000 G1 Z-3.000 F120.00 G0 Z50.000"
expect "G99 G81 Z-3 R1" "$(drill "G99" "G81 X10 Y5 Z-3 R1 F2")" "G0 X10.000 Y5.000 G1 Z1.000 F120.00 G1 Z-3.000 F120.00 G0 Z1.000"
expect "G98 G73 Z-5 R1 Q2" "$(drill "G98" "G73 X10 Y5 Z-5 R1 Q2 F2")" "G73 X10.000 Y5.000 Z-5.000 F120.000 Q2.000 R1.000"
