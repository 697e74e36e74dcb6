"""The bar of each program as its comments state it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.words.bar_comments import WORDS, bar_in
from polarcheck.columns.words.comment_lengths import comments_with
from polarcheck.foundation.arrays import Columns, Floats, Rows, cached_property, repeated
from polarcheck.foundation.states import Units
from polarcheck.program.execution.run import Run
from polarcheck.program.reading.words import Text


class StockComment(NamedTuple):
    """
    A comment that states the bar of a program.

    program: its number, as in blocks.program.
    comment: its number in text.comments.
    line: from 1.
    diameter, across_flats: of a round bar, of a hexagon [mm]; NaN for the other of the two.
    text: as it is written.
    """

    program: int
    comment: int
    line: int
    diameter: float
    across_flats: float
    text: str


class StockComments(Columns, frozen=True):
    """The bars that comments state: a column for each, with a value per executed block, which its program shares."""

    run: Run
    text: Text
    blocks: ExecutedBlocks
    lengths: Lengths

    @cached_property
    def stated(self) -> list[StockComment]:
        """The comments that state a bar, in the order of the file."""
        if not len(self.run) or not len(self.text.comments):
            return []
        found = []
        for number, comment in comments_with(self.text, WORDS):
            block = int(self.text.comments.block[number])
            row = self._row_of(block)
            bar = bar_in(comment, bool(self.lengths.units[self._row_of_units(row)] == Units.INCH))
            if bar is not None:
                line, program = int(self.text.blocks.line[block]), int(self.blocks.program[row])
                found.append(StockComment(program, number, line, *bar, comment.strip()))
        return found

    @cached_property
    def of_program(self) -> dict[int, StockComment]:
        """By program the comment that states its bar; none where comments state bars that differ."""
        first: dict[int, StockComment] = {}
        doubtful = set()
        for comment in self.stated:
            other = first.setdefault(comment.program, comment)
            if not np.allclose(
                (comment.diameter, comment.across_flats), (other.diameter, other.across_flats), equal_nan=True
            ):
                doubtful.add(comment.program)
        return {program: comment for program, comment in first.items() if program not in doubtful}

    @cached_property
    def comment(self) -> Rows:
        """The number of the comment in text.comments; -1 for none."""
        column = np.full(len(self.run), -1, np.int64)
        for program, bar in self.of_program.items():
            column[self.blocks.program == program] = bar.comment
        return column

    @cached_property
    def diameter(self) -> Floats:
        """Of a round bar [mm]; NaN where no comment states one."""
        return self._sizes({program: bar.diameter for program, bar in self.of_program.items()})

    @cached_property
    def across_flats(self) -> Floats:
        """Of a hexagon bar [mm]; NaN where no comment states one."""
        return self._sizes({program: bar.across_flats for program, bar in self.of_program.items()})

    def _sizes(self, of_program: dict[int, float]) -> Floats:
        if not of_program:
            return repeated(np.float64(np.nan), len(self.run))
        column = np.full(len(self.run), np.nan)
        for program, size in of_program.items():
            column[self.blocks.program == program] = size
        return column

    def _row_of(self, block: int) -> int:
        """The row that the block of a comment belongs to: its own, or the first one below it in the file."""
        rows = self.blocks.row_of_block
        below = np.flatnonzero(rows[block:] >= 0)
        if len(below):
            return int(rows[block + below[0]])
        return int(rows[np.flatnonzero(rows >= 0)[-1]])

    def _row_of_units(self, row: int) -> int:
        """The last row of the program of this one: a comment at its head stands above G20 and G21."""
        return int(np.flatnonzero(self.blocks.program == self.blocks.program[row])[-1])
