"""Walls cut where they meet, and the faces between them that are left standing: squares whose areas one knows."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from cases import looped

from polarcheck.geometry.polygons.faces import Standing, Walls, standing
from polarcheck.geometry.polygons.noding import noded
from polarcheck.geometry.tolerances import CROSSINGS, FREE_CROSSINGS

SQUARE = [20, 20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j, 20]
BOX = 100.0


def chain(*points: complex, left: bool = False, group: int = 0) -> Walls:
    """Walls from point to point with the tool on one side, and the square round their group."""
    path = np.array(points, complex)
    corners = BOX * np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j])
    start = np.concatenate([path[:-1], path[:1], corners])
    end = np.concatenate([path[1:], [BOX + 1j * path[0].imag], np.roll(corners, -1)])
    count, is_wall = len(path) - 1, np.arange(len(start)) < len(path) - 1
    shift = 3 * BOX * group
    joins = np.arange(len(start)) == count
    return Walls(start + shift, end + shift, is_wall & left, is_wall & (not left), joins, np.full(len(start), group))


def left_standing(*walls: Walls) -> Standing:
    joined = Walls.concatenated(walls)
    return standing(joined, len(walls), 0.005)


@pytest.mark.ci
@looped("turn", [1, np.exp(0.3j), 1j, np.exp(2j)], one_in=2)
@looped(
    ("name", "points", "left", "area"),
    [
        ("boss", SQUARE, False, 1600),
        ("pocket", SQUARE, True, 4 * BOX**2 - 1600),
        ("leads across the side", [30, *SQUARE, 30], False, 1600),
        ("leads over each other", [30, *SQUARE[:-1], 20 + 1j, 30 + 1j], False, 1600),
        ("leads that cross at a corner", [25 + 20j, -20 + 20j, -20 - 20j, 20 - 20j, 20 + 25j], False, 1600),
        ("a lead that ends in the part", [30, *SQUARE, 5], False, 1600),
        ("passes", [25, 25 + 25j, -25 + 25j, -25 - 25j, 25 - 25j, 25, *SQUARE], False, 1600),
        ("passes written twice", [*SQUARE, *SQUARE[1:]], False, 1600),
        ("passes outwards", [*SQUARE, 25, 25 + 25j, -25 + 25j, -25 - 25j, 25 - 25j, 25], True, 4 * BOX**2 - 2500),
        ("an open contour", [16 + 10j, -16 + 10j], False, 0),
        ("to and fro", [-16, 16, -16], False, 0),
        ("two parts", [0, 20, 20 + 20j, 0, -20 - 20j, -20, 0], True, 4 * BOX**2 - 400),
    ],
)
def test_what_is_left_standing(name: str, points: list[complex], left: bool, area: float, turn: complex) -> None:
    if name == "two parts":
        points = [0, 20, 20 + 20j, 20j, 0, -20, -20 - 20j, -20j, 0]  # a figure of two squares that meet in a corner
        area = 4 * BOX**2 - 800
    found = left_standing(chain(*(turn * point for point in points), left=left))
    assert shapely.area(found.polygon[0]) == pytest.approx(area, abs=1e-6)
    assert not found.tangled[0]
    inside = np.abs(found.start) < BOX
    mirrored = left_standing(chain(*(np.conj(turn * point) for point in points), left=not left))
    assert shapely.area(mirrored.polygon[0]) == pytest.approx(area, abs=1e-6)
    assert np.count_nonzero(np.abs(mirrored.start) < BOX) == np.count_nonzero(inside)


def test_what_bounds_it_has_it_on_the_left() -> None:
    for left in (False, True):
        found = left_standing(chain(30, *SQUARE, 30, left=left))
        inside = np.maximum(np.abs(found.start.real), np.abs(found.end.real)) < BOX
        middle, way = (found.start + found.end)[inside] / 2, (found.end - found.start)[inside]
        points = shapely.points((middle + 1e-3j * way / np.abs(way)).view(float).reshape(-1, 2))
        assert shapely.contains(found.polygon[0], points).all()


def test_groups_do_not_see_each_other() -> None:
    found = left_standing(chain(*SQUARE), chain(5, 5j, -5, -5j, 5, group=1), chain(0, 30, group=2))
    assert shapely.area(found.polygon).tolist() == pytest.approx([1600, 50, 0])


def test_an_island_stands_in_its_pocket() -> None:
    pocket, island = chain(*SQUARE, left=True), chain(5, 5j, -5, -5j, 5)
    both = Walls.concatenated([pocket, island[:5]])
    assert shapely.area(left_standing(both).polygon[0]) == pytest.approx(4 * BOX**2 - 1600 + 50)


def test_islands_stand_in_pockets_of_islands() -> None:
    sizes = np.arange(2.0, 0, -0.05)
    rings = [chain(*(size * np.array(SQUARE)), left=number % 2 == 0) for number, size in enumerate(sizes)]
    nested = Walls.concatenated([rings[0], *(ring[: len(SQUARE)] for ring in rings[1:])])
    areas = 1600 * sizes**2
    found = left_standing(nested).polygon[0]
    assert shapely.area(found) == pytest.approx(4 * BOX**2 - areas[::2].sum() + areas[1::2].sum())
    assert len(found.geoms) == 1 + len(sizes) // 2


def test_a_sliver_between_two_passes_is_nothing() -> None:
    points = [0, 10, 10 + 0.001j, 0.001j, 0]
    assert shapely.area(left_standing(chain(*points)).polygon[0]) == 0
    assert shapely.area(left_standing(chain(0, 10, 10 + 0.02j, 0.02j, 0)).polygon[0]) == pytest.approx(0.2)


def test_walls_are_cut_where_they_meet() -> None:
    path = np.array([0, 10, 10 + 10j, 5 + 10j, 5 - 5j, 20 - 5j, 20, 0], complex)
    edges = noded(path[:-1], path[1:], np.zeros(len(path) - 1, int))
    assert edges.nodes[edges.start[1:]] == pytest.approx(edges.nodes[edges.end[:-1]])
    assert np.bincount(edges.wall).tolist() == [2, 1, 1, 2, 1, 1, 3]
    at_crossing = np.flatnonzero(np.abs(edges.nodes[edges.start] - 5) < 1e-9)
    assert len(set(edges.start[at_crossing].tolist())) == 1


def test_noding_finds_what_comparing_all_walls_finds() -> None:
    random = np.random.default_rng(3)
    for count in (30, 300):
        way = random.normal(size=count) + 1j * random.normal(size=count) + 1
        path = np.cumsum(way)
        edges = noded(path[:-1], path[1:], np.zeros(count - 1, int))
        line = shapely.linestrings(path.view(float).reshape(-1, 2))
        lines = shapely.get_parts(shapely.unary_union(line))
        assert len(edges.wall) == np.sum(shapely.get_num_points(lines) - 1)


def test_a_path_that_crosses_itself_again_and_again_is_no_contour() -> None:
    random = np.random.default_rng(1)
    count = 400
    path = random.uniform(-30, 30, count) + 1j * random.uniform(-30, 30, count)
    found = left_standing(chain(*path), chain(*SQUARE, group=1))
    assert found.tangled.tolist() == [True, False]
    assert shapely.area(found.polygon).tolist() == pytest.approx([0, 1600])
    assert count**2 / 8 > CROSSINGS * count + FREE_CROSSINGS
