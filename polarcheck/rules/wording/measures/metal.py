"""Measures of the rules about the metal: lengths [mm], places on the polar plane [mm, X as a radius], lines."""

from __future__ import annotations

import math

import numpy as np

from polarcheck.columns.contour.crossings import Crossings
from polarcheck.columns.contour.misplaced_ramps import MisplacedRamps
from polarcheck.columns.contour.pass_differences import PassDifferences
from polarcheck.columns.contour.regularity import Regularity
from polarcheck.columns.contour.tangency import Tangency
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.part_comments import PartComments
from polarcheck.columns.metal.workpiece import Workpiece
from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.entry_angles import EntryAngles
from polarcheck.columns.modes.offsets import ToolOffsets
from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.columns.trace import Trace
from polarcheck.program.execution.run import Run
from polarcheck.rules.wording.phrases.common import executed_word
from polarcheck.rules.wording.phrases.misplaced import next_cancel


def radius_of_arc(arcs: Arcs, row: int) -> float:
    """The radius of an arc that is written by R."""
    return float(arcs.radius[row]) if arcs.by_radius[row] else math.nan


def radius_needed(arcs: Arcs, tangency: Tangency, row: int) -> float:
    """The radius that would be tangent, of an arc that is written by R."""
    return abs(float(tangency.radius_needed[row])) if arcs.by_radius[row] else math.nan


def turned_by(entry_angles: EntryAngles, index: int) -> float:
    """By how much a section comes out turned [deg]."""
    return abs(float(entry_angles.turned_by[index]))


def angle_at_entry(trace: Trace, index: int) -> float:
    """Where C stands at the G12.1 of a section [deg], from 0 to 360."""
    return float(trace.path.c_angle[trace.mode.sections.enter[index]]) % 360


def radius_of_offset(offsets: ToolOffsets, row: int) -> float:
    """R of the tool offset in force, without its sign."""
    return abs(float(offsets.radius_of_offset[row]))


def size_made(part_comments: PartComments, row: int) -> float:
    """The size or depth that is made instead of what the comment states."""
    return float(part_comments.contradictions[row].made)


def line_of_cancel(trace: Trace, row: int) -> int:
    """The line of the offset cancel that follows a start-up at once."""
    return int(trace.blocks.line[next_cancel(trace, row)])


def crossing(crossings: Crossings, row: int) -> complex:
    """Where a contour crosses itself."""
    return crossings.of_row(row)[1]


def line_crossed(blocks: ExecutedBlocks, crossings: Crossings, row: int) -> int:
    """The line that it crosses, or turns back along."""
    return int(blocks.line[crossings.of_row(row)[0]])


def word_of_correction(regularity: Regularity, run: Run, row: int) -> str:
    """The word that does not fit the contour; empty where a block is missing or too many."""
    word = regularity.corrections[row].word
    return executed_word(run, word) if word >= 0 else ""


def corrected_words(regularity: Regularity, row: int) -> str:
    """The words that would fit; empty where the block is too many."""
    return regularity.corrections[row].text


def distance_of_passes(path: ProgrammedPath, pass_differences: PassDifferences, row: int) -> float:
    """How far the ends of two blocks are apart; NaN where a block is missing."""
    found = pass_differences.found[row]
    return math.nan if found.is_missing else float(abs(path.end[row] - path.end[found.other]))


def line_of_other_pass(blocks: ExecutedBlocks, pass_differences: PassDifferences, row: int) -> int:
    """The line of the other pass."""
    return int(blocks.line[pass_differences.found[row].other])


def bar_in_the_way(bar: Bar, workpiece: Workpiece, row: int) -> float:
    """The diameter of the bar that a tool goes into; NaN in a pocket."""
    return bar.known.smallest if workpiece.hits_bar[row] else math.nan


def height_of_move(path: ProgrammedPath, row: int) -> float:
    """Z at which the tool is in the way: before the block where it rises."""
    before, after = float(path.z_before[row]), float(path.z[row])
    return before if after > before or np.isnan(after) else after


def line_before(blocks: ExecutedBlocks, misplaced_ramps: MisplacedRamps, row: int) -> int:
    """The line that has begun the contour without compensation."""
    return int(blocks.line[misplaced_ramps.begun_without[row]])


def x_of_contour(misplaced_ramps: MisplacedRamps, row: int) -> float:
    """X with which the contour would be closed, as a radius."""
    return float(misplaced_ramps.x_of_contour[row])
