"""The procedure around a polar section: the G12.1 that begins it, the live tool, and what it leaves to later work."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import before, fill_down, happened, last_row
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, is_among, repeated
from polarcheck.foundation.states import FeedMode, Motion, Side
from polarcheck.program.machines.code_lists import is_code

#: Least number of C moves at feed, with a move of X among them, of a contour; one alone is a groove or a position.
_MOVES_OF_CONTOUR = 2
#: C of a contour hardly passes the X from which it is approached; as a length, an angle of the C axis does. Its share.
_FARTHEST_C = 1.25
#: Below these F is no feed per minute but one per revolution: without the live tool, and with it [mm].
_LEAST_OF_TURNING, _LEAST_OF_LIVE_TOOL = 5.0, 1.0


class Procedure(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace

    # ---- a contour that no G12.1 has begun ----

    @cached_property
    def contour_without_mode(self) -> Rows:
        """
        The first row above in which C moves at feed as on a contour, outside the mode and known to be so; -1 for none.

        It is a contour with G41 or G42, on an arc, or where at least two moves of C and one of X lead at feed right up
        to the row, and C may be a length there; with a retract between, too, where a block moves X and C, or X goes
        below 0, and Z moves in none of them. Looked for back to the last tool change, G12.1 or G13.1, and only if a
        G13.1 stands outside sections. Beside G7.1 C is the radius of a cylinder, on which offset mode may move C.
        """
        trace = self.trace
        if not np.any(trace.axes.switches_off & ~trace.mode.leaves):
            return repeated(np.int64(-1), len(trace))
        since = trace.tools.changes_tool | trace.axes.ends_mode | trace.blocks.starts
        turns = self._turns & ~happened(self._may_begin, since)
        turns &= trace.blocks.whole_program | trace.tools.has_called_tool
        compensated = turns & ((trace.compensation.side != Side.OFF) | self._is_arc)
        stops = since | self._may_begin | self._leaves_work
        first = _first(compensated, since | self._may_begin, trace.blocks.starts)
        # G40 G13.1 is written for safety.
        plain = self._stretch(turns, stops)
        plain = np.where(plain < 0, self._contour_of_both(turns, since | self._may_begin), plain)
        return np.where((first < 0) & ~trace.compensation.writes_cancel, plain, first)

    @property
    def _turns(self) -> Mask:
        """Moves of the virtual axis at feed outside sections; full circles about a center with J name it alone."""
        trace, mode = self.trace, self.trace.machine.polar
        turns = trace.blocks.has(mode.virtual_axis, mode.virtual_axis_incremental) & (trace.mode.section < 0)
        turns &= (trace.path.moves_c | (self._is_arc & trace.blocks.has("J"))) if self._is_rotary else True
        return np.asarray(turns & trace.axes.at_feed)

    @property
    def _is_arc(self) -> Mask:
        """Arcs, where the virtual axis is the rotary one: a Y axis that moves on arcs is a real one."""
        return is_among(self.trace.axes.motion, (Motion.CW, Motion.CCW)) & self._is_rotary

    @property
    def _is_rotary(self) -> bool:
        """True if the virtual axis has the address of the rotary axis."""
        mode = self.trace.machine.polar
        return mode.virtual_axis == mode.rotary_address

    @cached_property
    def _may_begin(self) -> Mask:
        """Rows that begin the mode, a mode of another control, another plane, a cylinder, or something unknown."""
        trace, mode = self.trace, self.trace.machine.polar
        foreign = [name for name in mode.on_of_other_controls if is_code(name) and name not in mode.on_of_macros]
        begins = (
            trace.axes.switches_on
            | trace.blocks.codes(*foreign, *mode.ended_by, *mode.off_of_other_modes)
            | trace.run.unknown
        )
        return np.asarray(begins | trace.blocks.listed("cylindrical_interpolation"))

    @property
    def _leaves_work(self) -> Mask:
        """Rapid traverse, reference returns, stops between tools: a G13.1 behind them ends no contour."""
        trace = self.trace
        away = trace.blocks.listed("reference_return", "machine_coordinates")
        return np.asarray(
            (trace.axes.motion == Motion.RAPID) | away | trace.blocks.codes(*trace.machine.m_codes.optional_stop)
        )

    def _stretch(self, turns: Mask, stops: Mask) -> Rows:
        """The first row of C at feed of a stretch of moves at feed up to the row, if it is a contour; else -1."""
        trace = self.trace
        if not self._is_rotary:
            return repeated(np.int64(-1), len(trace))
        plane = turns & ~self._is_arc
        along_x = trace.axes.at_feed & trace.path.moves_x
        turning, moving = (before(_count(mask, stops), trace.blocks.starts, 0) for mask in (plane, along_x))
        first = _first(plane, stops, trace.blocks.starts)
        is_contour = (turning >= _MOVES_OF_CONTOUR) & (moving > 0) & ~self._is_angle(plane, stops)
        return np.where(is_contour, first, -1)

    def _contour_of_both(self, turns: Mask, stops: Mask) -> Rows:
        """The same where rapid traverse may stand between the contour and the row, and X and C move in one block."""
        trace = self.trace
        if not self._is_rotary:
            return repeated(np.int64(-1), len(trace))
        plane = turns & ~self._is_arc & ~trace.path.moves_z
        both = turns & (trace.path.moves_x | (trace.path.x < 0))
        turning, both_count, with_z = (
            before(_count(mask, stops), trace.blocks.starts, 0) for mask in (plane, both, turns & trace.path.moves_z)
        )
        is_contour = (turning >= _MOVES_OF_CONTOUR) & (both_count > 0) & (with_z == 0) & ~self._is_angle(plane, stops)
        return np.where(is_contour, _first(plane, stops, trace.blocks.starts), -1)

    @cached_property
    def contour_goes_on_behind(self) -> Rows:
        """
        The row of the G13.1 above, if it stands in the middle of a contour; -1 for others. Until the mode begins again.

        Behind it X and C go on at feed and at the same depth: with G41 or G42 still in force, or in two moves of C. The
        next G13.1, behind them, is the one that ends the contour.
        """
        trace, none = self.trace, repeated(np.int64(-1), len(self.trace))
        if not np.any(trace.axes.switches_off & ~trace.mode.leaves) and not np.any(
            trace.mode.leaves & (trace.compensation.side_before != Side.OFF)
        ):
            return none
        leaves = trace.mode.leaves
        since = last_row(leaves, trace.axes.switches_on | trace.tools.changes_tool | trace.blocks.starts)
        stops = leaves | self._leaves_work | trace.path.moves_z | trace.axes.switches_on | trace.blocks.starts
        last_stop = last_row(stops, trace.blocks.starts)
        goes_on = self._turns & (since >= 0) & (last_stop == since)
        turns = np.bincount(since[goes_on], minlength=len(trace))
        needed = np.where(trace.compensation.side_before != Side.OFF, 1, _MOVES_OF_CONTOUR)
        return np.where((since >= 0) & (turns >= needed)[since], since, none)

    # ---- a contour outside, and an arc ----

    @cached_property
    def contour_outside(self) -> Mask:
        """
        The first row of each contour of X and C at feed outside the mode, and known to be so, whatever ends it.

        C moves at least twice, may be a length there, and in between X goes below 0, as it does in the mode alone, or
        G41 or G42 is in force. Rapid traverse ends it, and what may begin a mode; on a cylinder C is its angle.
        """
        trace = self.trace
        none = np.zeros(len(trace), bool)
        if not self._is_rotary:
            return none
        since = trace.tools.changes_tool | trace.axes.ends_mode | trace.blocks.starts
        plane = self._turns & ~self._is_arc & ~trace.path.moves_z & ~trace.mode.on_cylinder
        plane &= ~happened(self._may_begin, since) & (trace.blocks.whole_program | trace.tools.has_called_tool)
        if np.count_nonzero(plane) < _MOVES_OF_CONTOUR:
            return none
        stops = since | self._may_begin | self._leaves_work
        stretch: Rows = np.cumsum(stops)
        at_feed = trace.axes.at_feed & (trace.mode.section < 0)
        turns, below, sides = (
            np.bincount(stretch[mask], minlength=int(stretch[-1]) + 1)
            for mask in (
                plane,
                at_feed & trace.path.moves_x & (trace.path.x < 0),
                plane & (trace.compensation.side != Side.OFF),
            )
        )
        is_contour = (turns >= _MOVES_OF_CONTOUR) & ((below > 0) | (sides >= _MOVES_OF_CONTOUR))
        hits = plane & is_contour[stretch] & ~self._is_angle_beside(np.abs(trace.path.x), plane, stretch)[stretch]
        hits[1:] &= ~happened(hits, stops)[:-1] | stops[1:]
        return np.asarray(hits)

    @cached_property
    def arc_without_mode(self) -> Mask:
        """
        Arcs with X and C outside the mode, and known to be so, which no G13.1 ends as a contour.

        C is an axis there: the program has positioned it before. On a cylinder, and in what may be another mode, an arc
        may move C; with Z it may be one of X and Z along which C turns.
        """
        trace, polar = self.trace, self.trace.machine.polar
        arcs = self._turns & self._is_arc & ~trace.axes.commands_z & ~trace.mode.on_cylinder
        if not arcs.any():
            return np.zeros(len(trace), bool)
        has_x = trace.blocks.has("X", "U") | trace.axes.has_center
        arcs &= has_x & trace.blocks.with_words(trace.blocks.word_indices("I", "J", trace.machine.arcs.radius_word))
        since = trace.tools.changes_tool | trace.axes.ends_mode | trace.blocks.starts
        arcs &= ~happened(self._may_begin, since) & (trace.blocks.whole_program | trace.tools.has_called_tool)
        is_line = is_among(trace.axes.motion, (Motion.RAPID, Motion.LINE))
        returned = trace.blocks.listed("c_axis_reference") & trace.blocks.has(*polar.rotary_words)
        positions = (trace.blocks.has(polar.rotary_address) & is_line) | returned | trace.mode.enters
        arcs &= happened(positions, trace.blocks.starts)
        for row in np.flatnonzero(trace.axes.switches_off & (self.contour_without_mode >= 0)).tolist():
            arcs[int(self.contour_without_mode[row]) : row] = False
        return np.asarray(arcs)

    def _is_angle(self, plane: Mask, stops: Mask) -> Mask:
        """
        C of the stretch up to the row above would lie far outside the part as a length: it is meant in degrees.

        Not where X goes below 0, as it does in the mode alone.
        """
        x, stretch = self.trace.path.x, np.asarray(np.cumsum(stops), np.int64)
        is_angle = self._is_angle_beside(np.where(x < 0, np.inf, x), plane, stretch)
        return before(is_angle[stretch], self.trace.blocks.starts, False)

    def _is_angle_beside(self, x: Floats, plane: Mask, stretch: Rows) -> Mask:
        """Per stretch: C would lie far outside these X [mm] as a length."""
        trace, mode = self.trace, self.trace.machine.polar
        longest, farthest = np.zeros((2, len(trace) + 1))
        for address in (mode.virtual_axis, mode.virtual_axis_incremental):
            rows = np.flatnonzero(plane & trace.blocks.has(address))
            np.fmax.at(longest, stretch[rows], np.abs(trace.lengths.length_of(address)[rows]))
        np.fmax.at(farthest, stretch, x)
        return (farthest > 0) & (longest > _FARTHEST_C * farthest)

    # ---- the live tool ----

    @cached_property
    def live_tool_without_speed(self) -> Mask:
        """
        The live tool is started in a program with a section, and no S of the whole program gives a speed; where the
        builder demands one beside the code, up to the first move at feed no S in force is for it.

        S is for the live tool if that starts next or runs, and where it has a word of its own, as S3=; one that the
        main spindle starts with is not, and takes the place of what was, nor is a surface speed, or S0. The limit of
        G50 is no speed. What stands before an excerpt without T may have given it.
        """
        trace, codes = self.trace, self.trace.machine.m_codes
        started = trace.blocks.codes(*codes.live_tool_on)
        if not started.any():
            return started
        if not self._demands_speed:
            return started & self._never_has_speed
        begins = np.flatnonzero(started | trace.blocks.codes(*codes.spindle_on))
        of_live_tool = np.append(started[begins], False)
        rows = np.arange(len(trace))
        following = of_live_tool[np.searchsorted(begins, rows)]
        running = of_live_tool[np.searchsorted(begins, rows, side="right") - 1]
        is_speed = ~(trace.blocks.word("S") == 0) & (started | (trace.modal.state("speed") == 0))
        takes = (trace.blocks.has("S") & ~trace.modal.sets_coordinates) | trace.run.unknown
        is_own = (is_speed & (following | running)) | trace.run.unknown
        for name in trace.machine.live_tool_speeds:
            named = trace.blocks.has(name)
            takes, is_own = takes | named, np.where(named, ~(trace.blocks.word(name) == 0), is_own)
        has_speed = fill_down(takes & is_own, takes | trace.blocks.starts, False).astype(bool)
        ends = trace.axes.at_feed | trace.blocks.codes(*codes.live_tool_off) | trace.blocks.ends_program
        until = np.append(np.flatnonzero(ends), len(trace) - 1)[np.searchsorted(np.flatnonzero(ends), rows)]
        is_whole = (trace.blocks.whole_program | trace.tools.has_called_tool) & trace.blocks.anywhere_in_program(
            trace.mode.enters
        )
        return np.asarray(started & ~has_speed[until] & is_whole)

    @property
    def _demands_speed(self) -> bool:
        """The builder, or the job, wants S beside the code that starts the live tool, whatever was in force."""
        rule = "live-tool-without-speed"
        return rule in self.trace.machine.severities or rule in self.trace.job.severities

    @property
    def _never_has_speed(self) -> Mask:
        """
        Rows of whole programs with a section in which no word gives any speed, and all is known.

        Not where the profile does not say with which word the live tool gets its speed: a code may start it at one.
        """
        trace, blocks = self.trace, self.trace.blocks
        word = trace.machine.writing.live_tool_speed.rstrip("=")
        gives = blocks.has("S") & ~trace.modal.sets_coordinates
        gives |= blocks.has(*trace.machine.live_tool_speeds) | trace.run.unknown
        if len(word) == 1:
            gives |= blocks.codes(*trace.machine.m_codes.live_tool_on) & blocks.has(word)
        ends = blocks.anywhere_in_program(blocks.ends_program) & blocks.anywhere_in_program(trace.mode.enters)
        return np.asarray(blocks.whole_program & ends & ~blocks.anywhere_in_program(gives) & bool(word))

    @cached_property
    def live_tool_above_highest_speed(self) -> Mask:
        """Rows with an S for the live tool above its highest speed."""
        if np.isnan(self.trace.machine.limits.live_tool_speed):
            return np.zeros(len(self.trace), bool)
        from polarcheck.columns.modes.live_tool import exceeds_highest_speed

        return exceeds_highest_speed(self.trace)

    @cached_property
    def live_tool_runs_on(self) -> Rows:
        """
        In rows that change the tool or end the program: the row that started the live tool of a section, if it still
        runs; -1 elsewhere.
        """
        trace, codes = self.trace, self.trace.machine.m_codes
        if not codes.live_tool_on:
            return repeated(np.int64(-1), len(trace))
        ends = trace.tools.changes_tool | trace.blocks.ends_program
        starts_tool, stops_tool = trace.blocks.codes(*codes.live_tool_on), trace.blocks.codes(*codes.live_tool_off)
        ran = before(trace.modal.live_tool, trace.blocks.starts, False)
        begun = starts_tool & ~ran
        since = begun | stops_tool | trace.run.unknown | trace.tools.changes_tool | trace.blocks.starts
        has_cut = before(happened(trace.path.cuts & trace.modal.live_tool, since), trace.blocks.starts, False)
        still = ran & ~stops_tool & has_cut
        row = last_row(begun, trace.blocks.starts)
        return np.where(ends & still, before(row, trace.blocks.starts, -1), -1)

    # ---- what a section leaves ----

    @cached_property
    def section_before(self) -> Rows:
        """The row in which the last section above ended, -1 without one; of the same program."""
        trace = self.trace
        return last_row(trace.mode.leaves, trace.mode.enters | trace.blocks.starts)

    @cached_property
    def turns_at_feed_of_mill(self) -> Mask:
        """
        Moves of turning, behind a section, with the feed per minute that was in force in it.

        It is known by F: below what anything is milled with per minute; or by F of the section itself while the main
        spindle runs. F of threads is a lead in either mode.
        """
        trace = self.trace
        of_mode = last_row(trace.modal.sets("feed_mode"), trace.blocks.starts)
        sure = ~happened(trace.run.unknown, trace.mode.leaves | trace.blocks.starts)
        carried = (
            (of_mode >= 0) & (of_mode < self.section_before) & (trace.feedrate.feed_mode == FeedMode.PER_MINUTE) & sure
        )
        is_own = last_row(trace.blocks.has("F"), trace.blocks.starts) > self.section_before
        least = np.where(trace.modal.live_tool, _LEAST_OF_LIVE_TOOL, _LEAST_OF_TURNING)
        is_small = np.abs(trace.feedrate.feed_number) < least
        of_section = ~is_own & ~trace.modal.live_tool & trace.modal.spindle
        return np.asarray(carried & self._turning & ((is_own & is_small) | of_section))

    @property
    def _turning(self) -> Mask:
        """Moves of X and Z at feed outside the mode, and cycles, but no threads."""
        trace = self.trace
        leads = trace.blocks.listed("thread_cutting", "threading_cycle", "feed_is_lead")
        threads = happened(leads, trace.modal.sets("motion") | trace.blocks.starts)
        at_feed = trace.axes.at_feed & (trace.path.moves_x | trace.path.moves_z) & ~self._turns
        cycle = (trace.axes.motion == Motion.CYCLE) | (trace.blocks.listed("repetitive_cycle") & trace.blocks.has("F"))
        return np.asarray((trace.mode.section < 0) & (at_feed | cycle) & ~threads)


def _count(mask: Mask, ends: Mask) -> Rows:
    """The number of rows of the mask at or above each row, back to the last row of `ends`."""
    count = np.cumsum(mask)
    return np.asarray(count - fill_down(count, ends, 0))


def _first(mask: Mask, ends: Mask, starts: Mask) -> Rows:
    """The first row of the mask above each row, back to the last row of `ends`; -1 for none."""
    has_begun = before(happened(mask, ends), starts, False)
    first = mask & (~has_begun | before(ends, starts, True))
    return before(last_row(first, ends), starts, -1)
