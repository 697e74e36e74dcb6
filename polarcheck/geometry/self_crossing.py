"""Where a path crosses itself. Lengths in mm, plane points complex, x + 1j*c."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.foundation.arrays import Floats, Points, Rows, ranges
from polarcheck.geometry.plane import cross

#: Length of the path before and after a crossing that is compared [mm].
_ASIDE = 0.1
#: Least angle between the two strands of the path there [rad]; below it one runs along the other.
_ANGLE = np.radians(5)
#: Lines whose ends are nearer than this meet [mm].
_MEETS = 0.003
#: Segments of a path, and pairs of them, that are compared.
SEGMENTS, _PAIRS = 3000, 400_000


class Crossing(NamedTuple):
    """
    Places where a path crosses itself, n of them.

    earlier, later: int[n], the segments that cross. place: complex128[n] [mm].
    """

    earlier: Rows
    later: Rows
    place: Points


def self_crossings(start: Points, end: Points) -> Crossing:
    """The crossings of a path of straight segments, each of which begins where the one before it ends."""
    none = np.zeros(0, np.int64)
    earlier, later = _pairs(start, end)
    if not len(earlier):
        return Crossing(none, none, np.zeros(0, np.complex128))
    vector, later_vector = (end - start)[earlier], (end - start)[later]
    between = start[later] - start[earlier]
    area = cross(vector, later_vector)
    oblique = np.abs(area) > np.sin(_ANGLE) * np.abs(vector) * np.abs(later_vector)
    with np.errstate(divide="ignore", invalid="ignore"):
        along, across = cross(between, later_vector) / area, cross(between, vector) / area
        meets = oblique & _within(along, np.abs(vector)) & _within(across, np.abs(later_vector))
    earlier, later, along, across = earlier[meets], later[meets], along[meets], across[meets]
    point = start[earlier] + np.clip(along, 0, 1) * vector[meets]
    length = np.abs(end - start)
    ends = np.cumsum(length)
    first, second = (
        (ends - length)[segment] + np.clip(share, 0, 1) * length[segment]
        for segment, share in ((earlier, along), (later, across))
    )
    inside = (first > _ASIDE) & (second - first > 4 * _ASIDE) & (second < ends[-1] - _ASIDE)
    earlier, later, point, first, second = earlier[inside], later[inside], point[inside], first[inside], second[inside]
    crosses = _alternate(
        *(
            _points(start, end, ends, middle + aside) - point
            for middle in (first, second)
            for aside in (-_ASIDE, _ASIDE)
        )
    )
    return Crossing(earlier[crosses], later[crosses], point[crosses])


def _within(share: Floats, length: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    slack = _MEETS / length
    return np.asarray((share > -slack) & (share < 1 + slack))


def _pairs(start: Points, end: Points) -> tuple[Rows, Rows]:
    """Pairs of segments, not next to each other, whose boxes overlap; none where there are too many."""
    none = np.zeros(0, np.int64)
    count = len(start)
    if not 1 < count <= SEGMENTS:
        return none, none
    low_x, high_x = np.minimum(start.real, end.real) - _MEETS, np.maximum(start.real, end.real) + _MEETS
    low_c, high_c = np.minimum(start.imag, end.imag) - _MEETS, np.maximum(start.imag, end.imag) + _MEETS
    if np.ptp(low_c) > np.ptp(low_x):
        low_x, high_x, low_c, high_c = low_c, high_c, low_x, high_x
    order = np.argsort(low_x, kind="stable")
    until = np.searchsorted(low_x[order], high_x[order], side="right")
    many = until - np.arange(count) - 1
    if many.sum() > _PAIRS:
        return none, none
    first, second = ranges(many)
    first, second = order[first], order[first + second + 1]
    earlier, later = np.minimum(first, second), np.maximum(first, second)
    meets = (later - earlier > 1) & (low_c[earlier] <= high_c[later]) & (low_c[later] <= high_c[earlier])
    return earlier[meets], later[meets]


def _points(start: Points, end: Points, ends: Floats, distance: Floats) -> Points:
    """The points of the path at these distances along it."""
    lengths, points = np.append(0.0, ends), np.append(start[:1], end)
    return np.interp(distance, lengths, points.real) + 1j * np.interp(distance, lengths, points.imag)


def _alternate(
    before: Points, after: Points, before_other: Points, after_other: Points
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """True where two strands cross: the ends of one lie on both sides of the other, by more than the least angle."""
    from_before = [np.angle(point * before.conj()) % (2 * np.pi) for point in (after, before_other, after_other)]
    limit, *arms = from_before
    inside = [(angle > _ANGLE) & (angle < limit - _ANGLE) for angle in arms]
    outside = [(angle > limit + _ANGLE) & (angle < 2 * np.pi - _ANGLE) for angle in arms]
    return np.asarray((inside[0] & outside[1]) | (outside[0] & inside[1]))
