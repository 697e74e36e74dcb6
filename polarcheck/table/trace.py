"""
The executed program as a table: one row per executed block, every column a NumPy array of that length.

Columns are made when they are first asked for. Inside everything is mm, deg, min and X as radius.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows, States, is_among, repeated
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.machines.codes import code_numbers, code_set
from polarcheck.machines.modal import FeedMode, Motion, Side
from polarcheck.reading.words import NumberFault
from polarcheck.table.filling import before, fill_down, happened
from polarcheck.table.tool_offsets import ToolOffsets

#: Addresses that name the rotary axis of a cylinder with its radius, or the radius itself; beside that of the machine.
_CYLINDER_WORDS = ("A", "B", "C", "H", "Q", "R")


class Trace(ToolOffsets):
    """The table of one file on one machine for one job; see the properties for its columns, and those it inherits."""

    # ---- what is known of the program ----

    @cached_property
    def line_in_file(self) -> Rows:
        """Line of the file itself; in a program that is called from another file, that of the call."""
        source = self.text.source
        if not source.parts:
            return self.line
        line, is_own = self.line.copy(), self.line < source.parts[0].first_line
        for first, until in pairwise([*(part.first_line for part in source.parts), len(source.line_starts) + 1]):
            if source.is_own(source.part_of(first) or ("", 0)):  # of another channel
                rows = (self.line >= first) & (self.line < until)
                line[rows] -= first - 1
                is_own |= rows
        return fill_down(line, is_own, 1)

    @cached_property
    def on_cylinder(self) -> Mask:
        """Cylindrical interpolation is in force: from G7.1 with a radius to G7.1 C0 or another tool."""
        written = self.listed("cylindrical_interpolation")
        if not written.any():
            return written
        names = dict.fromkeys((*_CYLINDER_WORDS, self.machine.polar.rotary_address))
        radius = np.array([self.has(address) & ~(self.word(address) == 0) for address in names])
        ends = self.changes_tool | self.ends_program | self.starts
        return fill_down(written & radius.any(axis=0), written | ends, False).astype(bool)

    @cached_property
    def contours_outside(self) -> Mask:
        """Blocks outside the mode with a code that cuts a contour there, and C beside it."""
        codes = self.machine.polar.contours_outside
        if not codes:
            return np.zeros(len(self), bool)
        written = code_numbers(self.run.words.value[self.g_words])
        return (
            self.with_words(self.g_words[code_set(codes)[written]])
            & self.has(self.machine.polar.rotary_address)
            & (self.section < 0)
        )

    @cached_property
    def extrudes(self) -> Mask:
        """
        G0 or G1 with a number in E, as printers feed their filament.

        On a lathe E is a word beside threads and beside the switch of the mode, and of no move.
        """
        e = self.word_indices("E")
        e = e[self.run.words.fault[e] == NumberFault.NONE]
        if not len(e):
            return np.zeros(len(self), bool)
        moves = is_among(self.state("motion"), (Motion.RAPID, Motion.LINE)) & self.uses_axes & ~self.in_cycle
        return np.asarray(self.with_words(e) & moves & ~self.switches_on)

    # ---- tool offset ----

    @cached_property
    def tool_called_before(self) -> Rows:
        """What T called above the row."""
        return before(self.tool_called, self.starts, 0)

    @cached_property
    def calls_other_offset_in_polar(self) -> Mask:
        """Another offset than the one in force is called in the mode, where this control allows none."""
        calls = self.in_polar & self.calls_offset & (self.tool_called != self.tool_called_before)
        if self.machine.offsets.called_in_polar == "never":
            return np.asarray(calls)
        return np.asarray(calls & ((self.side != Side.OFF) | (self.side_before != Side.OFF)))

    @cached_property
    def has_called_tool(self) -> Mask:
        """A tool or its offset has been called in the row or above it in its program."""
        return happened(self.calls_offset, self.starts)

    @cached_property
    def nose_is_of_mill(self) -> Mask:
        """The nose type of the offset in force leaves the programmed point in the cutter center; False if unknown."""
        return np.isin(self.nose, self.machine.compensation.nose_types)

    # ---- compensation ----

    @cached_property
    def writes_side(self) -> Mask:
        """G41 or G42 stands in the row."""
        return self.listed("compensation_left", "compensation_right")

    @cached_property
    def writes_cancel(self) -> Mask:
        """G40 stands in the row."""
        return self.listed("compensation_off")

    @cached_property
    def side(self) -> States:
        """
        Cutter compensation in force (Side).

        It is off when the mode is switched, be it that a G40 was forgotten: that has a finding, and what would be
        compensated wrongly up to the next G41 or G42 is no second mistake.
        """
        written = self.sets("side")
        state = np.where(written, self.state("side"), Side.OFF)
        switched = self.mask_of(self.sections.leave) | self.enters
        return fill_down(state, written | switched | self.starts, Side.OFF).astype(np.int16)

    @cached_property
    def side_before(self) -> States:
        """Cutter compensation in force before the row."""
        return before(self.side, self.starts, Side.OFF).astype(np.int16)

    @cached_property
    def compensates(self) -> Mask:
        """G41 or G42 is in force in the polar mode."""
        return np.asarray(self.in_polar & (self.side != Side.OFF))

    @cached_property
    def on_plane(self) -> Mask:
        """
        A move on the polar plane, be it in rapid traverse; a cycle is none, and neither is a move of no length.

        At G0 most controls alarm. A start-up or offset cancel in it is one nevertheless: what was meant is G1, and
        compensation itself asks for G0 or G1 (B-63324EN/03 p. 402).
        """
        return np.asarray(self.travels & ~self.in_cycle)

    @cached_property
    def cuts(self) -> Mask:
        """A move on the polar plane at feed."""
        return self.in_polar & self.moves_plane & is_among(self.motion, (Motion.LINE, Motion.CW, Motion.CCW))

    @cached_property
    def moves_at_feed(self) -> Mask:
        """A move in the polar mode at feed, that of Z alone included."""
        return self.in_polar & self.moves & is_among(self.motion, (Motion.LINE, Motion.CW, Motion.CCW))

    @cached_property
    def starts_up(self) -> Mask:
        """The move in which compensation is built up."""
        return np.asarray(self.on_plane & (self.side != Side.OFF) & (self.side_of_move_before == Side.OFF))

    @cached_property
    def cancels(self) -> Mask:
        """The move in which compensation is taken back."""
        return np.asarray(self.on_plane & (self.side == Side.OFF) & (self.side_of_move_before != Side.OFF))

    @cached_property
    def side_of_move_before(self) -> States:
        """Compensation of the last row above that moved on the plane in this section."""
        fixed = self.travels | self.enters
        side = fill_down(np.where(self.enters, Side.OFF, self.side).astype(np.int16), fixed, Side.OFF)
        return before(side, self.starts, Side.OFF).astype(np.int16)

    @cached_property
    def offset_mode(self) -> Mask:
        """The move before was made with compensation."""
        return np.asarray(self.in_polar & (self.side_of_move_before != Side.OFF))

    @cached_property
    def radius_of_move(self) -> Floats:
        """R by which the tool center is off the path [mm]: of the offset in force; in a cancel, of the move before."""
        used = self.compensates & self.moves_plane
        last = fill_down(self.radius, used | self.starts, np.nan)
        return np.where(self.offset_mode & (self.side == Side.OFF), last, self.radius)

    # ---- the radius that it takes ----

    @cached_property
    def is_path_of_center(self) -> Mask:
        """
        Rows of sections whose straight ramps are all shorter than the R that a comment gives.

        The comment tells the cutter, and not what stands in the offset table: with R 0 the program is that of the tool
        center, and then a ramp needs no length (builder's guide to G12.1, sample program).
        """
        ramps = (self.starts_up | self.cancels) & ~self.is_arc & self.radius_is_from_comment
        short = ramps & (self.length < self.radius_of_offset - ROUNDING)
        return np.asarray(self.anywhere_in_section(short) & ~self.anywhere_in_section(ramps & ~short))

    @cached_property
    def sides_are_open(self) -> Mask:
        """Rows of sections on the sub-spindle of which the machine does not say on which side G41 and G42 are there."""
        if self.machine.polar.sub_spindle_plane == "as-main" or not len(self.sections):
            return np.zeros(len(self), bool)
        is_open = (self.on_sub_spindle & ~self.enters_other_axes)[self.sections.enter]
        return np.asarray((self.section >= 0) & is_open[self.section])

    @cached_property
    def radius(self) -> Floats:
        """R with which the rows are compensated, allowance included [mm]; NaN where it is not known."""
        radius = np.where(self.is_path_of_center, 0.0, self.radius_of_offset) + self.allowance
        return np.where(self.sides_are_open, np.nan, radius) if self.sides_are_open.any() else radius

    @cached_property
    def allowance(self) -> Floats:
        """What is added to R while cutter compensation is in force [mm]: OFFN, up to the next or the program's end."""
        word = self.machine.offsets.allowance_word
        written = self.has(word)
        if not written.any():
            return repeated(np.float64(0), len(self))
        return fill_down(np.where(written, self.length_of(word), 0.0), written | self.starts, 0.0)

    @cached_property
    def changes_allowance_in_offset_mode(self) -> Mask:
        """Another allowance is written where compensation is in force and stays so."""
        changes = self.allowance != before(self.allowance, self.starts, 0.0)
        return np.asarray(changes & self.offset_mode & (self.side != Side.OFF))

    @property
    def stock_diameter(self) -> Floats:
        """Of the stock [mm]; NaN where the job gives none."""
        return np.broadcast_to(self.job.stock.diameter * self.job_scale, len(self))

    # ---- feed ----

    def given_in_section(self, rows: Mask) -> Mask:
        """Whether one of these rows is the present one or above it in the same section."""
        return np.asarray(happened(rows & self.in_polar, self.enters) & self.in_polar)

    @cached_property
    def takes_over_per_minute_only(self) -> bool:
        """F of the mode is per minute, and one per revolution from before is not taken over (M700V p. 73)."""
        return self.machine.feed.carried_into_polar == "per-minute-only"

    @cached_property
    def feed_mode(self) -> States:
        """FeedMode by which the control moves: per minute in a mode that knows no other (M700V p. 73, note 1)."""
        mode = self.modal_feed_mode
        is_other = self.in_polar & (mode == FeedMode.PER_REVOLUTION) & self.takes_over_per_minute_only
        return np.where(is_other, FeedMode.PER_MINUTE, mode).astype(np.int16)

    @cached_property
    def entered_per_revolution(self) -> Mask:
        """Rows of sections at whose G12.1 feed per revolution is in force."""
        if not len(self.sections):
            return np.zeros(len(self), bool)
        per_revolution = self.modal_feed_mode[self.sections.enter] == FeedMode.PER_REVOLUTION
        return np.asarray(self.in_polar & per_revolution[self.section])

    @cached_property
    def per_minute(self) -> Mask:
        """F in force, if there is one, is per minute."""
        per_minute = self.feed_mode == FeedMode.PER_MINUTE
        if self.takes_over_per_minute_only:
            given = self.given_in_section(self.has("F"))
            per_minute = np.where(self.entered_per_revolution, given, per_minute | self.in_polar)
        return np.asarray(per_minute)

    @cached_property
    def feed_number(self) -> Floats:
        """
        F in force as a number [mm per min or per revolution]; NaN before the first.

        On a control where F of the mode is per minute only and feed per revolution is in force at G12.1, the F of the
        mode ends with it: after G13.1 the one from before is in force again (M700V p. 73, both tables of item 8).
        """
        if not self.takes_over_per_minute_only or not len(self.sections):
            return self.written_feed
        written_outside = (self.has("F") | self.starts) & ~self.entered_per_revolution
        outside = fill_down(self.written_feed, written_outside, np.nan)
        return np.where(self.entered_per_revolution, self.written_feed, outside)

    @cached_property
    def programmed_feed(self) -> Floats:
        """F in force as programmed [mm/min]; NaN where none is or where it depends on a spindle."""
        return np.where(self.per_minute, self.feed_number, np.nan)

    @cached_property
    def feed(self) -> Floats:
        """F in force with which the control moves [mm/min]: in the mode clamped, where its limit acts; NaN likewise."""
        limits, feed = self.machine.limits, self.programmed_feed
        if not limits.polar_feed_clamps or np.isnan(limits.polar_feed):
            return feed
        return np.where(self.in_polar, np.minimum(feed, limits.polar_feed), feed)
