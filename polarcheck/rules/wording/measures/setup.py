"""Measures of the rules about the state of the lathe around the section."""

from __future__ import annotations

import math

from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.procedure import Procedure
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.path.lengths import Lengths
from polarcheck.program.execution.run import Run
from polarcheck.rules.wording.phrases.setup import x_wear, x_word


def speed_written(blocks: ExecutedBlocks, row: int) -> float:
    """S of the block [rev/min]."""
    return float(blocks.word("S")[row])


def line_of_start(blocks: ExecutedBlocks, procedure: Procedure, row: int) -> int:
    """The line that has started the live tool which still runs."""
    return int(blocks.line[procedure.live_tool_runs_on[row]])


def word_of_change(blocks: ExecutedBlocks, run: Run, row: int) -> str:
    """The word or the variable that sets X of a tool offset; empty for the wear of the job's table."""
    return x_word(blocks, run, row)


def wear_in_x(blocks: ExecutedBlocks, tools: CalledTools, lengths: Lengths, run: Run, row: int) -> float:
    """The wear in X of the job's table [mm]; NaN where the program sets X."""
    return math.nan if x_word(blocks, run, row) else x_wear(tools, lengths, row)
