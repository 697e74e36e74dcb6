"""
Lines that close contours whose ends lie beside their start, or beside walls that they follow; lengths in mm.

Such a line bounds no part by itself: it only lets the faces on both sides of it be told apart.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, first_in_run, ranges
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.contour_ends import CLOSED
from polarcheck.geometry.polygons.faces import Walls
from polarcheck.geometry.tolerances import TOUCH

#: Pairs of ends and walls to compare at a time.
_PAIRS = 1_000_000
#: A contour ends beside its start where that is nearer than this share of its length, and runs on in the direction of
#: its start where it turns by no more than this [rad].
_BESIDE, _STRAIGHT = 0.025, 0.35
#: The extended walls of a corner meet nearer to its ends than this multiple of their distance.
_MEETING = 3


class LoopEnds(Table, frozen=True):
    """
    The ends of loops, n of them.

    start, end: complex128[n] [mm]. begin, way: complex128[n], unit directions there.
    is_straight: bool[n], the loop begins and ends with a line.
    total: float64[n] [mm], its length. radius: float64[n] [mm], R, 0 if unknown. group: int[n].
    """

    start: Points
    end: Points
    begin: Points
    way: Points
    is_straight: Mask
    total: Floats
    radius: Floats
    group: Rows

    @property
    def limit(self) -> Floats:
        """Greatest distance beside its start at which a contour ends and is still closed [mm]."""
        return np.minimum(_BESIDE * self.total, np.where(self.radius > 0, self.radius, np.inf))


def lines_between(start: Points, end: Points, group: Rows) -> Walls:
    """Lines that are no walls."""
    neither = np.zeros(len(start), bool)
    return Walls(start, end, neither, neither, neither, group)


# ---- ends that rounding has moved off the wall that they follow ----


def joined_to_walls(loops: LoopEnds, walls: Walls) -> Walls:
    """Lines from the ends of loops to the walls of their group beside them, nearer than points are rounded to."""
    ends, group = np.append(loops.start, loops.end), np.tile(loops.group, 2)
    end, wall = _candidates(ends, walls)
    foot = _foot(ends[end], walls, wall)
    distance = np.abs(ends[end] - foot)
    joins = (distance > TOUCH / 10) & (distance <= CLOSED)
    return lines_between(ends[end[joins]], foot[joins], group[end[joins]])


def _foot(point: Points, walls: Walls, wall: Rows) -> Points:
    """The nearest point of a wall, for each point."""
    begin, vector = walls.start[wall], walls.end[wall] - walls.start[wall]
    length = np.maximum(np.abs(vector), TOUCH)
    along = ((point - begin) * vector.conj()).real / length
    return np.asarray(begin + vector * np.clip(along, 0, length) / length)


def _candidates(ends: Points, walls: Walls) -> tuple[Rows, Rows]:
    """Ends of loops and walls whose boxes are no farther apart than CLOSED, as pairs of their numbers."""
    order = np.argsort(ends.real, kind="stable")
    across = ends.real[order]
    low, high = np.minimum(walls.start.real, walls.end.real), np.maximum(walls.start.real, walls.end.real)
    first, until = np.searchsorted(across, low - CLOSED), np.searchsorted(across, high + CLOSED, side="right")
    total = np.cumsum(until - first)
    pairs: list[tuple[Rows, Rows]] = [(np.zeros(0, np.int64), np.zeros(0, np.int64))]
    begins = 0
    while begins < len(total):
        keep_time()
        before = total[begins - 1] if begins else 0
        stop = max(int(np.searchsorted(total, before + _PAIRS)), begins + 1)
        count = (until - first)[begins:stop]
        wall, index = ranges(count)
        wall += begins
        end = order[first[wall] + index]
        c, a, b = ends[end].imag, walls.start[wall].imag, walls.end[wall].imag
        near = (c >= np.minimum(a, b) - CLOSED) & (c <= np.maximum(a, b) + CLOSED)
        pairs.append((end[near], wall[near]))
        begins = stop
    end, wall = (np.concatenate(column) for column in zip(*pairs, strict=True))
    return end, wall


# ---- ends beside their start ----


def closed_beside(loops: LoopEnds, walls: Walls, loop: Rows, along: Floats) -> tuple[Walls, Floats]:
    """
    Lines that close contours which end a little beside their start; for each line how far beside, or how far either
    end is from the corner [mm].

    loop, along: the loop of each wall, and how far behind the start of that it begins [mm].
    At a corner the walls are extended to where they meet; along a wall its end is joined to what lies beside it. The
    walls of a blade lie as near to each other, but run against each other.
    """
    gap = loops.start - loops.end
    length = np.abs(gap)
    turn = np.abs(np.angle(loops.begin * loops.way.conj()))
    is_near = (length > CLOSED) & (length <= loops.limit)
    is_corner, meet, reach = _corners(loops, turn)
    is_corner &= is_near
    runs_on = (turn <= _STRAIGHT) & (np.abs((gap * loops.way.conj()).imag) > CLOSED)
    is_step = is_near & ~is_corner & (runs_on | (~loops.is_straight & (turn < np.pi - _STRAIGHT)))
    chosen = [np.flatnonzero(is_corner), np.flatnonzero(is_corner), np.flatnonzero(is_step)]
    lines = [
        lines_between(start[rows], end[rows], loops.group[rows])
        for start, end, rows in zip((loops.end, meet, loops.end), (meet, loops.start, loops.start), chosen, strict=True)
    ]
    sizes = [size[rows] for size, rows in zip((reach, reach, length), chosen, strict=True)]
    remaining = ~is_corner & ~is_step
    for point, heading, is_far in (
        (loops.end, loops.way, 2 * along < loops.total[loop]),
        (loops.start, loops.begin, 2 * along > loops.total[loop]),
    ):
        wall = np.flatnonzero(is_far & remaining[loop])
        foot = _foot(point[loop[wall]], walls, wall)
        distance = np.abs(foot - point[loop[wall]])
        direction = walls.end[wall] - walls.start[wall]
        is_beside = (direction * heading[loop[wall]].conj()).real > np.cos(_STRAIGHT) * np.abs(direction)
        is_beside &= (distance <= loops.limit[loop[wall]]) & (distance > CLOSED)
        wall, foot, distance = wall[is_beside], foot[is_beside], distance[is_beside]
        order = np.lexsort((distance, loop[wall]))
        nearest = order[first_in_run(loop[wall][order])]
        of = loop[wall[nearest]]
        lines.append(lines_between(point[of], foot[nearest], loops.group[of]))
        sizes.append(distance[nearest])
    return Walls.concatenated(lines), np.concatenate(sizes)


def _corners(loops: LoopEnds, turn: Floats) -> tuple[Mask, Points, Floats]:
    """
    The loops whose last and first wall meet near their ends, where these meet, and how far from the farther end [mm].

    They meet at end + ahead * way, which is start - back * begin.
    """
    gap = loops.start - loops.end
    bends = loops.is_straight & (turn > _STRAIGHT) & (turn < np.pi - _STRAIGHT)
    across = np.where(bends, (loops.way.conj() * loops.begin).imag, np.nan)
    ahead = (gap.conj() * loops.begin).imag / across
    back = (loops.way.conj() * gap).imag / across
    reach = np.fmax(np.abs(ahead), np.abs(back))
    return np.asarray(reach <= _MEETING * np.abs(gap)), loops.end + ahead * loops.way, np.fmax(reach, np.abs(gap))
