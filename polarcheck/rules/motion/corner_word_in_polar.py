from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine


@rule(WARNING, "chamfer, corner or angle word in the polar mode", at=(",C", ",R", ",A"))
def corner_word_in_polar(blocks: ExecutedBlocks, mode: PolarMode, machine: Machine) -> Mask:
    """
    Chamfer or corner by ,C ,R or ,A in the polar mode.

    Drawing dimensions are made for the plane of X and Z. In the mode the control stops with an alarm or does not know
    the word. Write the chamfer as a line and the corner as an arc. The path here is judged without them.

    Source: FANUC alarm 212.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20.,R3.          (expect: corner-word-in-polar)
        X-40.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20. ,C2.         (expect: corner-word-in-polar)
        X-40.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C17.
        G3 X34. C20. R3.
        G1 X-40.
        G13.1
    """
    return mode.in_polar & blocks.has(*machine.arcs.corners_not_made, ",A")
