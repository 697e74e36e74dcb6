#!/bin/bash
# FreeCAD 0.20.2, Import.readDXF: the base point of a block is not taken off, of an INSERT with three columns one is drawn, and one within a block is left out without a word; CIRCLE and LWPOLYLINE seen from below (extrusion 0, 0, -1) stay where they are, though an ARC is mirrored, and a quarter of an ELLIPSE is a whole one.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_freecad"
run_freecad <<'END'
sys.path.append(usr + "lib/freecad-python3/Mod")
import Import

BELOW = " 210 0 220 0 230 -1"
LINE = " 0 LINE 8 0 10 0 20 0 11 20 21 0"


def block(name, base, content):
    return f" 0 BLOCK 8 0 2 {name} 70 0 10 {base} 20 0 30 0 3 {name} {content} 0 ENDBLK 8 0"


def middles(blocks, entities):
    """Middles of the edges that FreeCAD reads, millimetres."""
    groups = f"0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 BLOCKS {blocks} 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    with open("drawing.dxf", "w") as file:
        file.write("\n".join(groups.split()) + "\n")
    document = FreeCAD.newDocument()
    Import.readDXF("drawing.dxf", document.Name)
    edges = [edge for part in document.Objects if hasattr(part, "Shape") for edge in part.Shape.Edges]
    points = [edge.valueAt((edge.FirstParameter + edge.LastParameter) / 2) for edge in edges]
    return [(round(point.x), round(point.y)) for point in points]


print("FreeCAD 0.20.2, Import.readDXF: middles of what is drawn, and those that are right")
for what, blocks, entities, seen, right in (
    ("block of a line to 20, at 100", block("B", 0, LINE), "0 INSERT 8 0 2 B 10 100 20 0", [(110, 0)], [(110, 0)]),
    ("the same with base point 10", block("B", 10, LINE), "0 INSERT 8 0 2 B 10 100 20 0", [(110, 0)], [(100, 0)]),
    ("three columns, 30 apart", block("B", 0, LINE), "0 INSERT 8 0 2 B 10 100 20 0 70 3 44 30", [(110, 0)], [(110, 0), (140, 0), (170, 0)]),
    ("a block in a block", block("B", 0, LINE) + block("C", 0, "0 INSERT 8 0 2 B 10 5 20 0"), "0 INSERT 8 0 2 C 10 100 20 0", [], [(115, 0)]),
    ("ARC from below", "", "0 ARC 8 0 10 20 20 0 30 0 40 10 50 0 51 90" + BELOW, [(-27, 7)], [(-27, 7)]),
    ("CIRCLE about 20 from below", "", "0 CIRCLE 8 0 10 20 20 0 30 0 40 10" + BELOW, [(30, 0)], [(-10, 0)]),
    ("LWPOLYLINE to 20 from below", "", "0 LWPOLYLINE 8 0 90 2 70 0 10 0 20 0 10 20 20 0" + BELOW, [(10, 0)], [(-10, 0)]),
    ("ELLIPSE, 0 to 90 degrees", "", "0 ELLIPSE 8 0 10 0 20 0 30 0 11 20 21 0 31 0 40 0.5 41 0 42 1.5707963", [(-20, 0)], [(14, 7)]),
):
    found = middles(blocks, entities)
    print(f"{what}: {found}, {right}")
    assert found == seen, "changed"
END
