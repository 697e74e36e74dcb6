"""The bar of each program as its comments state it."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.words.comment_patterns import BAR
from polarcheck.columns.words.comment_reader import bar_in
from polarcheck.columns.words.comments import Comments
from polarcheck.foundation.arrays import Columns, Floats, Rows, cached_property, repeated
from polarcheck.program.execution.run import Run


class StockComment(msgspec.Struct, frozen=True):
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
    blocks: ExecutedBlocks
    comments: Comments

    @cached_property
    def stated(self) -> list[StockComment]:
        """The comments that state a bar, in the order of the file."""
        text, stated = self.comments.text, []
        for comment in self.comments.with_words(BAR.words) if len(self.run) else ():
            bar = bar_in(comment.written, comment.in_inch)
            if bar is not None:
                line = int(text.blocks.line[text.comments.block[comment.number]])
                program = int(self.blocks.program[comment.row])
                stated.append(
                    StockComment(program, comment.number, line, bar.diameter, bar.across_flats, comment.written.strip())
                )
        return stated

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
        return self._by_program("comment", np.int64(-1))

    @cached_property
    def diameter(self) -> Floats:
        """Of a round bar [mm]; NaN where no comment states one."""
        return self._by_program("diameter", np.float64(np.nan))

    @cached_property
    def across_flats(self) -> Floats:
        """Of a hexagon bar [mm]; NaN where no comment states one."""
        return self._by_program("across_flats", np.float64(np.nan))

    def _by_program(self, name: str, none: np.float64 | np.int64) -> NDArray[Any]:
        """Per row what the comment of its program states; none: where there is no comment."""
        if not self.of_program:
            return repeated(none, len(self.run))
        column = np.full(len(self.run), none)
        for program, comment in self.of_program.items():
            column[self.blocks.program == program] = getattr(comment, name)
        return column
