"""Plane geometry of moves: closed forms against sampled paths, against numbers, and what a machinist would nod at."""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

import numpy as np
import pytest
from cases import looped
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from plane_moves import points_along

from polarcheck.foundation.states import Motion
from polarcheck.geometry import plane, polar, rates

NAN = complex(math.nan, math.nan)
LINE, CW, CCW = Motion.LINE, Motion.CW, Motion.CCW


class Move(NamedTuple):
    """One move; `of` calls a function of polar with it alone."""

    start: complex
    end: complex
    center: complex = NAN
    kind: Motion = LINE

    def of(self, function: Any, *more: Any) -> float:
        with np.errstate(all="raise"):
            return float(function(*columns(self), *more)[0])


def columns(*moves: Move) -> tuple[Any, ...]:
    start, end, center, kind = zip(*moves, strict=True) if moves else [()] * 4
    return (*(np.array(points, dtype=complex) for points in (start, end, center)), np.array(kind, dtype=np.int16))


def sampled(move: Move, count: int = 10_001) -> np.ndarray:
    return points_along(*move, count)


def way(points: np.ndarray) -> float:
    return float(np.abs(np.diff(points)).sum())


# ---- moves at random: coordinates of a lathe, the center of C anywhere beside, on or inside the path ----

coordinate = st.floats(-50, 50).map(lambda value: round(value, 3))
point = st.builds(complex, coordinate, coordinate)
angle = st.floats(0, 2 * math.pi)


@st.composite
def lines(draw: st.DrawFn) -> Move:
    start, end = draw(point), draw(point)
    assume(abs(end - start) > 0.1)
    return Move(start, end)


@st.composite
def arcs(draw: st.DrawFn) -> Move:
    center, radius, begin = draw(point), draw(st.floats(0.5, 60)), draw(angle)
    turn = draw(st.one_of(st.just(2 * math.pi), st.floats(0.01, 2 * math.pi - 0.01)))
    kind = draw(st.sampled_from([CW, CCW]))
    start = center + radius * complex(math.cos(begin), math.sin(begin))
    sign = 1 if kind == CCW else -1
    end = center + radius * complex(math.cos(begin + sign * turn), math.sin(begin + sign * turn))
    return Move(start, start if turn == 2 * math.pi else end, center, kind)


moves = st.one_of(lines(), arcs())


def clear_of_center(move: Move) -> Move:
    """Sampling needs a path that is smooth at its own scale."""
    assume(np.abs(sampled(move)).min() > 0.02 * way(sampled(move, 101)))
    return move


smooth_moves = moves.map(clear_of_center)
few = settings(max_examples=80, deadline=None)


# ---- closed forms against the path itself ----


@pytest.mark.nightly
@few
@given(moves)
def test_length_and_distances_are_those_of_the_path(move: Move) -> None:
    points = sampled(move)
    assert move.of(polar.length) == pytest.approx(way(points), rel=1e-6)
    step = way(points) / 10_000
    assert move.of(polar.nearest) == pytest.approx(np.abs(points).min(), abs=step)
    assert move.of(polar.nearest) <= np.abs(points).min() + 1e-9
    assert move.of(polar.farthest) == pytest.approx(np.abs(points).max(), abs=step)
    assert move.of(polar.farthest) >= np.abs(points).max() - 1e-9


@pytest.mark.nightly
@few
@given(smooth_moves)
def test_c_sweep_is_that_of_the_path(move: Move) -> None:
    c = np.unwrap(np.angle(sampled(move)))
    assert move.of(polar.c_sweep) == pytest.approx(math.degrees(c[-1] - c[0]), abs=1e-7)


@pytest.mark.nightly
@few
@given(smooth_moves)
def test_rates_are_those_of_the_path(move: Move) -> None:
    points, feed = sampled(move), 600.0
    step = way(points) / 10_000
    minutes = step / feed
    c_rate = np.abs(np.diff(np.unwrap(np.angle(points)))) / minutes
    assert move.of(rates.c_feed, feed) == pytest.approx(math.degrees(c_rate.max()), rel=1e-2, abs=1e-4)
    x_rate = np.abs(np.diff(np.abs(points))) / minutes
    assert move.of(rates.x_feed, feed) == pytest.approx(x_rate.max(), rel=1e-2, abs=0.05)
    assert move.of(rates.x_feed, feed) <= feed * (1 + 1e-12)


