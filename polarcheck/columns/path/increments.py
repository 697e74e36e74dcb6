"""Contours that are written in increments, and do not come back to where they began."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.passes import LEADS, Passes
from polarcheck.columns.path.path import NOWHERE
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, cached_property, column_at
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import arc_sweep, cross
from polarcheck.program.machines.axis_table import INCREMENTS

#: Share of the moves of a contour that are increments, and the least number of moves.
_MOSTLY, _LEAST_MOVES = 0.75, 4
#: Largest gap as a share of the size of the contour, and the least one [mm].
_SHARE, _LEAST = 0.1, 0.01
#: How far a contour turns on its way round, without the corner at its start; a spiral turns farther [rad].
_ROUND, _SPIRAL = 4.2, 8.5


class Increments(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    passes: Passes

    @cached_property
    def is_step(self) -> Mask:
        """Rows that write an axis of the plane as a distance."""
        trace = self.trace
        axes = [("X", "U"), *((axis, INCREMENTS[axis]) for axis in trace.axes.other_linear_axes)]
        axes += [pair for pair, _ in trace.axes.virtual_pairs]
        step = trace.blocks.nowhere.copy()
        for absolute, incremental in axes:
            step |= trace.blocks.has(incremental) if incremental else trace.blocks.nowhere
            if trace.blocks.has(absolute).any():
                step |= trace.blocks.has(absolute) & trace.modal.is_step(absolute)
        return np.asarray(step & trace.path.on_plane)

    @cached_property
    def _gaps(self) -> tuple[Rows, Points, Points]:
        """The rows in which such contours end, where they end [mm], and where they began [mm]."""
        passes = self.passes
        nothing = np.zeros(0, np.int64), np.zeros(0, np.complex128), np.zeros(0, np.complex128)
        if not len(passes.first) or not self.is_step.any():
            return nothing
        count = passes.last - passes.first + 1
        steps = np.add.reduceat(self.is_step[passes.row].astype(np.int64), passes.first)
        chosen = passes.compensated & ~passes.closed & (count >= _LEAST_MOVES) & (steps >= _MOSTLY * count)
        chosen &= (np.abs(self._turn) >= _ROUND) & (np.abs(self._turn) < _SPIRAL)
        gap_of_passes = [self._gap_of(which) for which in np.flatnonzero(chosen).tolist()]
        gaps = [gap for gap in gap_of_passes if gap is not None]
        if not gaps:
            return nothing
        row, end, start = zip(*gaps, strict=True)
        return np.array(row, np.int64), np.array(end, np.complex128), np.array(start, np.complex128)

    @cached_property
    def _turn(self) -> Floats:
        """Per pass how far it turns on its way [rad]."""
        passes = self.passes
        kind = np.where(np.isnan(passes.center), Motion.LINE, passes.motion).astype(np.int16)
        turn = np.nan_to_num(arc_sweep(passes.start, passes.end, passes.center, kind))
        return np.asarray(np.add.reduceat(turn + np.nan_to_num(passes.turns[1]), passes.first))

    def _gap_of(self, number: int) -> tuple[int, complex, complex] | None:
        """The row in which a pass ends, that end, and its start; None where it is closed, runs on, or never closes."""
        passes = self.passes
        first, last = int(passes.first[number]), int(passes.last[number])
        head, tail = np.arange(first, min(first + LEADS, last)), np.arange(max(last - LEADS + 1, first), last + 1)
        starts, ends = passes.start[head], passes.end[tail]
        gap = np.abs(starts[:, None] - ends[None, :])
        gap[tail[None, :] - head[:, None] < 2] = np.inf
        i, j = np.unravel_index(int(np.argmin(gap)), gap.shape)
        points = passes.end[first : last + 1]
        size = max(float(np.ptp(points.real)), float(np.ptp(points.imag)))
        rounding = 2 * float(passes.half_of_last_digit[first]) * (last - first + 2)
        near = max(_LEAST, rounding)
        if not near < gap[i, j] < _SHARE * size:
            return None
        if _cross(starts, passes.end[head], passes.start[tail], ends):
            return None
        if _nearest(ends[j], starts, passes.end[head]) <= near or _nearest(starts[i], passes.start[tail], ends) <= near:
            return None
        return int(passes.row[tail[j]]), complex(ends[j]), complex(starts[i])

    @cached_property
    def begins(self) -> Points:
        """In these rows the start of the contour [mm]; NaN in others."""
        return column_at(len(self.trace), self._gaps[0], self._gaps[2], NOWHERE)

    @cached_property
    def gap(self) -> Floats:
        """In these rows the distance from the end of the contour to its start [mm]; 0 in others."""
        return column_at(len(self.trace), self._gaps[0], np.abs(self._gaps[1] - self._gaps[2]), 0.0)


def _cross(start: Points, end: Points, second_start: Points, second_end: Points) -> bool:
    """One of some lines crosses one of some others, as leads do where the contour is closed; arcs as their chords."""
    a, b, c, d = start[:, None], end[:, None], second_start[None, :], second_end[None, :]
    parted = cross(b - a, c - a) * cross(b - a, d - a) < 0
    return bool((parted & (cross(d - c, a - c) * cross(d - c, b - c) < 0)).any())


def _nearest(point: complex, start: Points, end: Points) -> float:
    """The distance of a point to the nearest of some lines, arcs as their chords [mm]."""
    chord = end - start
    share = np.clip(((point - start) * chord.conj()).real / np.maximum(np.abs(chord) ** 2, 1e-12), 0, 1)
    return float(np.abs(start + share * chord - point).min())
