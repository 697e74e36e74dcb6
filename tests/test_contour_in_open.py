"""Ramps of contours that end in the open: a long flat at 10 mm from the center, R 5; distances known by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cases import looped

from polarcheck.foundation.states import Motion
from polarcheck.geometry.overcuts.cuts import Cuts
from polarcheck.geometry.overcuts.own_loop import overcuts
from polarcheck.geometry.segments import Curves

RADIUS = 5.0
FIRST, LAST = 20 + 10j, -60 + 10j
TOUCHES = 20 + 15j


def lines(start: list[complex], end: list[complex], row: list[int]) -> Curves:
    count = len(start)
    kind = np.full(count, Motion.LINE, np.int16)
    points = np.array(start, complex), np.array(end, complex), np.full(count, np.nan + 0j)
    return Curves(*points, kind, np.arange(count), np.array(row))


def ramped(begins: list[complex], air: list[float], turn: complex, cancels: bool) -> Cuts:
    """For each loop a ramp from or to here, with the radius from which on there is air."""
    count = len(begins)
    ends = [turn * FIRST] * count, [turn * LAST] * count
    ramp = [turn * point for point in begins], [turn * TOUCHES] * count
    rows = [10 * number for number in range(count)]
    contour = lines(*(ends[::-1] if cancels else ends), [row + 1 for row in rows])
    path = lines(*(ramp[::-1] if cancels else ramp), [row + 2 * cancels for row in rows])
    left, sizes = np.full(count, cancels), np.full(count, RADIUS)
    cuts, *_ = overcuts(contour, left, np.array(air), contour.loop, path, sizes, np.ones(count, bool))
    return cuts


def beside(air: float, begin: complex) -> float:
    """How deep a ramp from there runs beside the point at which the flat leaves the air [mm]."""
    point, way = complex(-math.sqrt(air**2 - 100), 10), TOUCHES - begin
    return RADIUS - abs(((point - begin).conjugate() * way).imag) / abs(way)


@pytest.mark.ci
@looped("cancels", [False, True])
@looped("turn", [1, 1j, np.exp(2j)])
def test_a_ramp_from_the_air_cuts_only_what_is_within_it(turn: complex, cancels: bool) -> None:
    """The way from (-40, 9) to (20, 15) runs through the flat at x = -30, 31.6 from the center."""
    begin, air = -40 + 9j, [15.0, 18.0, 25.0, 33.0, math.inf, 9.0]
    cuts = ramped([begin] * len(air), air, turn, cancels)
    depth = [beside(15, begin), beside(18, begin), beside(25, begin), RADIUS, RADIUS]
    assert cuts.move.tolist() == [0, 1, 2, 3, 4]
    assert cuts.depth == pytest.approx(depth, abs=0.001)
    assert cuts.wall.tolist() == [0, 1, 2, 3, 4]
    assert depth[0] == pytest.approx(5 - 1.882 * math.cos(math.atan(0.1)), abs=0.001)  # at (-11.18, 10)


@looped("cancels", [False, True])
@looped("turn", [1, 1j, np.exp(2j)])
def test_a_slant_nicks_the_end_that_it_leads_to(turn: complex, cancels: bool) -> None:
    """Past the end of the flat 0.02 nearer than 5 is no cut; behind it only what is more than the slant takes is."""
    cuts = ramped([50 + 12j, 60 + 13j, 24.2 + 9.5j, 23 + 9j], [math.inf] * 4, turn, cancels)
    assert cuts.move.tolist() == [3]
    assert cuts.depth == pytest.approx([2.5], abs=0.002)
