from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.execution.run import Run
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} changes the coordinate system in the polar mode; its origin must stay the center of the spindle, "
    "so write {code} {outside}",
    values=("code",),
    at=(
        "data_input",
        "coordinate_setting",
        "coordinate_preset",
        "local_shift",
        "machine_coordinates",
        "work_offset",
        "work_offset_extended",
    ),
)
def origin_shifted_in_polar(mode_words: ModeWords, blocks: ExecutedBlocks, mode: PolarMode, machine: Machine) -> Mask:
    """
    Origin shifted in the polar mode.

    The mode turns X and C of the program into X and C of the lathe about the center of the spindle, which must be the
    origin when it begins and stay it until it ends. Another work offset, a local shift, G50 (G92 in systems B and C)
    with axis words, machine coordinates, G10 on a work offset, or an assignment to its system variable stop the control
    or displace the contour. Set the origin before G12.1.

    Source: FANUC B-62764EN/01, p. 51; builder's guide to G12.1, coordinate system origin; 30i alarm list, PS0146.

    Bad:

        G54 G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        G55               (expect: origin-shifted-in-polar)
        C-10.
        X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G52 X2. C0        (expect: origin-shifted-in-polar)
        G1 X40. F200
        C10.
        G50 X50.          (expect: origin-shifted-in-polar)
        G1 C-10.
        G10 L2 P1 X1.     (expect: origin-shifted-in-polar)
        #5221=.5          (expect: origin-shifted-in-polar)
        X60.
        G13.1

    Good:

        G50 S3000
        G54 G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        G55
    """
    assigns_one = mode.in_polar & blocks.assigns(machine.macro.work_offset_variables)
    return mode_words.rows(mode_words.not_allowed & mode_words.shifts_origin) | assigns_one


def details(hit: Hit, run: Run) -> Details:
    return {"code": hit.code if hit.words else run.assigned[hit.row].name}
