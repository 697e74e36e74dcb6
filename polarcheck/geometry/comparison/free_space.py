"""
Fréchet distance of two polylines: how far apart two points must come that run along them, neither of them backwards.

The decision is that of Alt and Godau (1995): a cell for each pair of segments, with the parts of its edges that two
points can reach without ever being farther apart than a bound. Only cells that are reached are visited, which are few
where the bound is small against the polylines.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from polarcheck.foundation.time_limit import keep_time

#: x, c and z of a corner [mm].
Corner = tuple[float, float, float]
Interval = tuple[float, float]
#: Rounding of the arithmetic [mm].
_NOISE = 1e-9
#: Cells between two checks of the time.
_TURN = 1000


class OverBudgetError(Exception):
    """More cells than the caller allows."""


class Budget:
    """
    Cells that may still be visited.

    cells: their number.
    """

    def __init__(self, cells: int) -> None:
        self.cells = cells

    def spend(self) -> None:
        """Count a cell. Raises OverBudgetError if none is left."""
        self.cells -= 1
        if self.cells < 0:
            raise OverBudgetError
        if self.cells % _TURN == 0:
            keep_time()


class Meeting(NamedTuple):
    """
    Two points, one on each polyline.

    old, new: the points. in_old, in_new: the segments that they lie on.
    """

    old: Corner
    new: Corner
    in_old: int
    in_new: int

    @property
    def distance(self) -> float:
        """The distance of the two points [mm]."""
        return math.dist(self.old, self.new)


class Edge(NamedTuple):
    """An edge of a cell: a corner of the old line against a segment of the new one, or the other way round."""

    is_old: bool
    corner: int
    segment: int


#: Per reached edge the edge from which it was reached, None at the start, and its reached part.
Reached = dict[Edge, tuple[Edge | None, Interval]]


def frechet(
    old: Sequence[Corner], new: Sequence[Corner], upper: float, precision: float, budget: Budget, lower: float = 0.0
) -> tuple[float, Meeting]:
    """
    Return the Fréchet distance of two polylines [mm], and where two points have to be so far apart.

    upper: a distance that is known to suffice [mm]. lower: one that it certainly reaches, but for rounding [mm].
    precision: the result is at most this much above the distance [mm].
    Raises OverBudgetError.
    """
    at_start = Meeting(old[0], new[0], 0, 0)
    at_end = Meeting(old[-1], new[-1], max(len(old) - 2, 0), max(len(new) - 2, 0))
    farther = max(at_start, at_end, key=lambda meeting: meeting.distance)
    low, high = farther.distance, upper
    lower -= 2 * _NOISE
    if low >= lower and is_within(old, new, low, budget):
        return low, farther
    while high - low > precision:
        middle = (low + high) / 2
        if middle >= lower and is_within(old, new, middle, budget):
            high = middle
        else:
            low = middle
    reached: Reached = {}
    is_within(old, new, high, budget, reached)
    meetings = (at_start, *reversed(_narrowest(old, new, reached)), at_end)
    farthest = max(meeting.distance for meeting in meetings)
    return high, next(meeting for meeting in meetings if meeting.distance >= farthest - 2 * precision)


def _narrowest(old: Sequence[Corner], new: Sequence[Corner], reached: Reached) -> Sequence[Meeting]:
    """The least distance of the two points at each edge that they cross on their run to the ends of the lines."""
    meetings = []
    last = Edge(True, len(old) - 1, len(new) - 2), Edge(False, len(new) - 1, len(old) - 2)
    edge: Edge | None = next((edge for edge in last if edge in reached), None)
    while edge is not None:
        before, (low, high) = reached[edge]
        corner, line = (old[edge.corner], new) if edge.is_old else (new[edge.corner], old)
        start, end = line[edge.segment], line[edge.segment + 1]
        vector = [b - a for a, b in zip(start, end, strict=True)]
        length = sum(part * part for part in vector)
        along = sum((p - a) * part for p, a, part in zip(corner, start, vector, strict=True))
        # While one point waits at its start, the other one runs as far as the start of the segment.
        share = min(max(along / length if length else 0.0, low), high) if edge.corner else 0.0
        x, c, z = (a + share * part for a, part in zip(start, vector, strict=True))
        of_corner = max(edge.corner - 1, 0)
        # A corner belongs to the segment that ends there.
        on_line = edge.segment - 1 if share == 0 and edge.segment else edge.segment
        if edge.is_old:
            meetings.append(Meeting(corner, (x, c, z), of_corner, on_line))
        else:
            meetings.append(Meeting((x, c, z), corner, on_line, of_corner))
        edge = before
    return meetings


def is_within(
    old: Sequence[Corner], new: Sequence[Corner], bound: float, budget: Budget, reached: Reached | None = None
) -> bool:
    """
    Return True if two points can run along the polylines without being farther apart than a bound [mm].

    reached: is filled with the edges that they reach. Raises OverBudgetError.
    """
    bound += _NOISE
    square = bound * bound
    rows, columns = len(old) - 1, len(new) - 1
    if math.dist(old[0], new[0]) > bound or math.dist(old[-1], new[-1]) > bound:
        return False
    if not rows or not columns:
        return all(math.dist(a, b) <= bound for a in old for b in new)
    # The reachable parts of the edges of a corner of old against the segments of new.
    left = _while_one_waits(old[0], new, square)
    bottom = _while_one_waits(new[0], old, square)
    if reached is not None:
        reached |= {**_from_start(True, left), **_from_start(False, bottom)}
    row, below = 0, None
    for row in range(rows):
        following: dict[int, Interval] = {}
        waiting = sorted(left, reverse=True)
        below = bottom.get(row)
        column = 0 if below is not None else waiting[-1] if waiting else columns
        while column < columns:
            budget.spend()
            if waiting and waiting[-1] == column:
                waiting.pop()
            entry = left.get(column)
            right = _exit(old[row + 1], new[column], new[column + 1], square, below is not None, entry)
            above = _exit(new[column + 1], old[row], old[row + 1], square, entry is not None, below)
            if right is not None:
                following[column] = right
                if reached is not None:
                    came = Edge(False, column, row) if below is not None else Edge(True, row, column)
                    reached[Edge(True, row + 1, column)] = came, right
            if above is not None and reached is not None:
                came = Edge(True, row, column) if entry is not None else Edge(False, column, row)
                reached[Edge(False, column + 1, row)] = came, above
            below = above
            column += 1
            if below is None:
                column = waiting[-1] if waiting else columns
        left = following
        if not left and below is None and row + 1 not in bottom:
            break
    # The ends are within the bound: what is free of an edge that ends there lasts up to its end.
    return row == rows - 1 and (columns - 1 in left or below is not None)


def _from_start(is_old: bool, edges: dict[int, Interval]) -> Reached:
    return {
        Edge(is_old, 0, segment): (Edge(is_old, 0, segment - 1) if segment else None, interval)
        for segment, interval in edges.items()
    }


def _while_one_waits(corner: Corner, line: Sequence[Corner], square: float) -> dict[int, Interval]:
    """The edges that are reached while one point waits at its start and the other runs."""
    edges: dict[int, Interval] = {}
    for index in range(len(line) - 1):
        free = _free(corner, line[index], line[index + 1], square)
        if free is None or free[0] > 0:
            break
        edges[index] = free
        if free[1] < 1:
            break
    return edges


def _exit(
    corner: Corner, start: Corner, end: Corner, square: float, is_open: bool, entry: Interval | None
) -> Interval | None:
    """The reachable part of an edge: all that is free where the cell is entered from across, else from the entry on."""
    if not is_open and entry is None:
        return None
    free = _free(corner, start, end, square)
    if free is None or is_open or entry is None:
        return free
    low = max(free[0], entry[0])
    return (low, free[1]) if low <= free[1] else None


def _free(corner: Corner, start: Corner, end: Corner, square: float) -> Interval | None:
    """The part of a segment, from 0 to 1, within a distance of a corner; square: of that distance."""
    x, c, z = start[0] - corner[0], start[1] - corner[1], start[2] - corner[2]
    along_x, along_c, along_z = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    length = along_x * along_x + along_c * along_c + along_z * along_z
    beyond = x * x + c * c + z * z - square
    if length == 0:
        return (0.0, 1.0) if beyond <= 0 else None
    half = x * along_x + c * along_c + z * along_z
    root = half * half - length * beyond
    if root < 0:
        return None
    reach = math.sqrt(root)
    low, high = (-half - reach) / length, (-half + reach) / length
    if high < 0 or low > 1:
        return None
    x, c, z = x + along_x, c + along_c, z + along_z
    is_end_free = x * x + c * c + z * z <= square
    return 0.0 if beyond <= 0 else max(low, 0.0), 1.0 if is_end_free else min(high, 1.0)
