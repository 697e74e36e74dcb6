"""The largest deviation of two paths: by closed forms, by sampling, and whatever divides the path into moves."""

from __future__ import annotations

import cmath
import math
from random import Random

import numpy as np
import pytest
from cases import looped

from polarcheck.foundation.states import Motion
from polarcheck.geometry.comparison import path_deviation as paths
from polarcheck.geometry.comparison.free_space import Budget, frechet
from polarcheck.geometry.comparison.path_deviation import SpacePath, path_deviation
from polarcheck.geometry.comparison.polyline import polyline

TOLERANCE = 0.001
NOWHERE = complex("nan+nanj")


def path_of(start: complex, *moves: tuple, z: float = 0.0) -> SpacePath:
    """A path of moves: (end,), (end, z) for lines, (end, z, center, kind) for arcs."""
    rows = []
    for move in moves:
        end, depth, center, kind = (*move, *(None, z, NOWHERE, Motion.LINE)[len(move) :])
        rows.append((start, end, center, int(kind), z, depth))
        start, z = end, depth
    columns = [np.array(column) for column in zip(*rows, strict=True)]
    types = (complex, complex, complex, np.int16, float, float)
    return SpacePath(*(column.astype(kind) for column, kind in zip(columns, types, strict=True)))


def lines(*points: complex, z: float = 0.0) -> SpacePath:
    return path_of(points[0], *((point,) for point in points[1:]), z=z)


def joined(*pieces: SpacePath) -> SpacePath:
    return SpacePath.concatenated(pieces)


def by_sampling(old: SpacePath, new: SpacePath, count: int = 120) -> tuple[float, float]:
    """The discrete Fréchet distance of samples, and how far apart these are at most [mm]."""
    samples, step = [], 0.0
    for path in (old, new):
        line = polyline(path, 1e-5)[0]
        way = np.union1d(np.linspace(0, line.length[-1], count), line.length)
        samples.append(
            np.stack([np.interp(way, line.length, part) for part in (line.point.real, line.point.imag, line.z)], 1)
        )
        step = max(step, float(np.diff(way).max()))
    apart = np.linalg.norm(samples[0][:, None] - samples[1][None], axis=2)
    best = np.full(apart.shape, np.inf)
    for i, j in np.ndindex(*apart.shape):
        before = [best[i - a, j - b] for a, b in ((1, 0), (0, 1), (1, 1)) if i >= a and j >= b]
        best[i, j] = max(apart[i, j], min(before, default=0.0))
    return float(best[-1, -1]), step


SQUARE = (0j, 10 + 0j, 10 + 10j, 10j, 0j)
CIRCLE = path_of(20 + 0j, (20 + 0j, 0.0, 0j, Motion.CCW))


def circle_in(*angles: float, radius: float = 20.0, kind: Motion = Motion.CCW) -> SpacePath:
    """A full circle from 0, parted at angles [deg]."""
    ends = [radius * complex(np.exp(1j * math.radians(angle))) for angle in (*angles, 0.0)]
    return path_of(radius + 0j, *((end, 0.0, 0j, kind) for end in ends))


