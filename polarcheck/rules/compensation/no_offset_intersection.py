from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "paths of the tool center in this block and the next do not meet with R {signed_radius:length}",
    values=("radius",),
    worse=("radius",),
    gouges=True,
    once="loop",
    doubts=(("metal", "narrow loop"),),
    is_symptom=True,
)
def no_offset_intersection(tool_center: ToolCenter, ramps: Ramps) -> Mask:
    """
    Inside corner without a meeting point for the tool center.

    At an inside corner the tool center turns where its two paths meet. Beside an arc that is short or strongly curved
    for the cutter they may not meet at all, and the control stops with an alarm at the end of the block before. Take a
    smaller cutter, or change the corner.

    Source: FANUC B-63664EN, p. 178; alarm 033.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X110. C0
        G12.1
        G1 C20. F500
        G41 X60. F200
        C0.                (expect: no-offset-intersection)
        G3 X70. C0. R5.
        G1 C-20.
        G40 X110.
        G13.1

    Good, tool 1:radius=2:

        T0101
        G98 G0 X110. C0
        G12.1
        G1 C20. F500
        G41 X60. F200
        C0.
        G3 X70. C0. R5.
        G1 C-20.
        G40 X110.
        G13.1
    """
    return tool_center.no_intersection & ~ramps.is_consequence


def needs(compensation: CutterCompensation, ramps: Ramps) -> Needs:
    return ramps.compensated, {"radius": compensation.radius}
