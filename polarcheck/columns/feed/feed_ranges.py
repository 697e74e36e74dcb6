"""F against the ranges that a builder recommends for cutting and for positioning in the polar mode."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.ramps import Ramps
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows, cached_property, folded, mask_at
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.tolerances import ROUNDING, SHARE


class FeedRanges:
    """
    Columns of one trace, one value per row.

    A move cuts if it has compensation and is neither a ramp nor a move round the stock. Other moves are uncertain:
    any F between the lowest for cutting and the highest for positioning may be right.
    """

    def __init__(self, trace: Trace, tool_center: ToolCenter, ramps: Ramps) -> None:
        self.trace = trace
        self.tool_center = tool_center
        self.ramps = ramps
        self.limits = trace.machine.feed

    # ---- F ----

    @cached_property
    def known_limits(self) -> list[float]:
        """The ends of the ranges that the builder gives [mm/min]; there is one range, or there are two."""
        limits = self.limits
        ranges = (
            (limits.cutting_minimum, limits.cutting_maximum),
            (limits.positioning_minimum, limits.positioning_maximum),
        )
        return [limit for limit in np.ravel(ranges).tolist() if not np.isnan(limit)]

    @cached_property
    def nearest_limit(self) -> Floats:
        """The one of them that F is nearest to [mm/min]; NaN where there is none."""
        ends = np.array([*self.known_limits, np.nan][: max(len(self.known_limits), 1)])
        return np.asarray(ends[np.argmin(np.abs(self.trace.feedrate.programmed_feed[:, None] - ends), axis=1)])

    @cached_property
    def too_low(self) -> Mask:
        """Moves on the plane below the range for cutting."""
        return np.asarray(
            self.trace.path.cuts & (self.trace.feedrate.programmed_feed < self.limits.cutting_minimum * (1 - SHARE))
        )

    @cached_property
    def too_high(self) -> Mask:
        """Moves on the plane above the range for positioning."""
        return self.trace.path.cuts & self._above(self.limits.positioning_maximum)

    @cached_property
    def between(self) -> Mask:
        """F above the range for cutting and below that for positioning."""
        below = self.trace.feedrate.programmed_feed < self.limits.positioning_minimum * (1 - SHARE)
        return np.asarray(self._above(self.limits.cutting_maximum) & below)

    @cached_property
    def is_for_cutting(self) -> Mask:
        """F at most the highest for cutting."""
        return np.asarray(self.trace.feedrate.programmed_feed <= self.limits.cutting_maximum * (1 + SHARE))

    def _above(self, limit: float) -> Mask:
        return np.asarray(self.trace.feedrate.programmed_feed > limit * (1 + SHARE))

    # ---- what cuts ----

    @cached_property
    def without_contour(self) -> Mask:
        """Moves of sections without compensation, which may cut or not."""
        trace = self.trace
        return trace.path.cuts & ~trace.mode.anywhere_in_section(
            trace.compensation.compensates | (trace.modal.state("side") != Side.OFF)
        )

    @cached_property
    def too_high_for_cut(self) -> Mask:
        """Moves along the contour that cut, at an F above the range for cutting."""
        trace = self.trace
        above = self._on_contour & self._above(self.limits.cutting_maximum)
        return above & self.cuts_contour if above.any() else np.zeros(len(trace), bool)

    @cached_property
    def cuts_contour(self) -> Mask:
        """
        Moves along the contour that cut: into the stock where that is given, else as near to the center as a move of
        the section at an F for cutting, since bars are round; in a loop without such a move all of them.

        A lead in or out is none, since what it passes may be gone; nor is a move above the highest Z of the cuts.
        """
        cuts = np.where(self.knows_stock, self.is_in_stock, self.is_as_near_as_a_cut)
        return np.asarray(
            self._on_contour & ((cuts & ~self._leads) | self.is_of_fast_loop) & ~self._is_clear & ~self._is_above
        )

    @cached_property
    def _on_contour(self) -> Mask:
        return self.trace.compensation.compensates & self.trace.path.travels & ~self.trace.compensation.starts_up

    @cached_property
    def _slow(self) -> Mask:
        """Moves along a contour at an F for cutting."""
        return self._on_contour & self.is_for_cutting

    @property
    def _reach(self) -> Floats:
        """How far from the center the cutter reaches into the stock, at most [mm]; NaN unknown."""
        return np.asarray(self.trace.lengths.stock_diameter + self.trace.offsets.cutter_diameter) / 2

    @cached_property
    def knows_stock(self) -> Mask:
        """Stock, cutter and the way of its center are known."""
        return ~np.isnan(self._reach + self.tool_center.nearest)

    @cached_property
    def is_in_stock(self) -> Mask:
        """The cutter gets into the stock."""
        return np.asarray(self.tool_center.nearest < self._reach - ROUNDING)

    @property
    def _is_clear(self) -> Mask:
        return self.knows_stock & ~self.is_in_stock

    @cached_property
    def is_of_fast_loop(self) -> Mask:
        """No move along the contour of the loop is at an F for cutting."""
        loop = self.ramps.loop
        slow = mask_at(int(loop.max(initial=0)) + 1, loop[self._slow])
        return self._on_contour & ~slow[loop]

    @cached_property
    def nearest_of_cuts(self) -> Floats:
        """Largest distance from the center of the moves of the section at an F for cutting [mm]."""
        return self._most(self.tool_center.nearest)

    @cached_property
    def is_as_near_as_a_cut(self) -> Mask:
        """As near to the center as one of those."""
        return np.asarray(self.tool_center.nearest <= self.nearest_of_cuts + ROUNDING)

    @cached_property
    def _is_above(self) -> Mask:
        """Above the highest Z of the moves at an F for cutting, where there are any."""
        highest = self._most(self.trace.path.z)
        return np.asarray((self.trace.path.z > highest + ROUNDING) & (highest > -np.inf))

    def _most(self, values: Floats) -> Floats:
        """The largest value of the moves of a section along its contours at an F for cutting; -inf without one."""
        trace = self.trace
        rows = np.flatnonzero(self._slow & np.isfinite(values))
        most = folded(np.maximum, trace.mode.section[rows], values[rows], len(trace.mode.sections) + 1, -np.inf)
        return np.where(trace.mode.section >= 0, most[trace.mode.section], -np.inf)

    @cached_property
    def _leads(self) -> Mask:
        """
        The first and the last move of a contour, if they lead to it or away: arcs, and lines that only come nearer or
        only go away.
        """
        trace = self.trace
        rows = np.flatnonzero(self._on_contour)
        ends = np.zeros(len(trace), bool)
        if len(rows):
            parts = np.flatnonzero(np.diff(self.ramps.loop[rows]) != 0)
            ends[rows[np.concatenate(([0], parts, parts + 1, [len(rows) - 1]))]] = True
        chord = trace.path.end - trace.path.start
        begins, finishes = ((point * chord.conj()).real for point in (trace.path.start, trace.path.end))
        passes = (trace.axes.motion == Motion.LINE) & (begins < -ROUNDING) & (finishes > ROUNDING)
        return np.asarray(ends & ~passes)

    def slow_row(self, row: int) -> int:
        """The row of the section at an F for cutting that is the farthest out."""
        trace = self.trace
        rows: Rows = np.flatnonzero(self._slow & (trace.mode.section == trace.mode.section[row]))
        return int(rows[np.nanargmax(self.tool_center.nearest[rows])])
