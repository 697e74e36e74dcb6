"""How deep a way runs in a finished part: by hand, for rectangles about the center."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped

from polarcheck.foundation.states import Motion
from polarcheck.geometry.polygons.depth_inside import depth_inside
from polarcheck.geometry.segments import Curves

LONG = 40.0


def rectangle(width: float) -> Curves:
    """The outline of 40 by a width, the tool on its right."""
    corners = np.array([LONG / 2 - 0.5j * width, LONG / 2 + 0.5j * width, -LONG / 2 + 0.5j * width])
    start = np.append(corners, -LONG / 2 - 0.5j * width)
    rows = np.arange(len(start))
    kind = np.full(len(start), Motion.LINE, np.int16)
    return Curves(start, np.roll(start, -1), np.full(len(start), np.nan + 0j), kind, np.zeros_like(rows), rows)


def depth(width: float, start: complex, end: complex) -> float:
    contour = rectangle(width)
    ways = np.array([start]), np.array([end])
    return float(depth_inside(contour, np.zeros(len(contour), bool), ways, np.zeros(1, np.int64), 0.001, 0.002)[0])


@looped(
    ("width", "start", "end", "expected"),
    [
        (8, 15 + 0j, -15 + 0j, 4.0),
        (8, 30 + 3j, -30 + 3j, 1.0),
        (8, 30 + 0j, 18 + 0j, 2.0),
        (8, 30 + 5j, -30 + 5j, 0.0),
        (30, 0 - 30j, 0 + 30j, 15.0),
        # 4 pi times the area is a tenth of the square of the length at a width of 1.37: below it is a sliver.
        (1.5, 15 + 0j, -15 + 0j, 0.75),
        (1.2, 15 + 0j, -15 + 0j, 0.0),
    ],
)
def test_the_depth_of_a_way(width: float, start: complex, end: complex, expected: float) -> None:
    assert depth(width, start, end) == pytest.approx(expected, abs=0.01)
