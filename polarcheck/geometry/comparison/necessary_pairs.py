"""
Pairs of corners that two points have to pass together, however they run along two polylines within a distance.

Where no other part of either line comes as near to the corner of the other one, the places within the distance are one
stretch on each line, and the pair lies in both. A run within the distance comes to one of the two corners first, while
its other point is on that stretch; it can as well wait there for the other corner. So the runs before and behind such
a pair are compared each by itself.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, mask_at
from polarcheck.geometry.comparison.polyline import Polyline
from polarcheck.geometry.tolerances import ROUNDING


def are_necessary(old: Polyline, new: Polyline, old_at: Rows, new_at: Rows, distance: float) -> Mask:
    """
    Return which pairs of corners are necessary for every distance from their own one up to this one [mm].

    old_at, new_at: int[n], the corners that are paired.
    """
    return _is_alone(old, old_at, new, new_at, distance) & _is_alone(new, new_at, old, old_at, distance)


def _is_alone(line: Polyline, corner: Rows, other: Polyline, partner: Rows, distance: float) -> Mask:
    """Only the two segments beside the partner come as near to a corner."""
    import shapely  # type: ignore[import-untyped]

    ends = np.stack([other.point.real, other.point.imag], 1)
    tree = shapely.STRtree(shapely.linestrings(np.stack([ends[:-1], ends[1:]], 1)))
    points = shapely.points(line.point[corner].real, line.point[corner].imag)
    pair, segment = tree.query(points, predicate="dwithin", distance=distance + ROUNDING)
    elsewhere = (segment != partner[pair]) & (segment != partner[pair] - 1)
    pair, segment = pair[elsewhere], segment[elsewhere]
    apart = distances(other, line.point[corner[pair]], line.z[corner[pair]], segment)
    return ~mask_at(len(corner), pair[apart <= distance + ROUNDING])


def distances(
    line: Polyline, point: complex | Points, z: float | Floats, segment: Rows | slice = slice(None)
) -> Floats:
    """The distance of points from segments of a polyline, each from its own, or of one point from all [mm]."""
    if len(line) == 1:
        return np.hypot(np.abs(line.point - point), line.z - z)
    vector, rise = np.diff(line.point)[segment], np.diff(line.z)[segment]
    start, z_start = line.point[:-1][segment] - point, line.z[:-1][segment] - z
    length = np.abs(vector) ** 2 + rise**2
    along = -((start.conj() * vector).real + z_start * rise)
    share = np.clip(np.divide(along, length, out=np.zeros(len(length)), where=length > 0), 0, 1)
    return np.asarray(np.hypot(np.abs(start + share * vector), z_start + share * rise))
