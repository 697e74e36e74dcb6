"""
The polar plane and the two machine axes behind it: X as a radius, and C.

Moves come as arrays of one length n. start, end, center: complex128 [mm], plane points x + 1j*c, center NaN for lines.
kind: int8, Motion LINE, CW or CCW; all else counts as LINE, a rapid being the worst case of its straight way.
A line of no length is a point. An arc that ends where it starts is a full circle; its radius is that of its start.
Unknown (NaN) in, unknown out; nothing is raised.

Formulas: with R the radius of an arc, e the distance of its center from the center of C, r that of the tool center and
u the direction of travel, C turns by cross(p, u) / r^2 and X moves by dot(p, u) / r per mm of path. On a line at the
distance d the former is d / r^2, on an arc (1 + (R^2 - e^2) / r^2) / 2R. The rest is where these are largest.

A path exactly through the center asks C for half a turn in no time: its rates are inf, and the half turn counts as
+180 deg. A move that only begins or ends at the center comes and goes along one direction; it does not turn C on the
way, and what C must turn at the center between two moves belongs to neither.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polarcheck.modal import Motion

Points = NDArray[np.complex128]
Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Codes = NDArray[np.int8]
Rows = NDArray[np.intp]

#: Points nearer than this to each other or to the center [mm] are one; a millionth of the least increment.
SAME_POINT = 1e-9
#: What the arithmetic of one cross product may add, as a share of the coordinates.
_NOISE = 16 * np.finfo(np.float64).eps
_quiet = np.errstate(all="ignore")


def _cross(p: Points, q: Points) -> Floats:
    return np.asarray(p.real * q.imag - p.imag * q.real)


def _dot(p: Points, q: Points) -> Floats:
    return np.asarray(p.real * q.real + p.imag * q.imag)


def _angle_between(p: Points, q: Points) -> Floats:
    """Turn from p to q [rad], above -pi up to pi; adding 0 makes a half turn positive whatever the sign of the zero."""
    return np.asarray(np.arctan2(_cross(p, q) + 0.0, _dot(p, q)))


def _cleared(point: Points) -> Points:
    """The points, those at the center exactly there."""
    at_center = (np.abs(point.real) <= SAME_POINT) & (np.abs(point.imag) <= SAME_POINT)
    return np.where(at_center, 0, point) if at_center.any() else point


class _Lines(NamedTuple):
    """Lines seen from the center: d, and the way from the foot of the perpendicular to start and end [mm]."""

    offset: Floats
    before: Floats
    after: Floats
    near: Floats
    far: Floats

    @property
    def has_foot(self) -> Mask:
        return (self.before < 0) & (self.after > 0)


def _lines(start: Points, end: Points) -> _Lines:
    start, end = _cleared(start), _cleared(end)
    way = end - start
    long = np.abs(way)
    long[long == 0] = 1
    u = way * (1 / long)
    first, last = np.abs(start), np.abs(end)
    # From the end nearer to the center, lest a small d drown in the rounding of large coordinates.
    offset = np.abs(_cross(np.where(first <= last, start, end), u))
    far = np.maximum(first, last)
    offset[offset <= _NOISE * far] = 0
    before, after = _dot(start, u), _dot(end, u)
    near = np.where((before < 0) & (after > 0), offset, np.minimum(first, last))
    return _Lines(offset, before, after, near, far)


class _Arcs(NamedTuple):
    """
    Arcs seen from the center of C.

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


def _arcs(start: Points, end: Points, center: Points, kind: Codes, rows: Rows) -> _Arcs:
    sweep = arc_sweep(start[rows], end[rows], center[rows], kind[rows])
    start, end, center = _cleared(start[rows]), _cleared(end[rows]), center[rows]
    radius, away = np.abs(start - center), np.abs(center)
    inside = radius - away
    touches = (start == 0) | (end == 0)
    through = touches | (np.abs(inside) <= SAME_POINT)
    passes_near = _passes(start - center, sweep, -center)
    return _Arcs(
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
        passes_far=_passes(start - center, sweep, center),
        unknown=np.where(np.isnan(sweep), np.nan, 0.0),
    )


