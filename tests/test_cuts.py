"""The search for cuts into finished parts, by hand: endless parts, ends of contours in the open, depths and places."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped

from polarcheck.foundation.states import Motion
from polarcheck.geometry.overcuts.cuts import Cuts, assign_walls, cuts_into, endless, shortened
from polarcheck.geometry.polygons.finished_part import Contours, FinishedParts, finished_parts
from polarcheck.geometry.segments import Curves, Segments

TOLERANCE = 0.001


def parts_of(*loops: tuple[list[complex], bool], radius: float = 2.0) -> FinishedParts:
    """The parts of these contours, each a group of its own: its points, and whether the tool runs left of it."""
    start = np.concatenate([points[:-1] for points, _ in loops]).astype(complex)
    end = np.concatenate([points[1:] for points, _ in loops]).astype(complex)
    loop = np.repeat(np.arange(len(loops)), [len(points) - 1 for points, _ in loops])
    left = np.array([side for _, side in loops])[loop]
    kind = np.full(len(start), Motion.LINE, np.int16)
    curves = Curves(start, end, np.full(len(start), np.nan + 0j), kind, loop, np.arange(len(start)))
    numbers = np.arange(len(loops))
    return finished_parts(Contours(curves, left, numbers, numbers, np.full(len(loops), radius), np.nan, TOLERANCE))


def ways(*points: tuple[complex, complex]) -> Segments:
    start, end = np.array(points, complex).T
    return Segments(start, end, np.arange(len(start)), np.zeros(len(start), np.int64))


def cuts_of(part: FinishedParts, pieces: Segments, group: np.ndarray, radius: np.ndarray) -> Cuts:
    """Cuts with their walls, of parts that are open or endless into the walls alone."""
    by_walls = part.open | endless(part)
    return assign_walls(part, cuts_into(part, by_walls, pieces, group, radius, TOLERANCE))


SQUARE = [20, 20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j, 20]
SMALL = [5, 5 + 5j, -5 + 5j, -5 - 5j, 5 - 5j, 5]
FLAT = [30 + 10j, 10 + 10j, -30 + 10j]
BOSS, POCKET = (SQUARE, False), (SQUARE, True)


@looped(
    ("loops", "expected"),
    [
        ([BOSS], [False]),
        ([POCKET], [True]),
        ([BOSS, POCKET, BOSS, POCKET], [False, True, False, True]),
        ([POCKET, POCKET, BOSS], [True, True, False]),
        ([(SMALL, True), BOSS, (SMALL, False)], [True, False, False]),
    ],
)
def test_what_surrounds_a_pocket_has_no_end(loops: list[tuple[list[complex], bool]], expected: list[bool]) -> None:
    assert endless(parts_of(*loops)).tolist() == expected


@looped("turn", [1, 1j, -1, -1j, np.exp(0.4j)])
def test_depth_and_place_of_ways_beside_a_boss(turn: complex) -> None:
    """R 2: at 21.5 from the center 0.5 deep, at 22.5 none; through the part its whole R."""
    part = parts_of(([turn * point for point in SQUARE], False), (SMALL, False))
    given = ways(*((turn * a, turn * b) for a, b in ((21.5 - 9j, 21.5 - 11j), (22.5 - 9j, 22.5 + 9j), (0, 10 + 0j))))
    cuts = cuts_of(part, given, np.zeros(3, np.int64), np.full(2, 2.0))
    worst = cuts.worst()
    assert worst.move.tolist() == [0, 2]
    assert worst.depth == pytest.approx([0.5, 2])
    assert worst.aside[0] == pytest.approx(1.5)
    at = worst.place[0] / turn
    assert at.real == pytest.approx(20)
    assert -11 <= at.imag <= -9
    assert worst.wall[0] == 4


def test_each_group_is_compared_with_its_own_part() -> None:
    part = parts_of(BOSS, (SMALL, False), POCKET)
    way = (6 - 2j, 6 + 2j), (6 - 2j, 6 + 2j), (6 - 2j, 6 + 2j), (19 - 2j, 19 + 2j)
    cuts = cuts_of(part, ways(*way), np.array([0, 1, 2, 2]), np.full(3, 2.0)).worst()
    assert cuts.move.tolist() == [0, 1, 3]
    assert cuts.group.tolist() == [0, 1, 2]
    assert cuts.depth == pytest.approx([2, 1, 1])
    assert [cuts.place[at].real for at in (1, 2)] == pytest.approx([5, 20])
    assert cuts.wall[1] == 9


def test_a_corner_is_cut_with_both_of_its_walls() -> None:
    way = ways((21 + 22j, 22 + 21j))
    cuts = cuts_of(parts_of(BOSS), way, np.zeros(1, np.int64), np.array([3.0]))
    assert sorted(cuts.wall.tolist()) == [0, 1]
    assert cuts.place == pytest.approx([20 + 20j] * 2)
    assert cuts.depth == pytest.approx([3 - 1.5 * np.sqrt(2)] * 2)


@looped(("radius", "left"), [(2.0, [(28, 10), (10, -28)]), (25.0, [(5, -5)]), (30.0, []), (40.0, [])])
def test_of_a_contour_in_the_open_nothing_is_known_near_its_ends(
    radius: float, left: list[tuple[float, float]]
) -> None:
    """60 long: R off either end, nothing where both ends are within R of all of it; of a closed one all stays."""
    part = parts_of((FLAT, False), BOSS)
    assert part.open.tolist() == [True, False]
    short = shortened(part, np.full(2, radius))
    own = short.group == 0
    start, end = short.start[own].real, short.end[own].real
    assert sorted(zip(start.tolist(), end.tolist(), strict=True), reverse=True) == [
        pytest.approx(ends) for ends in left
    ]
    assert np.abs(short.end - short.start)[~own].sum() == pytest.approx(160)
