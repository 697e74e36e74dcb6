"""Draws a curve over time as a strip of characters, with a limit."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats
from polarcheck.reports.pages.painting import Paint, painted, plain

#: Cells filled from the bottom by 0 to 8 eighths.
_BLOCKS = " \u2581\u2582\u2583\u2584\u2585\u2586\u2587\u2588"
_FILLED, _LOW, _LIMIT = "#", "_", "-"
#: A limit above the highest value by more than this factor is not drawn: the curve would be flat.
_FAR = 2.0


def strip(
    time: Floats, values: Floats, limit: float, columns: int, rows: int, *, dots: bool, paint: Paint = plain
) -> list[str]:
    """
    Return bars over time, the highest value of each column, with a line of dashes at the limit.

    time: rising [s].
    values: one per time, not below 0; inf is drawn at the top, NaN is left empty.
    limit: NaN without one.
    columns, rows: the size.
    dots: draw with blocks of eighths of a cell; else ASCII.

    Empty if nothing is known, or all values are 0.
    """
    is_known = ~np.isnan(values)
    time, values = time[is_known], values[is_known]
    finite = values[np.isfinite(values)]
    highest = float(finite.max(initial=0.0))
    top = max(highest, limit if limit <= _FAR * highest or not highest else 0.0)
    if not len(values) or not values.any() or top <= 0:
        return []
    share = np.clip(_of_columns(time, np.where(np.isinf(values), top, values), columns) / top, 0.0, 1.0)
    parts = 8 if dots else 2
    filled = np.where(share > 0, np.maximum(np.round(share * rows * parts), 1), 0).astype(np.int64)
    at_limit = min(int(limit / top * rows), rows - 1) if limit <= top else -1
    is_above = share * top > limit * (1 + 1e-9)
    lines = []
    for row in reversed(range(rows)):
        cells = np.clip(filled - row * parts, 0, parts).tolist()
        line = "".join(_BLOCKS[cell] if dots else (" ", _LOW, _FILLED)[cell] for cell in cells)
        if row == at_limit:
            line = line.replace(" ", _LIMIT)
        lines.append(_painted(line.rstrip(), is_above.tolist(), paint))
    return lines


def _of_columns(time: Floats, values: Floats, columns: int) -> Floats:
    """Return the highest value in each column; a column without a value is interpolated."""
    whole = float(time[-1] - time[0]) or 1.0
    middle = time[0] + (np.arange(columns) + 0.5) / columns * whole
    highest = np.interp(middle, time, values)
    np.maximum.at(highest, np.minimum((time - time[0]) / whole * columns, columns - 1).astype(np.int64), values)
    return np.asarray(highest)


def _painted(line: str, is_above: list[bool], paint: Paint) -> str:
    """Paint cells above the limit as an error, and the limit as an aside."""
    styles = [
        "" if cell == " " else "aside" if cell == _LIMIT else "error" if above else "note"
        for cell, above in zip(line, is_above, strict=False)
    ]
    return painted(line, styles, paint)
