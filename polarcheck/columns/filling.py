"""Values in force from row to row, and positions from absolute and incremental words: sums and fills, no loops."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, Rows, is_uniform, repeated

Scalar = TypeVar("Scalar", bound=np.generic)

#: Where not one row in so many is written, what is in force is faster repeated than looked up row by row.
_SELDOM = 4


def fill_down(values: NDArray[Scalar], written: Mask, before: object) -> NDArray[Scalar]:
    """The value in force in each row: the last one written at or above it, `before` where none is."""
    start = np.array([before], values.dtype)
    written_rows = written.nonzero()[0]
    if len(written_rows) * _SELDOM < len(values):
        if len(written_rows) and not written_rows[0] and is_uniform(values[written_rows]):
            if values.dtype == np.bool_:
                return np.full(len(values), values[0])
            return repeated(values[0], len(values))
        count = np.concatenate((written_rows, (len(values),)))
        count[1:] -= written_rows
        return np.repeat(np.concatenate((start, values[written_rows])), count)
    last = np.maximum.accumulate(np.where(written, np.arange(1, len(values) + 1), 0))
    filled: NDArray[Scalar] = np.concatenate((start, values))[last]
    return filled


def happened(mask: Mask, ends: Mask) -> Mask:
    """True where a row of the mask stands at or above the row, back to the last row of `ends`."""
    return fill_down(mask, mask | ends, False).astype(bool)


def last_row(mask: Mask, ends: Mask) -> Rows:
    """The last row of the mask at or above each row, back to the last row of `ends`; -1 for none."""
    return fill_down(np.where(mask, np.arange(len(mask)), -1), mask | ends, -1)


def positions(absolute: Floats, increment: Floats, resets: Mask, values: Floats) -> Floats:
    """
    Where an axis stands after each row; NaN while it is unknown.

    absolute: the programmed coordinate, NaN where none. increment: 0 where none. resets: rows that set the coordinate
    to `values` (NaN: it becomes unknown), unless the row programs it.
    """
    programmed = ~np.isnan(absolute)
    broken = np.isnan(increment)
    base = programmed | resets | broken
    value = np.where(programmed, absolute, np.where(resets & ~broken, values, np.nan))
    moved = np.where(programmed | broken, 0.0, increment)
    value[~programmed] += moved[~programmed]
    travelled = np.cumsum(moved)
    last = np.maximum.accumulate(np.where(base, np.arange(1, len(base) + 1), 0)) - 1
    is_known = last >= 0
    after = value[last] + (travelled - travelled[last])
    return np.where(is_known, after, np.nan)


def before(after: NDArray[Scalar], starts: Mask, at_start: Any) -> NDArray[Scalar]:
    """The value of the row above; at_start where a program begins."""
    shifted = np.empty_like(after)
    shifted[1:] = after[:-1]
    if len(shifted):
        shifted[0] = at_start
    shifted[starts] = at_start
    return shifted
