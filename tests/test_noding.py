"""Walls that turn back over themselves: crossings between neighbours in a row, counted by hand."""

from __future__ import annotations

import numpy as np
from cases import looped

from polarcheck.geometry.polygons.noding import noded
from polarcheck.geometry.tolerances import CROSSINGS, FREE_CROSSINGS


def way(*moves: tuple[float, float]) -> np.ndarray:
    """The points of a path from 0: by how much each wall turns [deg], how long it is."""
    turns, lengths = np.array(moves).T
    return np.append(0, np.cumsum(lengths * np.exp(1j * np.radians(np.cumsum(turns)))))


@looped("turn", [1, 1j, np.exp(2.1j)])
@looped("mirrored", [False, True])
@looped(
    ("moves", "crossing"),
    [
        # Bent by 40 degrees, then back by 150: over the first wall, or short of it.
        ([(0, 10), (40, 3), (150, 20)], (0, 2)),
        ([(0, 10), (40, 3), (150, 8)], None),
        ([(0, 10), (40, 3), (130, 20)], None),
        # The same in the middle of a longer way.
        ([(0, 5), (20, 5), (-20, 10), (40, 3), (150, 12)], (2, 4)),
        ([(10, 10), (20, 2), (20, 2), (150, 25)], (0, 3)),
    ],
)
def test_a_way_that_turns_back_crosses_what_comes_just_before(
    moves: list[tuple[float, float]], crossing: tuple[int, int] | None, mirrored: bool, turn: complex
) -> None:
    points = turn * (way(*moves).conj() if mirrored else way(*moves))
    edges = noded(points[:-1], points[1:], np.zeros(len(moves), np.int64))
    parts = [1 + (wall in (crossing or ())) for wall in range(len(moves))]
    assert np.bincount(edges.wall, minlength=len(moves)).tolist() == parts
    assert not edges.tangled.any()


def grid(count: int, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """So many walls across as many others: start and end."""
    at = np.arange(count) + 0.5 + shift
    across = np.concatenate([at + 0j, shift + 1j * (at - shift)])
    return across, np.concatenate([at + 1j * count, shift + count + 1j * (at - shift)])


def test_crossings_are_counted_for_each_group_of_its_own() -> None:
    """n by n walls cross in n * n points: allowed are some for each wall and some beyond."""
    most = int(CROSSINGS + np.sqrt(CROSSINGS**2 + FREE_CROSSINGS))
    for count in (most - 1, most + 2):
        few, many = grid(9, 0.0), grid(count, 1000.0)
        start, end = (np.concatenate(ends) for ends in zip(few, many, strict=True))
        edges = noded(start, end, np.repeat([0, 1], [18, 2 * count]))
        assert edges.tangled.tolist() == [False, count**2 > CROSSINGS * 2 * count + FREE_CROSSINGS]
        assert np.count_nonzero(edges.wall < 18) == 18 * 10
        assert edges.tangled[1] == (count > most)
