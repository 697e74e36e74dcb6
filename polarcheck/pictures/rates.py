"""The rates of C and X over time: points of a curve for each move, closer together where it bends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from polarcheck.arrays import Floats, Mask, Points, Rows, States
from polarcheck.geometry.plane import arc_sweep, cross, dot, quiet
from polarcheck.machines.modal import Motion
from polarcheck.pictures.moves import SectionMoves

#: Points for each turn of C by so much, and of an arc about its own center [rad].
_STEP = np.radians(4.0)
#: Points of one move.
_MOST_OF_MOVE = 120


@dataclass(frozen=True, slots=True)
class Samples:
    """
    Points of curves, n of them: of which move, t: after the begin of the first one [s], c_feed [deg/min], above 0 where
    C rises, x_feed [mm/min], above 0 outward, feed along the path [mm/min].
    """

    move: Rows
    t: Floats
    c_feed: Floats
    x_feed: Floats
    feed: Floats

    def some(self, chosen: Rows) -> Samples:
        """Some of the points."""
        return Samples(*(getattr(self, name)[chosen] for name in Samples.__slots__))


@dataclass(frozen=True, slots=True)
class Ways:
    """
    Ways of one kind, k of them, each of a move or of a part of one: start, end, center [mm], kind as in polar.
    feed [mm/min]. begin, time [s]. held: C turns at a rate that is held, and the feed goes with it. move: of each.
    """

    start: Points
    end: Points
    center: Points
    kind: States
    feed: Floats
    begin: Floats
    time: Floats
    held: Mask
    move: Rows


def ways(found: SectionMoves, chosen: Rows) -> Ways:
    """Of some moves, those left out whose time is not known; the parts of one on which automatic override acts."""
    pieces = found.dynamics.pieces
    moves, time, begin = found.moves, found.time, found.begin
    of_path = found.of_path[chosen]
    slowed = (of_path >= 0) & np.append(found.dynamics.is_slowed, False)[of_path]
    plain = chosen[~slowed & ~np.isnan(time[chosen])]
    # Where in the order of the chosen moves the one of each piece stands.
    number = np.full(len(found.dynamics.moves) + 1, -1)
    number[of_path] = chosen
    number[-1] = -1
    move = number[pieces.move]
    part = np.flatnonzero(move >= 0)
    part = part[~np.isnan(time[move[part]])]
    own, part_time = move[part], pieces.time()[part]
    done = np.cumsum(part_time) - part_time
    first = np.searchsorted(own, own)
    rows = np.concatenate([plain, own])
    order = np.argsort(rows, kind="stable")
    return Ways(
        start=np.concatenate([moves.start[plain], pieces.start[part]])[order],
        end=np.concatenate([moves.end[plain], pieces.end[part]])[order],
        center=np.concatenate([moves.center[plain], pieces.center[part]])[order],
        kind=np.concatenate([moves.kind[plain], pieces.kind[part]])[order],
        feed=np.concatenate([found.true_feed[plain], pieces.feed[part]])[order],
        begin=np.concatenate([begin[plain], begin[own] + done - done[first]])[order],
        time=np.concatenate([time[plain], part_time])[order],
        held=np.concatenate([np.zeros(len(plain), bool), pieces.held[part]])[order],
        move=rows[order],
    )


@quiet
def samples(path: Ways, held_at: float) -> Samples:
    """
    The curves of some ways. held_at: the rate at which C is held [deg/min].

    Half of the points of a way divide it evenly, the other half the turn of C, lest a narrow peak where the tool passes
    the center fall between them: on a line that is seen under the angle w from the foot of the perpendicular d, at the
    way d tan(w) from it; on an arc, with v from the point nearest to the center of C about its own, at tan(v / 2) =
    |R - e| / (R + e) tan(w / 2), by which r^2 dw is proportional to dv. Rates as in geometry/polar. Time goes with the
    way or, where C is held, with its turn.
    """
    start, end, center, kind = path.start, path.end, path.center, path.kind
    is_arc = kind != Motion.LINE
    sweep = arc_sweep(start, end, center, kind)
    long = np.where(is_arc, 1.0, np.abs(end - start))
    u = np.where(long > 0, (end - start) / long, 0)
    offset, foot = np.abs(cross(start, u)), dot(start, u)
    # Of arcs: the angle from the nearest point to the start, in the direction of travel, and how the turn of C grows.
    radius, away = np.abs(start - center), np.abs(center)
    to_near = np.where(away > 0, -center, 1.0)
    first = np.copysign(1.0, sweep) * np.angle((start - center) / to_near)
    narrow = np.abs(radius - away) / (radius + away)

    def seen_at(share: Floats, of: Rows) -> Floats:
        """The angle from the nearest point under which a point of the way is seen from the center of C [rad]."""
        of_arc = _turned(first[of] + share * np.abs(sweep[of]), 1 / narrow[of])
        return np.where(is_arc[of], of_arc, np.arctan2(foot[of] + share * long[of], offset[of]))

    every = np.arange(len(start))
    seen_first = seen_at(np.zeros(len(start)), every)
    turn = np.nan_to_num(seen_at(np.ones(len(start)), every) - seen_first)
    count = np.ceil(np.maximum(turn, np.where(is_arc, np.abs(sweep), 0)) / _STEP)
    count = np.clip(np.nan_to_num(count), 1, _MOST_OF_MOVE).astype(np.int64)

    # The nearest point, where rates are highest.
    ahead = np.where(is_arc, np.where(first <= 0, -first, 2 * np.pi - first) / np.abs(sweep), -foot / long)
    passes = (ahead > 0) & (ahead < 1)

    # Each way has its two ends, count - 1 points that divide it, as many that divide the turn of C, and the nearest.
    each = 2 * count + passes
    of = np.repeat(np.arange(len(start)), each)
    place = np.arange(len(of)) - np.repeat(np.cumsum(each) - each, each)
    evenly = place <= count[of]
    share = np.where(evenly, place / count[of], (place - count[of]) / count[of])
    seen = seen_first[of] + share * turn[of]
    of_line = np.where(offset[of] > 0, (offset[of] * np.tan(seen) - foot[of]) / long[of], share)
    of_arc = (_turned(seen, narrow[of]) - first[of]) / np.abs(sweep[of])
    by_turn = np.where(is_arc[of], of_arc, of_line)
    share = np.clip(np.where(evenly | ~np.isfinite(by_turn), share, by_turn), 0.0, 1.0)
    share = np.where(place == 2 * count[of], ahead[of], share)
    order = np.lexsort((share, of))
    of, share = of[order], share[order]

    spoke = (start - center)[of] * np.exp(1j * sweep[of] * share)
    point = np.where(is_arc[of], center[of] + spoke, start[of] + share * (end - start)[of])
    along = np.where(is_arc[of], 1j * np.sign(sweep[of]) * spoke / radius[of], u[of])
    far = np.abs(point)
    stands = along == 0
    per_way = np.where(stands, 0.0, np.degrees(cross(point, along) / far**2))
    feed = np.where(path.held[of], held_at / np.abs(per_way), path.feed[of])
    passed = np.where(path.held[of] & (turn[of] > 0), (seen_at(share, of) - seen_first[of]) / turn[of], share)
    return Samples(
        move=path.move[of],
        t=path.begin[of] + passed * path.time[of],
        c_feed=np.where(stands, 0.0, feed * per_way),
        x_feed=np.where(stands, 0.0, feed * dot(point, along) / far),
        feed=feed,
    )


def _turned(angle: Floats, factor: Floats) -> Floats:
    """2 arctan(factor tan(angle / 2)), whole turns kept [rad]."""
    whole = 2 * np.pi * np.round(angle / (2 * np.pi))
    half = (angle - whole) / 2
    return np.asarray(whole + 2 * np.arctan2(factor * np.sin(half), np.cos(half)))


def fewer(curves: Samples, kept: Mask, most: int) -> Samples:
    """
    At most about so many points: of each short time the first, and the highest and lowest of each curve.

    kept: bool[moves], no point of these is left out.
    """
    count = len(curves.move)
    if count <= most:
        return curves
    columns: Sequence[Floats] = (curves.c_feed, curves.x_feed, curves.feed)
    bins = max(most // (2 * len(columns) + 1), 1)
    whole = float(curves.t[-1] - curves.t[0])
    # Where nothing takes time the points are divided by their number.
    part = (curves.t - curves.t[0]) / whole if whole > 0 else np.arange(count) / count
    number = np.minimum((part * bins).astype(np.int64), bins - 1)
    chosen = kept[curves.move]
    begins = np.append(True, np.diff(number) != 0)
    chosen[begins] = True
    ends = np.append(begins[1:], True)
    for column in columns:
        order = np.lexsort((column, number))
        chosen[order[begins]] = True
        chosen[order[ends]] = True
    chosen[-1] = True
    return curves.some(np.flatnonzero(chosen))
