"""The area within R of a path, against what shapely makes of each of its chords by itself."""

from __future__ import annotations

import cmath
import math
from random import Random
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped

from polarcheck.foundation.states import Motion
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.cleared import cleared
from polarcheck.geometry.polygons.widened import widened
from polarcheck.geometry.segments import Curves, segments

pytestmark = pytest.mark.ci

TOLERANCE = 0.004


def path_of(*arcs: tuple[complex, complex, complex, Motion]) -> Curves:
    start, end, center, kind = zip(*arcs, strict=True)
    number = np.arange(len(arcs))
    return Curves(
        np.array(start), np.array(end), np.array(center), np.array(kind, np.int16), np.zeros_like(number), number
    )


def arc(center: complex, radius: float, begin: float, end: float, kind: Motion = Motion.CCW) -> Any:
    return center + cmath.rect(radius, begin), center + cmath.rect(radius, end), center, kind


def area_of(path: Curves, radius: float) -> Any:
    return widened(path, segments(path, TOLERANCE), radius, TOLERANCE)


def chord_by_chord(path: Curves, radius: float) -> Any:
    """The same by another way: each chord of a finer path is widened by shapely."""
    chords = segments(path, TOLERANCE / 4)
    ends = np.stack([chords.start, chords.end], axis=1)
    lines = shapely.linestrings(np.stack([ends.real, ends.imag], axis=2))
    return shapely.union_all(shapely.buffer(lines, radius, quad_segs=40))


def furthest_apart(one: Any, other: Any) -> float:
    """The thickness of the difference of two areas [mm]: how far the edge of one lies from that of the other."""
    return float(max(shapely.hausdorff_distance(one.boundary, other.boundary), 0.0))


FAMILIES = {
    "a circle larger than R": path_of(arc(0j, 20, 0, 0)),
    "a circle smaller than R": path_of(arc(3 + 1j, 2, 1, 1)),
    "a circle just larger than R": path_of(arc(0j, 4.001, 0, 0)),
    "a circle as large as R": path_of(arc(0j, 4, 0, 0)),
    "a short arc larger than R": path_of(arc(0j, 20, 1, 1.2)),
    "a short arc smaller than R": path_of(arc(0j, 3, 1, 1.2)),
    "most of a circle": path_of(arc(0j, 10, 0, 6.2)),
    "most of a circle smaller than R": path_of(arc(0j, 2.5, 0, 6.2, Motion.CCW)),
    "a spiral": path_of((10 + 0j, -14 + 0j, 0j, Motion.CW)),
    "lobes that are tangent": path_of(
        *(
            (a, b, (a + b) / 2, Motion.CCW if k % 2 else Motion.CW)
            for k, (a, b) in enumerate(
                (cmath.rect(20, k * math.tau / 8), cmath.rect(20, (k + 1) * math.tau / 8)) for k in range(8)
            )
        )
    ),
    "a line and an arc": path_of((0j, 10 + 0j, complex(np.nan), Motion.LINE), arc(10 + 5j, 5, -math.pi / 2, 0)),
}


@pytest.mark.nightly
@looped("family", FAMILIES, one_in=14)
@looped("radius", [0.4, 4.0, 25.0])
def test_it_is_the_union_of_its_widened_chords(family: str, radius: float) -> None:
    found, expected = area_of(FAMILIES[family], radius), chord_by_chord(FAMILIES[family], radius)
    assert found.is_valid
    assert shapely.symmetric_difference(found, expected).area < TOLERANCE * expected.length
    assert furthest_apart(found, expected) < 0.1


@looped("seed", range(5), one_in=5)
def test_random_arcs(seed: int) -> None:
    chance = Random(seed)  # noqa: S311
    arcs = [
        arc(
            complex(chance.uniform(-20, 20), chance.uniform(-20, 20)),
            chance.choice([0.5, 2.0, 3.9, 4.0, 4.1, 10.0]),
            chance.uniform(0, 7),
            chance.uniform(0, 7),
            chance.choice([Motion.CW, Motion.CCW]),
        )
        for _ in range(10)
    ]
    found, expected = area_of(path_of(*arcs), 4.0), chord_by_chord(path_of(*arcs), 4.0)
    assert found.is_valid
    assert shapely.symmetric_difference(found, expected).area < TOLERANCE * expected.length


def points_joined(monkeypatch: pytest.MonkeyPatch, path: Curves, radius: float) -> int:
    """How many points go into unions."""
    points = 0
    union_all = areas.union_all

    def counted(parts: Any, grid_size: float | None = None) -> Any:
        nonlocal points
        points += int(shapely.get_num_coordinates(parts).sum())
        return union_all(parts, grid_size)

    monkeypatch.setattr(areas, "union_all", counted)
    cleared(path, radius)
    return points


def test_what_is_run_again_costs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    once, again = (points_joined(monkeypatch, path_of(*[arc(0j, 5, 0, 0)] * count), 5.0) for count in (1, 100))
    assert again == once
    backward = arc(0j, 5, 0, 0, Motion.CW)
    assert points_joined(monkeypatch, path_of(backward, arc(0j, 5, 0, 0)), 5.0) == once
    quarters = [arc(0j, 5, k * math.pi / 2, (k + 1) * math.pi / 2) for k in range(4)]
    once, again = (points_joined(monkeypatch, path_of(*quarters * count), 5.0) for count in (1, 25))
    assert again == once


@pytest.mark.nightly
def test_a_circle_costs_few_points(monkeypatch: pytest.MonkeyPatch) -> None:
    """Widened chord by chord a circle would have thousands of points for each of its chords."""
    for radius in (5.0, 127.0):
        path = path_of(*(arc(0j, 10 + 3 * k, 0, 0) for k in range(20)))
        chords = len(segments(path, TOLERANCE))
        assert points_joined(monkeypatch, path, radius) < 40 * chords + 200_000
