"""
Paths as points for a picture: arcs become chords, and points that make no visible difference are left out.

Import late: shapely is slow to import.
"""

from __future__ import annotations

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Mask, Points, Rows, States, Table, ranges
from polarcheck.geometry.segments import Curves, chord_counts, segments
from polarcheck.geometry.tolerances import ROUNDING

#: The largest deviation that is invisible, as a share of the size of the picture.
_UNSEEN = 1 / 8000
#: The tolerance for `segments` is this many times the allowed distance of a chord from its arc.
_SAGITTA = 4
#: Points thinned at a time: the time grows with their square where a path runs to and fro.
_AT_A_TIME = 1000
#: How often the tolerance is doubled until the points are few enough.
_DOUBLINGS = 16


class Chords(Table, frozen=True):
    """
    The n points of a path.

    point: complex[n] [mm].
    move: int64[n], the move that leads to the point.
    begins: bool[n], the path begins at the point.
    """

    point: Points
    move: Rows
    begins: Mask


def unseen(point: Points) -> float:
    """Return the largest invisible deviation of a path in a picture of these points [mm]."""
    finite = point[~np.isnan(point)]
    if not len(finite):
        return _UNSEEN
    size = max(float(np.ptp(finite.real)), float(np.ptp(finite.imag)))
    return _UNSEEN * max(size, 1.0)


def chords(curves: Curves, tolerance: float, most: int) -> tuple[Chords, float]:
    """
    Return curves as chords, without unknown curves, and the largest distance of a chord from its curve [mm].

    The tolerance [mm] is doubled until there are at most `most` chords of arcs.
    """
    for _ in range(_DOUBLINGS):
        if chord_counts(curves, _SAGITTA * tolerance).sum() <= most:
            break
        tolerance *= 2
    parts = segments(curves, _SAGITTA * tolerance)
    begins = np.append(True, np.abs(parts.start[1:] - parts.end[:-1]) > ROUNDING)[: len(parts)]
    index = np.arange(len(parts)) + np.cumsum(begins)
    total = len(parts) + int(np.count_nonzero(begins))
    point, move, is_first = np.zeros(total, complex), np.zeros(total, np.int64), np.zeros(total, bool)
    point[index], move[index] = parts.end, parts.move
    first = index[begins] - 1
    point[first], move[first], is_first[first] = parts.start[begins], parts.move[begins], True
    return Chords(point, move, is_first), tolerance


def thinned(path: Chords, keep: Mask, look: States, tolerance: float, most: int) -> tuple[Chords, float]:
    """
    Return the path with at most `most` points besides those that must stay, and its deviation [mm].

    keep: bool[moves], moves whose points all stay, unless these are too many themselves.
    look: int16[moves], how each move is drawn; a point where this changes stays.

    The tolerance [mm] is doubled until the points are few enough. A path with few points stays as it is.

    Source: D. H. Douglas, T. K. Peucker, Algorithms for the reduction of the number of points required to represent a
    digitized line, Cartographica 10 (1973) p. 112.
    """
    if len(path) <= most:
        return path, 0.0
    stays = keep[path.move]
    if np.count_nonzero(stays) > most:
        stays = np.zeros_like(stays)
    # The last point of a connected piece, and each point where the look changes.
    ends = np.append(path.begins[1:], True)
    differs = np.append((np.diff(look[path.move]) != 0) | (np.diff(stays) != 0), False)
    turns = path.begins | ends | differs
    enough = most + int(np.count_nonzero(stays | turns))
    bounds = np.flatnonzero(turns | (np.arange(len(path)) % _AT_A_TIME == 0))
    within = ~path.begins[bounds[1:]]
    low, high = bounds[:-1][within], bounds[1:][within]
    count = high - low + 1
    of, index = ranges(count)
    index += low[of]
    point = path.point[index]
    # The third coordinate holds the number of the point, to see which ones remain.
    lines = shapely.linestrings(np.stack([point.real, point.imag, index], axis=1), indices=of)
    for _ in range(_DOUBLINGS):
        simple = shapely.simplify(lines, tolerance, preserve_topology=False)
        chosen = stays.copy()
        chosen[shapely.get_coordinates(simple, include_z=True)[:, 2].astype(np.int64)] = True
        if np.count_nonzero(chosen) <= enough:
            break
        tolerance *= 2
    return path[chosen], tolerance
