"""Which block runs next: the row order, and the words of each row."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.arrays import Mask, Rows
from polarcheck.reading.words import Text, Words


class FlowFault(msgspec.Struct, frozen=True):
    """Something wrong in a macro statement or in the flow: the rule that reports it, its place, and what is wrong."""

    rule: str
    block: int
    start: int
    end: int
    text: str
    row: int = -1


class Run(msgspec.Struct, frozen=True):
    """
    The executed blocks of one file in order.

    words: in order of execution. row: the row of each word, ascending. block: the index into text.blocks of each row.
    starts: rows at which a program begins, so that nothing before them counts. unknown: rows whose effect is not known.
    depth: of calls. faults: what macro and flow found. remarks: what was not evaluated, and why, with the block.
    visited: per block, whether it was run; None where all were.
    """

    text: Text
    words: Words
    row: Rows
    block: Rows
    starts: Mask
    unknown: Mask
    depth: Rows
    faults: tuple[FlowFault, ...] = ()
    remarks: tuple[tuple[str, int], ...] = ()
    visited: Mask | None = None

    def __len__(self) -> int:
        return len(self.block)


def straight(text: Text) -> Run:
    """The rows of programs that run from top to bottom: one per block that has words."""
    has_row = text.blocks.is_macro.copy()
    has_row[text.words.block] = True
    block = np.flatnonzero(has_row)
    row = (np.cumsum(has_row) - 1)[text.words.block]
    starts = np.zeros(len(block), bool)
    if len(block):
        starts[0] = True
        starts[row[text.words.address == ord("O")]] = True
        ends = (text.words.address == ord("M")) & ((text.words.value == 30) | (text.words.value == 2))
        after = row[ends] + 1
        starts[after[after < len(block)]] = True
    return Run(text, text.words, row, block, starts, text.blocks.is_macro[block], np.zeros(len(block), np.int64))
