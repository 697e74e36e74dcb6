"""Lines and arcs divided into pieces of even X and C: closed forms, and dense sampling of the pieces."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from polarcheck.foundation.states import Motion
from polarcheck.geometry.straight_axes.division import Pieces, divide
from polarcheck.geometry.straight_axes.spans import Spans, spans_of

NO_CENTER = complex("nan+nanj")


def divided(
    start: complex, end: complex, center: complex = NO_CENTER, kind: int = Motion.LINE, tolerance: float = 0.005
) -> tuple[Spans, Pieces]:
    columns = (np.array([point], np.complex128) for point in (start, end, center))
    spans = spans_of(*columns, np.array([kind], np.int16), 2.5e-4)
    return spans, divide(spans, tolerance, np.pi, 100_000)


def sampled(pieces: Pieces, count: int = 41) -> np.ndarray:
    """The way of each piece, from its ends alone."""
    share = np.linspace(0, 1, count)
    r = np.abs(pieces.start)[:, None] + (np.abs(pieces.end) - np.abs(pieces.start))[:, None] * share
    turned = np.concatenate(([0.0], np.cumsum(pieces.turn)))
    angle = turned[:-1, None] + pieces.turn[:, None] * share
    return np.asarray(r * np.exp(1j * angle))


def test_a_circle_about_the_center_is_two_blocks_of_c() -> None:
    _, pieces = divided(10 + 0j, 10 + 0j, 0j, Motion.CW)
    assert np.abs(pieces.start).tolist() == pytest.approx([10, 10])
    assert pieces.turn.tolist() == pytest.approx([-np.pi, -np.pi])


def test_a_radial_line_is_one_block_of_x() -> None:
    _, pieces = divided(10 + 10j, 30 + 30j)
    assert len(pieces) == 1
    assert pieces.turn[0] == pytest.approx(0)


def test_through_the_center_x_goes_to_0_and_c_keeps_its_angle() -> None:
    _, pieces = divided(-30 + 0j, 20 + 1e-5j)
    assert pieces.end.tolist() == [0, 20 + 1e-5j]
    assert pieces.turn.tolist() == pytest.approx([0, 0], abs=1e-5)


@looped("distance", [0.001, 0.1, 5.0, 40.0])
def test_a_line_beside_the_center_is_d_by_the_cosine(distance: float) -> None:
    """Its points are r = d / cos(theta); near the center C turns by 5 deg a block at most."""
    _, pieces = divided(complex(distance, -25), complex(distance, 25))
    theta = np.angle(pieces.start)
    assert np.abs(pieces.start) == pytest.approx(distance / np.cos(theta))
    assert np.degrees(np.abs(pieces.turn).max()) < 5.5
    assert sampled(pieces)[:, 0] == pytest.approx(pieces.start * np.exp(-1j * theta[0]))


_POINT = st.builds(complex, st.floats(-40, 40), st.floats(-40, 40))


@pytest.mark.ci
@given(_POINT, _POINT, st.floats(-3, 3), st.sampled_from([0.001, 0.005, 0.05]))
@settings(max_examples=60, deadline=None)
def test_dense_samples_stay_within_the_chord_error(
    start: complex, end: complex, bulge: float, tolerance: float
) -> None:
    """bulge: the distance of the center of an arc from its chord, by the half of that; a line where it is near 0."""
    if abs(end - start) < 0.01:
        return
    is_line = abs(bulge) < 0.1
    center = (start + end) / 2 + 1j * bulge * (end - start) / 2
    kind = Motion.LINE if is_line else Motion.CCW
    spans, pieces = divided(start, end, NO_CENTER if is_line else center, kind, tolerance)
    assume(not np.any(pieces.start[1:] == 0))  # C turns on the spot there, between two pieces
    way = sampled(pieces) * np.exp(1j * np.angle(_direction(spans)))
    if is_line:
        unit = (end - start) / abs(end - start)
        distance = np.abs(((way - start) * np.conj(unit)).imag)
    else:
        distance = np.abs(np.abs(way - center) - abs(start - center))
    assert distance.max() <= tolerance * 1.02
    assert abs(way[-1, -1] - end) < 1e-3
    assert np.all(np.abs(pieces.turn) <= np.pi + 1e-9)


def _direction(spans: Spans) -> complex:
    """Where the path is seen from the center of C as it begins."""
    return complex(spans.start[0] or spans.directions(np.zeros((len(spans), 1)))[0, 0])


def test_the_number_of_pieces_is_near_the_least() -> None:
    """A line at the distance d asks for the integral of sqrt(d (2 - sech^2 u) / (8 tol)) with sinh u the way by d."""
    _, pieces = divided(20 - 40j, 20 + 40j)
    u = np.linspace(-np.arcsinh(2), np.arcsinh(2), 2001)
    least = np.trapezoid(np.sqrt(20 * (2 - 1 / np.cosh(u) ** 2) / 0.04), u)
    assert least - 1 <= len(pieces) <= 1.05 * least + 2


@looped(
    ("start", "end", "level", "between"),
    [
        (10 + 4j, 10 - 4j, 0.0, [6]),  # by the place that is nearest to the center of C
        (10 - 4j, 10 + 4j, 0.0, [14]),  # by the one that is farthest away
        (13.759 - 1.368j, 13.759 + 1.368j, 0.0, [14]),
        (13.759 - 1.368j, 13.759 + 1.368j, 0.5, []),  # 0.17 farther away than both ends
    ],
)
def test_an_arc_is_divided_where_it_is_nearest_and_farthest(
    start: complex, end: complex, level: float, between: list[complex]
) -> None:
    """R4 about 10 mm from the center of C, counterclockwise."""
    columns = (np.array([point], complex) for point in (start, end, 10))
    spans = spans_of(*columns, np.array([Motion.CCW], np.int16), 2.5e-4, level)
    assert spans.end[:-1] == pytest.approx(between, abs=1e-3)
