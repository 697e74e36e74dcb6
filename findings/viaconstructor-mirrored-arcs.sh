#!/bin/bash
# PyPI viaconstructor 0.7.0, its DXF input: in a mirrored block the lines are mirrored and the arcs are not; the same with an LWPOLYLINE seen from below (extrusion 0, 0, -1), which falls apart.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_viaconstructor"
run_viaconstructor <<'END'
import ezdxf
from viaconstructor.input_plugins.dxfread import DrawReader

QUARTER = 0.41421356237309503


def ends(draw):
    """Ends of the lines and of the whole arcs that viaconstructor reads, millimetres."""
    drawing = ezdxf.new("R2000", units=4)
    draw(drawing)
    drawing.saveas("drawing.dxf")
    with contextlib.redirect_stdout(io.StringIO()):
        pieces = DrawReader("drawing.dxf", None).get_segments()
    places = []
    for piece in pieces:
        begin, end = (tuple(round(value) + 0 for value in point[:2]) for point in (piece.start, piece.end))
        if places and piece.type == "ARC" == places[-1][0] and places[-1][2] == begin:
            begin = places.pop()[1]
        places.append((piece.type, begin, end))
    return places


def block(drawing):
    part = drawing.blocks.new("PART")
    part.add_line((0, 0), (20, 0))
    part.add_arc((0, 0), 10, 0, 90)
    drawing.modelspace().add_blockref("PART", (100, 0), dxfattribs={"xscale": scale})


def polyline(drawing):
    drawing.modelspace().add_lwpolyline([(0, 0, QUARTER), (10, 10, 0), (20, 0, 0)], format="xyb", dxfattribs={"extrusion": (0, 0, side)})


print("viaconstructor 0.7.0")
for scale, seen in (
    (1, [("LINE", (100, 0), (120, 0)), ("ARC", (110, 0), (100, 10))]),
    (-1, [("LINE", (100, 0), (80, 0)), ("ARC", (110, 0), (100, 10))]),
):
    print("block, a line to 20 and an arc from (10, 0) to (0, 10), at 100, X scale", scale, ends(block))
    assert ends(block) == seen, "changed"
for side, seen in (
    (1, [("ARC", (0, 0), (10, 10)), ("LINE", (10, 10), (20, 0))]),
    (-1, [("ARC", (0, 0), (10, 10)), ("LINE", (-10, 10), (-20, 0))]),
):
    print("LWPOLYLINE, an arc to (10, 10) and a line to (20, 0), extrusion", side, ends(polyline))
    assert ends(polyline) == seen, "changed"
END
