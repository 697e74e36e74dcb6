from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{switch} has no {direction_word}, which says in what direction the new axis points; write {direction_word}0 "
    "beside it",
    at=("on",),
)
def direction_word_missing(blocks: ExecutedBlocks, mode: PolarMode, machine: Machine) -> Mask:
    """
    Coordinate conversion without the direction of its first axis.

    On some controls the block that begins the mode has a C word. It is the angle of the C axis at which X of the new
    plane points. Without it the control takes an angle that the program does not give, or stops, and the contour may
    lie turned on the part. Write G137 C0 where X is to point where it did. Nothing is said where the machine needs no
    such word.

    Source: public post for the OSP-P300, which writes C0 at each G137; public notes on the manual of the OSP-P300L.

    Bad, machine okuma-osp:

        G94 G0 X120. C0 Z5.
        G137              (expect: direction-word-missing)
        G101 X40. Y0 F500
        Y10.
        X60.
        G136

    Good, machine okuma-osp:

        G94 G0 X120. C0 Z5.
        G137 C90.
        G101 X40. Y0 F500
        Y10.
        X60.
        G136
    """
    return mode.enters & (machine.polar.direction_word != "") & ~blocks.has(machine.polar.direction_word)


def details(hit: Hit, machine: Machine) -> Details:
    return {"direction_word": machine.polar.direction_word}
