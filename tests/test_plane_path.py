"""Paths of lines and arcs: points along moves, the angle of a turn, closed paths round the center of C."""

from __future__ import annotations

import numpy as np
import pytest

from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane_path import PlanePath, SpacePath

NAN = complex("nan+nanj")
#: A line, a quarter of a circle, a full circle, an arc whose end is 1 mm off its circle.
PATH = PlanePath(
    np.array([0j, 10 + 0j, 5 + 0j, 10 + 0j]),
    np.array([10 + 0j, 0 + 10j, 5 + 0j, 0 + 11j]),
    np.array([NAN, 0j, 0j, 0j]),
    np.array([Motion.LINE, Motion.CCW, Motion.CW, Motion.CCW], np.int16),
)


@pytest.mark.parametrize(
    ("move", "share", "point"),
    [(0, 0.25, 2.5), (1, 0.5, 10 * np.exp(0.25j * np.pi)), (2, 0.25, -5j), (3, 0.5, 10.5 * np.exp(0.25j * np.pi))],
)
def test_points_lie_at_shares_of_the_length_and_on_a_spiral_where_the_end_is_off_the_circle(
    move: int, share: float, point: complex
) -> None:
    moves, shares = np.full(3, move), np.array([0.0, share, 1.0])
    start, between, end = PATH.points(moves, shares).tolist()
    assert (start, end) == (PATH.start[move], PATH.end[move])
    assert between == pytest.approx(point)


def test_a_turned_path_keeps_its_lengths_and_sweeps() -> None:
    turned = PATH.turned_by(np.exp(0.3j))
    assert turned.length == pytest.approx(PATH.length)
    assert turned.sweep == pytest.approx(PATH.sweep)
    assert np.angle(turned.end[0]) == pytest.approx(0.3)
    assert turned.arriving[0] == pytest.approx(PATH.arriving[0] * np.exp(0.3j))


def test_a_move_is_known_where_all_of_its_coordinates_are() -> None:
    arcs = PlanePath(*PATH.shape[:2], np.array([NAN, NAN, 0j, 0j]), PATH.kind)
    assert arcs.is_known.tolist() == [True, False, True, True]
    z = np.array([0.0, 0.0, np.nan, 0.0])
    assert SpacePath(*PATH.shape, np.zeros(4), z).is_known.tolist() == [True, True, False, True]


@pytest.mark.parametrize(("side", "around"), [(1, True), (-1, True), (1, False), (-1, False)])
def test_the_center_is_on_the_left_of_what_encloses_it_counterclockwise(side: int, around: bool) -> None:
    corner = np.exp(0.5j * np.pi * side * np.arange(4)) + (0 if around else 3)
    square = PlanePath(corner, np.roll(corner, -1), np.full(4, NAN), np.full(4, Motion.LINE, np.int16))
    assert square.goes_round() == around
    assert square.is_on_left() == (around == (side > 0))
    assert square.twice_swept.sum() == pytest.approx(4 * side)
