"""Paths in the polar plane between two ramps or moves of Z, as loops that may close; and their rings."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np

from polarcheck.columns.path.lengths import same_place
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, column_at, first_in_run, side_by_side
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import angle_between, arc_sweep
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.regularity.rings import Ring, rings_in
from polarcheck.geometry.regularity.symmetry import Symmetry, symmetry_of

#: Blocks of a loop that is looked at, and how much work is done in one file: the squares of these numbers together, and
#: what each loop takes beside them.
_FEWEST, _MOST, _WORK, _WORK_OF_LOOP = 4, 64, 60_000, 300
#: Edges that are as long as another one, as a share of all, where a contour may be regular; and what is as long [mm].
_ALIKE, _AS_LONG = 0.25, 0.02
#: Readings of X by which a contour may be regular: as it is, and as the other of diameter and radius.
_X_FACTORS = (1.0, 2.0, 0.5)
#: Moves before a loop closes; arcs and ends of arcs that show by being tangent how X is meant; what is tangent [rad].
_LEADS, _FEWEST_ARCS, _FEWEST_ENDS, _SMOOTH = 4, 2, 4, 0.02
#: Ends of arcs that one wrong word turns.
_TURNED = 3
#: An arc of more is a full circle [rad].
_FULL = 6.2


class PlaneLoop(msgspec.Struct, frozen=True):
    """
    A path of n blocks at feed in the polar plane, without a ramp or a move of Z in it.

    row: int[n + 1], the first of them is the move before. point: complex128[n + 1] [mm], where the blocks begin and
    end. turns: int[n], -1 for a clockwise arc, 0 for a line, 1. radius: float64[n], R of an arc with its sign [mm], NaN
    without. to_center: complex128[n], from the start of an arc [mm]. tolerance: what is the same place [mm].
    last_digit: half of it, along both axes [mm].
    """

    row: Rows
    point: Points
    turns: Rows
    radius: Floats
    to_center: Points
    tolerance: float
    last_digit: complex

    @property
    def rings(self) -> Iterator[Ring]:
        """The closed contours in it."""
        return self.rings_through(self.point)

    def rings_through(self, point: Points) -> Iterator[Ring]:
        """The same with its blocks ending at other points."""
        return rings_in(point, self.bulges(point))

    def symmetry(self, point: Points | None = None) -> Symmetry | None:
        """Symmetry of the most regular ring; None where the path does not close."""
        rings = self.rings if point is None else self.rings_through(point)
        return max((symmetry_of(ring, self.tolerance) for ring in rings), key=lambda found: found.fixed, default=None)

    def bulges(self, point: Points) -> Floats:
        """The tangent of a quarter of the sweep of each block, 0 for lines, NaN for arcs that are no circle."""
        bulge = np.zeros(len(self.turns))
        arc = np.flatnonzero(self.turns)
        if not len(arc):
            return bulge
        start, end, radius = point[arc], point[arc + 1], self.radius[arc]
        half = np.abs(end - start) / 2
        by_radius = 2 * np.arcsin(np.minimum(half / np.maximum(np.abs(radius), 1e-9), 1.0))
        by_radius[half > np.abs(radius) + self.tolerance] = np.nan
        by_radius = np.where(radius < 0, 2 * np.pi - by_radius, by_radius)
        center = start + self.to_center[arc]
        kind = np.where(self.turns[arc] < 0, Motion.CW, Motion.CCW).astype(np.int16)
        by_center = np.abs(arc_sweep(start, end, center, kind))
        by_center[np.abs(np.abs(end - center) - np.abs(start - center)) > 2 * self.tolerance] = np.nan
        sweep = np.where(np.isnan(radius), by_center, by_radius)
        bulge[arc] = self.turns[arc] * np.tan(np.where(sweep < _FULL, sweep, np.nan) / 4)
        return bulge


def smooth_share(loop: PlaneLoop, point: Points) -> float:
    """
    The share of the ends of arcs at which a closed loop is smooth; 0 where there are fewer than four, or it is open.

    point: where its blocks end.
    """
    last = len(loop.turns)
    first = next(
        (index for index in range(min(_LEADS, last - 2)) if abs(point[index] - point[last]) <= loop.tolerance), None
    )
    if first is None or np.count_nonzero(loop.turns[first:]) < _FEWEST_ARCS:
        return 0.0
    bulge = loop.bulges(point)[first:]
    chord = np.diff(point)[first:]
    turned = 2 * np.arctan(bulge)
    into, out = chord * np.exp(1j * turned), chord * np.exp(-1j * turned)
    turn = np.abs(np.angle(out * np.roll(into, 1).conj()))
    at_arc = (loop.turns[first:] != 0) | (np.roll(loop.turns[first:], 1) != 0)
    if np.count_nonzero(at_arc) < _FEWEST_ENDS or np.isnan(bulge).all():
        return 0.0
    return float(np.count_nonzero(turn[at_arc] <= _SMOOTH) / np.count_nonzero(at_arc))


def loops_of(trace: Trace) -> list[PlaneLoop]:
    """The loops that may be regular, each contour once, in the order of the program."""
    if not len(trace.mode.sections):
        return []
    at_feed, compensation = trace.axes.at_feed, trace.compensation
    ramp = compensation.starts_up | compensation.cancels
    deeper = trace.path.moves_z & ~trace.path.travels
    begins = ramp | trace.mode.enters | deeper | (trace.path.travels & ~at_feed)
    rows = np.flatnonzero(trace.path.on_plane & at_feed & ~ramp & ~np.isnan(trace.path.end + trace.path.start))
    if not len(rows):
        return []
    stretch = np.cumsum(begins, dtype=np.int64)[rows]
    first = first_in_run(stretch).nonzero()[0]
    count = np.diff(first, append=len(rows))
    fits = (count >= _FEWEST) & (count <= _MOST)
    if not fits.any():
        return []
    chosen = np.repeat(fits, count)
    rows, stretch, count = rows[chosen], stretch[chosen], count[fits]
    step = trace.path.end[rows] - trace.path.start[rows]
    first = np.append(0, np.cumsum(count)[:-1])
    fits = np.zeros(len(first), bool)
    for factor in _X_FACTORS:
        length = np.hypot(step.real * factor, step.imag)
        fits |= np.add.reduceat(_as_long_as_another(length, stretch), first, dtype=np.int64) >= _ALIKE * count
        if fits.all():
            break
    if not fits.all():
        fits |= _is_nearly_smooth(trace.path.moves_of(rows), stretch, first)
    return [*_different(trace, rows, first[fits], count[fits])]


def _is_nearly_smooth(path: PlanePath, stretch: Rows, first: Rows) -> Mask:
    """Stretches of which nearly all arcs are tangent to what is beside them: one word turns three of their ends."""
    if not path.is_arc.any():
        return np.zeros(len(first), bool)
    at_arc = (path.is_arc[1:] | path.is_arc[:-1]) & (np.diff(stretch) == 0)
    turn = np.abs(angle_between(path.arriving[:-1], path.leaving[1:]))
    ends, corners = (
        np.add.reduceat(np.append(False, which), first, dtype=np.int64) for which in (at_arc, at_arc & (turn > _SMOOTH))
    )
    return np.asarray((corners > 0) & (corners <= _TURNED) & (ends >= _FEWEST_ENDS + corners))


def _as_long_as_another(length: Floats, stretch: Rows) -> Mask:
    """Blocks beside which their stretch has another one as long."""
    order = np.lexsort((length, stretch))
    near = (np.diff(length[order]) <= _AS_LONG) & (np.diff(stretch[order]) == 0)
    return column_at(len(length), order, np.append(near, False) | np.append(False, near), False)


def _different(trace: Trace, rows: Rows, first: Rows, count: Rows) -> Iterator[PlaneLoop]:
    """A loop for each of these stretches of the rows, but for those that repeat an earlier one."""
    if not len(first):
        return
    digits = trace.lengths.half_of_last_digit(rows[first])
    travels = np.flatnonzero(trace.path.travels)
    by_radius = trace.lengths.length_of(trace.machine.arcs.radius_word)
    to_center = np.nan_to_num(trace.path.center - trace.path.start)
    work, keys = 0, set[bytes]()
    for begin, size, digit in side_by_side(first, count, digits):
        rows_of_loop = rows[begin : begin + size]
        point = np.append(trace.path.start[rows_of_loop[:1]], trace.path.end[rows_of_loop])
        motion = trace.axes.motion[rows_of_loop]
        turns = np.where(motion == Motion.CW, -1, np.where(motion == Motion.CCW, 1, 0)).astype(np.int64)
        radius = np.where(turns != 0, by_radius[rows_of_loop], np.nan)
        key = np.round(point, 5).tobytes() + turns.tobytes() + radius.tobytes()
        if key in keys:
            continue
        keys.add(key)
        work += size**2 + _WORK_OF_LOOP
        if work > _WORK:
            return
        above = int(travels[max(int(np.searchsorted(travels, rows_of_loop[0])) - 1, 0)])
        yield PlaneLoop(
            np.append(min(above, rows_of_loop[0]), rows_of_loop),
            point,
            turns,
            radius,
            to_center[rows_of_loop],
            same_place(digit),
            digit,
        )
