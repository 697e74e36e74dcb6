from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.coverage import Coverage
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "{left}",
    values={
        "height": "height_left",
        "radius": "radius_of_tool",
        "plane_x": "place_left.real",
        "plane_c": "place_left.imag",
    },
    worse=("height",),
    once="loop",
    worst="coverage.height",
)
def material_left(coverage: Coverage) -> Mask:
    """
    Material that no tool takes off, though the contour asks for it.

    In offset mode the tool stops R before the corner between a lead and the contour. Where it comes to the contour and
    leaves it in such leads, a rib stays on the part, unless the contour goes on beyond its start: by 2R and more if
    both leads are perpendicular to it. Or come and leave on arcs that are tangent to the contour, or ramp directly onto
    it. Between passes that are farther apart than 2R a ring or strip stays. What other tools take off at this Z or
    deeper is not left; grooves and islands wider than R are taken as meant, and so are inside corners of the part,
    where no cutter of that radius reaches more.

    Source: FANUC B-63944EN-1, p. 216 (the tool stops at the intersection on the inner side of a corner).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C-4. F500
        G42 X60. C0 F200
        X40.
        C20.
        X-40.
        C-20.
        X40.
        C1.               (expect: material-left)
        X60.
        G40 X80. C5.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C-4. F500
        G42 X60. C0 F200
        X40.
        C20.
        X-40.
        C-20.
        X40.
        C6.
        X60.
        G40 X80. C10.
        G13.1
    """
    return coverage.height > 0
