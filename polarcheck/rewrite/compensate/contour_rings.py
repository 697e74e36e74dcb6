"""Finds closed contours in a run of moves: stretches of a path that return to their start, between leads in and out."""

from __future__ import annotations

import cmath
import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence

import msgspec

from polarcheck.foundation.time_limit import keep_time
from polarcheck.rewrite.compensate.pieces import Piece

#: The most moves of a lead: a smaller ring is looked for after dropping up to this many moves at the start or end of a
#: ring; and a ring may start in the middle of a move only this close after the previous ring.
_LEADS = 8
#: The least share of the length of a ring that remains without its leads.
_MOST_OF = 0.5
#: A ring encloses more than this share of the square of its length.
_FLAT = 1e-6
#: Directions that differ by no more are equal [rad].
_SAME_WAY = 0.02


class Ring(msgspec.Struct, frozen=True):
    """
    A closed stretch of moves.

    first, last: numbers of its moves in the run, both included.
    aside: 0 if the path itself closes; otherwise the distance to the left of the parallel that closes [mm].
    area: the enclosed area, above 0 counterclockwise [mm2]; the sum of several turns.
    """

    first: int
    last: int
    aside: float
    area: float


def rings_of(path: Sequence[Piece], radius: float, tolerance: float) -> list[Ring]:
    """
    Return the rings in a run of connected pieces, in order.

    radius: R of the cutter [mm]. Where a contour starts at a corner, the path at R beside it does not close, but its
    parallel does.
    tolerance: points nearer than this are equal [mm].
    """
    search = _Search(path, radius, tolerance)
    result: list[Ring] = []
    index = lead_start = 0
    while index < len(path):
        keep_time()
        ring = search.ring_from(index, index - lead_start <= _LEADS)
        if ring is None:
            index += 1
            continue
        if not (result and search.comes_back(result[-1], ring)):
            result.append(ring)
        index = lead_start = ring.last + 1
    return result


