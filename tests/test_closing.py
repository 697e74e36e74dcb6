"""Middles of boxes and crossings of half axes, by hand."""

from __future__ import annotations

import numpy as np
from cases import looped

from polarcheck.foundation.states import Motion
from polarcheck.geometry.contour_ends import Loops, crossings, gaps_of, may_be_open, may_leave_strips, middles
from polarcheck.geometry.segments import Curves


def square(half: float, middle: complex = 0j) -> np.ndarray:
    """The corners, counter-clockwise."""
    return middle + half * np.array([1 - 1j, 1 + 1j, -1 + 1j, -1 - 1j])


@looped("first", [0, 1, 3])
def test_the_middle_of_the_box_of_each(first: int) -> None:
    points = np.append(square(5, 10 + 2j), [0j, 4 + 0j, 4 + 6j])
    of = first + np.repeat([0, 2], [4, 3])
    assert middles(points, of).tolist() == [10 + 2j] * 4 + [2 + 3j] * 3


def test_a_square_crosses_each_half_axis_once() -> None:
    start = square(5, 1 + 1j)
    axis, of, apart = crossings(start, np.roll(start, -1), np.full(4, 7), np.full(4, 1 + 1j))
    assert sorted(axis.tolist()) == [0, 1, 2, 3]
    assert of.tolist() == [7] * 4
    assert apart.tolist() == [5.0] * 4


def test_a_line_crosses_where_it_does() -> None:
    start, end = np.array([2 - 1j, -1 - 3j]), np.array([6 + 3j, -3 + 1j])
    axis, of, apart = crossings(start, end, np.array([0, 1]), np.zeros(2, complex))
    assert sorted(zip(axis.tolist(), of.tolist(), apart.tolist(), strict=True)) == [(0, 0, 3.0), (1, 1, 2.5)]


@looped(
    ("inner", "may"),
    [
        (8.0, False),  # R 1 from either side covers 2 mm
        (7.97, True),
        (5.3, True),
        (5.1, False),  # so far apart that nobody takes it for one face
    ],
)
def test_strips_stay_between_passes_that_are_too_far_apart(inner: float, may: bool) -> None:
    start = np.append(square(10), square(inner))
    end = np.append(np.roll(square(10), -1), np.roll(square(inner), -1))
    assert may_leave_strips(start, end, np.zeros(8, np.int64), np.array([1.0])).tolist() == [may]


def box(right: float, top: float, left: float, bottom: float) -> np.ndarray:
    """The corners of a rectangle, counter-clockwise."""
    return np.array([right - 1j * bottom, right + 1j * top, -left + 1j * top, -left - 1j * bottom])


@looped(
    ("levels", "expected"),
    [
        # One pass that is longer than it is wide has nothing beside it.
        ([[box(10, 7, 10, 7)]], [False]),
        ([[box(7, 10, 7, 10)]], [False]),
        # What another level cuts is no neighbour.
        ([[square(7)], [square(10)]], [False, False]),
        # On one side alone, in each of the four.
        ([[square(10), box(10, 10, 10, 7)]], [True]),
        ([[square(10), box(10, 10, 7, 10)]], [True]),
        ([[square(10), box(10, 7, 10, 10)]], [True]),
        ([[square(10), box(7, 10, 10, 10)]], [True]),
        ([[square(10)], [square(10), square(7)]], [False, True]),
        ([[square(10), square(7)], [square(10)]], [True, False]),
    ],
)
def test_strips_are_between_neighbours_of_one_level(levels: list[list[np.ndarray]], expected: list[bool]) -> None:
    start = np.concatenate([one for level in levels for one in level])
    end = np.concatenate([np.roll(one, -1) for level in levels for one in level])
    of = np.repeat(np.arange(len(levels)), [4 * len(level) for level in levels])
    assert may_leave_strips(start, end, of, np.ones(len(levels))).tolist() == expected


Move = tuple[complex, complex, complex | None, Motion]
LINE, CCW, CW = Motion.LINE, Motion.CCW, Motion.CW


def loops_of(*moves: Move, radius: float = 1.0) -> Loops:
    """One loop of these moves: start, end, center and kind of each; the tool on its right."""
    start, end, center, kind = zip(*moves, strict=True)
    rows = np.arange(len(moves))
    centers = np.array([np.nan if one is None else one for one in center], complex)
    curves = Curves(
        np.array(start, complex), np.array(end, complex), centers, np.array(kind), np.zeros_like(rows), rows
    )
    return Loops(curves, np.zeros(len(rows), bool), rows[:1], rows[-1:], np.array([radius]))


#: A gap of 1 from -1 to 0, along which the contour goes on at 0 as an arc begins, and nowhere else.
BEGINS_AHEAD = [(0j, 10 + 10j, 10j, CCW), (10 + 10j, -1 + 10j, None, LINE), (-1 + 10j, -1 + 0j, None, LINE)]
#: The same with an arc that only ends along the gap.
BEGINS_ASIDE = [(0j, 10 - 10j, 10 + 0j, CCW), (10 - 10j, -1 - 10j, None, LINE), (-1 - 10j, -1 + 0j, None, LINE)]


def backwards(moves: list[Move]) -> list[Move]:
    """The same moves the other way round."""
    other = {LINE: LINE, CCW: CW, CW: CCW}
    return [(end, start, center, other[kind]) for start, end, center, kind in reversed(moves)]


@looped("turn", [1, 3j, 0.4 * np.exp(2.5j)])
@looped(
    ("moves", "expected"),
    [
        (BEGINS_AHEAD, True),
        (backwards(BEGINS_AHEAD), True),
        (BEGINS_ASIDE, False),
        (backwards(BEGINS_ASIDE), False),
    ],
)
def test_a_gap_leads_on_from_where_arcs_begin_and_end(moves: list[Move], expected: bool, turn: complex) -> None:
    turned = [(turn * a, turn * b, None if c is None else turn * c, kind) for a, b, c, kind in moves]
    long = abs(turn)
    loops = loops_of(*turned, radius=0.51 * long)
    assert may_be_open(loops).tolist() == [expected]
    assert not may_be_open(loops_of(*turned, radius=0.49 * long)).any()  # a gap of 2R lets the tool through
    to, of = gaps_of(loops, np.array([long]))
    assert (to.tolist(), of.tolist()) == ([0], [2])


def test_a_gap_of_twice_r_lets_the_tool_through() -> None:
    assert not may_be_open(loops_of(*BEGINS_AHEAD, radius=0.5)).any()