def _passes(spoke: Points, sweep: Floats, direction: Points) -> Mask:
    """Which arcs, begun at this spoke of their circle, pass the point in the direction."""
    turn = np.copysign(1.0, sweep) * _angle_between(spoke, direction)
    return np.asarray(turn + 2 * np.pi * (turn < 0) <= np.abs(sweep))


def _rows_of_arcs(kind: Codes) -> Rows:
    return np.flatnonzero((kind == Motion.CW) | (kind == Motion.CCW))


@_quiet
def arc_sweep(start: Points, end: Points, center: Points, kind: Codes) -> Floats:
    """Signed angle of each arc about its own center [rad]: CCW positive, a full circle 2 pi, lines 0."""
    sweep = np.where(np.isnan(start) | np.isnan(end), np.nan, 0.0)
    rows = _rows_of_arcs(kind)
    start, end, center = start[rows], end[rows], center[rows]
    sign = np.where(kind[rows] == Motion.CCW, 1.0, -1.0)
    turn = sign * _angle_between(start - center, end - center)
    turn += 2 * np.pi * (turn < 0)
    full = (np.abs(end - start) <= SAME_POINT) & ~np.isnan(center)
    sweep[rows] = sign * np.where(full, 2 * np.pi, turn)
    return sweep


@_quiet
def length(start: Points, end: Points, center: Points, kind: Codes) -> Floats:
    """Length of each move in the plane [mm]."""
    result = np.abs(end - start)
    rows = _rows_of_arcs(kind)
    sweep = arc_sweep(start[rows], end[rows], center[rows], kind[rows])
    result[rows] = np.abs(start[rows] - center[rows]) * np.abs(sweep)
    return result


@_quiet
def center_from_radius(
    start: Points, end: Points, radius: Floats, kind: Codes, tolerance: Floats | float = 0.0
) -> Points:
    """
    Centers of arcs written with R [mm, signed]: R above 0 turns through at most 180 deg, below 0 through more.

    Where the chord is longer than 2R by no more than the tolerance [mm], the middle of the chord; beyond it NaN, and so
    for lines, for R = 0 and where start and end are one point, since no circle is given (no movement at the control,
    FANUC 16/18-C lathe manual B-62754EN/01 p. 67).
    """
    half = (end - start) / 2
    reach = np.abs(half)
    height = np.sqrt(np.maximum((np.abs(radius) - reach) * (np.abs(radius) + reach), 0))
    left = (kind == Motion.CCW) == (radius > 0)
    center = start + half + np.where(left, 1j, -1j) * half * (height / reach)
    fits = 2 * (reach - np.abs(radius)) <= np.maximum(tolerance, _NOISE * reach)
    known = fits & (reach > SAME_POINT / 2) & (radius != 0) & ((kind == Motion.CW) | (kind == Motion.CCW))
    return np.where(known, center, complex("nan+nanj"))


@_quiet
def nearest(start: Points, end: Points, center: Points, kind: Codes) -> Floats:
    """L, the smallest distance of each move from the center of C [mm]."""
    result = _lines(start, end).near
    arcs = _arcs(start, end, center, kind, rows := _rows_of_arcs(kind))
    near = np.where(arcs.passes_near, np.abs(arcs.inside), np.inf)
    ends = np.minimum(np.abs(arcs.start), np.abs(arcs.end))
    result[rows] = np.where(arcs.crosses, 0.0, np.minimum(ends, near)) + arcs.unknown
    return result


@_quiet
def farthest(start: Points, end: Points, center: Points, kind: Codes) -> Floats:
    """The largest distance of each move from the center of C [mm]."""
    result = np.maximum(np.abs(start), np.abs(end))
    arcs = _arcs(start, end, center, kind, rows := _rows_of_arcs(kind))
    far = np.where(arcs.passes_far, arcs.around, 0.0)
    result[rows] = np.maximum(result[rows], far) + arcs.unknown
    return result


