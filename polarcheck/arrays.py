"""The array types of the tables, each defined once: what a column, a mask or a list of plane points is; look-ups."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

_Number = TypeVar("_Number", bound=np.generic)

#: So many values are looked for one after the other, which is the fastest.
_FEW = 4

#: Whether: one bool per row, word, move or section.
Mask: TypeAlias = NDArray[np.bool_]
#: Values: NaN where one is not known.
Floats: TypeAlias = NDArray[np.float64]
#: Plane points, x + 1j*c [mm, X as radius]; NaN where one is not known.
Points: TypeAlias = NDArray[np.complex128]
#: Whole numbers: rows, words, blocks, lines, counts.
Rows: TypeAlias = NDArray[np.int64]
#: Small whole numbers: a state or a kind per row, such as Motion or Side.
States: TypeAlias = NDArray[np.int16]


def repeated(value: _Number, count: int) -> NDArray[_Number]:
    """
    A column that holds one value throughout, and takes no more memory than that one; it cannot be written to.

    Not for masks: NumPy compares those whose elements stand side by side many at a time.
    """
    return np.ndarray(count, value.dtype, value.tobytes(), 0, (0,))


def is_one(values: NDArray[Any]) -> bool:
    """Whether some values are all the same, or all NaN."""
    first, last = values[0], values[-1]
    if first == last:
        return bool((values == first).all())
    return bool(first != first and last != last and (values != values).all())


def computed(function: Callable[..., NDArray[_Number]], *columns: NDArray[Any]) -> NDArray[_Number]:
    """What a function makes of columns row by row; once where all of them are `repeated`."""
    if all(column.strides == (0,) for column in columns) and len(columns[0]):
        return repeated(function(*(column[:1] for column in columns))[0], len(columns[0]))
    return function(*columns)


def stretch(column: NDArray[np.signedinteger[Any]], first: int, end: int) -> tuple[int, int]:
    """
    Where the values from first up to end, which is left out, stand in a rising column: from, to.

    For one after the other: NumPy would copy the column at each call to compare it with numbers of another type.
    """
    low, high = column.searchsorted(np.array((first, end), column.dtype)).tolist()
    return low, high


# np.unique and, for some arguments, np.isin load masked arrays to ask for them: a tenth of a small check.


def different(values: NDArray[_Number]) -> NDArray[_Number]:
    """The different ones of these values, rising; none of them is NaN."""
    rising = np.sort(values, axis=None)
    return rising[np.append(True, rising[1:] != rising[:-1])] if len(rising) else rising


def is_among(values: NDArray[Any], wanted: Sequence[float | str]) -> Mask:
    """Which of these values are one of those wanted."""
    if len(wanted) <= _FEW:
        found = np.zeros(np.shape(values), bool)
        for one in wanted:
            found |= values == one
        return found
    if values.dtype == np.uint8:
        table = np.zeros(256, bool)
        table[np.array(wanted, np.intp)] = True
        return np.asarray(table[values])
    known = np.sort(np.array(wanted))
    return np.asarray(known[np.minimum(known.searchsorted(values), len(known) - 1)] == values)
