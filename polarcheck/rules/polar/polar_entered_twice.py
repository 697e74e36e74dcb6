from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{code} again: the polar mode is on since line {other_line}",
    values=("code", "other_line"),
    at=("on",),
    follows={"section": ("polar-never-left",)},
    subject="mode",
)
def polar_entered_twice(axes: PlaneAxes, mode: PolarMode) -> Mask:
    """
    Polar mode switched on while it is on.

    Either the second G12.1 is left over, or the G13.1 of the first section is missing. Controls differ: some stop with
    an alarm, others take the present position for C0 again, so that the rest of the contour is turned.

    Source: Mitsubishi M700V programming manual, P486; FANUC B-62764EN/01, p. 51.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        G12.1             (expect: polar-entered-twice)
        C-10.
        X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        G0 C90.
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    return mode.in_polar & axes.switches_on


def details(hit: Hit, mode: PolarMode) -> Details:
    return {"code": hit.switch, "other_line": hit.line(mode.sections.enter[mode.section[hit.row]])}
