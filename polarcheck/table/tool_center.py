"""The path of the tool center as columns: how near it comes to the center of C, and what it asks of the C axis."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows
from polarcheck.geometry.compensation import ToolPath
from polarcheck.table.infeed import Infeed
from polarcheck.table.moves import Moves, compensated, per_row
from polarcheck.table.trace import Trace


class ToolCenter:
    """Columns over the rows of the trace, each from the moves of the tool center in that row; and those moves."""

    def __init__(self, trace: Trace, infeed: Infeed) -> None:
        self.trace = trace
        self.infeed = infeed

    @cached_property
    def _compensated(self) -> tuple[Moves, ToolPath, Rows]:
        found, tool, row = compensated(self.trace)
        return self.infeed.with_passes(found), tool, row

    @property
    def moves(self) -> Moves:
        """The moves of the tool center inside sections."""
        return self._compensated[0]

    def found(self, name: str) -> Mask:
        """What the control would object to while it compensates, per row (compensation.ToolPath)."""
        _, tool, row = self._compensated
        rows = np.zeros(len(self.trace), bool)
        rows[row[getattr(tool, name)]] = True
        return rows

    def _of_moves(self, values: Floats, none: float, largest: bool = True) -> Floats:
        return per_row(values, self.moves, len(self.trace), none, largest)

    @cached_property
    def nearest(self) -> Floats:
        """Smallest distance of the tool center to the center of C [mm]; inf without movement, NaN unknown."""
        return self._of_moves(self.moves.nearest, np.inf, largest=False)

    @cached_property
    def farthest(self) -> Floats:
        """Largest distance of the tool center to the center of C [mm]; -inf without movement, NaN unknown."""
        return self._of_moves(self.moves.farthest, -np.inf)

    @cached_property
    def c_feed(self) -> Floats:
        """Highest rate of C [deg/min]; 0 without movement, NaN unknown."""
        return self._of_moves(self.moves.c_feed, 0.0)

    @cached_property
    def c_acceleration(self) -> Floats:
        """Highest acceleration of C [deg/s2]; 0 without movement, NaN unknown."""
        return self._of_moves(self.moves.c_acceleration, 0.0)

    @cached_property
    def c_feed_limit(self) -> float:
        """Limit of C [deg/min]: the machine's own, of which automatic override takes a share; else a suspicious one."""
        limits = self.trace.machine.limits
        if np.isnan(limits.c_feed):
            return limits.c_feed_suspicious
        return limits.c_feed * (min(limits.override_share, 100) / 100 if limits.automatic_override else 1)

    @cached_property
    def feed_allowed(self) -> Floats:
        """Highest F that keeps C at or below its limit [mm/min]; inf without movement."""
        return self._of_moves(self.moves.feed_allowed(self.c_feed_limit), np.inf, largest=False)

    @cached_property
    def override(self) -> Floats:
        """
        Share of F that automatic override leaves in each row [%]; 100 where the machine has none or it does not act.

        It acts where C would turn faster than override_share of its limit, and leaves that (B-64120EN/01 p. 280).
        """
        limits = self.trace.machine.limits
        share = np.full(len(self.trace), 100.0)
        if limits.automatic_override and not np.isnan(limits.c_feed):
            np.divide(100 * self.c_feed_limit, self.c_feed, out=share, where=~(self.c_feed <= self.c_feed_limit))
        return share

    @cached_property
    def true_feed(self) -> Floats:
        """F that automatic override leaves [mm/min]."""
        return np.asarray(self.trace.feed * self.override / 100)
