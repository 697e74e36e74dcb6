from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.procedure import Procedure
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "contour with X and {rotary} outside the polar mode: {rotary} is an angle here, and X a place of the machine "
    "axis; write {code_needed} before it",
    values=("code_needed",),
    gouges=True,
    once="tool call",
    follows={"tool call": ("polar-never-entered", "arc-outside-polar-mode")},
    subject="mode",
)
def contour_outside_polar_mode(procedure: Procedure) -> Mask:
    """
    Contour of X and C at feed where nothing has begun the polar mode.

    Outside the mode C is the angle of the spindle and X a place of the machine axis: the lathe turns a little to and
    fro, X goes to the other side of the center, and the shape is not cut. It is a contour where C moves at least twice
    at feed, could be a length beside these X, and X goes below 0 or G41 or G42 is in force: in the mode alone X goes
    below 0 while C moves. Write G12.1, or G16 XC, behind the approach. Contours on a cylinder (G7.1) are none, nor are
    grooves in degrees, helices, and moves in rapid traverse.

    Source: FANUC B-62764EN/01, p. 51; public post for the Fagor 8055i-TC, G16 XC.

    Bad, machine fagor-8055t:

        G71 G90 G18
        T1 D1 M6
        G94
        M51
        G15
        G0 X40. C0
        G1 Z-2. F300
        X20. F300
        C10.              (expect: contour-outside-polar-mode)
        X-20.
        C-10.
        X20.
        C0
        X40.
        G0 Z50.
        G18
        M50
        M30

    Bad, tool 1:radius=4:

        O1
        T0101
        G98 G0 X60. Z2. C0
        Z-5.
        G1 G42 X40. F200
        C10.              (expect: contour-outside-polar-mode)
        X20.
        C0
        G40 X60.
        G0 Z2.
        M30

    Good:

        O1
        T0101
        G98 G0 X42. Z2. C0
        G1 X38. F50
        C90. F300
        C180.
        X42.
        G0 X-1. Z50.
        M30

    Good, machine fagor-8055t:

        G71 G90 G18
        T1 D1 M6
        G94
        M51
        G15
        G16 XC
        G0 X40. C0
        G1 Z-2. F300
        X20. F300
        C10.
        X-20.
        C-10.
        X20.
        C0
        X40.
        G0 Z50.
        G18
        M50
        M30
    """
    # Compares nothing: what makes a contour of moves needs their runs, which the table counts.
    return procedure.contour_outside


def details(hit: Hit) -> Details:
    return {"code_needed": hit.switch_on}
