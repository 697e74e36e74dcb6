"""The blocks of a program as text: what of them is no comment, and what kind of block each is."""

from __future__ import annotations

import re

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.program.execution.run import begins_program
from polarcheck.program.reading.words import Text
from polarcheck.rules.editing import line_end

_LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
_HEAD = re.compile(r"\s*(?:/\d?\s*)?(?:N\s*\d+\s*)?", re.IGNORECASE)


class BlockTexts:
    """
    The text of the blocks of a program.

    with_comment: blocks with a comment. with_program_number: blocks that begin a program with O and its number.
    """

    def __init__(self, trace: Trace) -> None:
        self.trace, self.text = trace, trace.text
        self._written, self._contents = self.text.written_blocks(), dict[int, str]()
        self.with_comment = set(self.text.comments.block.tolist())
        words = self.text.words
        self.with_program_number = set(words.block[begins_program(words)].tolist())
        names = self.text.names
        self._named = set(names.block.tolist())
        self._words = set(words.block.tolist())
        self._marks = set((np.searchsorted(self.text.blocks.start, self.text.tape_marks, side="right") - 1).tolist())
        other_spans = (self.text.prose, self.text.outside, self.text.dots)
        self._texts = {block for spans in other_spans for block in spans.block.tolist()}
        is_n = words.address == ord("N")
        self._numbers = words.value[is_n], words.block[is_n]

    def line(self, block: int) -> int:
        """The line of a block in the original, from 1."""
        return int(self.text.blocks.line[block])

    def is_mark(self, block: int) -> bool:
        """The block is % at the head or end of a file, or the name of its program."""
        return block in self._marks or (block in self._named and block not in self._words)

    def is_text(self, block: int) -> bool:
        """The block is text outside of the programs, or without words."""
        return block in self._texts or block not in self._words

    def block_numbered(self, number: float, after: int) -> int | None:
        """The first block with an N word behind a block; None where there is none."""
        values, blocks = self._numbers
        hits = blocks[(values == number) & (blocks > after)]
        return int(hits[0]) if len(hits) else None

    def line_end(self, block: int) -> str:
        """The line end behind the line of a block."""
        return line_end(self.text.source, self.line(block))

    def content(self, block: int) -> str:
        """The words of a block as they are written, without N, block skip and comments."""
        if block not in self._contents:
            is_bare = block not in self.with_comment
            written = self._written[block] if is_bare else self.text.without_comments(block)
            self._contents[block] = _behind_head(written)
        return self._contents[block]

    def rest(self, block: int, row: int) -> str:
        """What of a block is neither comment nor name nor an executed word of this row."""
        run = self.trace.run
        low, high = stretch(run.row, row, row + 1)
        spans = [
            (with_name(self.text, block, int(run.words.start[index])), int(run.words.end[index]))
            for index in range(low, high)
        ]
        labels = range(*stretch(self.text.labels.block, block, block + 1))
        spans += [(int(self.text.labels.start[index]), int(self.text.labels.end[index])) for index in labels]
        return _behind_head(self.text.without_comments(block, spans))

    # ---- head and end ----

    def ends(self) -> tuple[int, int]:
        """The first and the last block that is not empty."""
        number = range(len(self._written))
        first, last = (
            next((block for block in order if self._written[block].strip()), order[0])
            for order in (number, number[::-1])
        )
        return first, last

    def first_block(self, row: int) -> int | None:
        """The first block with words of a program that begins with a row, behind its number; None if there is none."""
        for block in range(int(self.trace.run.block[row]), len(self.text.blocks)):
            if block not in self.with_program_number and block in self._words:
                return block
        return None

    def marks(self) -> list[int]:
        """The blocks with % at the head or end of a file, or with the name of a program in the form of a control."""
        return sorted(self._marks | {block for block in self._named if block not in self._words})


def with_name(text: Text, block: int, start: int) -> int:
    """Where a word begins, with the letters of its name, of which CR=5 has the last alone, and OFFN=0 none."""
    before = text.source.excerpt(int(text.blocks.start[block]), start)
    return start - len(before) + len(before.rstrip(_LETTERS)) if before[-1:].isalpha() else start


def _behind_head(content: str) -> str:
    return " ".join(_HEAD.sub("", content, count=1).split())
