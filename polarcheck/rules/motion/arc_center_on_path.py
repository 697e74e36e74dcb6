from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.causes import END_IN_DOUBT
from polarcheck.rules.rule import ARC, ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "the center of the arc is its start or its end: a radius of 0",
    at=("I", "J"),
    doubts=END_IN_DOUBT,
    is_symptom=True,
    only_with=(ARC,),
)
def arc_center_on_path(arcs: Arcs) -> Mask:
    """
    Arc whose center is its start or its end.

    I0 J0 puts the center on the start, I and J that lead to the end put it there. Either is an arc without radius. The
    control stops with an alarm. I and J are counted from the start of the arc, not from the origin.

    Source: FANUC alarms 020, 038.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. I0 J0  (expect: arc-center-on-path)
        G1 X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. I-10. J10.  (expect: arc-center-on-path)
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. I-10. J0
        G1 X60.
        G13.1
    """
    return (arcs.start_radius <= ROUNDING) | (arcs.end_radius <= ROUNDING)