@pytest.mark.nightly
@few
@given(smooth_moves)
def test_c_acceleration_is_that_of_the_path(move: Move) -> None:
    points, feed = sampled(move, 16_001), 600.0
    seconds = way(points) / 16_000 / feed * 60
    c = np.degrees(np.unwrap(np.angle(points)))
    found = np.abs(np.diff(c, 2)).max() / seconds**2
    rounding = 1e-12 * (1 + np.abs(c).max()) / seconds**2
    assert move.of(rates.c_acceleration, feed) == pytest.approx(found, rel=2e-2, abs=rounding + 1e-6)


@pytest.mark.nightly
@few
@given(smooth_moves)
def test_x_acceleration_is_that_of_the_path(move: Move) -> None:
    points, feed = sampled(move, 16_001), 600.0
    seconds = way(points) / 16_000 / feed * 60
    x = np.abs(points)
    found = np.abs(np.diff(x, 2)).max() / seconds**2
    rounding = 1e-12 / seconds**2
    assert move.of(rates.x_acceleration, feed) == pytest.approx(found, rel=2e-2, abs=rounding + 1e-6)


@pytest.mark.nightly
@few
@given(moves, st.floats(1, 1e5))
def test_feed_allowed_is_just_allowed(move: Move, limit: float) -> None:
    feed = move.of(rates.feed_allowed, limit)
    assume(0 < feed < math.inf)
    assert move.of(rates.c_feed, feed) == pytest.approx(limit, rel=1e-9)


# ---- facts/compensation.md 6: numbers worked out there ----


def test_line_beside_the_center() -> None:
    line = Move(-10 + 2j, 10 + 2j)
    assert line.of(rates.c_feed, 600) == pytest.approx(17188.734, abs=1e-3)
    assert line.of(polar.c_sweep) == pytest.approx(-157.380, abs=1e-3)
    assert line.of(rates.c_acceleration, 600) == pytest.approx(math.degrees(16.238), rel=1e-4)
    assert line.of(polar.nearest) == 2
    assert line.of(polar.farthest) == pytest.approx(math.sqrt(104))
    assert line.of(rates.x_feed, 600) == pytest.approx(600 * 10 / math.sqrt(104))
    assert line.of(rates.x_acceleration, 600) == pytest.approx(10**2 / 2)
    assert line.of(rates.feed_allowed, 3600) == pytest.approx(125.664, abs=1e-3)


def test_line_that_stops_before_the_foot() -> None:
    line = Move(3 + 2j, 10 + 2j)
    assert line.of(rates.c_feed, 600) == pytest.approx(5288.841, abs=1e-3)
    assert line.of(polar.nearest) == pytest.approx(math.sqrt(13))
    assert line.of(rates.x_acceleration, 600) == pytest.approx(10**2 * 2**2 / 13**1.5)
    end = Move(10 + 2j, 10.0001 + 2j)
    assert end.of(rates.c_feed, 600) == pytest.approx(661.105, abs=2e-2)


@looped(
    ("center", "radius", "rate"),
    [(10, 4, 100), (2, 10, 75), (0, 10, 60)],
)
def test_full_circles(center: float, radius: float, rate: float) -> None:
    circle = Move(center + radius, center + radius, center, CCW)
    assert circle.of(rates.c_feed, 600) == pytest.approx(math.degrees(rate))
    assert circle.of(polar.nearest) == pytest.approx(abs(center - radius))
    assert circle.of(polar.farthest) == pytest.approx(center + radius)


