from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Motion, Side
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.mirrored import Mirrored
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{side_in_force} has the cutter on the wrong side: both ramps go through the part, and on the other "
    "side the cutter cuts into none of the contour; {remedy}{or_other_sense}{likewise}",
    values=("code", "radius"),
    worse=("radius",),
    gouges=True,
    at=("compensation_left", "compensation_right"),
    once="program",
    doubts=(("compensation", "compensation"),),
    follows={"section": ("degrees-in-polar",)},
)
def side_of_compensation_mirrored(mirrored: Mirrored) -> Mask:
    """
    G41 where G42 is meant, or the reverse.

    The cutter runs on the side of the contour where the part is: it comes to the contour through the part, does not fit
    into the corners, and leaves through the part. With the other code, or with the contour the other way round, nothing
    is cut that should stay. It is reported where both ramps run through the part and the other side is free of faults
    from the start-up to the offset cancel; all faults of that loop follow from it. A negative R in the tool offset
    exchanges G41 and G42, too: then either of them is wrong. Where a slot is milled beside its own walls, with ramps in
    the open, nobody can tell that no rib is meant.

    Source: FANUC B-63944EN-2, cutter compensation, G41 and G42; 16/18-C mill manual p. 302 (negative R).

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G41 X40. F200     (expect: side-of-compensation-mirrored)
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X10. C0
        G12.1
        G1 G41 X40. F200
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X10.
        G13.1
    """
    # Compares nothing: the loop has to be run on its other side.
    return mirrored.is_mirrored


def details(hit: Hit, compensation: CutterCompensation, mirrored: Mirrored) -> Details:
    from polarcheck.rules.wording.written import code_of

    code = "compensation_left" if compensation.side[hit.row] == Side.RIGHT else "compensation_right"
    radius = hit.signed_radius
    return {
        "code": hit.side,
        "side_in_force": f"{hit.side} with the negative R {hit.length(radius)}" if radius < 0 else hit.side,
        "remedy": f"write {code_of(hit.trace.machine, code)}"
        + (f", or R {hit.length(-radius)} in the tool offset" if radius < 0 else ""),
        "or_other_sense": _or_other_sense(hit),
        "likewise": hit.likewise(mirrored.is_mirrored),
    }


def _or_other_sense(hit: Hit) -> str:
    """`, or G2 for G3 of line 18`, where one code of arcs is in force in all blocks of the contour."""
    import numpy as np

    from polarcheck.rules.wording.arcs import arc_code

    trace = hit.trace
    moves = np.flatnonzero(trace.path.travels)
    moves = moves[moves > hit.row]
    leave = np.flatnonzero(~trace.compensation.compensates[moves])
    moves = moves[: leave[0]] if len(leave) else moves
    codes = trace.modal.motion_word[moves]
    if not len(moves) or trace.axes.motion[moves[0]] not in (Motion.CW, Motion.CCW) or np.any(codes != codes[0]):
        return ""
    first = int(moves[0])
    return f", or {arc_code(trace, first, reverse=True)} for {arc_code(trace, first)} of line {hit.line(first)}"
