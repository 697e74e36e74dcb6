from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Side
from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.procedure import Procedure
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{switch} while {code} is in force; {instead}{likewise}",
    values=("code",),
    at=("on", "off"),
    once="program",
    doubts=(("compensation", "section"), ("mode", "tool call"), ("rapid", "tool call")),
    follows={"section": ("block-skip-missing",)},
    subject="offset",
)
def polar_switched_in_offset_mode(mode: PolarMode, compensation: CutterCompensation) -> Mask:
    """
    Polar mode switched on or off while G41 or G42 is in force.

    The control stops with an alarm. Cutter compensation begins and ends inside the mode: G40 on entry, then G41 or G42
    with the move onto the part, then G40 with the move away from it, then G13.1.

    Where X and C go on at feed behind G13.1, that stands in the middle of the contour.

    A second G12.1 in the mode is no other: it stands in offset mode.

    Source: FANUC B-62764EN/01, p. 51; builder's guide to G12.1; GSK 988, description of G12.1, note to example 2.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G13.1             (expect: polar-switched-in-offset-mode)
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G42
        G12.1             (expect: polar-switched-in-offset-mode)
        G1 X40. F200
        C10.
        G40 X60.
        G13.1

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G12.1             (expect: polar-switched-in-offset-mode)
        X30.
        G40 X60.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
    """
    # Compares nothing: the comparison is that of the blocks that the message names, too.
    return _in_offset_mode(mode, compensation)


def details(hit: Hit, mode: PolarMode, compensation: CutterCompensation, procedure: Procedure) -> Details:
    goes_on = procedure.contour_goes_on_behind[hit.row] == hit.row
    switches_on = mode.enters[hit.row]
    alike = _in_offset_mode(mode, compensation) & (mode.enters == switches_on)
    return {
        "code": f"G{compensation.side_before[hit.row]}",
        "instead": "the contour goes on behind it: take it out" if goes_on else "G40 must be in force here",
        "likewise": hit.likewise(alike),
    }


def _in_offset_mode(mode: PolarMode, compensation: CutterCompensation) -> Mask:
    # A G41 after which nothing has moved is no offset mode yet; that is start-up-shorter-than-radius.
    in_offset_mode = (mode.leaves | mode.enters_again) & (compensation.side_of_move_before != Side.OFF)
    side_in_force = (compensation.side_before != Side.OFF) & ~compensation.writes_cancel
    return (mode.enters | in_offset_mode) & side_in_force
