"""Curves as straight segments: loop after loop, as near to the curve as asked for, the same chords on one circle."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped

from polarcheck.foundation.states import Motion
from polarcheck.geometry.segments import Curves, reach_from_start, segments


def curves(*moves: tuple[complex, complex, complex | None, Motion], loops: list[int] | None = None) -> Curves:
    """Of start, end, center and kind of each."""
    start, end, center, kind = zip(*moves, strict=True)
    centers = np.array([np.nan if one is None else one for one in center], np.complex128)
    rows = np.arange(len(moves))
    return Curves(
        np.array(start, np.complex128),
        np.array(end, np.complex128),
        centers,
        np.array(kind, np.int16),
        np.array(loops if loops else [0] * len(moves)),
        rows,
    )


LINES = [(0j, 1 + 0j, None, Motion.LINE), (1 + 0j, 1 + 1j, None, Motion.LINE), (1 + 1j, 0j, None, Motion.LINE)]


@looped(
    ("loops", "order"),
    [
        ([0, 0, 1], [0, 1, 2]),
        ([1, 0, 2], [1, 0, 2]),
        ([0, 2, 1], [0, 2, 1]),
        ([2, 1, 0], [2, 1, 0]),
        ([1, 0, 1], [1, 0, 2]),
    ],
)
def test_loop_after_loop(loops: list[int], order: list[int]) -> None:
    found = segments(curves(*LINES, loops=loops), 0.01)
    assert found.loop.tolist() == sorted(loops)
    assert found.move.tolist() == order
    assert found.start.tolist() == [LINES[row][0] for row in order]


@looped("kind", [Motion.CW, Motion.CCW])
@looped("tolerance", [0.1, 0.01, 0.001])
def test_the_sagitta_is_a_quarter_of_the_tolerance_at_most(kind: Motion, tolerance: float) -> None:
    found = segments(curves((10 + 0j, 0 + 10j, 0j, kind)), tolerance)
    assert np.abs(found.start) == pytest.approx(10)
    assert np.abs(found.end) == pytest.approx(10)
    assert (found.start[0], found.end[-1]) == (10, 10j)
    assert (found.start[1:] == found.end[:-1]).all()
    sagitta = 10 - np.abs(found.start + found.end) / 2
    assert sagitta.max() <= tolerance / 4
    assert sagitta[1:-1].min(initial=1) > tolerance / 16  # no more segments than needed
    turned = np.angle(found.end / found.start).sum()
    assert turned == pytest.approx(np.pi / 2 if kind == Motion.CCW else -3 * np.pi / 2)


def test_arcs_that_run_over_each_other_have_the_same_chords() -> None:
    begins = 10 * np.exp(0.3j)
    found = segments(curves((10 + 0j, 0 + 10j, 0j, Motion.CCW), (begins, -10 + 0j, 0j, Motion.CCW)), 0.01)
    one, other = (found.start[found.move == move] for move in (0, 1))
    shared = [point for point in one if 0.31 < np.angle(point) < 1.5]
    assert len(shared) > 10
    assert all(np.abs(other - point).min() < 1e-9 for point in shared)


def test_an_end_off_the_circle_is_reached_in_a_spiral() -> None:
    found = segments(curves((10 + 0j, 0 + 12j, 0j, Motion.CCW)), 0.01)
    angle = np.angle(found.start)
    assert np.abs(found.start) == pytest.approx(10 * (1 + 0.2 * angle / (np.pi / 2)))
    assert found.end[-1] == 12j


def test_what_is_not_known_and_what_has_no_length_is_left_out() -> None:
    nowhere = complex("nan")
    found = segments(
        curves((0j, nowhere, None, Motion.LINE), (1j, 1j, None, Motion.LINE), (0j, 2j, None, Motion.CW), LINES[0]), 0.01
    )
    assert found.move.tolist() == [3]


@looped("kind", [Motion.CW, Motion.CCW])
@looped("growth", [0.9, 1.0, 1.1])
@looped("turn", [0, 1, 90, 179, 180, 181, 270, 359])
def test_no_point_of_a_curve_is_farther_from_its_start_than_it_reaches(turn: int, growth: float, kind: Motion) -> None:
    arc = curves((10 + 0j, 10 * growth * np.exp(1j * np.radians(turn)), 0j, kind))
    parts = segments(arc, 1e-4)
    (reach,) = reach_from_start(arc)
    assert reach >= np.abs(parts.end - arc.start).max() - 1e-9
    assert reach <= 20 * max(growth, 1) + 1e-9


def test_a_short_arc_reaches_no_farther_than_its_chord() -> None:
    arcs = curves((10 + 0j, 10j, 0j, Motion.CCW), (10 + 0j, 10j, 0j, Motion.CW), (10 + 0j, 10 + 3j, None, Motion.LINE))
    assert reach_from_start(arcs) == pytest.approx([np.sqrt(200), 20, 3])
