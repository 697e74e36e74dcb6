"""F in the polar mode: whether there is one, where it changes, and what the C axis makes of it."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.machines.modal import FeedMode
from polarcheck.table.filling import fill_down
from polarcheck.table.reach import Reach
from polarcheck.table.tool_center import ToolCenter
from polarcheck.table.trace import Trace


class Feeds:
    """Columns of one trace, one value per row."""

    def __init__(self, trace: Trace, tool_center: ToolCenter, reach: Reach) -> None:
        self.trace = trace
        self.tool_center = tool_center
        self.reach = reach

    # ---- F in force ----

    @cached_property
    def missing(self) -> Mask:
        """Cutting moves for which no F was ever given, or F0. What stands before an excerpt may have given one."""
        trace = self.trace
        written = trace.has("F") | trace.run.unknown
        given = fill_down(written, written | trace.starts, False).astype(bool)
        return np.asarray(trace.cuts & ((~given & ~self._in_excerpt) | (trace.feed_number == 0)))

    @cached_property
    def _in_excerpt(self) -> Mask:
        """Rows of sections before which nothing moves, in a program without its head."""
        trace = self.trace
        shown = trace.whole_program | trace.moves
        begun = fill_down(shown, shown | trace.starts, False).astype(bool)
        return (
            np.asarray(trace.in_polar & ~begun[trace.sections.enter][trace.section]) if len(trace.sections) else ~begun
        )

    @cached_property
    def lost(self) -> Mask:
        """Cutting moves without an F of the mode, on a control that does not take over one per revolution."""
        trace = self.trace
        given = trace.given_in_section(trace.has("F"))
        return np.asarray(trace.cuts & trace.entered_per_revolution & ~given & trace.takes_over_per_minute_only)

    @cached_property
    def per_revolution(self) -> Mask:
        """Cutting moves whose F is per revolution."""
        trace = self.trace
        written = trace.feed_mode == FeedMode.PER_REVOLUTION
        return np.asarray(trace.cuts & written & (not trace.takes_over_per_minute_only))

    @cached_property
    def begins(self) -> Mask:
        """Cutting moves at another F than the one before in the section."""
        trace, rows = self.trace, np.flatnonzero(self.trace.cuts)
        number, section = trace.feed_number[rows], trace.section[rows]
        new = np.ones(len(rows), bool)
        new[1:] = (number[1:] != number[:-1]) | (section[1:] != section[:-1])
        mask = np.zeros(len(trace), bool)
        mask[rows[new]] = True
        return mask

    # ---- what is recommended ----

    @cached_property
    def outside_recommended(self) -> Mask:
        """Cutting moves with an F in neither of the ranges that the builder recommends; a bound not given is none."""
        feeds, value = self.trace.machine.feed, self.trace.feed
        not_cutting = (value < feeds.cutting_minimum) | (value > feeds.cutting_maximum)
        not_positioning = (value < feeds.positioning_minimum) | (value > feeds.positioning_maximum)
        return np.asarray(self.trace.cuts & not_cutting & not_positioning)

    # ---- the C axis ----

    @cached_property
    def above_acceleration(self) -> Mask:
        """Cutting moves that ask for more acceleration of C than the machine has."""
        trace, limit = self.trace, self.trace.machine.limits.c_acceleration
        if np.isnan(limit):
            return np.zeros(len(trace), bool)
        return np.asarray(self.reach.cuts_off_center & (self.tool_center.c_acceleration > limit))

    @cached_property
    def allowed_by_acceleration(self) -> Floats:
        """Highest F that keeps the acceleration of C, which grows with the square of F, at its limit [mm/min]."""
        limit = self.trace.machine.limits.c_acceleration
        return np.asarray(self.trace.feed * np.sqrt(limit / np.maximum(limit, self.tool_center.c_acceleration)))

    @cached_property
    def is_limited_in_acceleration(self) -> Mask:
        """Cutting moves, if the profile limits the acceleration of C."""
        return np.asarray(self.trace.cuts & (not np.isnan(self.trace.machine.limits.c_acceleration)))