def test_c_turns_back_within_an_arc_that_leaves_the_center_outside() -> None:
    far_half = Move(10 - 4j, 10 + 4j, 10, CCW)
    assert far_half.of(rates.c_feed, 600) == pytest.approx(math.degrees(600 / 14))
    near_half = Move(10 + 4j, 10 - 4j, 10, CCW)
    assert near_half.of(rates.c_feed, 600) == pytest.approx(math.degrees(100))
    # X = |center + R turned|; its acceleration (F / R)^2 e R / r where it is nearest and farthest.
    assert near_half.of(rates.x_acceleration, 600) == pytest.approx((10 / 4) ** 2 * 10 * 4 / 6)
    assert far_half.of(rates.x_acceleration, 600) == pytest.approx((10 / 4) ** 2 * 10 * 4 / 14)
    # Where the path points at the center, C stands and X has all of F.
    assert Move(14, 6, 10, CCW).of(rates.x_feed, 600) == pytest.approx(600)
    assert Move(12, -8, 2, CCW).of(rates.x_feed, 600) == pytest.approx(600 * 2 / 10)


def test_the_manuals_formula() -> None:
    """F < L * R * pi / 180 (B-62764EN/01 p. 52), exact where the tool passes the nearest point at a right angle."""
    nearest, limit = 5.0, 3600.0
    line = Move(nearest - 20j, nearest + 30j)
    assert line.of(rates.feed_allowed, limit) == pytest.approx(nearest * limit * math.pi / 180)
    assert line.of(rates.feed_allowed, limit) == pytest.approx(314.159, abs=1e-3)


@pytest.mark.nightly
@few
@given(moves, st.floats(1, 1e5))
def test_the_manuals_formula_is_never_too_high(move: Move, limit: float) -> None:
    by_the_book = move.of(polar.nearest) * limit * math.pi / 180
    assert move.of(rates.feed_allowed, limit) >= by_the_book * (1 - 1e-9)


# ---- round the center, through it, to it and from it ----


@looped(("kind", "sweep"), [(CCW, 360), (CW, -360)])
@looped("center", [0j, 3 + 4j, -9.99 + 0j])
def test_a_circle_about_the_center_turns_c_once(kind: Motion, sweep: float, center: complex) -> None:
    start = center + 10
    assert Move(start, start, center, kind).of(polar.c_sweep) == pytest.approx(sweep)


def test_a_circle_beside_the_center_brings_c_back() -> None:
    assert Move(14, 14, 10, CCW).of(polar.c_sweep) == 0


def test_an_arc_most_of_the_way_round_the_center() -> None:
    start, end = 10 * np.exp(0.1j), 10 * np.exp(-0.1j)
    assert Move(start, end, 0, CCW).of(polar.c_sweep) == pytest.approx(360 - math.degrees(0.2))
    assert Move(start, end, 0, CW).of(polar.c_sweep) == pytest.approx(-math.degrees(0.2))


@looped("ends", [(3 + 4j, -6 - 8j), (5, -1), (-5, 1), (0.1 + 0.3j, -0.3 - 0.9j), (-2j, 7j)])
def test_line_through_the_center(ends: tuple[complex, complex]) -> None:
    line = Move(*ends)
    assert line.of(rates.c_feed, 100) == math.inf
    assert line.of(rates.c_acceleration, 100) == math.inf
    assert line.of(rates.feed_allowed, 3600) == 0
    assert line.of(polar.nearest) == 0
    assert line.of(polar.c_sweep) == 180
    assert line.of(rates.x_feed, 100) == pytest.approx(100)
    assert line.of(rates.x_acceleration, 100) == math.inf
    assert line.of(rates.x_acceleration, 0) == 0


@looped("ends", [(0, 3 + 4j), (3 + 4j, 0), (1, 7), (-6 - 8j, -3 - 4j), (1e-13, 10j), (10j, 1e-13j)])
def test_line_along_a_radius(ends: tuple[complex, complex]) -> None:
    line = Move(*ends)
    assert line.of(rates.c_feed, 100) == 0
    assert line.of(rates.c_acceleration, 100) == 0
    assert line.of(rates.feed_allowed, 3600) == math.inf
    assert line.of(polar.c_sweep) == 0
    assert line.of(rates.x_feed, 100) == pytest.approx(100)
    assert line.of(rates.x_acceleration, 100) == 0


