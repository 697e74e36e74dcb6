"""Columns as an aligned table for a terminal, with units, as many as fit."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask
from polarcheck.program.reading.excerpt import cells, excerpt

#: The space between two columns.
_GAP = "  "
#: An unknown value.
_UNKNOWN = "?"
#: Numbers from this size on are shown with a power of ten.
_LARGE = 1e9
#: How many rows are formatted and written at a time, so that the first ones appear soon.
_AT_ONCE = 500
#: The least and the largest width of the text after the columns [characters].
_NARROWEST, _WIDEST = 16, 120


class Column(NamedTuple):
    """
    A column, one element per row.

    name, unit: the head.
    rank: columns with a low rank are shown first where the table is narrow.
    values: numbers, NaN if unknown; with `words`, keys of `words`.
    decimals: the digits after the point.
    words: the text of each key.
    is_blank: rows that show nothing.
    usual: a column that holds this value only is left out.
    """

    name: str
    unit: str
    rank: int
    values: NDArray[Any]
    decimals: int = 3
    words: Mapping[int, str] | None = None
    is_blank: Mask | None = None
    usual: float | None = None


def table(columns: Sequence[Column], text: Callable[[int], str], room: int | None, height: int | None) -> Iterator[str]:
    """
    Yield the head and the rows of a table, many rows at a time.

    text: returns the text after the columns of a row (from 0).
    room: the width of a line [characters]; None shows all columns.
    height: the head is repeated after this number of lines; None shows it once.
    """
    count = len(columns[0].values)
    if not count:
        return
    aligned = _fitting([_Aligned(column) for column in columns if _is_informative(column)], room)
    remaining = _WIDEST if room is None else room - sum(column.width + len(_GAP) for column in aligned)
    head = "".join(
        _GAP.join(getattr(cell, part).rjust(cell.width) if cell.is_number else getattr(cell, part).ljust(cell.width)
                  for cell in aligned).rstrip() + "\n"
        for part in ("name", "unit")
    )  # fmt: skip
    rows = min(max(height - head.count("\n") - 1, 1), _AT_ONCE) if height else count
    step = min(rows, _AT_ONCE)
    for first in range(0, count, step):
        chosen = slice(first, first + step)
        cells = [column.cells(chosen) for column in aligned]
        lines = [head] if first % rows == 0 else []
        for number, line in enumerate(zip(*cells, strict=True), first):
            block = excerpt(text(number), 0, 0, min(remaining, _WIDEST)).text if remaining >= _NARROWEST else ""
            lines.append((_GAP.join(line) + _GAP + block).rstrip() + "\n")
        yield "".join(lines)


def _is_informative(column: Column) -> bool:
    values = column.values if column.is_blank is None else column.values[~column.is_blank]
    values_known = values if column.words is not None else values[~np.isnan(values)]
    return bool(len(values_known)) and not bool((values_known == column.usual).all())


class _Aligned:
    """A column with the width of its longest number or word."""

    def __init__(self, column: Column) -> None:
        self._column = column
        self.name, self.unit, self.rank, self.is_number = column.name, column.unit, column.rank, column.words is None
        values = column.values if column.is_blank is None else column.values[~column.is_blank]
        if column.words is None:
            # All numbers have the same decimals, so the largest or the smallest is the longest.
            finite = values[np.isfinite(values)]
            ends = [*_extremes(finite[np.abs(finite) < _LARGE]), *_extremes(finite[np.abs(finite) >= _LARGE])]
            longest = max([len(_number(end, column.decimals)) for end in ends], default=1)
            longest = max(longest, 4 if np.isinf(values).any() else 1)
        else:
            longest = max(cells(column.words[int(key)]) for key in np.unique(values))
        self.width = max(longest, len(self.name), len(self.unit))

    def cells(self, rows: slice) -> list[str]:
        """Return the aligned cells of these rows."""
        column, width = self._column, self.width
        if column.words is None:
            texts = [_number(value, column.decimals).rjust(width) for value in column.values[rows].tolist()]
        else:
            words = {key: word + " " * (width - cells(word)) for key, word in column.words.items()}
            texts = [words[key] for key in column.values[rows].tolist()]
        if column.is_blank is None:
            return texts
        blank = " " * width
        is_blank = column.is_blank[rows].tolist()
        return [blank if empty else cell for cell, empty in zip(texts, is_blank, strict=True)]


def _extremes(values: Floats) -> list[float]:
    return [float(values.min()), float(values.max())] if len(values) else []


def _number(value: float, decimals: int) -> str:
    if value != value:
        return _UNKNOWN
    if abs(value) >= _LARGE:
        return f"{value:.{decimals}e}"
    # Adding 0.0 turns -0.0 into 0.0.
    return f"{round(value, decimals) + 0.0:.{decimals}f}"


def _fitting(columns: Sequence[_Aligned], room: int | None) -> list[_Aligned]:
    """Return the columns that fit, chosen by rank, in their original order."""
    if room is None:
        return [*columns]
    fitting, used = set[int](), 0
    for number in sorted(range(len(columns)), key=lambda number: columns[number].rank):
        used += columns[number].width + len(_GAP)
        if used > room + len(_GAP):
            break
        fitting.add(number)
    return [column for number, column in enumerate(columns) if number in fitting]
