"""
Paths as points for a picture: arcs become chords, and points that nobody would see are left out.

Import late: shapely takes its time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Mask, Points, Rows, States
from polarcheck.geometry.segments import Curves, chord_counts, segments
from polarcheck.geometry.tolerances import ROUNDING

#: What a picture of this part of its size shows alike [share].
_UNSEEN = 1 / 8000
#: How far chords of arcs may lie off them is this part of what is handed to `segments`.
_SAGITTA = 4
#: Points that are thinned at a time: the time of it grows with their square where a path runs to and fro.
_AT_A_TIME = 1000
#: How often the tolerance is doubled until the points are few enough.
_DOUBLINGS = 16


@dataclass(frozen=True, slots=True)
class Chords:
    """
    The points of a path, n of them: point [mm]; move: whose way leads up to it; begins: bool, nothing leads up to it,
    since the path begins there.
    """

    point: Points
    move: Rows
    begins: Mask

    def __len__(self) -> int:
        return len(self.move)

    def some(self, chosen: Mask) -> Chords:
        """Some of the points."""
        return Chords(self.point[chosen], self.move[chosen], self.begins[chosen])


def unseen(point: Points) -> float:
    """How far a path may be off in a picture of these points before anybody sees it [mm]."""
    known = point[~np.isnan(point)]
    if not len(known):
        return _UNSEEN
    size = max(float(np.ptp(known.real)), float(np.ptp(known.imag)))
    return _UNSEEN * max(size, 1.0)


def chords(curves: Curves, tolerance: float, most: int) -> tuple[Chords, float]:
    """
    Curves as chords, those that are not known left out, and how far these lie off the curves at most [mm].

    The tolerance [mm] grows where there would be more than `most` chords of arcs.
    """
    for _ in range(_DOUBLINGS):
        if chord_counts(curves, _SAGITTA * tolerance).sum() <= most:
            break
        tolerance *= 2
    parts = segments(curves, _SAGITTA * tolerance)
    begins = np.ones(len(parts), bool)
    begins[1:] = np.abs(parts.start[1:] - parts.end[:-1]) > ROUNDING
    place = np.arange(len(parts)) + np.cumsum(begins)
    total = len(parts) + int(np.count_nonzero(begins))
    point, move, is_first = np.zeros(total, complex), np.zeros(total, np.int64), np.zeros(total, bool)
    point[place], move[place] = parts.end, parts.move
    first = place[begins] - 1
    point[first], move[first], is_first[first] = parts.start[begins], parts.move[begins], True
    return Chords(point, move, is_first), tolerance


def thinned(path: Chords, kept: Mask, look: States, tolerance: float, most: int) -> tuple[Chords, float]:
    """
    The path with at most so many points besides those that stay, and how far it lies off the one given [mm].

    kept: bool[moves], of these all points stay. look: int16[moves], how each is drawn: where that changes a point
    stays. The tolerance [mm] is doubled until the points are few enough; if they are anyway, none is left out.

    Source: D. H. Douglas, T. K. Peucker, Algorithms for the reduction of the number of points required to represent a
    digitized line, Cartographica 10 (1973) p. 112.
    """
    if len(path) <= most:
        return path, 0.0
    stays = kept[path.move]
    # The last point of a stretch, and the one before another move of note begins.
    ends = np.append(path.begins[1:], True)
    differs = np.append((np.diff(look[path.move]) != 0) | (np.diff(stays) != 0), False)
    turns = path.begins | ends | differs
    enough = most + int(np.count_nonzero(stays | turns))
    bounds = np.flatnonzero(turns | (np.arange(len(path)) % _AT_A_TIME == 0))
    within = ~path.begins[bounds[1:]]
    low, high = bounds[:-1][within], bounds[1:][within]
    count = high - low + 1
    of = np.repeat(np.arange(len(count)), count)
    at = np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count) + np.repeat(low, count)
    point = path.point[at]
    # The third coordinate tells which points are left.
    lines = shapely.linestrings(np.stack([point.real, point.imag, at], axis=1), indices=of)
    for _ in range(_DOUBLINGS):
        simple = shapely.simplify(lines, tolerance, preserve_topology=False)
        chosen = stays.copy()
        chosen[shapely.get_coordinates(simple, include_z=True)[:, 2].astype(np.int64)] = True
        if np.count_nonzero(chosen) <= enough:
            break
        tolerance *= 2
    return path.some(chosen), tolerance