@_quiet
def c_feed(start: Points, end: Points, center: Points, kind: Codes, feed: Floats | float) -> Floats:
    """
    Largest |C rate| along each move [deg/min] for the feed F [mm/min] along the path.

    Where C turns back within an arc (R < e), the larger of both directions counts. inf through the center.
    Source: FANUC B-62764EN/01 p. 52 has F < L * R * pi / 180, exact where the tool center passes its nearest point
    at a right angle to the radius, on the safe side elsewhere; here the rate itself.
    """
    return _scaled(np.degrees(_c_turn(start, end, center, kind)), feed)


@_quiet
def feed_allowed(start: Points, end: Points, center: Points, kind: Codes, limit: Floats | float) -> Floats:
    """
    Highest F along each move [mm/min] at which the C rate stays at or below the limit [deg/min].

    inf where C does not turn, 0 through the center.
    """
    turn = np.degrees(_c_turn(start, end, center, kind))
    return np.asarray(np.where(turn == 0, np.inf + 0 * np.asarray(limit), limit / turn))


def _scaled(rate: Floats, feed: Floats | float) -> Floats:
    """The rate at this feed; without feed nothing moves, not even through the center."""
    return np.asarray(np.where(np.asarray(feed) == 0, 0 * np.nan_to_num(rate, nan=np.nan, posinf=0.0), rate * feed))


def _c_turn(start: Points, end: Points, center: Points, kind: Codes) -> Floats:
    """Largest turn of C per way [rad/mm]."""
    lines = _lines(start, end)
    turn = lines.offset / lines.near**2
    turn = np.where(lines.offset == 0, np.where(lines.has_foot, np.inf, 0.0), turn)
    arcs = _arcs(start, end, center, kind, rows := _rows_of_arcs(kind))
    turn[rows] = _c_turn_of_arcs(arcs)
    return turn


def _c_turn_of_arcs(arcs: _Arcs) -> Floats:
    """The rate hangs on r alone, and monotonously: it is largest at the nearest or at the farthest point."""
    turn = np.maximum(_c_turn_at(arcs, arcs.start), _c_turn_at(arcs, arcs.end))
    turn = np.maximum(turn, np.where(arcs.passes_near, 1 / np.abs(arcs.inside), 0.0))
    turn = np.maximum(turn, np.where(arcs.passes_far, 1 / arcs.around, 0.0))
    turn = np.where(arcs.through, np.where(arcs.crosses, np.inf, 0.5 / arcs.radius), turn)
    return np.where(arcs.radius == 0, 0.0, turn) + arcs.unknown


def _c_turn_at(arcs: _Arcs, point: Points) -> Floats:
    """|cross(p, u)| / r^2 at an end of the arc, from the point itself: exact however near to the center it is."""
    spoke = point - arcs.center
    return np.asarray(np.abs(_dot(point, spoke)) / (np.abs(spoke) * np.abs(point) ** 2))


@_quiet
def c_acceleration(start: Points, end: Points, center: Points, kind: Codes, feed: Floats | float) -> Floats:
    """
    Largest |C acceleration| within each move at the feed F [deg/s^2], not at its ends; inf through the center.

    On a line 2 F^2 d s / r^4 with s the way from the foot, largest at s = d / sqrt(3): 0.6495 F^2 / d^2. On an arc
    F^2 (R^2 - e^2) e sin(psi) / (R r^4) with psi the angle from the center's own direction.
    """
    lines = _lines(start, end)
    shortest = np.where(lines.has_foot, 0.0, np.minimum(np.abs(lines.before), np.abs(lines.after)))
    way = np.clip(lines.offset / np.sqrt(3), shortest, np.maximum(np.abs(lines.before), np.abs(lines.after)))
    bend = 2 * lines.offset * way / (lines.offset**2 + way**2) ** 2
    bend = np.where(lines.offset == 0, np.where(lines.has_foot, np.inf, 0.0), bend)
    arcs = _arcs(start, end, center, kind, rows := _rows_of_arcs(kind))
    bend[rows] = _c_bend_of_arcs(arcs)
    return _scaled(np.degrees(bend), (np.asarray(feed) / 60) ** 2)