@pytest.mark.ci
@looped(
    ("old", "new", "deviation"),
    [
        (lines(*SQUARE), lines(*SQUARE), 0),
        (lines(*SQUARE), lines(0j, 3 + 0j, 7 + 0j, 10 + 0j, 10 + 5j, 10 + 10j, 10j, 0j), 0),
        (CIRCLE, circle_in(120, 240), 0),
        (circle_in(90), circle_in(45, 100, 300), 0),
        (CIRCLE, circle_in(radius=20.01), 0.01),
        # A square run the other way round: the points are a side apart when one of them is at the far corner.
        (lines(*SQUARE), lines(*SQUARE[::-1]), 10),
        (lines(0j, 10 + 0j), lines(10 + 0j, 0j), 10),
        # Twice round: the other point waits in the middle of a side.
        (lines(*SQUARE), lines(*SQUARE, *SQUARE[1:]), math.sqrt(125)),
        (lines(*SQUARE), lines(0j, 10 + 0j, 10.5 + 10j, 10j, 0j), 0.5),
        (lines(*SQUARE), lines(0j, 5 + 0j, 5 + 3j, 5 + 0j, *SQUARE[1:]), 3),
        (lines(*SQUARE), lines(*SQUARE, z=-0.2), 0.2),
        (lines(*SQUARE), lines(*[point + 0.05 for point in SQUARE]), 0.05),
        # Forward 6, back 4, forward 8: the straight line waits in the middle of the way back.
        (lines(0j, 10 + 0j), lines(0j, 6 + 0j, 2 + 0j, 10 + 0j), 2),
        # An arc against its chord: the sagitta.
        (path_of(20 + 0j, (20j, 0.0, 0j, Motion.CCW)), lines(20 + 0j, 20j), 20 - 20 * math.cos(math.pi / 4)),
    ],
    one_in=3,
)
def test_closed_forms(old: SpacePath, new: SpacePath, deviation: float) -> None:
    for pair in ((old, new), (new, old)):
        measured = path_deviation(*pair, TOLERANCE)
        assert measured.largest == pytest.approx(deviation, abs=measured.rounding + 1e-6 * deviation)
        assert measured.is_within == (deviation <= TOLERANCE)
        assert measured.rounding <= max(0.1 * TOLERANCE, 5e-4 * deviation)
        if deviation > TOLERANCE:
            place = measured.place
            assert place is not None
            assert measured.is_exact
            assert math.hypot(abs(place.old - place.new), place.old_z - place.new_z) == pytest.approx(
                deviation, abs=1e-3 + 1e-3 * deviation
            )


@looped("seed", range(12), one_in=12)
def test_sampling_finds_the_same(seed: int) -> None:
    draw = Random(seed)  # noqa: S311 - paths that can be drawn again
    old = [complex(draw.uniform(-3, 3), draw.uniform(-3, 3)) for _ in range(draw.randint(2, 6))]
    new = [point + complex(draw.gauss(0, 0.2), draw.gauss(0, 0.2)) for point in old]
    if seed % 2:
        new.insert(1, (new[0] + new[1]) / 2)
    else:
        draw.shuffle(new)
    pair = lines(*old), lines(*new)
    sampled, step = by_sampling(*pair)
    assert sampled - step <= path_deviation(*pair, TOLERANCE).largest <= sampled + TOLERANCE


def test_place_names_the_moves_of_both() -> None:
    """The corner that has moved, at the end of the second move of the one, and of the third of the other."""
    measured = path_deviation(lines(*SQUARE), lines(0j, 5 + 0j, 10 + 0j, 10 + 12j, 10j, 0j), TOLERANCE)
    assert measured.place is not None
    assert measured.largest == pytest.approx(2, abs=1e-4)
    assert measured.place.new == 10 + 12j
    assert (measured.place.old_move, measured.place.new_move) == (1, 2)


def test_z_alone_between_two_moves_is_part_of_the_path() -> None:
    """A plunge stands as a way from the end of one move to the start of the next."""
    plunge = joined(lines(0j, 10 + 0j, z=2.0), lines(10 + 0j, 10 + 10j, z=-1.0))
    written = path_of(0j, (10 + 0j, 2.0), (10 + 0j, 0.5), (10 + 0j, -1.0), (10 + 10j, -1.0), z=2.0)
    assert path_deviation(plunge, written, TOLERANCE).largest == pytest.approx(0, abs=1e-9)
    late = path_of(0j, (10 + 0j, 2.0), (10 + 10j, -1.0), z=2.0)
    assert path_deviation(plunge, late, TOLERANCE).largest > 0.5


