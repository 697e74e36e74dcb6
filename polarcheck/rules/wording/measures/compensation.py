"""Measures of the rules about cutter compensation: lengths and places on the polar plane [mm, X as a radius], lines."""

from __future__ import annotations

import math

import numpy as np

from polarcheck.columns.contour.fitting import Fitting
from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.contour.passes import Passes
from polarcheck.columns.contour.senses import Senses
from polarcheck.columns.contour.slots import Slots
from polarcheck.columns.contour.uncompensated_cuts import UncompensatedCuts
from polarcheck.columns.metal.coverage import Coverage
from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.path.compensation import CutterCompensation
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.columns.trace import Trace
from polarcheck.foundation.errors import TooHardError
from polarcheck.parts.deviations import Deviations
from polarcheck.rules.wording.phrases.compensation import blocks_without_move, corner_of_arc


def cutter_radius(compensation: CutterCompensation, row: int) -> float:
    """R that a row is compensated with, without its sign."""
    return abs(float(compensation.radius[row]))


def ramp_length(path: ProgrammedPath, row: int) -> float:
    """The length of a ramp; 0 for one that never comes."""
    return float(path.length[row]) if path.travels[row] else 0.0


def corner_at_arc(senses: Senses, passes: Passes, row: int) -> float:
    """The turn at the ends of an arc [deg], the smaller one where both are known."""
    return corner_of_arc(senses, passes, row)


def height_left(coverage: Coverage, row: int) -> float:
    """The height of a rib, or the thickness of a strip."""
    return float(max(coverage.ribs.height[row], coverage.strips.height[row]))


def place_left(coverage: Coverage, row: int) -> complex:
    """Where it stays."""
    is_strip = coverage.strips.height[row] > coverage.ribs.height[row]
    return complex((coverage.strips if is_strip else coverage.ribs).place[row])


def radius_of_tool(compensation: CutterCompensation, row: int) -> float:
    """R of a move, in an offset cancel that of the move before it."""
    return abs(float(compensation.radius_of_move[row]))


def idle_blocks(trace: Trace, row: int) -> float:
    """Blocks without a move on the plane that follow; NaN where another block stops reading ahead."""
    count = blocks_without_move(trace, row)
    return math.nan if count is None else count


def idle_blocks_allowed(trace: Trace, row: int) -> float:
    """How many such blocks the control reads past."""
    return math.nan if blocks_without_move(trace, row) is None else trace.machine.compensation.read_ahead - 2


def radius_of_room(fitting: Fitting, row: int) -> float:
    """The largest R for which the contour has room, rounded down; NaN where there is none, or it is not known."""
    try:
        largest = float(fitting.radius[row])
        return largest if math.isnan(largest) or fitting.never[row] else math.floor(largest * 1000) / 1000
    except TooHardError:
        return math.nan


def place_of_overcut(overcuts: Overcuts, row: int) -> complex:
    """Where a row cuts deepest into its contour."""
    return overcuts.cuts.deepest(row)[1]


def line_of_overcut(blocks: ExecutedBlocks, overcuts: Overcuts, row: int) -> int:
    """The line into which it cuts there."""
    return int(blocks.line[overcuts.cuts.deepest(row)[0]])


def place_of_slot(slots: Slots, row: int) -> complex:
    """Where a row cuts deepest into another contour of its section."""
    return slots.cuts.deepest(row)[1]


def line_of_slot(blocks: ExecutedBlocks, slots: Slots, row: int) -> int:
    """The line into which it cuts there."""
    return int(blocks.line[slots.cuts.deepest(row)[0]])


def width_of_slot(slots: Slots, row: int) -> float:
    """The room between the walls; NaN where there is none to go round a corner."""
    width = float(slots.width(row))
    return width if width < slots.diameter[row] else math.nan


def _swept(overcuts: Overcuts, slots: Slots, row: int) -> tuple[int, complex]:
    own = overcuts.sweep_depth[row] >= slots.sweep_depth[row]
    return (overcuts if own else slots).sweeps.deepest(row)


def place_swept(overcuts: Overcuts, slots: Slots, row: int) -> complex:
    """Where a ramp goes deepest into a contour."""
    return _swept(overcuts, slots, row)[1]


def line_swept(blocks: ExecutedBlocks, overcuts: Overcuts, slots: Slots, row: int) -> int:
    """The line into which it goes there."""
    return int(blocks.line[_swept(overcuts, slots, row)[0]])


def place_of_cut(uncompensated_cuts: UncompensatedCuts, row: int) -> complex:
    """Where a move without compensation goes deepest into the part."""
    return uncompensated_cuts.cuts.deepest(row)[1]


def line_of_cut(blocks: ExecutedBlocks, uncompensated_cuts: UncompensatedCuts, row: int) -> int:
    """A line of the contour that leaves that part."""
    return int(blocks.line[uncompensated_cuts.cuts.deepest(row)[0]])


def too_much(deviations: Deviations, row: int) -> float:
    """Most material that is left on the part; NaN where its walls are not made."""
    return _side(deviations, row, 0)


def cut_away(deviations: Deviations, row: int) -> float:
    """Most material that is missing on the part; NaN where its walls are not made."""
    return _side(deviations, row, 1)


def _side(deviations: Deviations, row: int, index: int) -> float:
    one = deviations.of_row(row)
    is_compared = one.is_made and not one.is_other_way_round
    return (one.difference.proud, one.difference.deep)[index] if is_compared else np.nan
