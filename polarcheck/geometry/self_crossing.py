"""Where a path crosses itself. Lengths in mm, plane points complex, x + 1j*c."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.foundation.arrays import Floats, Points, Rows
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
    way, other = (end - start)[earlier], (end - start)[later]
    between = start[later] - start[earlier]
    area = cross(way, other)
    oblique = np.abs(area) > np.sin(_ANGLE) * np.abs(way) * np.abs(other)
    with np.errstate(divide="ignore", invalid="ignore"):
        along, across = cross(between, other) / area, cross(between, way) / area
        meets = oblique & _within(along, np.abs(way)) & _within(across, np.abs(other))
    earlier, later, along, across = earlier[meets], later[meets], along[meets], across[meets]
    place = start[earlier] + np.clip(along, 0, 1) * way[meets]
    length = np.abs(end - start)
    ends = np.cumsum(length)
    first, second = (
        (ends - length)[segment] + np.clip(share, 0, 1) * length[segment]
        for segment, share in ((earlier, along), (later, across))
    )
    inside = (first > _ASIDE) & (second - first > 4 * _ASIDE) & (second < ends[-1] - _ASIDE)
    earlier, later, place, first, second = earlier[inside], later[inside], place[inside], first[inside], second[inside]
    crosses = _alternate(
        *(_at(start, end, ends, middle + aside) - place for middle in (first, second) for aside in (-_ASIDE, _ASIDE))
    )
    return Crossing(earlier[crosses], later[crosses], place[crosses])


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
    one = np.repeat(np.arange(count), many)
    two = np.arange(len(one)) - np.repeat(np.cumsum(many) - many, many) + one + 1
    one, two = order[one], order[two]
    earlier, later = np.minimum(one, two), np.maximum(one, two)
    meets = (later - earlier > 1) & (low_c[earlier] <= high_c[later]) & (low_c[later] <= high_c[earlier])
    return earlier[meets], later[meets]


def _at(start: Points, end: Points, ends: Floats, way: Floats) -> Points:
    """The points of the path at these distances along it."""
    known, points = np.append(0.0, ends), np.append(start[:1], end)
    return np.interp(way, known, points.real) + 1j * np.interp(way, known, points.imag)


def _alternate(
    before: Points, after: Points, before_other: Points, after_other: Points
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """True where two strands cross: the ends of one lie on both sides of the other, by more than the least angle."""
    from_before = [np.angle(point * before.conj()) % (2 * np.pi) for point in (after, before_other, after_other)]
    limit, *others = from_before
    inside = [(angle > _ANGLE) & (angle < limit - _ANGLE) for angle in others]
    outside = [(angle > limit + _ANGLE) & (angle < 2 * np.pi - _ANGLE) for angle in others]
    return np.asarray((inside[0] & outside[1]) | (outside[0] & inside[1]))
