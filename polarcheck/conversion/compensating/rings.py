"""Contours in a run of moves: stretches of a path that come back to where they began, beside ways in and out."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import msgspec

from polarcheck.conversion.compensating.pieces import Piece

#: Moves behind the beginning of a ring, or before its end, within which a ring without them is looked for; and moves
#: behind the one before, from whose middle a ring may begin.
_LEADS = 8
#: The share of the way of a ring that one without its first and last moves must have.
_MOST_OF = 0.5
#: A ring encloses more than this share of the square of its way.
_FLAT = 1e-6
#: Directions that differ by less are one [rad].
_SAME_WAY = 0.02


class Ring(msgspec.Struct, frozen=True):
    """
    A stretch of moves that closes.

    first, last: numbers of moves in the run, both included. aside: 0 where the path itself closes; else that its
    parallel at this distance to the left does [mm]. area: enclosed, above 0 counterclockwise [mm2]; of several turns
    their sum.
    """

    first: int
    last: int
    aside: float
    area: float


def rings_of(path: Sequence[Piece], radius: float, tolerance: float) -> list[Ring]:
    """
    Return the rings of a run of pieces that join, in order.

    radius: R of the cutter [mm]: where a contour begins and ends at a corner, paths with R beside it do not close.
    tolerance: points nearer than this are one [mm].
    """
    search = _Search(path, radius, tolerance)
    result: list[Ring] = []
    at = behind = 0
    while at < len(path):
        ring = search.ring_from(at, at - behind <= _LEADS)
        if ring is None:
            at += 1
            continue
        result.append(ring)
        at = behind = ring.last + 1
    return result


class _Search:
    """Looks for rings in a run of pieces."""

    def __init__(self, path: Sequence[Piece], radius: float, tolerance: float) -> None:
        self.path, self.tolerance = path, tolerance
        self.length, self.area = [0.0], [0.0]
        for piece in path:
            self.length.append(self.length[-1] + piece.length)
            self.area.append(self.area[-1] + _area(piece, path[0].start))
        self.asides = (0.0, radius, -radius)
        self.starts = [[piece.start + 1j * aside * piece.leaving for piece in path] for aside in self.asides]
        self.ends = [[piece.end + 1j * aside * piece.arriving for piece in path] for aside in self.asides]
        self.ending: list[dict[tuple[int, int], list[int]]] = []
        for ends in self.ends:
            cells: dict[tuple[int, int], list[int]] = {}
            for number, end in enumerate(ends):
                cells.setdefault(self._cell(end), []).append(number)
            self.ending.append(cells)

    def _cell(self, point: complex) -> tuple[int, int]:
        size = 4 * self.tolerance
        return math.floor(point.real / size), math.floor(point.imag / size)

    def ring_from(self, first: int, may_overlap: bool) -> Ring | None:
        """The ring that begins with a piece; None where none does. may_overlap: it may begin within its last piece."""
        found = [ring for which in range(3) if (ring := self._closed(which, first)) is not None]
        ring = max(found, key=lambda ring: (ring.last, ring.aside == 0), default=None)
        ring = ring or (self._overlapping(first) if may_overlap else None)
        if ring is None or self._has_leads(ring):
            return None
        return self._with_overlap(ring)

    def _closed(self, which: int, first: int) -> Ring | None:
        """The longest ring from the start of a piece, of the path or of one of its parallels."""
        start = self.starts[which][first]
        x, y = self._cell(start)
        last = -1
        for cell in ((x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)):
            for number in reversed(self.ending[which].get(cell, [])):
                if number <= last or number < first:
                    break
                if abs(self.ends[which][number] - start) <= self.tolerance:
                    last = number
                    break
        return self._ring(first, last, self.asides[which]) if last >= first else None

    def _ring(self, first: int, last: int, aside: float) -> Ring | None:
        closing = Piece(self.path[last].end, self.path[first].start)
        area = self.area[last + 1] - self.area[first] + _area(closing, self.path[0].start)
        length = self.length[last + 1] - self.length[first]
        return Ring(first, last, aside, area) if abs(area) > _FLAT * length**2 else None

    def _overlapping(self, first: int) -> Ring | None:
        """A ring whose end runs on along its first piece, from the middle of which it has begun."""
        start, along = self.path[first].start, self.path[first].leaving
        for last in range(len(self.path) - 1, first, -1):
            piece = self.path[last]
            if piece.center is not None:
                spoke = start - piece.center
                if abs(abs(spoke) - piece.radius) > self.tolerance:
                    continue
                share = _angle(piece, start) / piece.sweep
                tangent = 1j * piece.turning * spoke / abs(spoke)
            else:
                share = ((start - piece.start) * piece.leaving.conjugate()).real / (piece.length or 1.0)
                tangent = piece.leaving
            if not 0 < share < 1 or abs(piece.at(share) - start) > self.tolerance:
                continue
            if abs(tangent - along) <= _SAME_WAY:
                return self._ring(first, last, 0.0)
        return None

    def _has_leads(self, ring: Ring) -> bool:
        """A ring without its first and its last moves, which are not run again within it, is the contour."""
        whole = self.length[ring.last + 1] - self.length[ring.first]
        for first in range(ring.first + 1, min(ring.first + _LEADS, ring.last) + 1):
            inner = [found for which in range(3) if (found := self._closed(which, first)) is not None]
            for each in inner:
                if not max(ring.last - _LEADS, first) <= each.last <= ring.last - (ring.aside == 0):
                    continue
                inside = self.length[each.last + 1] - self.length[first]
                rest = {_key(piece, self.tolerance) for piece in self.path[first : each.last + 1]}
                leads = [*self.path[ring.first : first], *self.path[each.last + 1 : ring.last + 1]]
                if inside >= _MOST_OF * whole and all(_key(piece, self.tolerance) not in rest for piece in leads):
                    return True
        return False

    def _with_overlap(self, ring: Ring) -> Ring:
        """The ring with the moves behind it that run along its first ones again."""
        first, last = ring.first, ring.last
        while last + 1 < len(self.path) and first < ring.last:
            piece, again = self.path[first], self.path[last + 1]
            if ring.aside or again.turning != piece.turning or abs(again.start - piece.start) > self.tolerance:
                break
            if abs(again.leaving - piece.leaving) > _SAME_WAY or again.length > piece.length + self.tolerance:
                break
            if not _same_center(again, piece, 2 * self.tolerance):
                break
            last += 1
            if again.length < piece.length - self.tolerance:
                break
            first += 1
        return msgspec.structs.replace(ring, last=last)


def _same_center(one: Piece, other: Piece, tolerance: float) -> bool:
    """Two lines, or two arcs about one center."""
    if one.center is None or other.center is None:
        return one.center is other.center
    return abs(one.center - other.center) <= tolerance


def _angle(arc: Piece, point: complex) -> float:
    """The angle from the start of an arc to a point of its circle as it turns [rad]."""
    center = 0j if arc.center is None else arc.center
    return (arc.turning * cmath.phase((point - center) / (arc.start - center))) % math.tau


def _area(piece: Piece, origin: complex) -> float:
    """The signed area between a piece and a point [mm2]."""
    start, end = piece.start - origin, piece.end - origin
    area = (start.conjugate() * end).imag / 2
    if piece.center is None:
        return area
    return area + piece.turning * piece.radius**2 / 2 * (piece.sweep - math.sin(piece.sweep))


def _key(piece: Piece, tolerance: float) -> tuple[int, ...]:
    """The same for pieces that run along one way, forward."""
    size = 4 * tolerance
    points = (piece.start, piece.end, piece.at(0.5))
    return tuple(round(value / size) for point in points for value in (point.real, point.imag))