def test_arc_from_the_center_turns_c_evenly() -> None:
    arc = Move(0, 10, 5, CW)
    assert arc.of(rates.c_feed, 600) == pytest.approx(math.degrees(600 / 10))
    assert arc.of(rates.c_acceleration, 600) == 0
    assert arc.of(polar.c_sweep) == pytest.approx(-90)
    assert arc.of(polar.nearest) == 0
    assert arc.of(rates.x_feed, 600) == pytest.approx(600)
    assert arc.of(rates.x_acceleration, 600) == pytest.approx(10**2 * 10 / (2 * 5) ** 2)
    assert Move(10 + 0j, 10 + 0j, 5, CCW).of(rates.x_acceleration, 600) == math.inf
    assert Move(10 + 0j, 10 + 0j, 0, CCW).of(rates.x_acceleration, 600) == 0
    assert Move(0, 0, 5, CCW).of(polar.c_sweep) == pytest.approx(180)


def test_arc_that_ends_at_the_center_but_for_rounding() -> None:
    arc = Move(10, 3e-10j, 5 + 4e-10, CCW)
    assert arc.of(rates.c_feed, 600) == pytest.approx(math.degrees(600 / 10))
    assert arc.of(rates.c_acceleration, 600) == 0
    assert arc.of(polar.nearest) == 0


def test_arc_on_a_circle_through_the_center_that_stays_away_from_it() -> None:
    arc = Move(5 - 5j, 5 + 5j, 5, CCW)
    assert arc.of(rates.c_feed, 600) == pytest.approx(math.degrees(600 / 10))
    assert arc.of(polar.c_sweep) == pytest.approx(90)


def test_arc_across_the_center() -> None:
    arc = Move(5 + 5j, 5 - 5j, 5, CCW)
    assert arc.of(rates.c_feed, 600) == math.inf
    assert arc.of(rates.c_acceleration, 600) == math.inf
    assert arc.of(polar.c_sweep) == pytest.approx(90 + 180)
    assert arc.of(polar.nearest) == 0


@looped("distance", [1e-6, 1e-5, 1e-3])
def test_a_millionth_beside_the_center(distance: float) -> None:
    line = Move(complex(distance, -50), complex(distance, 70))
    assert line.of(polar.nearest) == pytest.approx(distance, rel=1e-9)
    assert line.of(rates.c_feed, 100) == pytest.approx(math.degrees(100 / distance), rel=1e-9)
    turn = math.degrees(math.atan(50 / distance) + math.atan(70 / distance))
    assert line.of(polar.c_sweep) == pytest.approx(turn, rel=1e-12)

    around = Move(100, 100, 50 - distance, CCW)
    arc = Move(100, 50 - distance + 1j * (50 + distance), 50 - distance, CW)
    assert around.of(polar.c_sweep) == pytest.approx(360)
    assert around.of(rates.c_feed, 100) == pytest.approx(math.degrees(100 / (2 * distance)), rel=1e-6)
    assert arc.of(rates.c_feed, 100) == pytest.approx(math.degrees(100 / (2 * distance)), rel=1e-6)
    beside = Move(100 + 2 * distance, 100 + 2 * distance, 50 + 2 * distance, CCW)
    assert beside.of(polar.c_sweep) == 0
    assert beside.of(rates.c_feed, 100) == pytest.approx(math.degrees(100 / (2 * distance)), rel=1e-6)


@pytest.mark.nightly
@few
@given(smooth_moves, st.sampled_from([1e-6, 1e-3, 1e3]))
def test_scaling_changes_rates_alone(move: Move, scale: float) -> None:
    small = Move(move.start * scale, move.end * scale, move.center * scale, move.kind)
    assert small.of(polar.c_sweep) == pytest.approx(move.of(polar.c_sweep), abs=1e-6)
    assert small.of(polar.length) == pytest.approx(move.of(polar.length) * scale, rel=1e-9)
    assert small.of(polar.nearest) == pytest.approx(move.of(polar.nearest) * scale, rel=1e-9)
    assert small.of(rates.c_feed, 100) == pytest.approx(move.of(rates.c_feed, 100) / scale, rel=1e-7)
    assert small.of(rates.c_acceleration, 100) == pytest.approx(
        move.of(rates.c_acceleration, 100) / scale**2, rel=1e-6, abs=1e-9 / scale**2
    )


