from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.tangency import Tangency
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "{written_arc} turns a corner of {tangency.corner:whole} deg at an end of the arc; {needed_arc} would {fit_of_arc}",
    values={
        "corner": "tangency.corner",
        "arc_radius": "radius_of_arc",
        "arc_radius_needed": "radius_needed",
        "word": "written_arc",
        "word_needed": "needed_arc",
    },
    worse=("corner",),
    at=("R", "I", "J"),
    once="misfit",
    subject="side",
    doubts=(("compensation", "loop"), ("move", "loop"), ("metal", "section")),
    follows={"block": ("arc-sweep-above-limit",)},
)
def arc_not_tangent(tangency: Tangency, arcs: Arcs) -> Mask:
    """
    Arc of a contour that is not tangent where the others are.

    An arc between two blocks rounds the corner between them if it is tangent to both. With another R, another center or
    the other sign of R it still ends where it should, and no control objects: the part has a corner at either end of
    the arc. It is reported where one word explains it: the other arcs of the contour are tangent, or all arcs have
    twice the R that would be, and with the R that is named this one is tangent, too. Arcs about the center of C, as
    those of a bar with flats, and contours whose corners are meant are not concerned.

    Source: FANUC B-62754EN/01, p. 67 (R of an arc).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C16.
        G3 X32. C20. R4.
        G1 X-32.
        G3 X-40. C16. R8.   (expect: arc-not-tangent)
        G1 C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X32. F200
        X12.5 C7.806
        G3 X12.5 C-7.806 R10.   (expect: arc-not-tangent)
        G1 X32. C0
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C16.
        G3 X32. C20. R4.
        G1 X-32.
        G3 X-40. C16. R4.
        G1 C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X30. F200
        C13.229
        G3 X-30. C13.229 R20.
        G1 C-13.229
        G3 X30. C-13.229 R20.
        G1 C0
        G40 X100.
        G13.1
    """
    return tangency.misfits & ~arcs.negative_stops
