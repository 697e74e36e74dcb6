"""Curves of contours and of tool center paths as straight segments; lengths in mm, plane points complex, x + 1j*c."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, Table
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.states import Motion
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.plane import arc_sweep
from polarcheck.geometry.tolerances import CHORDS_OF_FILE, TOUCH, ZERO

#: A chord shorter than this share of the others is merged with its neighbour.
_STUB = 1e-3


class Curves(Table, frozen=True):
    """
    Curves of a contour or of a tool center path, n of them in the order in which they run.

    start, end, center: complex128[n] [mm], center NaN for lines. kind: int16[n], Motion.
    loop: int[n], number of the run of blocks from a start-up to its cancel at one depth. row: int[n], programmed row.
    """

    start: Points
    end: Points
    center: Points
    kind: States
    loop: Rows
    row: Rows


class Segments(Table, frozen=True):
    """
    Straight parts of moves, n of them, loop after loop.

    start, end: complex128[n] [mm].
    move: int[n], the move that each is part of.
    loop: int[n], the loop of that move.
    """

    start: Points
    end: Points
    move: Rows
    loop: Rows

    def shifted(self, by: NDArray[np.floating]) -> Segments:
        """The segments, each shifted along X [mm]."""
        return Segments(self.start + by, self.end + by, self.move, self.loop)


def segments(moves: Curves, tolerance: float) -> Segments:
    """
    The lines and chords of all known moves with a length. The sagitta of chords is at most a quarter of the tolerance.

    Overlapping arcs of one circle have the same chords: their ends lie at whole multiples of one angle.
    Raises TooHardError for more than CHORDS_OF_FILE, and where the time is over.
    """
    keep_time()
    start, end, center = moves.start, moves.end, moves.center
    arcs = (moves.kind == Motion.CW) | (moves.kind == Motion.CCW)
    is_known = ~(np.isnan(start) | np.isnan(end) | (arcs & np.isnan(center)))
    count = is_known.astype(np.int64)
    round_ = np.flatnonzero(arcs & is_known)
    spoke, last = start[round_] - center[round_], end[round_] - center[round_]
    sweep = arc_sweep(start[round_], end[round_], center[round_], moves.kind[round_])
    unit = _angle_of_chords(np.maximum(np.abs(spoke), np.abs(last)), tolerance) * np.where(sweep < 0, -1, 1)
    begins = np.angle(spoke) / unit
    first, until_ = np.floor(begins + _STUB) + 1, np.ceil(begins + sweep / unit - _STUB)
    count[round_] = np.maximum(until_ - first, 0).astype(np.int64) + 1
    if len(round_) and count.sum() > CHORDS_OF_FILE + len(count):
        raise TooHardError(
            f"arcs of {count.sum()} chords are too many to look at: check its sections in separate files"
        )

    move = np.repeat(np.arange(len(start)), count)
    begin, until, loop = start[move], end[move], moves.loop[move].astype(np.int64, copy=False)
    on_arc = np.flatnonzero(arcs[move])
    which = np.repeat(np.arange(len(round_)), count[round_])
    of_arc = round_[which]
    index = on_arc - (np.cumsum(count) - count)[of_arc]
    turned = (first[which] + index - 1) * unit[which] - np.angle(spoke)[which]
    share = np.divide(turned, sweep[which], out=np.zeros(len(which)), where=index > 0)
    # An end that is not quite on the circle is reached in a spiral, at the same angles as by the tool center.
    growth = np.where(spoke == 0, 0, np.abs(last) / np.maximum(np.abs(spoke), ZERO) - 1)
    on = spoke[which] * (1 + growth[which] * share) * np.exp(1j * sweep[which] * share)
    begin[on_arc] = np.where(index == 0, begin[on_arc], center[of_arc] + on)
    inner = on_arc[1:][of_arc[1:] == of_arc[:-1]]
    until[inner - 1] = begin[inner]
    result = Segments(begin, until, move, loop)
    has_length = np.abs(until - begin) > ZERO
    result = result if has_length.all() else result[has_length]
    in_order = np.all(result.loop[1:] >= result.loop[:-1])
    return result if in_order else result[np.argsort(result.loop, kind="stable")]


def _angle_of_chords(radius: Floats, tolerance: float) -> Floats:
    """The angle of the chords of arcs with this R [rad]; it divides a full circle."""
    flat = np.clip(tolerance / 4 / np.maximum(radius, ZERO), 1e-9, 0.25)
    return np.asarray(2 * np.pi / np.ceil(np.pi / np.arccos(1 - flat)))


def chord_counts(moves: Curves, tolerance: float) -> Floats:
    """The approximate number of chords of each move; 0 for lines."""
    result = np.zeros(len(moves))
    arcs = ((moves.kind == Motion.CW) | (moves.kind == Motion.CCW)) & ~np.isnan(moves.start + moves.end + moves.center)
    start, end, center = moves.start[arcs], moves.end[arcs], moves.center[arcs]
    unit = _angle_of_chords(np.maximum(np.abs(start - center), np.abs(end - center)), tolerance)
    result[arcs] = np.abs(arc_sweep(start, end, center, moves.kind[arcs])) / unit
    return result


def first_of_its_kind(curves: Curves) -> Mask:
    """True for the first of equal curves in a loop: a repeated pass needs no second check."""
    center = np.where(np.isnan(curves.center), 0, curves.center)
    columns = [
        *(np.rint(part / TOUCH) for point in (curves.start, curves.end, center) for part in (point.real, point.imag))
    ]
    columns += [curves.loop, np.where(np.isnan(curves.center), 0, curves.kind)]
    key = np.zeros(len(curves), np.uint64)
    for column in columns:
        # An odd number without a pattern: different curves have different sums but for a chance of 2 ** -64.
        key = (key + column.astype(np.int64).view(np.uint64)) * np.uint64(0x9E3779B97F4A7C15)
        key ^= key >> np.uint64(29)
    _, first = np.unique(key, return_index=True)
    result = np.zeros(len(curves), bool)
    result[first] = True
    return result


def directions(start: Points, end: Points, center: Points, kind: States) -> tuple[Points, Points]:
    """The unit directions of curves at their start and at their end."""
    turning = np.where(kind == Motion.CCW, 1j, -1j)
    is_arc = ~np.isnan(center)
    vector = end - start
    before = np.where(is_arc, turning * (start - center), vector)
    after = np.where(is_arc, turning * (end - center), vector)
    return _unit(before), _unit(after)


def _unit(vector: Points) -> Points:
    unit: Points = vector / np.maximum(np.abs(vector), ZERO)
    return unit


def boxes(curves: Curves, first: Rows) -> Floats:
    """Boxes of runs of curves, each from one `first` to the next: least x and c, greatest x and c [mm]."""
    low, high = (
        [extreme(part(curves.start), part(curves.end)) for part in (np.real, np.imag)]
        for extreme in (np.minimum, np.maximum)
    )
    arcs = np.flatnonzero(((curves.kind == Motion.CW) | (curves.kind == Motion.CCW)) & ~np.isnan(curves.center))
    if len(arcs):
        middle = curves.center[arcs]
        reach = np.maximum(np.abs(curves.start[arcs] - middle), np.abs(curves.end[arcs] - middle))
        for side, part in enumerate((middle.real, middle.imag)):
            low[side][arcs], high[side][arcs] = part - reach, part + reach
    sides = [np.minimum.reduceat(side, first) for side in low] + [np.maximum.reduceat(side, first) for side in high]
    return np.array(sides)


def reach_from_start(curves: Curves) -> Floats:
    """The greatest distance of a curve from its start: float64[curves] [mm]."""
    reach = np.abs(curves.end - curves.start)
    arcs = np.flatnonzero(~np.isnan(curves.center))
    start, end, center = curves.start[arcs], curves.end[arcs], curves.center[arcs]
    first, last = np.abs(start - center), np.abs(end - center)
    # Up to half a turn an arc gets no farther than its end; one whose end is off the circle runs in a spiral.
    short = np.abs(arc_sweep(start, end, center, curves.kind[arcs])) <= np.pi
    of_short = np.where(short, reach[arcs] + 2 * np.abs(first - last), np.inf)
    reach[arcs] = np.minimum(of_short, 2 * np.maximum(first, last))
    return reach


def members(loop: Rows, requested: Rows) -> tuple[Rows, Rows]:
    """The rows of each requested loop, loop after loop, and the index of the requested loop of each row."""
    low, high = np.searchsorted(loop, requested), np.searchsorted(loop, requested, side="right")
    group = np.repeat(np.arange(len(requested)), high - low)
    before = np.cumsum(high - low) - (high - low)
    return np.arange(len(group)) - before[group] + low[group], group
