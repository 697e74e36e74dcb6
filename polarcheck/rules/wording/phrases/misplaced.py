"""Phrases of the rules about ramps in the wrong block."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.misplaced_ramps import MisplacedRamps
from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.entry_angles import EntryAngles
from polarcheck.columns.modes.offsets import ToolOffsets
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.quantity import in_row
from polarcheck.rules.wording.phrases.common import block_and_line, code_of, point, switch
from polarcheck.rules.wording.phrases.compensation import ramp_at_rest
from polarcheck.rules.wording.phrases.compensation import side as side

#: Least number of blocks that cut between two offset cancels, for the first to be the one too many.
_LEAST_BLOCKS = 2


def cancel(machine: Machine) -> str:
    """G40."""
    return code_of(machine, "compensation_off")


def early_cancel(trace: Trace, row: int) -> str:
    """The offset cancel that follows a start-up at once, with its line."""
    return f"{cancel(trace.machine)} of line {int(trace.blocks.line[next_cancel(trace, row)])}"


def next_cancel(trace: Trace, row: int) -> int:
    """The row of the next offset cancel."""
    return _next(trace.compensation.cancels, row)


def where_ramps_belong(trace: Trace, row: int) -> str:
    """
    What to write where an offset cancel follows a start-up at once.

    A second G40 behind blocks that cut shows that the first stands there by mistake.
    """
    of_section = trace.mode.section == trace.mode.section[row]
    first = _next(trace.compensation.cancels, row)
    again = _next((trace.compensation.writes_cancel & of_section) | trace.compensation.starts_up, first)
    is_second = again > first and not trace.compensation.starts_up[again]
    if is_second and np.count_nonzero(trace.path.cuts[first:again]) >= _LEAST_BLOCKS:
        line = int(trace.blocks.line[again])
        return f"the contour behind it is left by {cancel(trace.machine)} of line {line}, so delete the earlier one"
    return (
        f"write {side(trace.compensation, row)} into the block that leads to the contour, and {cancel(trace.machine)} "
        "into the one that leaves it"
    )


def _next(mask: Mask, row: int) -> int:
    """The first row of a mask behind a row; the row itself where there is none."""
    behind = mask[row + 1 :]
    return row + 1 + int(behind.argmax()) if behind.any() else row


def turned(trace: Trace, entry_angles: EntryAngles, index: int) -> str:
    """Where C stands at the G12.1 of a section, and at that before it."""
    enter = trace.mode.sections.enter
    here, before = (float(trace.path.c_angle[enter[at]]) for at in (index, index - 1))
    by = f"{abs(float(entry_angles.turned_by[index])):.4g} deg"
    return by if np.isnan(here - before) else f"at {here % 360:.4g} deg, {by}"


def to_position(trace: Trace, index: int) -> str:
    """What to write where nobody has positioned C; of a mode that is left and entered again at once, what to delete."""
    blocks, machine, sections = trace.blocks, trace.machine, trace.mode.sections
    enter, last = int(sections.enter[index]), int(sections.last[index - 1])
    begins = switch(blocks, machine, enter)
    approach = f"write {machine.polar.rotary_address} with the approach before {begins}"
    if last >= len(blocks) or trace.axes.moves[last:enter].any():
        return approach
    ends = f"{switch(blocks, machine, last)} of line {int(blocks.line[last])}"
    return f"nothing moves between {ends} and {begins}: delete both, or {approach}"


def left_or_right(machine: Machine) -> str:
    """G41 or G42."""
    return f"{code_of(machine, 'compensation_left')} or {code_of(machine, 'compensation_right')}"


def wrong_by(lengths: Lengths, offsets: ToolOffsets, row: int) -> str:
    """By how much the walls are off."""
    radius = abs(float(offsets.radius_of_offset[row]))
    return "off by R" if np.isnan(radius) else f"off by R {in_row(radius, lengths, row):length}"


def block_before(blocks: ExecutedBlocks, run: Run, misplaced_ramps: MisplacedRamps, row: int) -> str:
    """The block that has begun the contour."""
    return block_and_line(blocks, run, int(misplaced_ramps.begun_without[row]))


def where_to_begin(trace: Trace, row: int) -> str:
    """Where G41 or G42 belongs; where it stands in a block that moves nowhere, that."""
    at_rest = ramp_at_rest(trace, row).removeprefix("; ")
    if at_rest:
        return f"{at_rest}: begin outside the contour"
    return f"write {side(trace.compensation, row)} into the block that leads to the contour"


def ramp_end(axes: PlaneAxes, lengths: Lengths, path: ProgrammedPath, row: int) -> str:
    """Where the start-up ends."""
    return point(axes, lengths, complex(path.end[row]), row)


def contour_end_there(
    axes: PlaneAxes, lengths: Lengths, path: ProgrammedPath, misplaced_ramps: MisplacedRamps, row: int
) -> str:
    """Where its contour ends."""
    return point(axes, lengths, complex(misplaced_ramps.x_of_contour[row], path.end[row].imag), row)


def x_meant(axes: PlaneAxes, lengths: Lengths, misplaced_ramps: MisplacedRamps, row: int) -> str:
    """The X with which the contour would be closed."""
    return point(axes, lengths, complex(misplaced_ramps.x_of_contour[row], 0.0), row).split()[0]


def x_of_ramp(axes: PlaneAxes, lengths: Lengths, path: ProgrammedPath, row: int) -> str:
    """The X at which the start-up ends."""
    return point(axes, lengths, complex(path.end[row].real, 0.0), row).split()[0]


def line_of_end(trace: Trace, row: int) -> int:
    """The line that has written the X with which the contour of a start-up ends."""
    end = _next(trace.compensation.cancels, row)
    writes = trace.blocks.has("X", "U")[:end]
    return int(trace.blocks.line[int(np.flatnonzero(writes)[-1])]) if writes.any() else int(trace.blocks.line[row])


def leads_where(path: ProgrammedPath, misplaced_ramps: MisplacedRamps, row: int) -> str:
    """What a start-up does that ends at the wrong X."""
    begins, ends = (float(abs(place.real)) for place in (path.start[row], path.end[row]))
    meant = abs(float(misplaced_ramps.x_of_contour[row]))
    goes_past = (ends - meant) * (meant - begins) > 0
    return "leads through what the contour keeps" if goes_past else "ends before the contour"
