from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import OUT_OF_PLACE
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.crossings import Crossings
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the contour {crosses_line}: look for a wrong point or sign, a wrong arc, or a block that stands twice",
    values=("plane_x", "plane_c", "other_line"),
    gouges=True,
    once="loop",
    subject="outline",
    doubts=(("compensation", "loop"),),
    follows={"loop": (*OUT_OF_PLACE, "arc-sweep-above-limit")},
    is_symptom=True,
)
def contour_crosses_itself(crossings: Crossings) -> Mask:
    """
    Contour that crosses itself, or turns back along itself.

    With G41 or G42 the programmed path is the wall of the part. Where it crosses itself the tool is on the wrong side
    of the wall for a part of the way; where it turns back along the block before, both sides of one line are cut.
    Looked at is the contour of each pass: leads, what runs over the start once more, and the way from one pass to the
    next are left out, and so are paths without compensation, which may run to and fro.

    Source: B-62764EN/01, p. 53 (the programmed path is the contour).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X30. F200
        C15.
        C0                (expect: contour-crosses-itself)
        G40 X100.
        G13.1

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C20.
        X40. C-20.        (expect: contour-crosses-itself)
        X-40. C20.
        C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C20.
        X-40.
        C-20.
        X40.
        C6.
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X30. F200
        C8.660
        X0 C17.321
        X#5041 C8.660
        X-30. C-8.660
        X0 C-17.321
        X30. C-8.660
        C0
        G40 X100.
        G13.1
    """
    # Compares nothing: the table searches the moves of each pass for crossings.
    return crossings.crosses


def details(hit: Hit, crossings: Crossings) -> Details:
    into, place, back = crossings.of_row(hit.row)
    crosses = "turns back along" if back else "crosses"
    return {
        "plane_x": place.real,
        "plane_c": place.imag,
        "other_line": hit.line(into),
        "crosses_line": f"{crosses} line {hit.line(into)} at {hit.point_off_center(place)}",
    }
