"""Where the tool center goes at corners, by hand, for any size of tool: a square of 40 from outside and inside."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from cases import looped
from plane_moves import path_of_rows

from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.cutter_compensation.offset_path import Method, Phase, tool_center_path

NAN = complex(math.nan, math.nan)
SQUARE = [20, 20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j, 20]


def offset_ends(side: Side, radius: float, start_up: str) -> np.ndarray:
    """The ends of the moves in offset mode round the square, from (45, 0) and back, or from (0, 0)."""
    away = 45 if side == Side.RIGHT else 0
    points = [complex(point) for point in (away, *SQUARE, away)]
    last = len(points) - 2
    rows = [
        (0, Motion.LINE, True, begin, end, NAN, Side.OFF if row == last else side, row == 0, radius, NAN, False)
        for row, (begin, end) in enumerate(itertools.pairwise(points))
    ]
    tool = tool_center_path(path_of_rows(rows), Method(start_up=start_up))
    return tool.end[tool.phase == Phase.OFFSET]


@looped("start_up", ["A", "B"])
@looped("radius", [0.01, 0.5, 0.999, 1.0, 1.001, 6.0])
def test_the_tool_goes_round_each_corner_at_its_radius(radius: float, start_up: str) -> None:
    corners = np.array(SQUARE[1:-1])
    for side, half in ((Side.RIGHT, 20 + radius), (Side.LEFT, 20 - radius)):
        ends = offset_ends(side, radius, start_up)
        assert all(np.abs(ends - corner * half / 20).min() < 1e-9 for corner in corners)
        assert np.maximum(np.abs(ends.real), np.abs(ends.imag)) == pytest.approx(half)


def test_a_tool_without_a_radius_goes_along_the_contour() -> None:
    ends = offset_ends(Side.RIGHT, 0.0, "A")
    assert np.maximum(np.abs(ends.real), np.abs(ends.imag)) == pytest.approx(20)
    assert all(np.abs(ends - corner).min() < 1e-9 for corner in SQUARE)
