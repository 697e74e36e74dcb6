from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.passes import Passes
    from polarcheck.columns.contour.same_circle import SameCircle
    from polarcheck.columns.contour.tangency import Tangency
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{code} turns a corner of {corner:.0f} deg at its ends; {code_needed} {fit}: write {code_needed}",
    values=("corner", "code", "code_needed"),
    worse=("corner",),
    gouges=True,
    at=("arc_clockwise", "arc_counterclockwise"),
    once="motion",
    doubts=(("compensation", "loop"), ("move", "loop")),
)
def arc_sense_reversed(tangency: Tangency, same_circle: SameCircle) -> Mask:
    """
    G2 where G3 is meant at a corner, or the reverse.

    A corner is rounded by an arc that is tangent to the blocks on both sides. With the other code the arc by R bends
    the other way, and the corner becomes a notch; by I and J it goes round the rest of the circle. Where the cutter
    fits into the notch no control objects, and the part is scrap. It is reported where the rest of the contour shows
    what is meant: another of its arcs is tangent, and this one alone would be the other way round, or it ends on the
    circle of another arc with the same R. Several such notches are a pattern that is meant.

    Source: FANUC B-62754EN/01, p. 67 (G02 clockwise, G03 counterclockwise).

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C10.
        G3 X20. C20. R10.
        G1 X-20.
        G2 X-40. C10. R10.   (expect: arc-sense-reversed)
        G1 C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C10.
        G3 X20. C20. R10.
        G1 X-20.
        G3 X-40. C10. R10.
        G1 C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C10.
        G2 X20. C20. R10.
        G1 X-20.
        G2 X-40. C10. R10.
        G1 C-20.
        X40.
        C0
        G40 X100.
        G13.1
    """
    return tangency.is_reversed | same_circle.reversed


def details(hit: Hit, tangency: Tangency, passes: Passes) -> Details:
    import numpy as np

    from polarcheck.rules.wording.arcs import arc_code

    fits, move = tangency.fits_reversed[hit.row], int(np.searchsorted(passes.row, hit.row))
    corners = np.abs([turn[move] for turn in passes.turns])
    return {
        "corner": np.degrees(np.min(corners) if fits else np.nanmax(corners)),
        "code": arc_code(hit.trace, hit.row),
        "code_needed": arc_code(hit.trace, hit.row, reverse=True),
        "fit": "is tangent to the blocks before and after it" if fits else "lies on one circle with the other arcs",
    }
