"""Curves of contours and of tool center paths as straight segments; lengths in mm, plane points complex, x + 1j*c."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, column_at, first_of_each, mask_at, ranges
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import CHORDS_OF_FILE, TOUCH, ZERO

#: A chord shorter than this share of the others is merged with its neighbour.
_STUB = 1e-3


class Curves(PlanePath, frozen=True):
    """
    Curves of a contour or of a tool center path.

    loop: int[n], number of the run of blocks from a start-up to its cancel at one depth. row: int[n], programmed row.
    """

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
    is_known = moves.is_known
    count = is_known.astype(np.int64)
    round_ = np.flatnonzero(moves.is_arc & is_known)
    arcs = moves[round_]
    angle, sweep = np.angle(arcs.start - arcs.center), arcs.sweep
    unit = _angle_of_chords(arcs, tolerance) * np.where(sweep < 0, -1, 1)
    begins = angle / unit
    first, until_ = np.floor(begins + _STUB) + 1, np.ceil(begins + sweep / unit - _STUB)
    count[round_] = np.maximum(until_ - first, 0).astype(np.int64) + 1
    if len(round_) and count.sum() > CHORDS_OF_FILE + len(count):
        raise TooHardError(
            f"arcs of {count.sum()} chords are too many to look at: check its sections in separate files"
        )

    move = np.repeat(np.arange(len(moves)), count)
    begin, until, loop = moves.start[move], moves.end[move], moves.loop[move].astype(np.int64, copy=False)
    which, index = ranges(count[round_] - 1)
    share = ((first[which] + index) * unit[which] - angle[which]) / sweep[which]
    inner = (np.cumsum(count) - count)[round_][which] + index + 1
    begin[inner] = until[inner - 1] = arcs.points(which, share)
    result = Segments(begin, until, move, loop)
    has_length = np.abs(until - begin) > ZERO
    result = result if has_length.all() else result[has_length]
    in_order = np.all(result.loop[1:] >= result.loop[:-1])
    return result if in_order else result[np.argsort(result.loop, kind="stable")]


def _angle_of_chords(arcs: Curves, tolerance: float) -> Floats:
    """The angle of the chords of arcs [rad]; it divides a full circle."""
    radius = np.maximum(np.abs(arcs.start - arcs.center), np.abs(arcs.end - arcs.center))
    flat = np.clip(tolerance / 4 / np.maximum(radius, ZERO), 1e-9, 0.25)
    return np.asarray(2 * np.pi / np.ceil(np.pi / np.arccos(1 - flat)))


def chord_counts(moves: Curves, tolerance: float) -> Floats:
    """The approximate number of chords of each move; 0 for lines."""
    is_chorded = moves.is_arc & moves.is_known
    arcs = moves[is_chorded]
    return column_at(len(moves), is_chorded, np.abs(arcs.sweep) / _angle_of_chords(arcs, tolerance), 0.0)


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
    first, _ = first_of_each(key)
    return mask_at(len(curves), first)


def boxes(curves: Curves, first: Rows) -> Floats:
    """Boxes of runs of curves, each from one `first` to the next: least x and c, greatest x and c [mm]."""
    low, high = (
        [extreme(part(curves.start), part(curves.end)) for part in (np.real, np.imag)]
        for extreme in (np.minimum, np.maximum)
    )
    arcs = np.flatnonzero(curves.is_arc & ~np.isnan(curves.center))
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
    is_arc = ~np.isnan(curves.center)
    arcs = curves[is_arc]
    first, last = np.abs(arcs.start - arcs.center), np.abs(arcs.end - arcs.center)
    # Up to half a turn an arc gets no farther than its end; one whose end is off the circle runs in a spiral.
    of_short = np.where(np.abs(arcs.sweep) <= np.pi, reach[is_arc] + 2 * np.abs(first - last), np.inf)
    reach[is_arc] = np.minimum(of_short, 2 * np.maximum(first, last))
    return reach


def members(loop: Rows, requested: Rows) -> tuple[Rows, Rows]:
    """The rows of each requested loop, loop after loop, and the index of the requested loop of each row."""
    low, high = np.searchsorted(loop, requested), np.searchsorted(loop, requested, side="right")
    group, index = ranges(high - low)
    return low[group] + index, group