def test_rounded_values_of_a_long_path_stay_within_what_they_are_rounded_by() -> None:
    """The lengths of the ways drift apart over thousands of moves; places do not."""
    draw = np.random.default_rng(1)
    points = np.cumsum(draw.normal(size=4000) + 1j * draw.normal(size=4000))
    rounded = np.round(points, 3)
    split = np.insert(rounded, np.arange(1, 4000, 7), np.round((rounded[:-1] + rounded[1:])[::7] / 2, 3))
    measured = path_deviation(lines(*points), lines(*split), 0.0015)
    assert measured.is_within
    assert 0.0004 < measured.largest < 0.0015


def test_paths_too_long_to_be_measured_as_a_whole_give_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(paths, "_CELLS_OF_WHOLE", 3)
    measured = path_deviation(lines(*SQUARE), lines(0j, 10 + 0j, 10.5 + 10j, 10j, 0j), TOLERANCE)
    assert (measured.largest, measured.is_exact) == (pytest.approx(0.5, abs=1e-3), False)
    monkeypatch.setattr(paths, "_CELLS_OF_PIECES", 3)
    measured = path_deviation(lines(*SQUARE), lines(*SQUARE, *SQUARE[1:]), TOLERANCE)
    assert measured.largest >= math.sqrt(125)
    assert not measured.is_within


def test_empty_and_unknown_paths() -> None:
    square, nothing = lines(*SQUARE), lines(*SQUARE)[:0]
    assert path_deviation(nothing, nothing, TOLERANCE).is_within
    assert path_deviation(square, nothing, TOLERANCE).largest == math.inf
    with pytest.raises(ValueError, match="not known"):
        path_deviation(square, lines(0j, NOWHERE), TOLERANCE)
    standing = path_of(0j, (0j,))
    assert path_deviation(standing, square, TOLERANCE).largest == pytest.approx(math.sqrt(200))


def test_a_distance_that_is_certain_spares_cells_and_changes_nothing() -> None:
    old = [(float(x), 0.0, 0.0) for x in range(50)]
    new = [(x, 0.01 if x == 40 else 0.0, 0.0) for x, _, _ in old]
    plain, bounded = Budget(100_000), Budget(100_000)
    found = frechet(old, new, 0.02, 1e-5, bounded, 0.01)
    assert found == frechet(old, new, 0.02, 1e-5, plain)
    assert found[0] == pytest.approx(0.01, abs=1e-5)
    assert bounded.cells > plain.cells


@pytest.mark.ci
@looped("seed", range(40), one_in=5)
def test_a_long_path_is_measured_between_the_pairs_that_every_run_has(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Against the distance of the whole lines, which take more cells than are allowed here; some laps run twice."""
    chance = Random(seed)  # noqa: S311 - numbers of a test
    laps = chance.choice((1, 1, 1, 2))
    points = [cmath.rect(20 + 3 * math.sin(5 * t), t) for t in np.linspace(0, laps * math.tau, laps * 300 + 1)]
    near = [point + complex(chance.uniform(-1, 1), chance.uniform(-1, 1)) * TOLERANCE / 4 for point in points]
    for index in chance.sample(range(5, len(points) - 5), 3):
        # A corner out of its place, twice in a row or left out.
        near[index] += cmath.rect(chance.uniform(2, 9) * TOLERANCE, chance.uniform(0, math.tau))
        if chance.random() < 0.5:
            near[index + 1] = near[index] - 0.1 * (points[index + 1] - points[index])
    old, new = lines(*points), lines(*near)
    corners = [[(point.real, point.imag, 0.0) for point in line] for line in (points, near)]
    expected, _ = frechet(*corners, 0.1, 1e-7, Budget(10_000_000))
    monkeypatch.setattr(paths, "_CELLS_OF_WHOLE", 500 if laps == 1 else 200_000)
    found = path_deviation(old, new, TOLERANCE)
    assert found.is_within == (expected <= TOLERANCE)
    if not found.is_within:
        assert found.is_exact
        assert found.largest == pytest.approx(expected, abs=0.021 * TOLERANCE)
