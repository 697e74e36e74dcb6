#!/bin/bash
# FreeCAD 0.20.2, PathGeom.edgeForCmd, by which its dressups see a path: an arc of more than half a circle becomes the smaller one between its ends: G3 by 270 degrees is an edge of 90 degrees on the other side; the same arc with a Z is right.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_freecad"
run_freecad <<'END'
import PathScripts.PathGeom as PathGeom

print("FreeCAD 0.20.2, edges of radius 10 from (10, 0): length and middle")
for command, seen in (
    ("G3 X0 Y10 I-10 J0", (15.708, 7.07, 7.07)),
    ("G3 X0 Y-10 I-10 J0", (15.708, 7.07, -7.07)),
    ("G2 X0 Y10 I-10 J0", (15.708, 7.07, 7.07)),
    ("G3 X0 Y-10 Z-3 I-10 J0", (47.219, -7.07, 7.07)),
):
    edge = PathGeom.edgeForCmd(Path.Command(command), FreeCAD.Vector(10, 0, 0))
    middle = edge.valueAt((edge.FirstParameter + edge.LastParameter) / 2)
    found = (round(edge.Length, 3), round(middle.x, 2), round(middle.y, 2))
    print(command, found)
    assert found == seen, "changed"
END
