from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import SECTION_READ_OTHERWISE
from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "no {axis} word in this section, whose linear axis is {axis}: X moves beside the polar plane, not on "
    "it; write {axis}, or make X the linear axis",
    values=("axis",),
    over="sections",
    at=("on",),
    doubts=SECTION_READ_OTHERWISE,
)
def linear_axis_never_programmed(blocks: ExecutedBlocks, modal: ModalStates, axes: PlaneAxes, mode: PolarMode) -> Mask:
    """
    Section that is written in X although its linear axis is another.

    P beside G12.1, or a parameter (5460, on Mitsubishi 1533), makes Y or Z the linear axis of the polar plane. X is one
    of the other axes then: it moves by itself, and the rotary axis turns about a linear axis that stands still. Write
    the contour in the linear axis that is named, or name X. One finding stands for all that is wrong with the path.

    Source: GSK 988, description of G12.1 IP P Q E; B-62764EN/01, p. 51: axes that are not in the plane move normally.

    Bad, machine gsk-988, set polar.linear_address="Y":

        G98 G0 X60. Y40. C0
        G12.1             (expect: linear-axis-never-programmed)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good, machine gsk-988, set polar.linear_address="Y":

        G98 G0 X60. Y40. C0
        G12.1
        G1 Y20. F200
        C10.
        X58.
        Y40.
        G13.1
    """
    beside = blocks.has("X", "U") & modal.uses_axes & mode.in_polar & (axes.linear_axis != ord("X"))
    is_meant = mode.anywhere_in_section(beside) & mode.anywhere_in_section(axes.programs_virtual_axis)
    return (is_meant & mode.nowhere_in_section(axes.programs_linear_axis))[mode.sections.enter]


def details(hit: Hit) -> Details:
    return {"axis": hit.linear}