def _c_bend_of_arcs(arcs: _Arcs) -> Floats:
    """Largest change of the C turn per way and way [rad/mm^2]; at an end, or where its derivative by psi is 0."""
    bend = np.maximum(_c_bend_at(arcs, arcs.start), _c_bend_at(arcs, arcs.end))
    a, b = arcs.radius**2 + arcs.away**2, 2 * arcs.radius * arcs.away
    root = np.sqrt(a**2 + 8 * b**2)
    # cos(psi) comes near to -1 with the center near to the circle; 1 + cos(psi) then keeps its digits.
    above = 2 * arcs.inside**2 / (a + 2 * b + root)
    sine = np.sqrt(above * (2 - above))
    r_squared = arcs.inside**2 + b * above
    extreme = np.abs(arcs.inside) * arcs.around * arcs.away * sine / (arcs.radius * r_squared**2)
    ahead = arcs.center * (above - 1 + 1j * sine)
    behind = arcs.center * (above - 1 - 1j * sine)
    spoke = arcs.start - arcs.center
    passes = _passes(spoke, arcs.sweep, ahead) | _passes(spoke, arcs.sweep, behind)
    bend = np.where(passes, np.maximum(bend, extreme), bend)
    bend = np.where(arcs.through, np.where(arcs.crosses, np.inf, 0.0), bend)
    return np.where((arcs.radius == 0) | (arcs.away == 0), 0.0, bend) + arcs.unknown


def _c_bend_at(arcs: _Arcs, point: Points) -> Floats:
    power = _dot(point, point - 2 * arcs.center)
    spoke = np.abs(point - arcs.center)
    return np.asarray(np.abs(power * _cross(arcs.center, point)) / (spoke * np.abs(point) ** 2) ** 2)


@_quiet
def x_feed(start: Points, end: Points, center: Points, kind: Codes, feed: Floats | float) -> Floats:
    """Largest |X rate| along each move [mm/min, X as a radius]; never above F."""
    lines = _lines(start, end)
    way = np.maximum(np.abs(lines.before), np.abs(lines.after))
    share = np.where(way == 0, way, way / np.hypot(lines.offset, way))
    arcs = _arcs(start, end, center, kind, rows := _rows_of_arcs(kind))
    share[rows] = _x_share_of_arcs(arcs)
    return _scaled(share, feed)


def _x_share_of_arcs(arcs: _Arcs) -> Floats:
    """Largest |X rate| per feed: e |sin(psi)| / r, at its best F where e > R, where the tool runs straight to C0."""
    share = np.maximum(_x_share_at(arcs, arcs.start), _x_share_at(arcs, arcs.end))
    less, more = np.minimum(arcs.radius, arcs.away), np.maximum(arcs.radius, arcs.away)
    cosine = -less / more
    sine = np.sqrt((more - less) * (more + less)) / more
    spoke = arcs.start - arcs.center
    ahead, behind = arcs.center * (cosine + 1j * sine), arcs.center * (cosine - 1j * sine)
    passes = _passes(spoke, arcs.sweep, ahead) | _passes(spoke, arcs.sweep, behind)
    share = np.where(passes, arcs.away / more, share)
    return np.where((arcs.radius == 0) | (arcs.away == 0), 0.0, share) + arcs.unknown


def _x_share_at(arcs: _Arcs, point: Points) -> Floats:
    spoke = np.abs(point - arcs.center)
    share = np.abs(_cross(arcs.center, point)) / (spoke * np.abs(point))
    return np.where(point == 0, 1.0, share)


@_quiet
def time(length: Floats, feed: Floats | float) -> Floats:
    """Time of each move [s] from its length [mm] and F [mm/min]; inf where F is 0."""
    return np.asarray(np.where(length == 0, 0 * np.asarray(feed), 60 * length / feed))


