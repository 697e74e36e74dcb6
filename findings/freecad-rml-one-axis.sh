#!/bin/bash
# FreeCAD 0.20.2, rml_post: a feed move that names X or Y alone is left out, so that the next one goes diagonally; a whole circle raises OCCError.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_freecad"
moves() { post rml "" "$@" | grep -E '^(P[UD][0-9]|Z)|Error' | xargs; }
echo "FreeCAD 0.20.2, rml_post (40 units per mm)"
expect "G1 X10 Y0, G1 X10 Y20" "$(moves "G0 X0 Y0 Z5" "G1 X10 Y0 Z-1 F10" "G1 X10 Y20 Z-1 F10")" "PU0,0; Z400,0,-40; Z400,800,-40;"
expect "G1 X10, G1 Y20, G1 X30 Y20" "$(moves "G0 X0 Y0 Z5" "G1 Z-1 F10" "G1 X10 F10" "G1 Y20" "G1 X30 Y20")" "PU0,0; PD1200,800;"
expect "G2 X20 Y0 I5, half a circle" "$(moves "G0 X10 Y0 Z5" "G1 X10 Y0 Z-1 F10" "G2 X20 Y0 I5 J0" | sed 's/ .* / .. /')" "PU400,0; .. Z800,0,-40;"
expect "G2 X10 Y0 I5, a whole one" "$(moves "G0 X10 Y0 Z5" "G1 X10 Y0 Z-1 F10" "G2 X10 Y0 I5 J0")" "OCCError: Geom_TrimmedCurve::U1 == U2"
