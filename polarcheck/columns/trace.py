"""The executed program: all tables of one element per executed block, and what they are made from, under one name."""

from __future__ import annotations

from typing import SupportsIndex

from polarcheck.columns.feed.feedrate import Feedrate
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.offsets import ToolOffsets
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.compensation import CutterCompensation
from polarcheck.columns.path.coordinates import Coordinates
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.foundation.arrays import Columns
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.words import Text


class Trace(Columns, frozen=True):
    """
    The tables of the executed blocks of one file on one machine for one job, for what reads many of them.

    Inside everything is mm, deg, min and X as a radius; unknown is NaN. A column is computed when it is first read.

    run: the executed blocks and their words.
    text: the file.
    machine, job: the merged profile; tools, stock and options.
    blocks: words, codes, lines and programs.
    modal: modal states in force.
    tools: the tool and the offset called.
    coordinates: what numbers without a decimal point count; one element per executed word.
    axes: the axes of the polar plane, and which of them a block moves.
    mode: the polar sections.
    lengths: units in force, words as lengths.
    path: programmed positions and moves.
    offsets: R and nose type of the offset in force.
    compensation: side, ramps and the radius that the control compensates with.
    feedrate: F in force and its mode.
    """

    run: Run
    text: Text
    machine: Machine
    job: Job
    blocks: ExecutedBlocks
    modal: ModalStates
    tools: CalledTools
    coordinates: Coordinates
    axes: PlaneAxes
    mode: PolarMode
    lengths: Lengths
    path: ProgrammedPath
    offsets: ToolOffsets
    compensation: CutterCompensation
    feedrate: Feedrate

    def __len__(self) -> int:
        return len(self.run)

    def line(self, row: SupportsIndex) -> int:
        """Return the line of a row in the file, from 1."""
        return int(self.blocks.line_in_file[row])