@_quiet
def c_sweep(start: Points, end: Points, center: Points, kind: Codes) -> Floats:
    """
    Signed turn of C along each move [deg]; +180 for a line through the center, whichever way it runs.

    An arc round the center turns C as it turns itself but for the angles at which it is seen; one that leaves the
    center outside turns C by no more than half a turn.
    """
    first, last = _cleared(start), _cleared(end)
    turn = _angle_between(first, last)
    straight = _lines(start, end)
    turn = np.where(straight.offset == 0, np.where(straight.has_foot, np.pi, 0.0), turn)
    turn += np.where(np.isnan(start) | np.isnan(end), np.nan, 0.0)
    arcs = _arcs(start, end, center, kind, rows := _rows_of_arcs(kind))
    leave = _angle_between(arcs.end - arcs.center, arcs.end)
    enter = _angle_between(arcs.start - arcs.center, arcs.start)
    inside = arcs.sweep + np.where(arcs.sweep == 0, 0, leave - enter)
    outside = np.where(arcs.start == arcs.end, 0.0, _angle_between(arcs.start, arcs.end))
    # Seen from a point of the circle itself, an arc is half as wide as from its center.
    through = arcs.sweep / 2 + np.where(arcs.crosses, np.pi, 0.0)
    turned = np.where(arcs.inside > 0, inside, outside)
    turn[rows] = np.where(arcs.radius == 0, 0.0, np.where(arcs.through, through, turned)) + arcs.unknown
    return np.degrees(turn)


def to_machine(point: Points, entry: Floats | float) -> tuple[Floats, Floats]:
    """
    X as a radius [mm], never negative, and C [deg] of plane points; `entry` is C on the plane's +X side.

    C is entry - 180 (not included) to entry + 180; at the center itself it is entry.
    """
    return np.abs(point), np.asarray(entry + np.degrees(np.angle(point)))


def to_plane(x: Floats, c_angle: Floats, entry: Floats | float) -> Points:
    """Plane points of X [mm, radius] and C [deg]; turns back what `to_machine` does."""
    return np.asarray(x * np.exp(1j * np.radians(c_angle - entry)))


@_quiet
def c_angles(
    start: Points, end: Points, center: Points, kind: Codes, section: NDArray[np.integer], entry: Floats
) -> tuple[Floats, Floats]:
    """
    C at the start and at the end of each move [deg], continuous along each section.

    section: int[n], number of the section, moves of one section together; below 0 outside, which gives NaN.
    entry: float64[sections] [deg], C at the G12.1 of each section.
    The position at G12.1 counts as angle 0 (B-62764EN/01 p. 51), and C does not jump there: a section that begins on
    the negative side of X has entry there, and the plane lies turned by 180 deg against the machine.
    After an unknown move C goes on the shorter way from where it was last known: right but for whole turns.
    """
    count = len(section)
    sweep = c_sweep(start, end, center, kind)
    leaving, arriving = _directions(_cleared(start), _cleared(end), center, kind)
    known = ~np.isnan(sweep) & (section >= 0)
    row = np.arange(count)
    begins = np.append(True, section[1:] != section[:-1])[:count]
    first = np.maximum.accumulate(np.where(begins, row, 0))
    turned = ((start.imag == 0) & (start.real < 0))[first]
    seen = known & (leaving != 0)
    last = np.maximum.accumulate(np.where(seen, row, -1))
    before = np.append(-1, last[:-1])[:count]
    continues = before >= first

    zero = np.where(turned, -1.0 + 0j, 1.0 + 0j)
    here = np.degrees(_angle_between(zero, leaving))
    jump = np.where(continues, np.degrees(_angle_between(arriving[before], leaving)), here)
    total = np.cumsum(np.where(known, np.where(seen, jump, 0.0) + sweep, 0.0))
    earlier = np.append(0.0, total[:-1])[:count]
    turns = total - sweep - earlier[first]
    # The sum knows the whole turns, the point itself the rest; so no rounding piles up.
    turns = np.where(seen, here + 360 * np.round((turns - here) / 360), turns)
    c_from = np.where(known, entry[np.where(section >= 0, section, 0)] + turns, np.nan)
    return c_from, c_from + sweep


def _directions(start: Points, end: Points, center: Points, kind: Codes) -> tuple[Points, Points]:
    """Where start and end are seen from the center; at the center itself, where the move goes to or comes from."""
    leave, arrive = end - start, start - end
    arcs = _rows_of_arcs(kind)
    ahead = np.where(kind[arcs] == Motion.CCW, 1j, -1j)
    leave[arcs] = ahead * (start[arcs] - center[arcs])
    arrive[arcs] = -ahead * (end[arcs] - center[arcs])
    return np.where(start == 0, leave, start), np.where(end == 0, arrive, end)
