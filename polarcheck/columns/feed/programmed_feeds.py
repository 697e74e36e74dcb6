"""F in the polar mode: whether there is one, where it changes, and what the acceleration of C leaves of it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from polarcheck.columns.filling import before, fill_down, happened
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    cached_property,
    column_at,
    first_in_run,
    folded,
    repeated,
)
from polarcheck.foundation.states import FeedMode, Motion, Units
from polarcheck.geometry.tolerances import SHARE

#: From here on F is no feed per revolution [in the units of the program: mm, inch].
_NOT_PER_REVOLUTION = {Units.MM: 5.0, Units.INCH: 0.2}
#: Nobody mills so slowly [in the units of the program for each minute].
_NOT_PER_MINUTE = {Units.MM: 1.0, Units.INCH: 0.04}
#: A block takes minutes, or hours [s].
_MINUTES, _HOURS = 300.0, 7200.0
#: Blocks of a series: more than a control without look-ahead reads in advance.
_SERIES = 10

#: A way that comes so much nearer to the center than the contour does, as a share of its distance, is none to it.
_STRAYS = 0.5


class Feeds(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    tool_center: ToolCenter

    # ---- F in force ----

    @cached_property
    def missing(self) -> Mask:
        """No F was ever given, or none above 0 is in force. Blocks before an excerpt may have given one."""
        trace = self.trace
        given = happened(trace.blocks.has("F") | trace.run.unknown, trace.blocks.starts)
        return np.asarray((~given & ~self._in_excerpt) | (trace.feedrate.feed_number <= 0))

    @cached_property
    def _in_excerpt(self) -> Mask:
        """Rows of sections before which nothing moves, in a program without its head."""
        trace = self.trace
        begun = happened(trace.blocks.whole_program | trace.axes.moves, trace.blocks.starts)
        if not len(trace.mode.sections):
            return ~begun
        return np.asarray(trace.mode.in_polar & ~begun[trace.mode.sections.enter][trace.mode.section])

    @cached_property
    def lost(self) -> Mask:
        """The F of the rows before G12.1, per revolution, is not taken over, and the mode has none of its own yet."""
        trace = self.trace
        given = trace.mode.given_in_section(trace.blocks.has("F"))
        return np.asarray(trace.feedrate.entered_per_revolution & ~given & trace.feedrate.takes_over_per_minute_only)

    @cached_property
    def strays_to_center(self) -> Mask:
        """
        Ramps and ways that come nearer to the center than half of what the contour of their section does.

        A coordinate of them is wrong, rather than F.
        """
        trace, nearest = self.trace, self.tool_center.nearest
        of_contour = trace.compensation.compensates & ~trace.compensation.starts_up & trace.path.travels
        of_contour &= trace.mode.in_polar & ~np.isnan(nearest)
        section, count = trace.mode.section, len(trace.mode.sections) + 1
        least = folded(np.fmin, section[of_contour], nearest[of_contour], count, np.nan)
        least[-1] = np.nan
        return np.asarray(~of_contour & (nearest < _STRAYS * least[section]))

    @property
    def is_only_fast(self) -> Mask:
        """Moves that turn C too fast for their F, and stray nowhere."""
        return np.asarray(self.tool_center.exceeds_c_feed_limit & ~self.strays_to_center)

    def before_on_plane(self, rows: Mask) -> Mask:
        """Rows above which the last move on the plane in their section is one of these rows."""
        trace = self.trace
        last = fill_down(rows & trace.axes.moves_plane, trace.axes.moves_plane | trace.mode.enters, False)
        return before(last, trace.mode.enters | trace.blocks.starts, False)

    @cached_property
    def mode_is_unknown(self) -> Mask:
        """
        No code of feed per minute or per revolution, of whichever G-code system, stands above in a whole program, and
        the profile does not say which is in force at its beginning.
        """
        trace, machine = self.trace, self.trace.machine
        systems = (machine.g_code_system_a, machine.g_code_system_b, machine.g_code_system_c)
        codes = [code for system in systems for code in (*system.feed_per_minute, *system.feed_per_revolution)]
        says = trace.blocks.codes(*codes) | trace.modal.sets("feed_mode") | trace.run.unknown
        return np.asarray(
            trace.blocks.whole_program & ~happened(says, trace.blocks.starts) & (not machine.power_on.feed_mode)
        )

    @cached_property
    def is_too_high_per_revolution(self) -> Mask:
        """F in force is too high for one per revolution: 5 mm or .2 inch, and more."""
        return self._is_at_least(_NOT_PER_REVOLUTION)

    def _is_at_least(self, least: Mapping[Units, float]) -> Mask:
        trace = self.trace
        in_units = np.where(trace.lengths.feed_units == Units.INCH, least[Units.INCH], least[Units.MM])
        return np.asarray(trace.feedrate.feed_number / trace.lengths.feed_scale >= in_units)

    @cached_property
    def is_left_per_revolution(self) -> Mask:
        """F in force is known, was written for feed per revolution, could be nothing else, and is per minute now."""
        trace = self.trace
        written = trace.blocks.has("F") | trace.blocks.starts
        per_revolution = fill_down(trace.feedrate.feed_mode == FeedMode.PER_REVOLUTION, written, False)
        has_feed = ~np.isnan(trace.feedrate.feed)
        return np.asarray(per_revolution & trace.feedrate.per_minute & has_feed & ~self.is_too_high_per_revolution)

    @cached_property
    def looks_per_revolution(self) -> Mask:
        """
        F in force is per minute, and as small as one per revolution, of which the program has some, or of which a code
        in force in the mode speaks, to a control that reads every F of the mode per minute.

        Where no code says that it is per minute, but the mode alone, the same F as before it is that up to higher ones.
        """
        trace = self.trace
        written = trace.blocks.has("F") & (trace.feedrate.feed_mode == FeedMode.PER_REVOLUTION)
        number = fill_down(
            np.where(written, trace.feedrate.written_feed, np.nan), written | trace.blocks.starts, np.nan
        )
        same = (
            np.isclose(trace.feedrate.feed_number, number, rtol=SHARE, atol=0) & trace.feedrate.entered_per_revolution
        )
        same &= trace.feedrate.takes_over_per_minute_only
        says = trace.mode.in_polar & (trace.feedrate.modal_feed_mode == FeedMode.PER_REVOLUTION)
        is_small = ~self._is_at_least(_NOT_PER_MINUTE) & (~np.isnan(number) | says)
        is_small |= same & ~self.is_too_high_per_revolution
        return np.asarray(
            is_small & trace.feedrate.per_minute & ~np.isnan(trace.feedrate.feed) & ~self.is_left_per_revolution
        )

    @cached_property
    def block_time(self) -> Floats:
        """How long a move of the mode takes at its F, were that per minute [s]; 0 for rows without one, NaN unknown."""
        trace = self.trace
        rows = np.flatnonzero(trace.path.moves_at_feed & (trace.feedrate.feed_number > 0))
        depth = np.where(trace.path.moves_z[rows], np.abs(trace.path.z[rows] - trace.path.z_before[rows]), 0.0)
        length = trace.path.length[rows]
        distance = np.where(length == 0, depth, np.hypot(length, trace.path.rise[rows]))
        return column_at(len(trace), rows, 60 * distance / trace.feedrate.feed_number[rows], 0.0)

    @cached_property
    def takes_too_long(self) -> Mask:
        """
        F in force is per minute, or no code has said what it is, and no cutter moves so slowly.

        That is an F below what anything is milled with in a block of minutes, or any F in one that takes hours.
        """
        trace = self.trace
        # Where neither G20 nor G21 stands, the number may be one of inch.
        is_inch = ~happened(trace.modal.sets("units"), trace.blocks.starts)
        may_do = is_inch & (trace.feedrate.feed_number / trace.lengths.feed_scale >= _NOT_PER_MINUTE[Units.INCH])
        is_small = ~self._is_at_least(_NOT_PER_MINUTE) & ~may_do & (trace.feedrate.feed_number > 0)
        takes_long = is_small & (self.block_time > _MINUTES)
        hours = trace.feedrate.per_minute & (self.block_time > _HOURS)
        explained = self.is_left_per_revolution | self.looks_per_revolution
        return np.asarray((((trace.feedrate.per_minute | self.mode_is_unknown) & takes_long) | hours) & ~explained)

    @cached_property
    def begins(self) -> Mask:
        """Cutting moves at another F than the one before in the section."""
        trace, rows = self.trace, np.flatnonzero(self.trace.path.cuts)
        number, section = trace.feedrate.feed_number[rows], trace.mode.section[rows]
        return trace.blocks.mask_of(rows[first_in_run(number, section)])

    def first_at_each(self, mask: Mask) -> Mask:
        """The first row of a mask at each F in each section."""
        rows = np.flatnonzero(mask)
        kinds = np.stack((self.trace.mode.section[rows].astype(float), self.trace.feedrate.feed_number[rows]))
        first = np.zeros(len(mask), bool)
        if len(rows):
            first[rows[np.unique(kinds, axis=1, return_index=True)[1]]] = True
        return first

    @cached_property
    def time_of_series(self) -> Floats:
        """
        The time of a block [s], as the mean of the fastest series of cutting blocks in which the row stands; inf where
        there are too few of them one behind the other in the section, NaN unknown.

        The control has read the blocks of a series in advance, so that single short ones among them cost nothing.
        """
        moves, motion = self.tool_center.moves, self.trace.axes.motion
        at_feed = motion[moves.row] != Motion.RAPID
        time = np.bincount(moves.row[at_feed], moves.time[at_feed], minlength=len(self.trace))
        rows, mean = np.flatnonzero(self.trace.path.cuts), np.full(len(self.trace), np.inf)
        if len(rows) < _SERIES:
            return mean
        windows = np.lib.stride_tricks.sliding_window_view
        section = self.trace.mode.section[rows]
        of_series = windows(time[rows], _SERIES).mean(axis=1)
        of_series[section[_SERIES - 1 :] != section[: 1 - _SERIES]] = np.inf
        around = np.pad(of_series, _SERIES - 1, constant_values=np.inf)
        mean[rows] = windows(around, _SERIES).min(axis=1)
        return mean

    @cached_property
    def blocks_too_fast(self) -> Floats:
        """How many times as much time the control needs for the blocks of a series as F leaves it; 0 unknown."""
        needed = self.trace.machine.limits.block_time
        if np.isnan(needed):
            return repeated(np.float64(0), len(self.trace))
        with np.errstate(divide="ignore"):
            return np.nan_to_num(needed / self.time_of_series, nan=0.0)

    @cached_property
    def feed_of_series(self) -> Floats:
        """F that is left in such a series [mm/min]; inf or NaN elsewhere."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(self.trace.feedrate.feed / self.blocks_too_fast)

    # ---- the C axis ----

    @cached_property
    def is_limited_in_acceleration(self) -> Mask:
        """Cutting moves, if the profile limits the acceleration of C."""
        return np.asarray(self.trace.path.cuts & (not np.isnan(self.trace.machine.limits.c_acceleration)))

    @cached_property
    def allowed_by_acceleration(self) -> Floats:
        """
        F in force, reduced where it would exceed the acceleration limit of C [mm/min].

        The acceleration grows with the square of F. inf where the profile has no limit, NaN unknown.
        """
        return self._feed_within("c_acceleration")

    @cached_property
    def is_limited_in_x_acceleration(self) -> Mask:
        """Cutting moves, if the profile limits the acceleration of X."""
        return np.asarray(self.trace.path.cuts & (not np.isnan(self.trace.machine.limits.x_acceleration)))

    @cached_property
    def allowed_by_x_acceleration(self) -> Floats:
        """The same of the acceleration of X [mm/min]."""
        return self._feed_within("x_acceleration")

    def _feed_within(self, name: str) -> Floats:
        trace, limit = self.trace, getattr(self.trace.machine.limits, name)
        if np.isnan(limit):
            return repeated(np.float64(np.inf), len(trace))
        needed = getattr(self.tool_center, name)
        share = np.divide(limit, needed, out=np.ones(len(trace)), where=~(needed <= limit))
        return np.asarray(trace.feedrate.feed * np.sqrt(share))
