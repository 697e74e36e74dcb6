"""Phrases of the rules about ramps in the wrong block."""

from __future__ import annotations

import numpy as np

from polarcheck.checking.phrases.common import block_and_line, code_of
from polarcheck.checking.phrases.compensation import point
from polarcheck.checking.phrases.compensation import side as side
from polarcheck.checking.quantity import in_row
from polarcheck.columns.axes import PlaneAxes
from polarcheck.columns.blocks import ExecutedBlocks
from polarcheck.columns.lengths import Lengths
from polarcheck.columns.offsets import ToolOffsets
from polarcheck.columns.path import ProgrammedPath
from polarcheck.columns.trace import Trace
from polarcheck.execution.run import Run
from polarcheck.machines.machine import Machine
from polarcheck.table.entry_angles import EntryAngles
from polarcheck.table.misplaced_ramps import MisplacedRamps


def cancel(machine: Machine) -> str:
    """G40."""
    return code_of(machine, "compensation_off")


def turned(trace: Trace, entry_angles: EntryAngles, index: int) -> str:
    """Where C stands at the G12.1 of a section, and at that before it."""
    enter = trace.mode.sections.enter
    here, before = (float(trace.path.c_angle[enter[at]]) for at in (index, index - 1))
    by = f"{abs(float(entry_angles.turned_by[index])):.4g} deg"
    return by if np.isnan(here - before) else f"at {here % 360:.4g} deg, {by}"


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


def leads_where(path: ProgrammedPath, misplaced_ramps: MisplacedRamps, row: int) -> str:
    """What a start-up does that ends at the wrong X."""
    begins, ends = (float(abs(place.real)) for place in (path.start[row], path.end[row]))
    meant = abs(float(misplaced_ramps.x_of_contour[row]))
    goes_past = (ends - meant) * (meant - begins) > 0
    return "leads through what the contour keeps" if goes_past else "ends before the contour"
