"""Points of a path over time, so close together that straight lines between them are near to all of its curves."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, first_in_run, ranges
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import angle_between, cleared, cross, dot, quiet
from polarcheck.view.rate_curves import Samples, Segments

#: The turn of C, or of an arc about its own center, between two points [rad].
_STEP = np.radians(4.0)
#: The most points of one segment before it is refined.
_MOST_OF_SEGMENT = 120
#: How far a straight line between two points may be off, in the middle between them [mm], [rad].
_NEAR, _NEAR_ANGLE = 0.004, np.radians(0.04)
#: How often an interval is halved at most, and points added by that at most for each point that may remain.
_HALVINGS, _ADDED = 14, 10


@quiet
def samples(path: Segments, held_at: float, sense: int, most: int) -> Samples:
    """
    Return points of the curves along segments.

    held_at: the rate at which C is held [deg/min].
    sense: 1 where C grows with the angle on the plane, -1 where it falls.
    most: how many points may remain, which limits how many are computed.
    """
    sampler = _Sampler(path)
    of, share = sampler.first_shares()
    if len(of) <= _ADDED * most:
        of, share = sampler.refined(of, share, _ADDED * most)
    # In the center C jumps, or turns while the tool waits: two points, before and behind it.
    at_center = path.jumps[of] & (share == sampler.ahead[of])
    count = 1 + at_center
    is_behind = np.repeat(at_center, count)
    is_behind[1:] &= np.diff(np.repeat(np.arange(len(of)), count)) == 0
    is_behind[:1] = False
    of, share, at_center = (np.repeat(column, count) for column in (of, share, at_center))
    point, along = sampler.at(of, share)
    point = np.where(at_center, 0, point)
    toward = _seen(point, along, share, is_behind | (path.jumps[of] & (share > sampler.ahead[of])))
    far = np.abs(point)
    stands = along == 0
    per_way = np.where(stands, 0.0, np.degrees(cross(point, along) / far**2))
    per_way = np.where(at_center, np.nan, np.where(far == 0, 0.0, per_way))
    feed = np.where(path.held[of], held_at / np.abs(per_way), path.feed[of])
    outward = np.where(stands, 0.0, dot(toward, along) / np.abs(toward))
    waits = at_center & (path.waits[of] > 0)
    return Samples(
        move=path.move[of],
        t=sampler.time(of, share, is_behind),
        c_feed=np.where(waits, held_at, sense * feed * per_way),
        x_feed=np.where(waits, 0.0, feed * outward),
        feed=np.where(waits, 0.0, feed),
        point=point,
        z=path.z_start[of] + share * (path.z_end - path.z_start)[of],
        angle=path.c_from[of] + sense * _turned_by(path.move[of], toward, is_behind),
    )


def _seen(point: Points, along: Points, share: Floats, is_behind: Mask) -> Points:
    """Return where points are seen from the center; at the center itself, where the move goes to or comes from."""
    leaves = is_behind | (share == 0)
    return np.where(cleared(point) == 0, np.where(leaves, along, -along), point)


def _turned_by(move: Rows, toward: Points, is_behind: Mask) -> Floats:
    """Return the turn since the start of the move, as seen from the center [deg]; half a turn in it counts as 180."""
    turn = np.append(0.0, np.degrees(angle_between(toward[:-1], toward[1:])))[: len(move)]
    turn[is_behind] = 180.0
    begins = first_in_run(move)
    turn = np.nan_to_num(turn)
    turn[begins] = 0.0
    total = np.cumsum(turn)
    return np.asarray(total - total[np.maximum.accumulate(np.where(begins, np.arange(len(move)), 0))])


class _Sampler:
    """
    Segments by the share of their length, from 0 to 1.

    ahead: the share at the point that is nearest to the center; outside of 0 to 1 if it is beyond the ends.
    """

    def __init__(self, path: Segments) -> None:
        self.path = path
        start, end, center = path.start, path.end, path.center
        self._is_arc = path.kind != Motion.LINE
        self._sweep = path.sweep
        self._long = np.where(self._is_arc, 1.0, np.abs(end - start))
        self._u = np.where(self._long > 0, (end - start) / self._long, 0)
        self._offset, self._foot = np.abs(cross(start, self._u)), dot(start, self._u)
        # On arcs: the angle from the nearest point to the start, in the direction of travel; the factor of the turn.
        self._radius, away = np.abs(start - center), np.abs(center)
        to_near = np.where(away > 0, -center, 1.0)
        self._first = np.copysign(1.0, self._sweep) * np.angle((start - center) / to_near)
        self._narrow = np.abs(self._radius - away) / (self._radius + away)
        first = self._first
        to_arc = np.where(first <= 0, -first, 2 * np.pi - first) / np.abs(self._sweep)
        self.ahead = np.where(self._is_arc, to_arc, -self._foot / self._long)
        every = np.arange(len(start))
        self._seen_first = self._seen(every, np.zeros(len(start)))
        self._turn = np.nan_to_num(self._seen(every, np.ones(len(start))) - self._seen_first)

    def _seen(self, of: Rows, share: Floats) -> Floats:
        """Return the turn of C from the nearest point to the point at this share of the segment [rad]."""
        of_arc = _turned(self._first[of] + share * np.abs(self._sweep[of]), 1 / self._narrow[of])
        return np.where(self._is_arc[of], of_arc, np.arctan2(self._foot[of] + share * self._long[of], self._offset[of]))

    def at(self, of: Rows, share: Floats) -> tuple[Points, Points]:
        """Return points [mm] and directions."""
        start, end, center = self.path.start[of], self.path.end[of], self.path.center[of]
        # On the circle itself, as the rates are.
        spoke = (start - center) * np.exp(1j * self._sweep[of] * share)
        point = np.where(self._is_arc[of], center + spoke, start + share * (end - start))
        return point, np.where(self._is_arc[of], 1j * np.sign(self._sweep[of]) * spoke / self._radius[of], self._u[of])

    def time(self, of: Rows, share: Floats, is_behind: Mask | bool = False) -> Floats:
        """Return the time of points [s]: it is proportional to the length or, where C is held, to its turn."""
        path, turn = self.path, self._turn[of]
        by_turn = (self._seen(of, share) - self._seen_first[of]) / turn
        passed = np.where(path.held[of] & (turn > 0), by_turn, share)
        waited = np.where(is_behind | (share > self.ahead[of]), path.waits[of], 0.0)
        return np.asarray(path.begin[of] + passed * (path.time - path.waits)[of] + waited)

    def first_shares(self) -> tuple[Rows, Floats]:
        """
        Return the segment and the share of the first points, in order.

        Half of the points of a segment divide its length evenly. The other half divide the turn w of C evenly, so that
        a narrow peak near the center does not fall between two points. On a line with its foot of the perpendicular at
        the distance d from the center, the point at the turn w from the foot is d tan(w) away from the foot. On an arc
        with radius R and its center at the distance e, the point has the angle v about the arc's center, from the point
        nearest to the center of C: tan(v / 2) = |R - e| / (R + e) tan(w / 2), since r^2 dw is proportional to dv.
        """
        is_arc, turn = self._is_arc, self._turn
        count = np.ceil(np.maximum(turn, np.where(is_arc, np.abs(self._sweep), 0)) / _STEP)
        count = np.clip(np.nan_to_num(count), 1, _MOST_OF_SEGMENT).astype(np.int64)
        passes = (self.ahead > 0) & (self.ahead < 1)
        # Each segment has its two ends, count - 1 points that divide its length, as many that divide the turn of C, and
        # the nearest point, where rates are highest.
        counts = 2 * count + passes
        of, number = ranges(counts)
        evenly = number <= count[of]
        share = np.where(evenly, number / count[of], (number - count[of]) / count[of])
        seen = self._seen_first[of] + share * turn[of]
        of_line = (self._offset[of] * np.tan(seen) - self._foot[of]) / self._long[of]
        of_arc = (_turned(seen, self._narrow[of]) - self._first[of]) / np.abs(self._sweep[of])
        by_turn = np.where(is_arc[of], of_arc, np.where(self._offset[of] > 0, of_line, share))
        # Through the center all of the turn is in one point.
        by_turn = np.where(self.path.jumps[of], share, by_turn)
        share = np.clip(np.where(evenly | ~np.isfinite(by_turn), share, by_turn), 0.0, 1.0)
        share = np.where(number == 2 * count[of], self.ahead[of], share)
        order = np.lexsort((share, of))
        of, share = of[order], share[order]
        differs = first_in_run(of, share)
        return of[differs], share[differs]

    def refined(self, of: Rows, share: Floats, most: int) -> tuple[Rows, Floats]:
        """Return the points with others between them, where a straight line is off; at most about `most` more."""
        inner = np.flatnonzero((of[1:] == of[:-1]) & (share[1:] > share[:-1]))
        segment, low, high = of[inner], share[inner], share[inner + 1]
        more, shares, added = [of], [share], 0
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            bends = self._bends(segment, low, middle, high)
            segment, low, middle, high = segment[bends], low[bends], middle[bends], high[bends]
            added += len(segment)
            if not len(segment) or added > most:
                break
            more.append(segment)
            shares.append(middle)
            segment = np.concatenate([segment, segment])
            low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        of, share = np.concatenate(more), np.concatenate(shares)
        order = np.lexsort((share, of))
        return of[order], share[order]

    def _bends(self, of: Rows, low: Floats, middle: Floats, high: Floats) -> Mask:
        """Return where the line between two points is off in the middle."""
        ends = [self.at(of, share) for share in (low, middle, high)]
        first, between, last = (point for point, _ in ends)
        is_after = low >= self.ahead[of]
        seen = [
            _seen(point, along, share, is_after)
            for (point, along), share in zip(ends, (low, middle, high), strict=True)
        ]
        # The center itself lies behind the first of two points, before the last.
        begin = self.time(of, low, self.path.jumps[of] & (low == self.ahead[of]))
        time = self.time(of, high) - begin
        part = np.where(time > 0, (self.time(of, middle) - begin) / time, 0.5)
        off = np.abs(between - first - part * (last - first))
        off_x = np.abs(np.abs(between) - np.abs(first) - part * (np.abs(last) - np.abs(first)))
        turn, whole = angle_between(seen[0], seen[1]), angle_between(seen[0], seen[2])
        rise = np.abs(self.path.z_end - self.path.z_start)[of] * np.abs((middle - low) - part * (high - low))
        is_off = (off > _NEAR) | (off_x > _NEAR) | (rise > _NEAR) | (np.abs(turn - part * whole) > _NEAR_ANGLE)
        return np.asarray(is_off & (np.abs(last - first) > 0))


def _turned(angle: Floats, factor: Floats) -> Floats:
    """Return 2 arctan(factor tan(angle / 2)), with whole turns added back [rad]."""
    whole = 2 * np.pi * np.round(angle / (2 * np.pi))
    half = (angle - whole) / 2
    return np.asarray(whole + 2 * np.arctan2(factor * np.sin(half), np.cos(half)))
