"""A curve over time as a strip of characters, with a limit and its highest value."""

from __future__ import annotations

import numpy as np

from polarcheck.arrays import Floats
from polarcheck.pictures.painting import Paint, painted, plain

#: A cell filled by eighths, from the bottom.
_BLOCKS = " \u2581\u2582\u2583\u2584\u2585\u2586\u2587\u2588"
_FILLED, _LOW, _LIMIT = "#", "_", "-"
#: A limit further above the highest value than this is told, not drawn: the curve would be flat.
_FAR = 2.0


def strip(
    time: Floats, values: Floats, limit: float, columns: int, rows: int, *, dots: bool, paint: Paint = plain
) -> list[str]:
    """
    Bars over time, the highest value in each column, on as many rows; a line of dashes at the limit.

    time: rising. values: of the same length and not below 0; inf stands above all others, NaN is left empty. limit: NaN
    without one. dots: blocks of eighths of a cell; else ASCII. Empty where nothing is known, or all is 0.
    """
    known = ~np.isnan(values)
    time, values = time[known], values[known]
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
    """The highest value in each column; between two instants that lie further apart it goes straight."""
    whole = float(time[-1] - time[0]) or 1.0
    middle = time[0] + (np.arange(columns) + 0.5) / columns * whole
    found = np.interp(middle, time, values)
    np.maximum.at(found, np.minimum((time - time[0]) / whole * columns, columns - 1).astype(np.int64), values)
    return np.asarray(found)


def _painted(line: str, is_above: list[bool], paint: Paint) -> str:
    """What lies above the limit as an error, the limit itself as an aside."""
    styles = [
        "" if cell == " " else "aside" if cell == _LIMIT else "error" if above else "note"
        for cell, above in zip(line, is_above, strict=False)
    ]
    return painted(line, styles, paint)
