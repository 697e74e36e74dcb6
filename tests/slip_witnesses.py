"""
What tells without a drawing that a contour is not the one that was meant: the sound one is more regular.

    witness(program, sound, other)      # "closed", "tangent", "regular", "alike", "size", or "" where nothing tells

It is computed from the contours as metal_simulation reads them, before anything is checked.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from itertools import combinations, pairwise
from typing import NamedTuple

from metal_simulation import Outcome, Piece
from setter_programs import Program

_NEAR = 0.02  # [mm]
_TURNED = 0.004  # [rad]


class Side(NamedTuple):
    """A side of an outline: its length, its radius (0 of a line, below 0 of a clockwise arc), the turn behind it."""

    length: float
    radius: float
    turn: float

    def fits(self, other: Side) -> bool:
        apart = abs(self.length - other.length), abs(self.radius - other.radius)
        return max(apart) < _NEAR and abs(self.turn - other.turn) < _TURNED


class Outline(NamedTuple):
    """What a pass leaves: its sides, whether they are closed, and how many arcs meet a neighbour without a tangent."""

    sides: tuple[Side, ...]
    is_closed: bool
    corners: int

    @property
    def regularity(self) -> tuple[int, int]:
        """The order of the symmetry group; how few lengths, radii and turns there are."""
        sides, count = self.sides, len(self.sides)
        # Reversed, a turn stands before its side.
        mirror = tuple(
            one._replace(turn=before.turn) for before, one in zip(sides[-1:] + sides[:-1], sides, strict=True)
        )
        mirror = mirror[::-1]
        starts = range(count) if self.is_closed else (0,)
        turned = [copy[start:] + copy[:start] for copy in (sides, mirror) for start in starts]
        order = sum(all(map(Side.fits, sides, other)) for other in turned)
        kinds = (
            _kinds([side.length for side in sides], _NEAR)
            + _kinds([side.radius for side in sides], _NEAR)
            + _kinds([side.turn for side in sides], _TURNED)
        )
        return order, -kinds

    def is_alike(self, other: Outline) -> bool:
        """Whether both are the same, or parallel."""
        if len(self.sides) != len(other.sides):
            return False
        apart = []
        for before, one, two in zip(self.sides[-1:] + self.sides[:-1], self.sides, other.sides, strict=True):
            share = math.tan(before.turn / 2) + math.tan(one.turn / 2) + (one.length / one.radius if one.radius else 0)
            if abs(one.turn - two.turn) > _TURNED or (abs(share) < 1e-3 and abs(one.length - two.length) > _NEAR):
                return False
            if abs(share) > 1e-3:
                apart.append((two.length - one.length) / share)
        return not apart or max(apart) - min(apart) < 2 * _NEAR


def witness(program: Program, sound: Outcome, other: Outcome) -> str:
    """What of a sound program tells that another one is not it."""
    before, behind = [outline(path) for path in sound.paths], [outline(path) for path in other.paths]
    if len(before) == len(behind):
        for one, two in zip(before, behind, strict=True):
            if one.is_closed and not two.is_closed:
                return "closed"
            if one.corners < two.corners:
                return "tangent"
            if one.regularity > two.regularity:
                return "regular"
    if _alike(before) > _alike(behind):
        return "alike"
    said = any(line.role == "size" for line in program.lines) and program.size
    if said and _has_size(sound, said) and not _has_size(other, said):
        return "size"
    return ""


def outline(path: Sequence[Piece]) -> Outline:
    """The outline of a pass: leads, overlaps and the ends of extensions are cut off."""
    pieces, is_closed = _loop(path)
    pieces = _joined(pieces, is_closed)
    followers = [*pieces[1:], *([pieces[0]] if is_closed else [])]
    turns = [cmath.phase(_ways(two)[0] / _ways(one)[1]) for one, two in zip(pieces, followers, strict=False)]
    turns = [0.0 if abs(abs(turn) - math.pi) < 1e-6 else turn for turn in turns] + [0.0] * (not is_closed)
    pairs = zip(pieces, followers, turns, strict=False)
    corners = sum(abs(turn) > 0.01 for one, two, turn in pairs if one.center is not None or two.center is not None)
    sides = tuple(Side(_length(piece), _radius(piece), turn) for piece, turn in zip(pieces, turns, strict=True))
    return Outline(sides, is_closed, corners)


def _loop(path: Sequence[Piece]) -> tuple[list[Piece], bool]:
    points = [path[0].start, *(piece.end for piece in path)]
    loops = [(j - i, i, j) for i, j in combinations(range(len(points)), 2) if abs(points[i] - points[j]) < _NEAR]
    if loops:
        _, first, behind = max(loops)
        return list(path[first:behind]), True
    one, two = path[0], path[-1]
    if len(path) > 3 and one.center is None and two.center is None:
        u, v, gap = one.end - one.start, two.end - two.start, two.start - one.start
        across = (u.conjugate() * v).imag
        if abs(across) < 1e-3 * abs(u) * abs(v):
            is_overlap = abs((gap.conjugate() * u).imag) < _NEAR * abs(u) and (u.conjugate() * v).real > 0
            if is_overlap and (((two.end - one.start).conjugate() * u).real > 0):
                return [one._replace(start=two.start), *path[1:-1]], True
        else:
            share, part = (gap.conjugate() * v).imag / across, (gap.conjugate() * u).imag / across
            if 0 <= share <= 1 and 0 <= part <= 1:
                corner = one.start + u * share
                return [one._replace(start=corner), *path[1:-1], two._replace(end=corner)], True
    return list(path), False


def _joined(pieces: list[Piece], is_closed: bool) -> list[Piece]:
    """Pieces on one line or circle as one."""
    joined: list[Piece] = []
    for piece in (one for one in pieces if _length(one) > 1e-6):
        if joined and _continues(joined[-1], piece):
            joined[-1] = joined[-1]._replace(end=piece.end)
        else:
            joined.append(piece)
    if is_closed and len(joined) > 1 and _continues(joined[-1], joined[0]):
        joined = [joined[-1]._replace(end=joined[0].end), *joined[1:-1]]
    return joined or pieces[:1]


def _continues(one: Piece, two: Piece) -> bool:
    if (one.center is None) != (two.center is None):
        return False
    if one.center is not None and two.center is not None:
        is_one = abs(one.center - two.center) < _NEAR and one.ccw == two.ccw
        return is_one and abs(abs(_radius(one)) - abs(_radius(two))) < _NEAR
    return abs(cmath.phase(_ways(two)[0] / _ways(one)[1])) < _TURNED


def _ways(piece: Piece) -> tuple[complex, complex]:
    """The directions at start and end."""
    if piece.center is None:
        way = piece.end - piece.start
        way = way / abs(way) if abs(way) > 1e-9 else 1 + 0j
        return way, way
    turn = 1j if piece.ccw else -1j
    one, two = (piece.start - piece.center) * turn, (piece.end - piece.center) * turn
    return one / abs(one), two / abs(two)


def _radius(piece: Piece) -> float:
    if piece.center is None:
        return 0.0
    return abs(piece.start - piece.center) * (1 if piece.ccw else -1)


def _length(piece: Piece) -> float:
    if piece.center is None:
        return abs(piece.end - piece.start)
    sweep = cmath.phase((piece.end - piece.center) / (piece.start - piece.center)) * (1 if piece.ccw else -1)
    sweep %= math.tau
    return abs(_radius(piece)) * (sweep if sweep > 1e-6 else math.tau)


def _kinds(values: list[float], near: float) -> int:
    return 1 + sum(high - low > near for low, high in pairwise(sorted(values)))


def _alike(outlines: list[Outline]) -> int:
    return sum(one.is_alike(two) for one, two in combinations(outlines, 2))


def _has_size(outcome: Outcome, size: float) -> bool:
    """Whether each line of some pass is as far from the center as a comment says."""
    for path in outcome.paths:
        lines = [one for one in _joined(*_loop(path)) if one.center is None]
        apart = [abs((one.start.conjugate() * one.end).imag) / abs(one.end - one.start) for one in lines]
        if apart and min(apart) > size / 2 - _NEAR and sum(abs(2 * one - size) < _NEAR for one in apart) > 1:
            return True
    return False
