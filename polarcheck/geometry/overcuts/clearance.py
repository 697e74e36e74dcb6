"""
A test for small programs that needs no shapely: does the tool stay at R from every wall?

Loading shapely takes longer than the test itself.

Lengths in mm, plane points complex, x + 1j*c.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points
from polarcheck.geometry.plane import cross, dot
from polarcheck.geometry.segments import Curves, segments
from polarcheck.geometry.tolerances import ROUNDING, ZERO

#: Up to this number of pairs of a wall and a chord of the path, all are compared; for more, a tree is faster.
_PAIRS = 20_000


def keeps_away(contour: Curves, path: Curves, radius: Floats, tolerance: float) -> bool:
    """
    True if no move comes nearer than R less the tolerance to a wall of its loop; False if there are too many pairs.

    The test uses the same chords as the search for overcuts. radius: float64[moves of path] [mm].
    """
    if len(contour) * len(path) > _PAIRS:
        return False
    walls, chords = segments(contour, tolerance), segments(path, tolerance)
    chords = chords[radius[chords.move] > tolerance]
    if len(walls) * len(chords) > _PAIRS:
        return False
    wall, chord = np.nonzero(walls.loop[:, None] == chords.loop)
    wall_ends, chord_ends = (walls.start[wall], walls.end[wall]), (chords.start[chord], chords.end[chord])
    distance = np.minimum.reduce(
        [_aside(point, *line) for line, ends in ((wall_ends, chord_ends), (chord_ends, wall_ends)) for point in ends]
    )
    # Pairs within rounding of the limit fail here, and the search for overcuts measures them.
    return not (_cross(wall_ends, chord_ends) | ~(distance > radius[chords.move[chord]] - tolerance + ROUNDING)).any()


def _aside(point: Points, start: Points, end: Points) -> Floats:
    """The distance [mm] of each point from the straight line of the same row."""
    vector, to = end - start, point - start
    along = np.clip(dot(to, vector) / np.maximum(np.abs(vector) ** 2, ZERO**2), 0, 1)
    return np.asarray(np.abs(to - along * vector))


def _cross(walls: tuple[Points, Points], chords: tuple[Points, Points]) -> Mask:
    """True where two lines cross between their ends. Of lines that only touch, one has an end on the other."""
    crossed = np.ones(len(walls[0]), bool)
    for (start, end), ends in ((walls, chords), (chords, walls)):
        first, last = (np.sign(cross(end - start, point - start)) for point in ends)
        crossed &= first != last
    return crossed
