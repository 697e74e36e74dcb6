from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{linear} stands at {x:diameter} at {switch}; enter the polar mode above 0",
    values=("x",),
    worse=("-x",),
    at=("on",),
    doubts=(("position", "way"),),
)
def x_not_positive_at_entry(mode: PolarMode, path: ProgrammedPath) -> Mask:
    """
    X at the center or beyond it where the polar mode begins.

    In the mode the tool stays on the plus side of X and C turns the part. Entered at X0 the control has no angle to
    start from; entered below 0 it would have to begin with half a turn. Approach from the plus side.

    Source: builder's guide to G12.1, deciding the machining method; Mitsubishi M700V programming manual, p. 77.

    Bad:

        G98 G0 X-60. C0
        G12.1             (expect: x-not-positive-at-entry)
        G1 X-40. F200
        C10.
        X-60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    return mode.enters & (path.x < ROUNDING)


def details(hit: Hit, path: ProgrammedPath) -> Details:
    return {"x": path.x[hit.row]}
