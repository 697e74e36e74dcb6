"""The moves of a section over time as points of curves, closer together where a curve bends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.foundation.arrays import (
    Floats,
    Mask,
    Points,
    Rows,
    Table,
    column_at,
    first_in_run,
    last_in_run,
    mask_at,
)
from polarcheck.geometry import rates as of_moves
from polarcheck.geometry.plane_path import SpacePath
from polarcheck.view.drawn_moves import SectionMoves

#: How far a point may lie from the curves between its neighbours to be left out [mm], [deg], as a share of rates.
_NEAR, _NEAR_ANGLE, _SHARE = 0.002, 0.02, 0.002
#: How often every second point is tried.
_ROUNDS = 16
#: Of more points than this many times those that may remain, no single ones are tried.
_FAR_TOO_MANY = 8


class Samples(Table, frozen=True):
    """
    The n points of the curves.

    move: int64[n], the move of each point.
    t: float[n], the time since the begin of the first move [s].
    c_feed: float[n], positive where C rises; NaN where C jumps [deg/min].
    x_feed: float[n], positive outward [mm/min].
    feed: float[n], along the path [mm/min].
    point: complex[n], the center of the cutter [mm].
    z: float[n] [mm].
    angle: float[n], C of the machine, continuous along the section [deg].
    """

    move: Rows
    t: Floats
    c_feed: Floats
    x_feed: Floats
    feed: Floats
    point: Points
    z: Floats
    angle: Floats


class Segments(SpacePath, frozen=True):
    """
    The k segments of a path, each a move or a part of one.

    feed: float[k] [mm/min].
    begin, time: float[k] [s].
    held: bool[k], C turns at a constant rate, and the feed follows.
    move: int64[k], the move of each segment.
    jumps: bool[k], it passes through the center of C.
    waits: float[k], how much of its time the tool stands in the center, while C makes half a turn [s].
    c_from: float[k], C at the start of its move [deg].
    """

    feed: Floats
    begin: Floats
    time: Floats
    held: Mask
    move: Rows
    jumps: Mask
    waits: Floats
    c_from: Floats


def path_segments(table: SectionMoves, chosen: Rows) -> Segments:
    """Return the chosen moves of known time; a move with automatic override is divided into its parts."""
    pieces = table.dynamics.pieces
    moves, time, begin = table.moves, table.time, table.begin
    of_path = table.of_path[chosen]
    slowed = (of_path >= 0) & np.append(table.dynamics.is_slowed, False)[of_path]
    plain = chosen[~slowed & ~np.isnan(time[chosen])]
    # The number of the chosen move of each piece, -1 for other moves.
    number = column_at(len(table.dynamics.moves) + 1, of_path, chosen, -1)
    number[-1] = -1
    move = number[pieces.move]
    part = np.flatnonzero(move >= 0)
    part = part[~np.isnan(time[move[part]])]
    of_part, part_time, length = move[part], pieces.time()[part], pieces.length[part]
    first = np.searchsorted(of_part, of_part)
    done = np.cumsum(part_time) - part_time
    gone = np.cumsum(length) - length
    gone -= gone[first]
    rows = np.concatenate([plain, of_part])
    order = np.argsort(rows, kind="stable")
    start, end, center, kind = (
        np.concatenate([getattr(moves, name)[plain], getattr(pieces, name)[part]])[order]
        for name in ("start", "end", "center", "kind")
    )
    jumps = np.isinf(of_moves.c_feed(start, end, center, kind, 1.0))
    z_from, z_to = (column[rows] for column in table.z)
    with np.errstate(all="ignore"):
        whole = np.append(moves.length, 0.0)[of_part]
        low, high = gone / whole, (gone + length) / whole
        waiting = np.where(jumps[np.argsort(order)][len(plain) :], 180 * 60 / pieces.allowed, 0.0)
    rise = z_to - z_from
    share_from = np.concatenate([np.zeros(len(plain)), low])
    share_to = np.concatenate([np.ones(len(plain)), high])
    return Segments(
        start=start,
        end=end,
        center=center,
        kind=kind,
        z_start=(z_from + share_from * rise)[order],
        z_end=(z_from + share_to * rise)[order],
        feed=np.concatenate([table.true_feed[plain], pieces.feed[part]])[order],
        begin=np.concatenate([begin[plain], begin[of_part] + done - done[first]])[order],
        time=np.concatenate([time[plain], part_time])[order],
        held=np.concatenate([np.zeros(len(plain), bool), pieces.held[part]])[order],
        move=rows[order],
        jumps=jumps,
        waits=np.concatenate([np.zeros(len(plain)), waiting])[order],
        c_from=table.moves.c_angles[0][rows][order],
    )


def thinned(curves: Samples, keep: Mask, most: int) -> tuple[Samples, float]:
    """
    Return about `most` points at most, and how far the positions between them are off [mm].

    keep: bool[moves], moves whose points all stay, unless these are too many themselves.

    First points go that lie on the curves between their neighbours. If too many are left, the ends of moves stay, if
    these are not too many, and of each short interval the first point, and the highest and lowest of each curve.
    """
    if len(curves) <= most:
        return curves, 0.0
    if np.count_nonzero(keep[curves.move]) > most:
        keep = np.zeros_like(keep)
    rest = np.arange(len(curves))
    for number in range(_ROUNDS if len(rest) <= _FAR_TOO_MANY * most else 0):
        if len(rest) <= most:
            break
        rest = _without_straight(curves, rest, keep, number % 2)
    if len(rest) > most:
        rest = rest[_extremes(curves[rest], keep, most)]
    chosen = curves[rest]
    between = np.interp(curves.t, chosen.t, chosen.point.real) + 1j * np.interp(curves.t, chosen.t, chosen.point.imag)
    return chosen, float(np.abs(between - curves.point).max(initial=0.0))


def _without_straight(curves: Samples, rest: Rows, keep: Mask, first: int) -> Rows:
    """Return the points without every second one, if it lies on the curves between its neighbours."""
    middle = np.arange(1 + first, len(rest) - 1, 2)
    low, inner, high = rest[middle - 1], rest[middle], rest[middle + 1]
    time = curves.t[high] - curves.t[low]
    part = np.divide(curves.t[inner] - curves.t[low], time, out=np.full(len(inner), 0.5), where=time > 0)

    def off(column: Floats | Points) -> Floats:
        return np.asarray(np.abs(column[inner] - column[low] - part * (column[high] - column[low])))

    near = (off(curves.point) <= _NEAR) & (off(np.abs(curves.point)) <= _NEAR) & (off(curves.angle) <= _NEAR_ANGLE)
    near &= ~(off(curves.z) > _NEAR)
    for column in (curves.c_feed, curves.x_feed, curves.feed):
        finite = np.abs(column[np.isfinite(column)])
        near &= off(column) <= _SHARE * float(finite.max(initial=0.0))
    return rest[~mask_at(len(rest), middle[near & ~keep[curves.move[inner]]])]


def _extremes(curves: Samples, keep: Mask, most: int) -> Rows:
    """Return the ends of moves, and of each short interval the first point and the highest and lowest of each curve."""
    count = len(curves)
    columns: Sequence[Floats] = (curves.c_feed, curves.x_feed, curves.feed)
    bins = max(most // (4 * len(columns)), 1)
    whole = float(curves.t[-1] - curves.t[0])
    # Without any time the points are divided by their number.
    part = (curves.t - curves.t[0]) / whole if whole > 0 else np.arange(count) / count
    number = np.minimum((part * bins).astype(np.int64), bins - 1)
    chosen = keep[curves.move]
    begins, ends = first_in_run(number), last_in_run(number)
    chosen[begins] = True
    for column in columns:
        order = np.lexsort((column, number))
        chosen[order[begins]] = True
        chosen[order[ends]] = True
    chosen[-1] = True
    is_end = last_in_run(curves.move)
    if np.count_nonzero(is_end) <= most:
        chosen |= is_end
    return np.flatnonzero(chosen)
