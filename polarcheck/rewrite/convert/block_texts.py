"""The blocks of a program as text: what of them is no comment, and what kind of block each is."""

from __future__ import annotations

import re

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.program.execution.run import begins_program
from polarcheck.rules.editing import line_end

_LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
_HEAD = re.compile(r"\s*(?:/\d?\s*)?(?:N\s*\d+\s*)?", re.IGNORECASE)


class BlockTexts:
    """The text of the blocks of a program."""

    def __init__(self, trace: Trace) -> None:
        self.trace, self.text = trace, trace.text
        self._comments: dict[int, list[tuple[int, int]]] = {}
        self._contents: dict[int, str] = {}
        comments = self.text.comments
        for block, start, end in zip(
            comments.block.tolist(), comments.start.tolist(), comments.end.tolist(), strict=True
        ):
            self._comments.setdefault(block, []).append((start, end))
        words = self.text.words
        self._numbered = set(words.block[begins_program(words)].tolist())
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

    def has_comment(self, block: int) -> bool:
        """The block has a comment."""
        return block in self._comments

    def has_program_number(self, block: int) -> bool:
        """The block begins a program with O and its number."""
        return block in self._numbered

    def is_statement(self, block: int) -> bool:
        """The block is a statement of a macro, or of the language of the control."""
        return bool(self.text.blocks.is_macro[block])

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

    def comments(self, block: int) -> list[str]:
        """The comments of a block, without the signs around them."""
        texts = [self.text.source.excerpt(*span) for span in self._comments.get(block, [])]
        return [text[1:-1] if text.startswith("(") and text.endswith(")") else text[1:].strip() for text in texts]

    def line_end(self, block: int) -> str:
        """The line end behind the line of a block."""
        return line_end(self.text.source, self.line(block))

    def content(self, block: int) -> str:
        """The words of a block as they are written, without N, block skip and comments."""
        if block not in self._contents:
            kept = self._without_comments(block, [])
            self._contents[block] = " ".join(_HEAD.sub("", kept, count=1).split())
        return self._contents[block]

    def rest(self, block: int, row: int) -> str:
        """What of a block is neither comment nor an executed word of this row."""
        run = self.trace.run
        low, high = stretch(run.row, row, row + 1)
        spans = [
            (self._with_name(block, int(run.words.start[index])), int(run.words.end[index]))
            for index in range(low, high)
        ]
        return " ".join(_HEAD.sub("", self._without_comments(block, spans), count=1).split())

    def _with_name(self, block: int, start: int) -> int:
        """Where a word begins, with the letters of its address, of which CR=5 has the last alone."""
        before = self.text.source.excerpt(int(self.text.blocks.start[block]), start)
        return start - len(before) + len(before.rstrip(_LETTERS)) if before[-1:].isalpha() else start

    def _without_comments(self, block: int, spans: list[tuple[int, int]]) -> str:
        offset, end = int(self.text.blocks.start[block]), int(self.text.blocks.end[block])
        pieces = []
        for first, last in sorted([*self._comments.get(block, []), *spans]):
            pieces.append(self.text.source.excerpt(offset, first) if first > offset else "")
            offset = max(offset, last)
        pieces.append(self.text.source.excerpt(offset, end) if end > offset else "")
        return " ".join(pieces)

    # ---- head and end ----

    def ends(self) -> tuple[int, int]:
        """The first and the last block that is not empty."""
        blocks = self.text.blocks
        filled = [block for block in range(len(blocks)) if self.text.written(blocks, block).strip()]
        return (filled[0], filled[-1]) if filled else (0, len(blocks) - 1)

    def first_block(self, row: int) -> int | None:
        """The first block with words of a program that begins with a row, behind its number; None if there is none."""
        for block in range(int(self.trace.run.block[row]), len(self.text.blocks)):
            if block not in self._numbered and block in self._words:
                return block
        return None

    def marks(self) -> list[int]:
        """The blocks with % at the head or end of a file, or with the name of a program in the form of a control."""
        return sorted(self._marks | {block for block in self._named if block not in self._words})

    def numbered(self) -> list[int]:
        """The blocks with O and a program number."""
        return sorted(self._numbered)