@pytest.mark.nightly
@few
@given(moves, angle)
def test_turning_the_plane_shifts_c_alone(move: Move, turn: float) -> None:
    by = complex(math.cos(turn), math.sin(turn))
    turned = Move(move.start * by, move.end * by, move.center * by, move.kind)
    assume(move.of(polar.nearest) > 1e-6)
    for function, more in [(polar.c_sweep, ()), (rates.c_feed, (100,)), (rates.x_feed, (100,)), (polar.nearest, ())]:
        assert turned.of(function, *more) == pytest.approx(move.of(function, *more), rel=1e-6, abs=1e-6)


@pytest.mark.nightly
@few
@given(smooth_moves, st.floats(0.05, 0.95))
def test_splitting_a_move_changes_no_maximum(move: Move, share: float) -> None:
    middle = complex(sampled(move, 1001)[round(1000 * share)])
    first, second = move._replace(end=middle), move._replace(start=middle)
    for function in (rates.c_feed, rates.c_acceleration, rates.x_feed):
        whole, parts = move.of(function, 100), max(first.of(function, 100), second.of(function, 100))
        assert parts == pytest.approx(whole, rel=1e-6, abs=1e-9)
    assert min(first.of(polar.nearest), second.of(polar.nearest)) == pytest.approx(move.of(polar.nearest))
    assert first.of(polar.c_sweep) + second.of(polar.c_sweep) == pytest.approx(move.of(polar.c_sweep), abs=1e-7)
    assert first.of(polar.length) + second.of(polar.length) == pytest.approx(move.of(polar.length))


# ---- sweep, center and time ----


def test_arc_sweep() -> None:
    quarter = columns(
        Move(1, 1j, 0, CCW), Move(1, 1j, 0, CW), Move(1, 1, 0, CCW), Move(1, 1, 0, CW), Move(1, 1j), Move(1, NAN)
    )
    expected = [math.pi / 2, -1.5 * math.pi, 2 * math.pi, -2 * math.pi, 0, math.nan]
    assert plane.arc_sweep(*quarter) == pytest.approx(np.array(expected), nan_ok=True)


def test_a_circle_whose_ends_differ_by_rounding_is_full() -> None:
    assert Move(25, 25 + 4e-15j, 0, CCW).of(plane.arc_sweep) == 2 * math.pi
    assert Move(25, 25 - 4e-15j, 0, CCW).of(plane.arc_sweep) == 2 * math.pi
    assert Move(25, 25 + 1e-3j, 0, CCW).of(plane.arc_sweep) == pytest.approx(4e-5)


@looped(
    ("end", "radius", "kind", "center"),
    [
        (10 + 20j, 10, CCW, 10 + 10j),
        (10 + 20j, 10, CW, 20 + 20j),
        (10 + 20j, -10, CCW, 20 + 20j),
        (10 + 20j, -10, CW, 10 + 10j),
        (0 + 10j, 10, CCW, 10 + 10j),
        (20 + 10j, 10, CCW, NAN),
        (20 + 30j, 9.9995, CW, 20 + 20j),
        (20 + 30j, 9.9994, CW, NAN),
        (20 + 30j, 0, CW, NAN),
        (20 + 30j, math.nan, CW, NAN),
        (20 + 30j, 10, LINE, NAN),
    ],
)
def test_center_from_radius(end: complex, radius: float, kind: Motion, center: complex) -> None:
    found = polar.center_from_radius(
        np.array([20 + 10j]), np.array([end]), np.array([radius]), np.array([kind], dtype=np.int16), 0.00101
    )
    assert [found[0].real, found[0].imag] == pytest.approx([center.real, center.imag], nan_ok=True)


