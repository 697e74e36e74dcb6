"""The comments of a file, found by their words and by their place; comment_reader reads what one of them states."""

import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.path.lengths import Lengths
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property
from polarcheck.foundation.states import Units
from polarcheck.program.execution.run import Run
from polarcheck.program.reading.words import Text

#: More often than this no program that a person writes has words of one subject.
_MOST_WORDS = 2000
#: T9, TOOL NO. 9, T0909 at the head of a comment: up to eight digits behind zeros, more than any T word has.
_TOOL = re.compile(r"\W*+(?:T\s*+(?=\d)|TOOL\s*+(?:NO\b|NR\b|NUMBER\b|#)[\s:.#]*+(?=\d))0*+(\d{0,8}+)\b(?![.,/]\d)")


def named_tool(comment: str) -> int | None:
    """The number behind T at the head of a comment, as it is written: 909 in `T0909`; None where there is none."""
    match = _TOOL.match(comment.upper())
    return int(match[1] or 0) if match else None


class PlacedComment(NamedTuple):
    """
    A comment and the executed row that it belongs to.

    number: in text.comments.
    written: its text.
    row: of its block, of the first block below it that is executed, or of the last one.
    is_behind: no block below it is executed.
    in_inch: the program of the row ends in inch: a comment at its head stands above G20 and G21.
    """

    number: int
    written: str
    row: int
    is_behind: bool
    in_inch: bool


class Comments(Columns, frozen=True):
    """The comments of a file by their number in text.comments, and the executed rows that they belong to."""

    run: Run
    text: Text
    blocks: ExecutedBlocks
    lengths: Lengths

    def __len__(self) -> int:
        return len(self.text.comments)

    def written(self, number: int) -> str:
        """A comment as it is written."""
        comments = self.text.comments
        return self.text.written(comments, number)

    def with_words(self, words: tuple[str, ...]) -> Iterator[PlacedComment]:
        """
        Find the comments in which one of these words stands, in upper or lower case.

        The text of all comments is searched at once, since a file may have 100,000 of them and none of the words.
        """
        begins, capitals = self._capitals
        sought = [word.encode("latin-1") for word in words]
        hits = [
            match.start() for word in sought if word in capitals for match in re.finditer(re.escape(word), capitals)
        ]
        if not 0 < len(hits) <= _MOST_WORDS:
            return
        rows, program = self.blocks.row_of_block, self.blocks.program
        executed = np.flatnonzero(rows >= 0)
        ends = np.flatnonzero(np.append(np.diff(program) > 0, True))
        for number in sorted({int(number) for number in np.searchsorted(begins, hits, side="right") - 1}):
            below = int(np.searchsorted(executed, self.text.comments.block[number]))
            row = int(rows[executed[min(below, len(executed) - 1)]])
            in_inch = bool(self.lengths.units[ends[program[row]]] == Units.INCH)
            yield PlacedComment(number, self.written(number), row, below == len(executed), in_inch)

    @cached_property
    def may_name_tool(self) -> Mask:
        """Per comment: it begins with T, or with neither a letter nor a digit."""
        comments, code = self.text.comments, self.text.source.code
        first = code[np.minimum(comments.start + 1, len(code) - 1)]
        letter = first & 0xDF
        is_digit = (first >= ord("0")) & (first <= ord("9"))
        is_no_letter = (letter < ord("A")) | (letter > ord("Z"))
        return np.asarray((letter == ord("T")) | (is_no_letter & ~is_digit))

    @cached_property
    def _capitals(self) -> tuple[Rows, bytes]:
        """The text of all comments in upper case, and where each begins in it."""
        comments = self.text.comments
        length = comments.end - comments.start
        begins = np.cumsum(length) - length
        spread = np.repeat(comments.start - begins, length) + np.arange(length.sum())
        return begins, bytes(self.text.source.code[spread].tobytes().upper())
