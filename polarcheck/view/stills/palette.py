"""Colors as on the page: the color-blind distinguish them, and they differ in black and white."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from polarcheck.view.picture_data import SectionPicture

#: Viridis from light to dark, without the end that is too near to the paper.
SHADES = ("#9bd93c", "#55c667", "#22a884", "#21918c", "#2a788e", "#35608d", "#414487", "#440154")
#: Upper bounds of the classes, in percent of the limit of C: most paths run far below it.
SHARES = (1.0, 3.0, 5.0, 10.0, 20.0, 40.0, 70.0, 100.0)
ABOVE, PLAIN, UNKNOWN, INK = "#d55e00", "#1b3a5c", "#767676", "#1a1a1a"
LEFT, DRAWING = "#0072b2", "#8e3a8a"
PART, PART_EDGE, BAR, BAR_EDGE, CENTER = "#dde6ee", "#9db0c2", "#f4efe2", "#8a6d3b", "#595959"
#: The color of a label by the severity of its finding.
SEVERITIES = {"error": "#a8321a", "warning": "#8a5a00", "note": "#4f4f4f", "overcut": ABOVE, "left standing": LEFT}
#: A value at a bound is not above it.
_ROUNDING = 1e-4


class Coloring(NamedTuple):
    """
    What the path of the tool center is colored by.

    title: with its unit.
    bounds: the upper bound of each class; empty if there is nothing to color by.
    moves: the color of each move.
    has_limit: what is above the last bound is above the limit of C, and has its own color.
    """

    title: str
    bounds: Sequence[float]
    moves: Sequence[str]
    has_limit: bool

    @property
    def shades(self) -> list[str]:
        """Return the color of each class."""
        return _shades(len(self.bounds))


def coloring(section: SectionPicture) -> Coloring:
    """Return the colors by the share of the limit of C or, without a limit, by its rate."""
    moves = section.moves
    has_limit = any(share is not None for share in moves.share)
    values: Sequence[float | None]
    if has_limit:
        title, values = "C rate, % of its limit", [None if share is None else 100 * share for share in moves.share]
    else:
        title, values = "C rate, deg/min", moves.c_feed
    values = [None if role == "positioning" else value for role, value in zip(moves.role, values, strict=True)]
    bounds = SHARES if has_limit else round_bounds(values)
    shades = [*_shades(len(bounds)), ABOVE if has_limit else SHADES[-1]]
    colors = [
        ABOVE
        if jumps
        else UNKNOWN
        if role == "unknown"
        else PLAIN
        if value is None
        else shades[bisect_left(bounds, value * (1 - _ROUNDING))]
        for role, value, jumps in zip(moves.role, values, moves.jump, strict=True)
    ]
    return Coloring(title, bounds, colors, has_limit)


def round_bounds(values: Iterable[float | None]) -> list[float]:
    """Return the bounds of at most 8 classes: each value if there are few, else round, on a logarithmic scale."""
    ordered = sorted({float(f"{value:.4g}") for value in values if value is not None})
    if len(ordered) <= len(SHADES):
        return ordered
    low, high = max(ordered[0], ordered[-1] / 1e4), ordered[-1]
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    between = [bound for decade in decades for digit in (1, 2, 5) if low < (bound := digit * 10.0**decade) < high]
    every = math.ceil((len(between) + 1) / len(SHADES))
    return [*between[every - 1 :: every], high][-len(SHADES) :]


def _shades(count: int) -> list[str]:
    """Return colors from light to dark, so many."""
    if count < 2:
        return [SHADES[-3]] * count
    return [SHADES[round(index * (len(SHADES) - 1) / (count - 1))] for index in range(count)]
