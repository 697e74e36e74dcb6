"""The contour beside a path of the tool center: hand formulas for paths whose part is known."""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Callable, Sequence

import pytest
from cases import looped

from polarcheck.rewrite.compensate.parallel import NoContourError, contour_beside
from polarcheck.rewrite.compensate.pieces import Piece

R = 4.0
#: Corners of a part, counterclockwise, with the tool outside; no two sides are alike, one corner is acute.
PART = [15 - 9j, 21 + 14j, -3 + 11j, -12 - 10j]


def lines(points: Sequence[complex]) -> list[Piece]:
    """Straight moves from point to point."""
    return [Piece(*pair, move=number) for number, pair in enumerate(itertools.pairwise(points))]


def normals() -> list[complex]:
    """Outward unit normals of the sides, from each corner to the next."""
    return [-1j * (other - one) / abs(other - one) for one, other in zip(PART, [*PART[1:], PART[0]], strict=True)]


def miters(part: Sequence[complex]) -> list[Piece]:
    """Lines that meet at R from both sides of each corner."""
    corners = []
    for corner, before, after in zip(part, [normals()[-1], *normals()[:-1]], normals(), strict=True):
        corners.append(corner + R * (before + after) / (1 + (before * after.conjugate()).real))
    middle = (part[0] + part[-1]) / 2 + R * normals()[-1]
    return lines([middle, *corners, middle])


def round_corners(part: Sequence[complex], chords: int = 0) -> list[Piece]:
    """Arcs with R about each corner, or chords in their place."""
    path: list[Piece] = []
    middle = (part[0] + part[-1]) / 2 + R * normals()[-1]
    at = middle
    for corner, before, after in zip(part, [normals()[-1], *normals()[:-1]], normals(), strict=True):
        path.append(Piece(at, corner + R * before))
        at = corner + R * after
        if chords:
            turn = cmath.phase(after / before) / chords
            outside = R * before / math.cos(turn / 2) * cmath.exp(-0.5j * turn)
            points = [corner + outside * cmath.exp(1j * turn * each) for each in range(1, chords + 1)]
            path += lines([corner + R * before, *points, at])
        else:
            path.append(Piece(corner + R * before, at, corner, 1))
    return [*path, Piece(at, middle)]


def square_corners(part: Sequence[complex]) -> list[Piece]:
    """As the control goes round an acute corner: R on along each side, and across."""
    points = [(part[0] + part[-1]) / 2 + R * normals()[-1]]
    for corner, before, after in zip(part, [normals()[-1], *normals()[:-1]], normals(), strict=True):
        cosine = (before * after.conjugate()).real
        if cosine >= 0:
            points.append(corner + R * (before + after) / (1 + cosine))
        else:
            points += [corner + R * (before + 1j * before), corner + R * (after - 1j * after)]
    return lines([*points, points[0]])


@looped(
    "path",
    [miters, round_corners, square_corners, lambda part: round_corners(part, 7), lambda part: round_corners(part, 90)],
    ids=["miters", "arcs", "across", "chords", "many chords"],
)
def test_corners_of_a_part(path: Callable[[Sequence[complex]], list[Piece]]) -> None:
    contour = contour_beside(path(PART), R)
    middle = (PART[0] + PART[-1]) / 2
    assert contour[0].start == pytest.approx(middle)
    assert [piece.end for piece in contour] == pytest.approx([*PART, middle], abs=1e-3)


def test_pocket_with_sharp_corners() -> None:
    """Inside corners are those of the drawing, where the tool leaves its own radius."""
    contour = contour_beside(lines([10, 10 + 10j, -10 + 10j, -10 - 10j, 10 - 10j, 10 + 0j]), -R)
    assert [piece.end for piece in contour] == pytest.approx([14 + 14j, -14 + 14j, -14 - 14j, 14 - 14j, 14])


@looped("aside", [3.0, -3.0, -8.0])
def test_arcs_change_their_radius(aside: float) -> None:
    """A slot: half circles and their tangents, counterclockwise; the part within, or around."""
    path = [Piece(10 - 6j, 10 + 6j, 10 + 0j, 1), Piece(10 + 6j, -10 + 6j)]
    path += [Piece(-10 + 6j, -10 - 6j, -10 + 0j, 1), Piece(-10 - 6j, 10 - 6j)]
    radius = 6 - aside
    contour = contour_beside(path, aside)
    assert [piece.radius for piece in contour] == pytest.approx([radius, math.inf, radius, math.inf])
    assert contour[1].end == pytest.approx(-10 + 1j * radius)


def test_line_and_arc_meet() -> None:
    """A D-shaft: where the flat meets the round, the circles of part and path are about one center."""
    part, path = 20.0, 24.0
    flat = Piece(12 + 4 - 1j * math.sqrt(path**2 - 16**2), 16 + 1j * math.sqrt(path**2 - 16**2))
    contour = contour_beside([flat, Piece(flat.end, flat.start, 0j, 1)], R)
    assert contour[0].end == pytest.approx(12 + 1j * math.sqrt(part**2 - 12**2))
    assert contour[1].radius == pytest.approx(part)


def test_full_circle() -> None:
    contour = contour_beside([Piece(14, 14, 0j, 1)], R)
    assert contour == [Piece(10, 10, 0j, 1)]


def test_nothing_within_a_small_circle() -> None:
    with pytest.raises(NoContourError):
        contour_beside([Piece(3, 3, 0j, 1)], R)
