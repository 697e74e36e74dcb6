"""F in the polar mode: whether there is one, where it changes, and what the C axis makes of it."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.arrays import Mask
from polarcheck.checking.message import Quantity
from polarcheck.machines.modal import FeedMode, Units
from polarcheck.table.filling import fill_down

if TYPE_CHECKING:
    from polarcheck.table.trace import Trace


class Feeds:
    """Columns of one trace, one value per row; the methods give words for a message about one row."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    # ---- F in force ----

    def given_in_section(self, rows: Mask) -> Mask:
        """Whether one of these rows is the present one or above it in the same section."""
        trace = self.trace
        inside = rows & trace.in_polar
        return np.asarray(fill_down(inside, inside | trace.enters, False).astype(bool) & trace.in_polar)

    @cached_property
    def is_taken_over_per_minute_only(self) -> bool:
        """F of the mode is per minute, and one per revolution from before is not taken over (M700V p. 73)."""
        return self.trace.machine.feed.inheritance == "per-minute-only"

    @cached_property
    def _entered_per_revolution(self) -> Mask:
        """Rows of sections at whose G12.1 feed per revolution is in force."""
        trace = self.trace
        if not len(trace.sections):
            return np.zeros(len(trace), bool)
        per_revolution = trace.feed_mode[trace.sections.enter] == FeedMode.PER_REVOLUTION
        return np.asarray(trace.in_polar & per_revolution[trace.section])

    @cached_property
    def per_minute(self) -> Mask:
        """F in force, if there is one, is per minute."""
        trace = self.trace
        per_minute = trace.feed_mode == FeedMode.PER_MINUTE
        if self.is_taken_over_per_minute_only:
            given = self.given_in_section(trace.has("F"))
            per_minute = np.where(self._entered_per_revolution, given, per_minute | trace.in_polar)
        return np.asarray(per_minute)

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
        given = self.given_in_section(trace.has("F"))
        return np.asarray(trace.cuts & self._entered_per_revolution & ~given & self.is_taken_over_per_minute_only)

    @cached_property
    def per_revolution(self) -> Mask:
        """Cutting moves whose F is per revolution."""
        trace = self.trace
        written = trace.feed_mode == FeedMode.PER_REVOLUTION
        return np.asarray(trace.cuts & written & (not self.is_taken_over_per_minute_only))

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

    def recommended(self, row: int) -> str:
        """The ranges of F that the builder recommends."""
        feeds = self.trace.machine.feed
        cutting = self._range(row, feeds.cutting_minimum, feeds.cutting_maximum)
        positioning = self._range(row, feeds.positioning_minimum, feeds.positioning_maximum)
        return f"{cutting} for cutting, {positioning} for positioning"

    def _range(self, row: int, least: float, most: float) -> str:
        shown = self._quantity(row, least)
        return f"{shown.length(least):.4g} to {shown.length(most):.4g} {shown.unit}/min"

    def _quantity(self, row: int, value: float) -> Quantity:
        return Quantity(value, bool(self.trace.units[row] == Units.INCH), False)

    # ---- the C axis ----

    def c_verdict(self, row: int) -> str:
        """What the machine allows of C, as far as the profile knows."""
        trace, limit = self.trace, self.trace.machine.limits.c_feed
        rate = float(trace.c_feed[row])
        if np.isnan(limit):
            return f"{rate / 360:.0f} turns a minute and more than a C axis cuts with"
        allows = f"{trace.machine.title} allows {limit:.0f}"
        if not trace.machine.limits.automatic_override:
            return allows
        slowed = self._quantity(row, float(trace.own.true_feed[row]))
        return f"{allows} and slows the feed down to {trace.own.override[row]:.2g} %, {slowed:feed}"

    def c_advice(self, row: int) -> str:
        """The highest F, or what to give to learn it."""
        if np.isnan(self.trace.machine.limits.c_feed):
            return "limits.c_feed would give the highest F here"
        return f"highest F here: {self._quantity(row, float(self.trace.feed_allowed[row])):feed}"

    @cached_property
    def above_acceleration(self) -> Mask:
        """Cutting moves that ask for more acceleration of C than the machine has."""
        trace, limit = self.trace, self.trace.machine.limits.c_acceleration
        if np.isnan(limit):
            return np.zeros(len(trace), bool)
        return np.asarray(trace.reach.cuts_off_center & (trace.c_acceleration > limit))

    def allowed_by_acceleration(self, row: int) -> float:
        """Highest F that keeps the acceleration of C, which grows with the square of F, at its limit [mm/min]."""
        trace = self.trace
        limit = trace.machine.limits.c_acceleration
        return float(trace.feed[row]) * math.sqrt(limit / max(limit, float(trace.c_acceleration[row])))

    @cached_property
    def is_limited_in_acceleration(self) -> Mask:
        """Cutting moves, if the profile limits the acceleration of C."""
        return np.asarray(self.trace.cuts & (not np.isnan(self.trace.machine.limits.c_acceleration)))
