"""
Whether a tool keeps its distance from every wall: what small programs are let off with, without shapely, which takes
longer to load than to answer for them.

Lengths in mm, plane points complex, x + 1j*c.
"""

from __future__ import annotations

import numpy as np

from polarcheck.arrays import Floats, Mask, Points
from polarcheck.geometry.plane import cross, dot
from polarcheck.geometry.segments import Curves, segments
from polarcheck.geometry.tolerances import ROUNDING, ZERO

#: Pairs of a wall and a way up to which each is looked at; for more, a tree is faster by far.
_PAIRS = 20_000


def keeps_away(contour: Curves, path: Curves, radius: Floats, tolerance: float) -> bool:
    """
    Whether no move comes nearer than R less the tolerance to a wall of its loop; no answer, False, for many of them.

    Both become the chords that an overcut is looked for with (contour.overcuts); radius: float64[moves of path] [mm].
    """
    if len(contour) * len(path) > _PAIRS:
        return False
    walls, ways = segments(contour, tolerance), segments(path, tolerance)
    ways = ways[radius[ways.move] > tolerance]
    if len(walls) * len(ways) > _PAIRS:
        return False
    wall, way = np.nonzero(walls.loop[:, None] == ways.loop)
    one, other = (walls.start[wall], walls.end[wall]), (ways.start[way], ways.end[way])
    apart = np.minimum.reduce([_aside(point, *line) for line, ends in ((one, other), (other, one)) for point in ends])
    # What is as near as makes no difference is looked at once more, by what measures it.
    return not (_cross(one, other) | ~(apart > radius[ways.move[way]] - tolerance + ROUNDING)).any()


def _aside(point: Points, start: Points, end: Points) -> Floats:
    """How far points are from straight lines, each from its own [mm]."""
    way, to = end - start, point - start
    along = np.clip(dot(to, way) / np.maximum(np.abs(way) ** 2, ZERO**2), 0, 1)
    return np.asarray(np.abs(to - along * way))


def _cross(one: tuple[Points, Points], other: tuple[Points, Points]) -> Mask:
    """Whether straight lines cross each other between their ends; what only touches has an end on the other."""
    crossed = np.ones(len(one[0]), bool)
    for (start, end), ends in ((one, other), (other, one)):
        first, last = (np.sign(cross(end - start, point - start)) for point in ends)
        crossed &= first != last
    return crossed