class _Search:
    """Finds rings in a run of pieces."""

    def __init__(self, path: Sequence[Piece], radius: float, tolerance: float) -> None:
        self.path, self.tolerance = path, tolerance
        self.length, self.area = [0.0], [0.0]
        for piece in path:
            self.length.append(self.length[-1] + piece.length)
            self.area.append(self.area[-1] + _area(piece, path[0].start))
        self.offsets = (0.0, radius, -radius)
        self.starts = [[piece.start + 1j * aside * piece.leaving for piece in path] for aside in self.offsets]
        self.ends = [[piece.end + 1j * aside * piece.arriving for piece in path] for aside in self.offsets]
        self.ending: list[dict[tuple[int, int], list[int]]] = []
        #: False where an arc is too small for a parallel.
        self.is_there = [[piece.radius - piece.turning * aside > tolerance for piece in path] for aside in self.offsets]
        for ends, is_there in zip(self.ends, self.is_there, strict=True):
            cells: dict[tuple[int, int], list[int]] = {}
            for number, end in enumerate(ends):
                if is_there[number]:
                    cells.setdefault(self._cell(end), []).append(number)
            self.ending.append(cells)

    def _cell(self, point: complex) -> tuple[int, int]:
        size = 4 * self.tolerance
        return math.floor(point.real / size), math.floor(point.imag / size)

    def ring_from(self, first: int, may_overlap: bool) -> Ring | None:
        """
        Return the ring that starts with a piece; None if there is none. may_overlap: it may start within its last
        piece.
        """
        ring = self._closed(first, len(self.path) - 1)
        ring = ring or (self._overlapping(first) if may_overlap else None)
        if ring is None or self._has_leads(ring):
            return None
        return self._with_overlap(ring)

    def comes_back(self, before: Ring, ring: Ring) -> bool:
        """Return True for a short loop right after a ring: out, and back for another pass."""
        lengths = [self.length[stretch.last + 1] - self.length[stretch.first] for stretch in (before, ring)]
        return ring.first == before.last + 1 and lengths[1] < _MOST_OF * lengths[0]

    def _closed(self, first: int, most: int) -> Ring | None:
        """
        Return the shortest ring from the start of a piece up to another piece, on the path or on one of its parallels.
        """
        rings = (self._closed_parallel(which, first, most) for which in range(len(self.offsets)))
        return min((ring for ring in rings if ring is not None), key=lambda ring: ring.last, default=None)

    def _closed_parallel(self, which: int, first: int, most: int) -> Ring | None:
        if not self.is_there[which][first]:
            return None
        start = self.starts[which][first]
        x, y = self._cell(start)
        cells = [self.ending[which].get((x + i, y + j), []) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        near = (numbers[bisect_left(numbers, first) : bisect_right(numbers, most)] for numbers in cells)
        for number in sorted(number for numbers in near for number in numbers):
            if abs(self.ends[which][number] - start) <= self.tolerance:
                ring = self._ring(first, number, self.offsets[which])
                if ring is not None:
                    return ring
        return None

    def _ring(self, first: int, last: int, aside: float) -> Ring | None:
        closing = Piece(self.path[last].end, self.path[first].start)
        area = self.area[last + 1] - self.area[first] + _area(closing, self.path[0].start)
        length = self.length[last + 1] - self.length[first]
        return Ring(first, last, aside, area) if abs(area) > _FLAT * length**2 else None

    def _overlapping(self, first: int) -> Ring | None:
        """Return a ring that starts in the middle of its last piece and ends along its first one."""
        start, along = self.path[first].start, self.path[first].leaving
        for last in range(len(self.path) - 1, first, -1):
            piece = self.path[last]
            if piece.center is not None:
                spoke = start - piece.center
                if not (spoke and piece.sweep) or abs(abs(spoke) - piece.radius) > self.tolerance:
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
        """Return True if the contours are smaller rings within this one, and its remaining moves are leads."""
        return any(self._leads_to_rings(ring, first) for first in range(ring.first + 1, ring.first + _LEADS + 1))

    def _leads_to_rings(self, ring: Ring, first: int) -> bool:
        """
        Return True if from this move on rings follow one another, and no other move of the ring repeats a move of
        theirs.
        """
        inner: list[Ring] = []
        index = lead_start = first
        # A ring that closes where the whole does is one only if the moves before it close as well.
        apart = abs(self.path[min(first, ring.last)].start - self.path[ring.first].start)
        most = ring.last - (ring.aside == 0 and apart > self.tolerance)
        while index <= most and (inner or index == first) and index - lead_start <= _LEADS:
            hit = self._closed(index, most)
            if hit is not None:
                inner.append(hit)
                lead_start = hit.last + 1
            index = index + 1 if hit is None else lead_start
        if ring.last + 1 - lead_start > _LEADS:
            return False
        length = sum(self.length[hit.last + 1] - self.length[hit.first] for hit in inner)
        if length < _MOST_OF * (self.length[ring.last + 1] - self.length[ring.first]):
            return False
        within = {number for hit in inner for number in range(hit.first, hit.last + 1)}
        keys = {_key(self.path[number], self.tolerance) for number in within}
        leads = (number for number in range(ring.first, ring.last + 1) if number not in within)
        return all(_key(self.path[number], self.tolerance) not in keys for number in leads)

    def _with_overlap(self, ring: Ring) -> Ring:
        """Return the ring with the moves after it that run along its first moves again."""
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


def _same_center(first: Piece, second: Piece, tolerance: float) -> bool:
    """Return True for two lines, or two arcs with the same center."""
    if first.center is None or second.center is None:
        return first.center is second.center
    return abs(first.center - second.center) <= tolerance


def _angle(arc: Piece, point: complex) -> float:
    """Return the angle from the start of an arc to a point on its circle, in the direction of the arc [rad]."""
    center = 0j if arc.center is None else arc.center
    return (arc.turning * cmath.phase((arc.start - center).conjugate() * (point - center))) % math.tau


def _area(piece: Piece, origin: complex) -> float:
    """Return the signed area between a piece and a point [mm2]."""
    start, end = piece.start - origin, piece.end - origin
    area = (start.conjugate() * end).imag / 2
    if piece.center is None:
        return area
    return area + piece.turning * piece.radius**2 / 2 * (piece.sweep - math.sin(piece.sweep))


def _key(piece: Piece, tolerance: float) -> tuple[int, ...]:
    """Return a grid cell that equal pieces usually share; pieces on both sides of a cell border get different ones."""
    size = 4 * tolerance
    points = (piece.start, piece.end, piece.at(0.5))
    return tuple(round(value / size) for point in points for value in (point.real, point.imag))