def test_center_of_a_half_circle_whose_radius_is_short_by_rounding() -> None:
    start, end, kind = np.array([0.1 + 0.2j]), np.array([7.3 - 4.9j]), np.array([CCW], dtype=np.int16)
    radius = np.nextafter(np.abs(end - start) / 2, 0)
    assert polar.center_from_radius(start, end, radius, kind)[0] == pytest.approx(3.7 - 2.35j)


@pytest.mark.nightly
@few
@given(arcs())
def test_center_from_radius_finds_the_center(arc: Move) -> None:
    start, end, center, kind = columns(arc)
    sweep = abs(arc.of(plane.arc_sweep))
    assume(0.1 < sweep < 2 * math.pi - 0.1 and abs(sweep - math.pi) > 0.01)
    radius = np.abs(start - center) * (1 if sweep <= math.pi else -1)
    assert abs(polar.center_from_radius(start, end, radius, kind)[0] - arc.center) < 1e-8


def test_time() -> None:
    found = polar.time(np.array([10.0, 10, 0, 10]), np.array([600.0, 0, 0, math.nan]))
    assert found == pytest.approx(np.array([1, math.inf, 0, math.nan]), nan_ok=True)


# ---- unknown, empty, without movement ----

PER_MOVE = [
    (polar.length, ()),
    (polar.nearest, ()),
    (polar.farthest, ()),
    (polar.c_sweep, ()),
    (rates.c_feed, (100,)),
    (rates.feed_allowed, (100,)),
    (rates.c_acceleration, (100,)),
    (rates.x_feed, (100,)),
]


@looped(("function", "more"), PER_MOVE)
@looped(
    "move",
    [
        Move(NAN, 1),
        Move(1, NAN),
        Move(complex(math.nan, 0), 5 + 1j),
        Move(1, 1j, NAN, CCW),
        Move(NAN, 1j, 0, CCW),
        Move(1, complex(1, math.nan), 0, CW),
    ],
)
def test_unknown_stays_unknown(function: Any, more: Any, move: Move) -> None:
    assert math.isnan(move.of(function, *more))


@looped(("function", "more"), PER_MOVE)
def test_no_moves_give_nothing(function: Any, more: Any) -> None:
    empty = np.zeros(0, dtype=complex)
    assert len(function(empty, empty, empty, np.zeros(0, dtype=np.int16), *more)) == 0


@looped("move", [Move(3 + 4j, 3 + 4j), Move(0, 0), Move(5, 5, 5, CCW)])
def test_a_point_asks_nothing_of_the_axes(move: Move) -> None:
    for function in (rates.c_feed, rates.c_acceleration, rates.x_feed):
        assert move.of(function, 100) == 0
    assert move.of(polar.c_sweep) == 0
    assert move.of(polar.nearest) == abs(move.start)


def test_unknown_feed_and_no_feed() -> None:
    line, through = Move(5 - 5j, 5 + 5j), Move(5, -5)
    assert math.isnan(line.of(rates.c_feed, math.nan))
    assert line.of(rates.c_feed, 0) == 0
    assert through.of(rates.c_feed, 0) == 0
    assert rates.c_feed(*columns(line, line), np.array([100.0, 200.0])) == pytest.approx(
        np.degrees(np.array([20.0, 40.0]))
    )


# ---- the machine's axes ----


def c_angles(*moves: Move, section: Any = None, entry: Any = (0.0,)) -> tuple[list[float], list[float]]:
    sections = np.zeros(len(moves), dtype=np.int64) if section is None else np.array(section)
    with np.errstate(all="raise"):
        c_from, c_to = polar.c_angles(*columns(*moves), sections, np.array(entry))
    return list(c_from), list(c_to)


def around(*points: complex) -> list[Move]:
    return list(itertools.starmap(Move, itertools.pairwise(points)))


def test_c_goes_on_round_the_center_turn_after_turn() -> None:
    square = [20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j]
    c_from, c_to = c_angles(*around(40, 20, *square, *square, 20 - 0j, 40), entry=[90.0])
    assert c_from == pytest.approx([90, 90, 135, 225, 315, 405, 495, 585, 675, 765, 810])
    assert c_to == pytest.approx([90, 135, 225, 315, 405, 495, 585, 675, 765, 810, 810][: len(c_to)])


