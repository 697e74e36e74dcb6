"""LinesFromCenter and arcs of the polar plane as they are seen from the center of C."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ZERO

#: As plain numbers: NumPy compares a column with an enum slowly (arrays.is_among).
_CW, _CCW = int(Motion.CW), int(Motion.CCW)

#: What the arithmetic of one cross product may add, as a share of the coordinates.
NOISE = 16 * np.finfo(np.float64).eps
quiet = np.errstate(all="ignore")


def cross(p: Points, q: Points) -> Floats:
    return np.asarray(p.real * q.imag - p.imag * q.real)


def dot(p: Points, q: Points) -> Floats:
    return np.asarray(p.real * q.real + p.imag * q.imag)


def angle_between(p: Points, q: Points) -> Floats:
    """Turn from p to q [rad], above -pi up to pi; adding 0 makes a half turn positive whatever the sign of the zero."""
    return np.asarray(np.arctan2(cross(p, q) + 0.0, dot(p, q)))


def cleared(point: Points) -> Points:
    """The points, those at the center exactly there."""
    at_center = (np.abs(point.real) <= ZERO) & (np.abs(point.imag) <= ZERO)
    return np.where(at_center, 0, point) if np.count_nonzero(at_center) else point


@quiet
def arc_sweep(start: Points, end: Points, center: Points, kind: States) -> Floats:
    """Signed angle of each arc about its own center [rad]: CCW positive, a full circle 2 pi, lines 0."""
    sweep = np.where(np.isnan(start) | np.isnan(end), np.nan, 0.0)
    rows = rows_of_arcs(kind)
    start, end, center = start[rows], end[rows], center[rows]
    sign = np.where(kind[rows] == _CCW, 1.0, -1.0)
    turn = sign * angle_between(start - center, end - center)
    turn += 2 * np.pi * (turn < 0)
    full = (np.abs(end - start) <= ZERO) & ~np.isnan(center)
    sweep[rows] = sign * np.where(full, 2 * np.pi, turn)
    return sweep


class LinesFromCenter(msgspec.Struct, frozen=True):
    """LinesFromCenter seen from the center: d, and the way from the foot of the perpendicular to start and end [mm]."""

    offset: Floats
    before: Floats
    after: Floats
    near: Floats

    @property
    def has_foot(self) -> Mask:
        return (self.before < 0) & (self.after > 0)


def lines_from_center(start: Points, end: Points) -> LinesFromCenter:
    start, end = cleared(start), cleared(end)
    vector = end - start
    long = np.abs(vector)
    long[long == 0] = 1
    u = vector * (1 / long)
    first, last = np.abs(start), np.abs(end)
    # From the end nearer to the center, lest a small d drown in the rounding of large coordinates.
    offset = np.abs(cross(np.where(first <= last, start, end), u))
    offset[offset <= NOISE * np.maximum(first, last)] = 0
    before, after = dot(start, u), dot(end, u)
    near = np.where((before < 0) & (after > 0), offset, np.minimum(first, last))
    return LinesFromCenter(offset, before, after, near)


class ArcsFromCenter(msgspec.Struct, frozen=True):
    """
    ArcsFromCenter seen from the center of C.

    away: e. inside: R - e, above 0 where the center of C lies in the circle. around: R + e. sweep: signed [rad].
    through: the circle passes through the center. crosses: so does the arc, between start and end.
    passes_near, passes_far: the arc has the nearest, the farthest point of its circle between start and end.
    unknown: 0 to add where all is known, else NaN.
    """

    start: Points
    end: Points
    center: Points
    radius: Floats
    away: Floats
    inside: Floats
    around: Floats
    sweep: Floats
    through: Mask
    crosses: Mask
    passes_near: Mask
    passes_far: Mask
    unknown: Floats


def arcs_from_center(start: Points, end: Points, center: Points, kind: States, rows: Rows) -> ArcsFromCenter:
    sweep = arc_sweep(start[rows], end[rows], center[rows], kind[rows])
    start, end, center = cleared(start[rows]), cleared(end[rows]), center[rows]
    radius, away = np.abs(start - center), np.abs(center)
    inside = radius - away
    touches = (start == 0) | (end == 0)
    through = touches | (np.abs(inside) <= NOISE * (radius + away))
    passes_near = passes_toward(start - center, sweep, -center)
    return ArcsFromCenter(
        start=start,
        end=end,
        center=center,
        radius=radius,
        away=away,
        inside=inside,
        around=radius + away,
        sweep=sweep,
        through=through,
        crosses=through & ~touches & passes_near & (radius > 0),
        passes_near=passes_near,
        passes_far=passes_toward(start - center, sweep, center),
        unknown=np.where(np.isnan(sweep), np.nan, 0.0),
    )


def passes_toward(spoke: Points, sweep: Floats, direction: Points) -> Mask:
    """A boolean per arc: begun at this spoke of its circle, it passes the point in the direction."""
    turn = np.copysign(1.0, sweep) * angle_between(spoke, direction)
    return np.asarray(turn + 2 * np.pi * (turn < 0) <= np.abs(sweep))


def rows_of_arcs(kind: States) -> Rows:
    return np.asarray(((kind == _CW) | (kind == _CCW)).nonzero()[0])
