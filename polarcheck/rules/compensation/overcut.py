from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.overcuts import Overcuts
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "the cutter goes {overcuts.depth:length} deep into {place}{way_out}",
    values={
        "depth": "overcuts.depth",
        "radius": "cutter_radius",
        "highest_radius": "radius_of_room",
        "plane_x": "place_of_overcut.real",
        "plane_c": "place_of_overcut.imag",
        "other_line": "line_of_overcut",
    },
    worse=("depth",),
    gouges=True,
    needs=("compensation.radius",),
    where="compensation.offset_mode",
    worst="overcuts.depth",
    once="wall",
)
def overcut(overcuts: Overcuts) -> Mask:
    """
    Tool cuts into the contour.

    The path of the tool center comes nearer than the cutter radius to another block of the same contour, and takes away
    material that the part keeps: a groove narrower than the cutter, a step lower than its radius, a corner that turns
    back. The control does not always see it, since it compares one block with the next. Use a smaller cutter or another
    order of the contour. Each contour is judged by itself, from the start-up to the offset cancel and depth by depth;
    passes inside each other and spirals do not count as cuts into each other.

    Source: FANUC B-63944EN-1, p. 216 (what interference check cannot find); B-63664EN, p. 184.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C3. F500
        G41 X60. F200
        X30.              (expect: overcut)
        C20.
        X-20.
        C-20.
        X30.
        C-3.
        X60.
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C3. F500
        G41 X60. F200
        X30.
        C20.
        X-20.
        C-20.
        X30.
        C-3.
        X60.
        G40 X100.
        G13.1
    """
    return overcuts.depth > 0
