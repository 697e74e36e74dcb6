"""
How little of an outline is there by chance: tangents, a closed end, lengths and coordinates that come again.

Outlines of one contour that differ in a word or a block are compared as the rows of one table.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.plane import cross

#: What is tangent [rad].
_TANGENT = np.radians(1.2)
#: Ends of an outline between which it may be closed.
_ENDS = 3
#: The least number of edges of a ring.
_FEWEST = 3
#: A length or a denominator that is none [mm].
_NONE = 1e-9
#: What each chance costs, as a number of coordinates that are as they are by chance.
_OF_BROKEN_ARC, _OF_TURN_BACK, _OF_OPEN_END, _OF_CORNER_AT_ARC = 6.0, 3.0, 2.0, 1.5
_OF_CORNER, _OF_SENSE, _OF_NO_MOVE, _OF_LENGTH, _OF_COORDINATE, _OF_ROUNDING = 0.2, 1.0, 3.0, 0.6, 1.0, 0.4
_OF_IDLE_POINT, _OF_LONG_LEAD = 1.5, 1.5


class Outlines(NamedTuple):
    """
    k outlines of n edges.

    point: complex128[k, n + 1] [mm], where the edges begin and end. turns: int[k, n], -1 for a clockwise arc, 0 for a
    line, 1. radius: float64[k, n], R of an arc with its sign [mm], NaN without. to_center: complex128[k, n], from the
    start of an arc [mm].
    """

    point: Points
    turns: Rows
    radius: Floats
    to_center: Points


class Chances(NamedTuple):
    """
    What k outlines have by chance, a number for each.

    broken_arcs: that do not reach their ends. corners_at_arcs: ends of arcs that are not tangent. turns_back: ends at
    which the path turns back. is_open: 1 where the end is not the start. corners: of lines.
    others: what is left, such as the number of different lengths.
    """

    broken_arcs: Rows
    corners_at_arcs: Rows
    turns_back: Rows
    is_open: Rows
    corners: Rows
    others: Floats

    @property
    def total(self) -> Floats:
        """All of them together: the outline with the least is the most regular."""
        return np.asarray(_OF_BROKEN_ARC * self.broken_arcs + self.without_broken_arcs)

    @property
    def without_broken_arcs(self) -> Floats:
        """All but the arcs that do not reach their ends: many edits mend these, and few make the outline regular."""
        return np.asarray(
            _OF_CORNER_AT_ARC * self.corners_at_arcs
            + _OF_TURN_BACK * self.turns_back
            + _OF_OPEN_END * self.is_open
            + self.others
        )


def chances_of(outlines: Outlines, tolerance: float) -> Chances:
    """Count what each outline has by chance. tolerance: what is the same place [mm]."""
    point, turns = outlines.point, outlines.turns
    chord = np.diff(point, axis=1)
    length, is_arc = np.abs(chord), turns != 0
    moves = length > tolerance / 2
    sweep, is_broken, off = _sweeps(outlines, length, moves, tolerance)
    is_circle = is_arc & ~moves & (sweep > np.pi)
    direction = np.where(
        is_circle,
        -1j * turns * outlines.to_center / np.maximum(np.abs(outlines.to_center), _NONE),
        chord / np.maximum(length, _NONE),
    )
    bend = np.where(is_circle, 0.0, turns * sweep / 2)
    kind = np.where(are_about_axis(outlines, tolerance), 1, 2) * is_arc
    turn, beside, meets = _turns(direction, bend, moves | is_circle, kind)
    beside_arc, beside_free_arc = beside > 0, beside > 1
    is_corner = meets & (np.abs(turn) >= _TANGENT)
    left, right = ((is_corner & (sign * turn > 0)).sum(axis=1) for sign in (1, -1))
    last = np.arange(point.shape[1])[-_ENDS:, None]
    is_ring = last - np.arange(min(_ENDS, point.shape[1])) >= _FEWEST
    ends = np.where(is_ring, np.abs(point[:, -_ENDS:, None] - point[:, None, :_ENDS]), np.inf)
    size = np.where(np.isnan(outlines.radius), np.abs(outlines.to_center), np.abs(outlines.radius))
    length_of_moves = np.where(moves, length, 0.0)
    others = (
        _OF_CORNER * is_corner.sum(axis=1)
        + _OF_SENSE * np.minimum(left, right)
        + _OF_IDLE_POINT * (meets & ~is_corner & ~beside_arc).sum(axis=1)
        + _OF_NO_MOVE * (~(moves | is_circle)).sum(axis=1)
        + _OF_LENGTH * (_different(length_of_moves, 2 * tolerance) + _different(np.abs(point), 2 * tolerance))
        + _OF_COORDINATE * _different(np.where(is_arc, size, 0.0), tolerance)
        + _OF_ROUNDING * off
        + _OF_LONG_LEAD * ((sweep > np.pi + _TANGENT) & ~is_circle)[:, [0, -1]].sum(axis=1)
    )
    for part in (point.real, point.imag):
        others += _OF_COORDINATE * np.minimum(_different(np.abs(part), tolerance), _different(part, tolerance))
    return Chances(
        is_broken.sum(axis=1),
        (is_corner & beside_free_arc).sum(axis=1),
        (meets & (np.abs(turn) > np.pi - _TANGENT)).sum(axis=1),
        ((ends.min(axis=(1, 2)) > tolerance) & ~_overlaps(point, turns, tolerance)).astype(np.int64),
        (is_corner & ~beside_free_arc).sum(axis=1),
        others,
    )


def _overlaps(point: Points, turns: Rows, tolerance: float) -> Mask:
    """The first or the last line of the outline has an end of the other one on it, or they cross."""
    overlaps = np.zeros(len(point), bool)
    for place, begin, end, turn in ((-1, 0, 1, 0), (-2, 0, 1, 0), (0, -2, -1, -1), (1, -2, -1, -1)):
        way = np.abs(point[:, place] - point[:, begin]) + np.abs(point[:, end] - point[:, place])
        is_on = way - np.abs(point[:, end] - point[:, begin]) <= tolerance
        overlaps |= is_on & (turns[:, turn] == 0) & (point.shape[1] > _FEWEST + (place in (-2, 1)))
    first, last = point[:, :2].T, point[:, -2:].T
    are_aside = [
        cross(way, one[0] - begin) * cross(way, one[1] - begin) < 0
        for begin, way, one in ((first[0], first[1] - first[0], last), (last[0], last[1] - last[0], first))
    ]
    crosses = are_aside[0] & are_aside[1] & (turns[:, 0] == 0) & (turns[:, -1] == 0)
    return np.asarray(overlaps | crosses)


def are_about_axis(outlines: Outlines, tolerance: float) -> Mask:
    """The edges that would be a part of the round bar, if they are arcs: the axis is at 0."""
    point, turns, radius, to_center = outlines
    start, end, size = point[:, :-1], point[:, 1:], np.abs(radius)
    on_bar = np.maximum(np.abs(np.abs(start) - size), np.abs(np.abs(end) - size)) <= 2 * tolerance
    on_bar &= turns * np.sign(radius) * cross(start, end) >= -tolerance * size
    return np.asarray(np.where(np.isnan(radius), np.abs(start + to_center) <= 2 * tolerance, on_bar))


def _sweeps(outlines: Outlines, length: Floats, moves: Mask, tolerance: float) -> tuple[Floats, Mask, Floats]:
    """The sweep of each edge [rad], 0 for lines; whether it is an arc that misses its end; how far all miss it."""
    swept, broken = np.zeros(length.shape), np.zeros(length.shape, bool)
    # Most edges are lines in all of the outlines.
    arcs = (outlines.turns != 0).any(axis=0)
    if not arcs.any():
        return swept, broken, np.zeros(len(length))
    turns, radius, to_center = (part[:, arcs] for part in outlines[1:])
    chord, length, moves = np.diff(outlines.point, axis=1)[:, arcs], length[:, arcs], moves[:, arcs]
    is_arc, by_radius = turns != 0, ~np.isnan(radius)
    size = np.abs(radius)
    of_radius = 2 * np.arcsin(np.minimum(length / 2 / np.maximum(size, _NONE), 1.0))
    of_radius = np.where(radius < 0, 2 * np.pi - of_radius, of_radius)
    from_center = chord - to_center
    of_center = np.angle(from_center * -to_center.conj()) * turns
    of_center = np.where((of_center <= 0) | ~moves, of_center + 2 * np.pi, of_center)
    of_center = np.where(moves, of_center, 2 * np.pi)
    off_circle = np.abs(np.abs(from_center) - np.abs(to_center))
    is_broken = np.where(
        by_radius,
        (length / 2 > size + tolerance) | ~moves,
        (off_circle > 2 * tolerance) | (np.abs(to_center) < tolerance),
    )
    off = np.where(is_arc & ~by_radius, np.minimum(off_circle / (2 * tolerance), 1.0), 0.0).sum(axis=1)
    swept[:, arcs] = np.where(is_arc, np.where(by_radius, of_radius, of_center), 0.0)
    broken[:, arcs] = is_arc & is_broken
    return swept, broken, off


def _turns(direction: Points, bend: Floats, is_edge: Mask, kind: Rows) -> tuple[Floats, Rows, Mask]:
    """By which angle the path turns where each edge begins [rad]; the larger kind of both edges; whether two meet."""
    begins, ends, bent = direction.copy(), direction.copy(), (bend != 0).any(axis=0)
    begins[:, bent] *= np.exp(-1j * bend[:, bent])
    ends[:, bent] *= np.exp(1j * bend[:, bent])
    number = np.maximum.accumulate(np.where(is_edge, np.arange(is_edge.shape[1]), -1), axis=1)
    before = np.concatenate([np.full((len(number), 1), -1), number[:, :-1]], axis=1)
    meets = is_edge & (before >= 0)
    into = np.take_along_axis(ends, np.maximum(before, 0), axis=1)
    of_both = np.maximum(kind, np.take_along_axis(kind, np.maximum(before, 0), axis=1))
    return np.where(meets, np.angle(begins * into.conj()), 0.0), of_both, meets


def _different(values: Floats, tolerance: float) -> Rows:
    """How many different values each row has."""
    return np.asarray(1 + (np.diff(np.sort(values, axis=1), axis=1) > tolerance).sum(axis=1))