def test_c_of_full_circles_piles_up() -> None:
    circle = Move(20, 20, 0, CW)
    c_from, c_to = c_angles(circle, circle, circle)
    assert c_from == pytest.approx([0, -360, -720])
    assert c_to == pytest.approx([-360, -720, -1080])


def test_each_section_begins_at_its_own_angle() -> None:
    c_from, c_to = c_angles(*around(10, 10j, -10), *around(5, 5j), section=[0, 0, 2], entry=[60.0, math.nan, -90.0])
    assert c_from == pytest.approx([60, 150, -90])
    assert c_to == pytest.approx([150, 240, 0])


def test_c_does_not_jump_at_an_entry_on_the_negative_side() -> None:
    c_from, c_to = c_angles(*around(-10, -10 + 10j, 10j, 10), entry=[30.0])
    assert c_from == pytest.approx([30, 30 - 45, 30 - 90])
    assert c_to == pytest.approx([30 - 45, 30 - 90, 30 - 180])


def test_c_turns_on_the_spot_at_the_center() -> None:
    c_from, c_to = c_angles(*around(10, 0, 5j, 0, -5))
    assert c_from == pytest.approx([0, 90, 90, 180])
    assert c_to == pytest.approx([0, 90, 90, 180])


def test_c_leaves_the_center_along_an_arc() -> None:
    c_from, c_to = c_angles(Move(10, 0), Move(0, 10, 5, CW), Move(10, 0, 5, CCW), Move(0, 0), Move(0, -3))
    assert c_from == pytest.approx([0, 90, 0, 90, 180])
    assert c_to == pytest.approx([0, 0, 90, 90, 180])


def test_half_a_turn_through_the_center_counts_up() -> None:
    assert c_angles(*around(10, -10, 10)) == ([0, 180], [180, 360])


def test_c_after_an_unknown_move_goes_on_from_where_it_was_known() -> None:
    c_from, c_to = c_angles(*around(10, 10j, -10, -10j), Move(-10j, NAN), Move(NAN, 5), *around(5, 5j))
    assert c_from == pytest.approx([0, 90, 180, math.nan, math.nan, 360], nan_ok=True)
    assert c_to == pytest.approx([90, 180, 270, math.nan, math.nan, 450], nan_ok=True)


def test_a_section_that_begins_unknown_takes_nothing_from_the_one_before() -> None:
    before, after = [complex(10 * np.exp(1j * math.radians(turn))) for turn in (-170, 170)]
    c_from, _ = c_angles(
        *around(10, -10j, before), Move(NAN, after), Move(after, 10j), section=[0, 0, 1, 1], entry=[0, 0]
    )
    assert c_from == pytest.approx([0, -90, math.nan, 170], nan_ok=True)


def test_c_outside_sections_is_unknown() -> None:
    c_from, _ = c_angles(Move(10, 10j), Move(10, 10j), section=[-1, 0], entry=[15.0])
    assert c_from == pytest.approx([math.nan, 15], nan_ok=True)
    assert c_angles(section=np.zeros(0, dtype=np.int64), entry=[]) == ([], [])


@pytest.mark.nightly
@few
@given(st.lists(point, min_size=3, max_size=30), st.floats(-360, 360))
def test_c_angles_lead_to_the_points(points: list[complex], entry: float) -> None:
    points[0] = complex(abs(points[0]), 0)
    path = [move for move in around(*points) if move.start != move.end]
    assume(path and all(abs(place) > 1e-3 for place in points))
    c_from, c_to = c_angles(*path, entry=[entry])
    assert c_from[0] == pytest.approx(entry)
    assert c_from[1:] == pytest.approx(c_to[:-1], abs=1e-6)
    for angles, ends in ((c_from, [move.start for move in path]), (c_to, [move.end for move in path])):
        back = np.abs(ends) * np.exp(1j * np.radians(np.array(angles) - entry))
        assert np.abs(back - np.array(ends)).max() < 1e-6
