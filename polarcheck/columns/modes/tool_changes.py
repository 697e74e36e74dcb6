"""Which tool a control calls on which M6 stands beside T: `T05.01 T02 M6` changes to tool 5 and prepares tool 2."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.foundation.arrays import Mask, Rows

#: A T of so many digits before the point is a tool alone: T05.01, T012. A longer one has its offset: T0505.
_TOOL_DIGITS = 3
#: How many numbers of offsets there are: a tool has the one of its own number.
OFFSET_COUNT = 10**_TOOL_DIGITS
_LONGEST = 1e15


def called_tools(blocks: ExecutedBlocks) -> tuple[Mask, Rows]:
    """
    The rows that call a tool, and there tool * OFFSET_COUNT + offset.

    In a program with M6, a T that is a tool alone calls nothing by itself: the next M6 takes the first T beside it,
    else the last one before it. In another program, and with its offset in its digits, T calls by itself.
    """
    words, index, most = blocks.run.words, blocks.word_indices("T"), 10**blocks.machine.control.offset_digits
    row, written = blocks.run.row[index], np.abs(np.nan_to_num(words.value[index]))
    value = np.where(written < _LONGEST, written, 0).astype(np.int64)
    is_alone = (value < OFFSET_COUNT) & (words.digits[index] - words.decimals[index] <= _TOOL_DIGITS)
    changes = blocks.codes(*blocks.machine.m_codes.tool_change)
    is_alone &= blocks.anywhere_in_program(changes)[row]
    number = np.where(is_alone, value * (OFFSET_COUNT + 1), value // most * OFFSET_COUNT + value % most)
    first, last = np.zeros(len(blocks), np.int64), np.zeros(len(blocks), np.int64)
    first[row[::-1]], last[row] = number[::-1], number
    has_t = blocks.has("T")
    prepared = fill_down(last, has_t | blocks.starts, 0)
    calls = changes & (has_t | (prepared > 0)) | blocks.with_words(index[~is_alone])
    return calls, np.where(has_t & changes, first, prepared)
