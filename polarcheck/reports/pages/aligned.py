"""Columns as a table that people read at a terminal: aligned, with their units, as many as there is room for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Floats, Mask
from polarcheck.reading.excerpt import cells, excerpt

#: Between two columns.
_GAP = "  "
#: What nobody knows.
_UNKNOWN = "?"
#: Numbers from here on are shown with their power of ten.
_LARGE = 1e9
#: Rows that are written at once: the first ones stand there before the others are made.
_AT_ONCE = 500
#: The text behind the columns has at least this room, and at most that.
_NARROWEST, _WIDEST = 16, 120


class Column(NamedTuple):
    """
    A column, one element per row.

    values: numbers, NaN for what is not known; or, with words, the keys of these. is_blank: rows in which there is
    nothing to say. usual: a column with this value alone says nothing. rank: the lowest go into the narrowest table.
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
    The head and the rows of a table, many rows at once.

    text: of a row (from 0), behind its columns. room: cells in a line; None shows all columns. height: lines after
    which the head stands there again; None shows it once.
    """
    count = len(columns[0].values)
    if not count:
        return
    told = [_Told(column) for column in columns if _says_something(column)]
    told = _fitting(told, room)
    left = _WIDEST if room is None else room - sum(one.width + len(_GAP) for one in told)
    head = "".join(
        _GAP.join(getattr(one, part).rjust(one.width) if one.is_number else getattr(one, part).ljust(one.width)
                  for one in told).rstrip() + "\n"
        for part in ("name", "unit")
    )  # fmt: skip
    rows = min(max(height - head.count("\n") - 1, 1), _AT_ONCE) if height else count
    step = min(rows, _AT_ONCE)
    for first in range(0, count, step):
        chosen = slice(first, first + step)
        shown = [one.cells(chosen) for one in told]
        lines = [head] if first % rows == 0 else []
        for number, line in enumerate(zip(*shown, strict=True), first):
            behind = excerpt(text(number), 0, 0, min(left, _WIDEST)).text if left >= _NARROWEST else ""
            lines.append((_GAP.join(line) + _GAP + behind).rstrip() + "\n")
        yield "".join(lines)


def _says_something(column: Column) -> bool:
    values = column.values if column.is_blank is None else column.values[~column.is_blank]
    known = values if column.words is not None else values[~np.isnan(values)]
    return bool(len(known)) and not bool((known == column.usual).all())


class _Told:
    """A column with the width that its longest number or word needs."""

    def __init__(self, column: Column) -> None:
        self._column = column
        self.name, self.unit, self.rank, self.is_number = column.name, column.unit, column.rank, column.words is None
        values = column.values if column.is_blank is None else column.values[~column.is_blank]
        if column.words is None:
            # Of numbers with as many decimals the longest are the largest and the smallest.
            finite = values[np.isfinite(values)]
            ends = [*_extremes(finite[np.abs(finite) < _LARGE]), *_extremes(finite[np.abs(finite) >= _LARGE])]
            longest = max([len(_number(end, column.decimals)) for end in ends], default=1)
            longest = max(longest, 4 if np.isinf(values).any() else 1)
        else:
            longest = max(cells(column.words[int(key)]) for key in np.unique(values))
        self.width = max(longest, len(self.name), len(self.unit))

    def cells(self, rows: slice) -> list[str]:
        """The column in these rows, aligned."""
        column, width = self._column, self.width
        if column.words is None:
            shown = [_number(value, column.decimals).rjust(width) for value in column.values[rows].tolist()]
        else:
            words = {key: word + " " * (width - cells(word)) for key, word in column.words.items()}
            shown = [words[key] for key in column.values[rows].tolist()]
        if column.is_blank is None:
            return shown
        blank = " " * width
        return [blank if nothing else one for one, nothing in zip(shown, column.is_blank[rows].tolist(), strict=True)]


def _extremes(values: Floats) -> list[float]:
    return [float(values.min()), float(values.max())] if len(values) else []


def _number(value: float, decimals: int) -> str:
    if value != value:
        return _UNKNOWN
    if abs(value) >= _LARGE:
        return f"{value:.{decimals}e}"
    # What rounding makes 0 has no sign.
    return f"{round(value, decimals) + 0.0:.{decimals}f}"


def _fitting(columns: Sequence[_Told], room: int | None) -> list[_Told]:
    """Those for which there is room, by their rank, in their order."""
    if room is None:
        return [*columns]
    kept, used = set[int](), 0
    for number in sorted(range(len(columns)), key=lambda number: columns[number].rank):
        used += columns[number].width + len(_GAP)
        if used > room + len(_GAP):
            break
        kept.add(number)
    return [column for number, column in enumerate(columns) if number in kept]
