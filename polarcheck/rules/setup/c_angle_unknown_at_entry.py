from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.spindles import Spindles
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{rotary} has not been positioned before {switch}; {of_unknown_angle}",
    at=("on",),
    follows={"block": ("c-axis-not-engaged", "c-axis-not-referenced", "x-unknown-at-entry")},
)
def c_angle_unknown_at_entry(
    blocks: ExecutedBlocks, mode: PolarMode, machine: Machine, entry: Entry, spindles: Spindles
) -> Mask:
    """
    C never positioned before the polar mode.

    The angle of C at G12.1 becomes the direction of X on the plane: after G0 C60. the whole shape is turned by 60 deg.
    Where the program has not positioned C at all, the shape comes out at a chance angle. Write G0 C0 with the approach.
    A word beside the switch that gives the direction, as in G137 C0 (polar.direction_word), does as well. Where C does
    not turn the plane (polar.zero_angle), a first G0 in the mode that writes both axes is enough.

    Source: builder's guide to G12.1, angular orientation of the plane.

    Bad:

        O0001
        T0101
        G98 G0 X60. Z2.
        G12.1             (expect: c-angle-unknown-at-entry)
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30

    Good:

        O0001
        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30

    Good, machine okuma-osp:

        O1
        T0101
        M110
        G94 G0 X60. Z2.
        SB=1000 M13
        G137 C0
        G101 X20. Y0 F200
        Y10.
        X60.
        G136
        M12
        M2

    Good:

        O0001
        T0101
        G28 H0
        G98 G0 X60. Z2.
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30
    """
    positioned = (blocks.has(*machine.polar.rotary_words) & (mode.section < 0)) | blocks.moves_unnamed
    return (
        mode.enters
        & ~mode.enters_with_direction
        & mode.rotary_is_followed
        & blocks.whole_program
        & ~entry.happened(positioned, since=spindles.engages_c_axis)
        & ~entry.positions_in_mode
    )


def details(hit: Hit, machine: Machine) -> Details:
    if not machine.polar.plane_is_fixed:
        return {"of_unknown_angle": "the shape stands wherever the spindle stopped"}
    where = f"where the first move begins is not known: begin with G0 that writes X and {machine.polar.virtual_axis}"
    return {"of_unknown_angle": where}
