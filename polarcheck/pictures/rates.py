"""The rates of C and X over time, as points of curves, closer together where a curve bends."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.arrays import Floats, Mask, Points, Rows, States
from polarcheck.geometry.plane import arc_sweep, cross, dot, quiet
from polarcheck.machines.modal import Motion
from polarcheck.pictures.moves import SectionMoves

#: The turn of C, or of an arc about its own center, between two points [rad].
_STEP = np.radians(4.0)
#: The most points of one move.
_MOST_OF_MOVE = 120


class Samples(msgspec.Struct, frozen=True):
    """
    The n points of the curves.

    move: int64[n], the move of each point.
    t: float[n], the time since the begin of the first move [s].
    c_feed: float[n], positive where C rises [deg/min].
    x_feed: float[n], positive outward [mm/min].
    feed: float[n], along the path [mm/min].
    """

    move: Rows
    t: Floats
    c_feed: Floats
    x_feed: Floats
    feed: Floats

    def chosen(self, chosen: Rows) -> Samples:
        """Return the chosen points."""
        return Samples(*(getattr(self, name)[chosen] for name in Samples.__struct_fields__))


class Segments(msgspec.Struct, frozen=True):
    """
    The k segments of a path, each a move or a part of one.

    start, end, center: complex[k] [mm].
    kind: int16[k], a Motion.
    feed: float[k] [mm/min].
    begin, time: float[k] [s].
    held: bool[k], C turns at a constant rate, and the feed follows.
    move: int64[k], the move of each segment.
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


def path_segments(table: SectionMoves, chosen: Rows) -> Segments:
    """Return the chosen moves of known time; a move with automatic override is divided into its parts."""
    pieces = table.dynamics.pieces
    moves, time, begin = table.moves, table.time, table.begin
    of_path = table.of_path[chosen]
    slowed = (of_path >= 0) & np.append(table.dynamics.is_slowed, False)[of_path]
    plain = chosen[~slowed & ~np.isnan(time[chosen])]
    # The number of the chosen move of each piece, -1 for other moves.
    number = np.full(len(table.dynamics.moves) + 1, -1)
    number[of_path] = chosen
    number[-1] = -1
    move = number[pieces.move]
    part = np.flatnonzero(move >= 0)
    part = part[~np.isnan(time[move[part]])]
    of_part, part_time = move[part], pieces.time()[part]
    done = np.cumsum(part_time) - part_time
    first = np.searchsorted(of_part, of_part)
    rows = np.concatenate([plain, of_part])
    order = np.argsort(rows, kind="stable")
    return Segments(
        start=np.concatenate([moves.start[plain], pieces.start[part]])[order],
        end=np.concatenate([moves.end[plain], pieces.end[part]])[order],
        center=np.concatenate([moves.center[plain], pieces.center[part]])[order],
        kind=np.concatenate([moves.kind[plain], pieces.kind[part]])[order],
        feed=np.concatenate([table.true_feed[plain], pieces.feed[part]])[order],
        begin=np.concatenate([begin[plain], begin[of_part] + done - done[first]])[order],
        time=np.concatenate([time[plain], part_time])[order],
        held=np.concatenate([np.zeros(len(plain), bool), pieces.held[part]])[order],
        move=rows[order],
    )


@quiet
def samples(path: Segments, held_at: float) -> Samples:
    """
    Return points of the curves along segments. held_at: the rate at which C is held [deg/min].

    Half of the points of a segment divide its length evenly. The other half divide the turn w of C evenly, so that a
    narrow peak near the center does not fall between two points. On a line with its foot of the perpendicular at the
    distance d from the center, the point at the turn w from the foot is d tan(w) away from the foot. On an arc with
    radius R and its center at the distance e, the point has the angle v about the arc's center, from the point nearest
    to the center of C: tan(v / 2) = |R - e| / (R + e) tan(w / 2), since r^2 dw is proportional to dv.

    Rates as in geometry/polar. Time is proportional to the length or, where C is held, to its turn.
    """
    start, end, center, kind = path.start, path.end, path.center, path.kind
    is_arc = kind != Motion.LINE
    sweep = arc_sweep(start, end, center, kind)
    long = np.where(is_arc, 1.0, np.abs(end - start))
    u = np.where(long > 0, (end - start) / long, 0)
    offset, foot = np.abs(cross(start, u)), dot(start, u)
    # On arcs: the angle from the nearest point to the start, in the direction of travel, and the factor of the turn.
    radius, away = np.abs(start - center), np.abs(center)
    to_near = np.where(away > 0, -center, 1.0)
    first = np.copysign(1.0, sweep) * np.angle((start - center) / to_near)
    narrow = np.abs(radius - away) / (radius + away)

    def seen_at(share: Floats, of: Rows) -> Floats:
        """Return the turn of C from the nearest point to the point at this share of the segment [rad]."""
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

    # Each segment has its two ends, count - 1 points that divide its length, as many that divide the turn of C, and the
    # nearest point.
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
    """Return 2 arctan(factor tan(angle / 2)), with whole turns added back [rad]."""
    whole = 2 * np.pi * np.round(angle / (2 * np.pi))
    half = (angle - whole) / 2
    return np.asarray(whole + 2 * np.arctan2(factor * np.sin(half), np.cos(half)))


def thinned(curves: Samples, keep: Mask, most: int) -> Samples:
    """
    Return about `most` points at most: of each short interval the first, and the highest and lowest of each curve.

    keep: bool[moves], moves whose points all stay.
    """
    count = len(curves.move)
    if count <= most:
        return curves
    columns: Sequence[Floats] = (curves.c_feed, curves.x_feed, curves.feed)
    bins = max(most // (2 * len(columns) + 1), 1)
    whole = float(curves.t[-1] - curves.t[0])
    # Without any time the points are divided by their number.
    part = (curves.t - curves.t[0]) / whole if whole > 0 else np.arange(count) / count
    number = np.minimum((part * bins).astype(np.int64), bins - 1)
    chosen = keep[curves.move]
    begins = np.append(True, np.diff(number) != 0)
    chosen[begins] = True
    ends = np.append(begins[1:], True)
    for column in columns:
        order = np.lexsort((column, number))
        chosen[order[begins]] = True
        chosen[order[ends]] = True
    chosen[-1] = True
    return curves.chosen(np.flatnonzero(chosen))
