"""Measures of the rules about the polar mode: lengths [mm], lines."""

from __future__ import annotations

import math

from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.procedure import Procedure
from polarcheck.columns.modes.switch_slips import SwitchSlips
from polarcheck.columns.modes.switch_words import SwitchWords
from polarcheck.columns.path.compensation import CutterCompensation
from polarcheck.columns.path.infeed import Infeed


def infeed_taken(switch_words: SwitchWords, infeed: Infeed, row: int) -> float:
    """The infeed that the control takes; NaN where the word cannot hold it."""
    return math.nan if switch_words.infeed_too_large[row] else float(infeed.depth[row])


def allowance_of_pass(infeed: Infeed, row: int) -> float:
    """How far the nearest pass that does not fit is off the contour."""
    return infeed.least_unfit[row][0]


def line_of_misfit(blocks: ExecutedBlocks, infeed: Infeed, row: int) -> int:
    """The line along which there is no way for it."""
    return int(blocks.line[infeed.least_unfit[row][1]])


def radius_on_pass(compensation: CutterCompensation, infeed: Infeed, row: int) -> float:
    """R with which the passes are compensated; NaN without compensation."""
    at = infeed.least_unfit[row][1]
    radius = abs(float(compensation.radius[at]))
    return radius if radius > 0 and compensation.compensates[at] else math.nan


def first_line_of_contour(blocks: ExecutedBlocks, procedure: Procedure, row: int) -> int:
    """The line from which on the axes move as on a contour."""
    return int(blocks.line[procedure.contour_without_mode[row]])


def line_of_missing_end(blocks: ExecutedBlocks, mode: PolarMode, index: int) -> int | None:
    """The line before which G13.1 is missing; None at the end of the program."""
    row = int(mode.sections.leave[index])
    return None if row >= len(blocks) or blocks.starts[row] else int(blocks.line[row])


def switch_meant(switch_slips: SwitchSlips, row: int) -> str:
    """The code that is meant; empty for the codes of a builder."""
    slip = switch_slips.slips[row]
    return "" if slip.is_of_builder else slip.meant
