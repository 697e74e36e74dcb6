"""Lines and arcs through the places of plain X and C moves: few, near enough, and where they were."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cases import looped
from numpy.typing import NDArray
from unrolled_contours import Piece, as_x_and_c, hexagon, oval, places, slot

from polarcheck.foundation.states import Motion
from polarcheck.geometry.fitted_curves.curves import FittedPath, fitted
from polarcheck.geometry.fitted_curves.spirals import MOST_BOW, bows, counts, sampled
from polarcheck.geometry.polar import length

TOLERANCE, RESERVE = 0.005, 0.001
NOISE = 0.0005


def fit(x: NDArray[np.float64], c: NDArray[np.float64], z: NDArray[np.float64] | None = None) -> FittedPath:
    samples = sampled(x, np.radians(c), np.zeros(len(x)) if z is None else z, TOLERANCE, RESERVE)
    return fitted(samples, TOLERANCE - RESERVE, NOISE)


@looped(("turn", "pieces"), [(0.07, 2), (0.2, 9)])
def test_a_block_that_bows_little_is_looked_at_in_its_middle_alone(turn: float, pieces: int) -> None:
    """Up to MOST_BOW tolerances it stands for a contour through its ends; another one is followed as it is."""
    around = np.array([20.0, 20.0]), np.array([0.0, turn])
    assert (bows(*around)[0] <= MOST_BOW * TOLERANCE) == (pieces == 2)
    assert len(sampled(*around, np.zeros(2), TOLERANCE).point) == pieces + 1


def along(start: complex, curves: FittedPath, share: NDArray[np.float64]) -> list[NDArray[np.complex128]]:
    """Dense points of each element."""
    result, begin = [], start
    for end, center, kind in zip(curves.end.tolist(), curves.center.tolist(), curves.kind.tolist(), strict=True):
        if kind == Motion.LINE:
            result.append(begin + (end - begin) * share)
        else:
            turn = float(np.angle((end - center) / (begin - center))) * (1 if kind == Motion.CCW else -1) % math.tau
            sweep = (turn if abs(end - begin) > 1e-9 else math.tau) * (1 if kind == Motion.CCW else -1)
            result.append(center + (begin - center) * np.exp(1j * sweep * share))
        begin = end
    return result


def farthest(x: NDArray[np.float64], c: NDArray[np.float64], curves: FittedPath) -> tuple[float, float]:
    """How far the end points of the blocks, and their way between, are from the curves, by points 0.002 mm apart."""
    angle = np.radians(c)
    ends = x * np.exp(1j * angle)
    share = np.linspace(0, 1, 6, endpoint=False)
    way = np.concatenate(
        [
            (x[k] + (x[k + 1] - x[k]) * share) * np.exp(1j * (angle[k] + (angle[k + 1] - angle[k]) * share))
            for k in range(len(x) - 1)
        ]
    )
    lengths = [abs(np.diff(part)).sum() for part in along(complex(ends[0]), curves, np.linspace(0, 1, 50))]
    dense = np.concatenate(
        [
            along(complex(ends[0]), curves, np.linspace(0, 1, max(3, int(long / 0.002))))[k]
            for k, long in enumerate(lengths)
        ]
    )

    def distance(points: NDArray[np.complex128]) -> float:
        return max(float(np.abs(dense - point).min()) for point in points)

    return distance(ends), distance(way)


CONTOURS = {"hexagon": (hexagon(), 13), "slot": (slot(), 5), "oval": (oval(), 5)}


@pytest.mark.ci
@looped("chord_error", [0.005, 0.0005], one_in=6)
@looped("name", CONTOURS)
def test_a_clean_contour_comes_back_with_its_lines_and_arcs(name: str, chord_error: float) -> None:
    (start, pieces), count = CONTOURS[name]
    x, c = as_x_and_c(places(start, pieces, chord_error))
    curves = fit(x, c)
    assert len(curves) == count
    np.testing.assert_allclose(curves.end, [piece[0] for piece in pieces], atol=0.002)
    centers = np.array([piece[1] if len(piece) > 1 else complex("nan+nanj") for piece in pieces])
    np.testing.assert_allclose(curves.center, centers, atol=0.02)
    ends, way = farthest(x, c, curves)
    assert ends <= TOLERANCE
    assert way <= (1 + MOST_BOW) * TOLERANCE


@looped(("start", "center", "ccw"), [(20 + 0j, 0j, True), (20 + 0j, 12 + 3j, False), (14 - 3j, 14 + 4j, True)])
def test_a_full_circle_is_one_arc_whose_ends_are_one_point(start: complex, center: complex, ccw: bool) -> None:
    x, c = as_x_and_c(places(start, [(start, center, ccw)], 0.002))
    curves = fit(x, c)
    assert curves.kind.tolist() == [Motion.CCW if ccw else Motion.CW]
    assert curves.end[0] == x[0] * np.exp(1j * math.radians(c[0]))
    assert abs(curves.center[0] - center) < 0.001


def test_a_long_block_of_constant_x_is_an_arc_about_the_center_and_one_of_constant_c_a_line() -> None:
    curves = fit(np.array([30.0, 20.0, 20.0, 8.0]), np.array([10.0, 10.0, 250.0, 250.0]))
    assert curves.kind.tolist() == [Motion.LINE, Motion.CCW, Motion.LINE]
    assert abs(curves.center[1]) < 1e-6


def test_an_archimedean_spiral_of_one_block_is_followed_along_its_way() -> None:
    x, c = np.array([10.0, 14.0]), np.array([0.0, 300.0])
    curves = fit(x, c)
    assert 3 < len(curves) < 30
    assert farthest(x, c, curves)[1] <= TOLERANCE


@looped("negative", [False, True])
def test_x_below_zero_is_the_other_side_and_corners_stay(negative: bool) -> None:
    corners: list[Piece] = [(10 + 10j,), (-10 + 10j,), (-10 - 10j,), (10 - 10j,)]
    x, c = as_x_and_c(places(10 - 10j, corners, 0.005))
    curves = fit(-x, c + 180) if negative else fit(x, c)
    assert curves.kind.tolist() == [Motion.LINE] * 4
    np.testing.assert_allclose(curves.end, [piece[0] for piece in corners], atol=0.001)


def test_a_way_back_along_itself_ends_an_element() -> None:
    points = places(10 + 5j, [(20 + 5j,), (12 + 5j,), (15 + 9j,)], 0.005)
    assert len(fit(*as_x_and_c(points))) == 3


def test_z_is_held_along_a_helix_and_a_change_of_its_slope_ends_an_element() -> None:
    points = places(20 + 0j, [(20 + 0j, 12 + 0j, True), (20 + 0j, 12 + 0j, True)], 0.002)
    half = len(points) // 2
    z = np.interp(np.arange(len(points)), [0, half, len(points) - 1], [0.0, -3.0, -4.0])
    curves = fit(*as_x_and_c(points), z)
    assert len(curves) == 2


@pytest.mark.nightly
@looped("seed", range(3), one_in=3)
def test_random_contours_are_passed_within_the_tolerance(seed: int) -> None:
    random = np.random.default_rng(seed)
    angle = np.linspace(0, 4, 300)
    wave = sum(random.normal() * np.sin(k * angle + random.uniform(0, 6)) / k for k in range(1, 6))
    x, c = as_x_and_c((15 + wave) * np.exp(1j * angle))
    curves = fit(x, c)
    assert len(curves) < 80
    ends, way = farthest(x, c, curves)
    assert ends <= TOLERANCE
    assert way <= TOLERANCE + bows(x, np.radians(c)).max() + RESERVE


@pytest.mark.ci
def test_twenty_thousand_points_of_an_ellipse_are_few_arcs() -> None:
    angle = np.linspace(0, math.tau, 20_001)
    x, c = as_x_and_c(20 * np.cos(angle) + 12j * np.sin(angle))
    assert len(fit(x, c)) < 60


def test_counts_say_how_many_samples_a_turn_of_c_takes() -> None:
    turns = np.array([0.0, 1e9])
    assert counts(np.array([50.0, 50.0]), turns, TOLERANCE)[0] > 1e9
    assert counts(np.array([50.0, 40.0]), np.zeros(2), TOLERANCE)[0] == 1


def test_elements_follow_each_other() -> None:
    start, pieces = hexagon()
    x, c = as_x_and_c(places(start, pieces, 0.005))
    curves = fit(x, c)
    begin = np.append(x[0] * np.exp(1j * math.radians(c[0])), curves.end[:-1])
    assert np.isfinite(length(begin, curves.end, curves.center, curves.kind)).all()
