from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.bar import Bar
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.trace import Trace
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.execution.run import Run
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "tool offset changed in the polar mode by {changed_by}{beside_part}; write it {outside}",
    values=("changed_by",),
    at=("T", "D", "data_input"),
)
def offset_changed_in_polar(
    blocks: ExecutedBlocks, mode: PolarMode, compensation: CutterCompensation, mode_words: ModeWords, machine: Machine
) -> Mask:
    """
    Tool offset changed in the polar mode.

    The offset must be set before G12.1 and cannot be changed before G13.1: a T word with another tool or offset, T0800,
    G10 on an offset, or an assignment to its system variable stops the control or shifts the plane off the center of
    the spindle, and the contour with it. Leave the mode, change the offset, position, and enter again. Controls on
    which D calls an edge of the tool take another one where no compensation is in force.

    Source: FANUC B-62764EN/01, p. 52; Mitsubishi M700V programming manual, P485; Siemens Job Planning 03/2006, p. 7-76.

    Bad:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        T0111             (expect: offset-changed-in-polar)
        C10.
        G10 P11 X0.1      (expect: offset-changed-in-polar)
        #2001=.5          (expect: offset-changed-in-polar)
        X60.
        G13.1

    Good:

        T0101
        G98 G0 X60. C0
        G10 P1 R4.
        #2001=.5
        G12.1
        G1 X40. F200
        T0101
        C10.
        X60.
        G13.1
        T0111
    """
    calls_another = compensation.calls_other_offset_in_polar
    writes_one = mode_words.rows(mode_words.changes_tool_offset & mode_words.not_allowed)
    assigns_one = mode.in_polar & blocks.assigns(machine.macro.tool_offset_variables)
    return calls_another | writes_one | assigns_one


def details(hit: Hit, tools: CalledTools, run: Run, machine: Machine, upright: Trace, bar: Bar) -> Details:
    from polarcheck.rules.wording.metal import turret_at_depth
    from polarcheck.rules.wording.offsets import called_tool

    if hit.row in run.assigned:
        return {"changed_by": run.assigned[hit.row].name, "beside_part": ""}
    if not tools.calls_offset[hit.row]:
        return {"changed_by": machine.codes("data_input")[0], "beside_part": ""}
    return {"changed_by": called_tool(tools, hit.row), "beside_part": turret_at_depth(hit, upright, bar, hit.row)}
