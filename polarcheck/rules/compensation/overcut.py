from __future__ import annotations

import math
from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.fitting_radius import Fitting
    from polarcheck.columns.contour.overcuts import Overcuts
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "the cutter goes {depth:length} deep into {place}{way_out}",
    values=("depth", "radius", "highest_radius", "plane_x", "plane_c", "other_line"),
    worse=("depth",),
    gouges=True,
    once="wall",
    is_symptom=True,
)
def overcut(overcuts: Overcuts) -> Hits:
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
    return Hits(overcuts.depth > 0, worst=overcuts.depth)


def details(hit: Hit, overcuts: Overcuts, fitting: Fitting) -> Details:
    into, place = overcuts.cuts.deepest(hit.row)
    highest, way_out = _room(hit, fitting)
    return {
        "depth": overcuts.depth[hit.row],
        "highest_radius": highest,
        "plane_x": place.real,
        "plane_c": place.imag,
        "other_line": hit.line(into),
        "place": f"the contour of line {hit.line(into)} at {hit.point(place)}",
        "way_out": way_out,
    }


def needs(compensation: CutterCompensation) -> Needs:
    return compensation.offset_mode, {"radius": compensation.radius}


def _room(hit: Hit, fitting: Fitting) -> tuple[float, str]:
    """The largest R for which the contour has room, and what to write; NaN where that would take too long to find."""
    from polarcheck.foundation.errors import TooHardError

    try:
        never, largest = bool(fitting.never[hit.row]), float(fitting.radius[hit.row])
    except TooHardError:
        return math.nan, ""
    if never:
        return largest, "; a smaller one does, too: look for a wrong point of the contour"
    if math.isnan(largest):
        return largest, ""
    largest = math.floor(largest * 1000) / 1000
    return largest, f"; the contour has room for R {hit.length(largest)} at most"
