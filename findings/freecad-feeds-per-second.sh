#!/bin/bash
# FreeCAD 0.20.2, heidenhain_post, philips_post and fablin_post: feeds stay in mm/s, 10 mm/s is F10, where linuxcnc_post writes F600 (fablin_post itself has rapids at F10000, heidenhain_post at F8000); a dwell of 2 s is left out in heidenhain_post, and a G4 without a time in the others, as in centroid_post and dynapath_post.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_freecad"
# The workbench of FreeCAD has these loaded.
sed -i 's/^import Path$/&\nimport PathScripts.PathHelix, PathScripts.PathMillFace, PathScripts.PathProfileEdges, PathScripts.PathToolController/' post.py
while read -r name seen; do
    words=$(post "$name" "" "G0 X0 Y0 Z5" "G1 X10 Y0 Z-1 F10" "G4 P2" | grep -oE '\bG0?4\b.*|\bF[0-9.]+|.*Error.*' | sed 's/ *$//' | paste -sd' ')
    expect "FreeCAD 0.20.2, ${name}_post, a rapid, G1 at 10 mm/s and G4 P2" "$words" "$seen"
done <<'END'
heidenhain F8000 F10
philips F10.00 G4
fablin F10000 F10.00 G4
centroid F600.0 G4
dynapath F600.000 G4
linuxcnc F600.000 G4 P2.000
END
