from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.procedure import Procedure
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "arc with X and {rotary} outside the polar mode: {rotary} is an angle here, and no plane has both axes; write "
    "{code_needed} before the contour",
    values=("code_needed",),
    gouges=True,
    at=("arc_clockwise", "arc_counterclockwise"),
    once="tool call",
    subject="mode",
)
def arc_outside_polar_mode(procedure: Procedure) -> Mask:
    """
    Arc with X and C where no G12.1 has begun the polar mode.

    Outside the mode C is the angle of the spindle, and belongs to no plane with X: the control stops with an alarm for
    an axis that is not in the plane, or turns C while X follows an arc of another plane. Arcs of X and C are those of a
    face; write G12.1 before the contour. An arc on a cylinder (G7.1), or along X and Z, is none of these.

    Source: FANUC alarm 021; B-62764EN/01, p. 51.

    Bad:

        O1
        T0101
        G98 G0 X60. Z2. C0
        Z-5.
        G1 X40. F200
        G3 X0. C20. R20.  (expect: arc-outside-polar-mode)
        G1 X60.
        G0 Z2.
        M30

    Good:

        O1
        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 Z-5. F200
        X40.
        G3 X0. C20. R20.
        G1 X60.
        Z2.
        G13.1
        M30

    Good:

        O1
        T0101
        G98 G0 X60. Z2. C0
        G7.1 C30.
        G1 Z-5. F200
        G2 Z-10. C20. R8.
        G7.1 C0
        M30
    """
    # Compares nothing: what may have begun a mode before the arc is a column.
    return procedure.arc_without_mode


def details(hit: Hit) -> Details:
    return {"code_needed": hit.switch_on}
