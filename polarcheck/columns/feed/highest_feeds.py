"""The highest F of each row that keeps C and X within their limits, and what a tooth takes at F."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.columns.modes.live_tool import speed
from polarcheck.columns.path.center import Center
from polarcheck.columns.path.moves import per_row
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, States, cached_property
from polarcheck.foundation.states import Motion
from polarcheck.geometry import rates
from polarcheck.geometry.tolerances import SHARE

#: Limits of F, in the order of the rows of `HighestFeeds.limits`; the first of equals counts.
LIMITS = C_FEED, C_ACCELERATION, X_FEED, X_ACCELERATION, POLAR_FEED = (
    "C",
    "acceleration of C",
    "X",
    "acceleration of X",
    "limit of F in the mode",
)


class HighestFeeds(Columns, frozen=True):
    """
    Columns of one trace, one value per row.

    Along a move the rates of C and X are proportional to F, and their accelerations to its square; so each limit
    gives an F in closed form. An axis without a limit in the profile limits nothing.
    """

    trace: Trace
    dynamics: Dynamics
    center: Center

    @cached_property
    def cuts(self) -> Mask:
        """Rows of sections that move at F: on the plane, or Z alone."""
        trace = self.trace
        return np.asarray(
            trace.path.moves_at_feed & (self.dynamics.on_path | (trace.path.moves_z & ~trace.axes.moves_plane))
        )

    @cached_property
    def limits(self) -> Floats:
        """Highest F by each of LIMITS [mm/min], a row of the array each; inf without a limit, NaN unknown."""
        trace, moves, limits = self.trace, self.dynamics.moves, self.trace.machine.limits
        c_bend, x_share, x_bend = (
            np.where(moves.known, of(*moves.shape, moves.plane_share), np.nan)
            for of in (rates.c_acceleration, rates.x_feed, rates.x_acceleration)
        )
        rows_of_limits = np.full((len(LIMITS), len(trace)), np.inf)
        rows_of_limits[0] = self.dynamics.tool_center.feed_allowed
        with np.errstate(divide="ignore"):  # what does not turn C, or move X, is not limited by it
            if not np.isnan(limits.c_acceleration):
                rows_of_limits[1] = self._lowest(np.sqrt(limits.c_acceleration / c_bend))
            if not np.isnan(limits.x_feed):
                rows_of_limits[2] = self._lowest(limits.x_feed / x_share)
            if not np.isnan(limits.x_acceleration):
                rows_of_limits[3] = self._lowest(np.sqrt(limits.x_acceleration / x_bend))
        if not np.isnan(limits.polar_feed):
            rows_of_limits[4] = limits.polar_feed
        rows_of_limits[:, ~self.cuts] = np.inf
        return rows_of_limits

    def _lowest(self, feed: Floats) -> Floats:
        return per_row(feed, self.dynamics.moves, len(self.trace), np.inf, largest=False)

    @cached_property
    def allowed(self) -> Floats:
        """Highest F that keeps all limits, beyond the programmed one, too [mm/min]; 0 through the center of C."""
        return np.asarray(np.where(self.meets_center, 0.0, self.limits.min(axis=0)))

    @cached_property
    def limited_by(self) -> States:
        """Which of LIMITS it is; where none is, any."""
        lowest: States = np.argmin(np.where(np.isnan(self.limits), np.inf, self.limits), axis=0).astype(np.int16)
        return lowest

    @cached_property
    def meets_center(self) -> Mask:
        """Cutting moves through the center of C, or too near to it for any F."""
        return np.asarray(self.cuts & self.trace.path.cuts & ~self.center.cuts_off_center)

    @cached_property
    def is_left_out(self) -> Mask:
        """
        The highest F itself is not allowed any more.

        FANUC B-62764EN/01 p. 52: F < L * R * pi / 180, with the machine's own limit and without automatic override.
        """
        limits = self.trace.machine.limits
        return np.asarray((self.limited_by == 0) & (limits.c_feed > 0) & (not limits.automatic_override))

    @cached_property
    def must_be_lower(self) -> Mask:
        """F as programmed is above what the limits allow or, where that is left out, at it."""
        edge = np.where(self.is_left_out, 1 - SHARE, 1 + SHARE)
        above = self.trace.feedrate.programmed_feed >= self.allowed * edge
        return np.asarray(self.cuts & ~self.meets_center & above)

    @cached_property
    def time(self) -> Floats:
        """How long each row takes at F as programmed and clamped, were there no override [s]; NaN unknown."""
        moves = self.dynamics.moves
        of_moves = np.where(self.dynamics.at_feed, self.dynamics.time_without_override, 0.0)
        on_path = np.bincount(moves.row, of_moves, minlength=len(self.trace))
        return np.where(self.dynamics.on_path, on_path, self.dynamics.time)

    # ---- the cutter ----

    @cached_property
    def cuts_of_teeth(self) -> Floats:
        """
        Teeth that cut in a minute, of S up to the highest speed of the live tool; NaN where S or the teeth are not
        known. F by this is the chip load.
        """
        cuts = np.minimum(speed(self.trace), np.nan_to_num(self.trace.machine.limits.live_tool_speed, nan=np.inf))
        cuts = cuts * self.trace.offsets.teeth
        return np.where(self.cuts & (self.trace.axes.motion != Motion.RAPID) & (cuts > 0), cuts, np.nan)
