"""
The executed program as a table: one row per executed block, every column a NumPy array of that length.

Columns are made when they are first asked for. Inside everything is mm, deg, min and X as radius.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask, Points, Rows, States
from polarcheck.checking.other_machine import OtherMachine
from polarcheck.geometry import polar
from polarcheck.geometry.compensation import ToolPath
from polarcheck.machines.modal import COORDINATE_SETTING, Distance, Motion, Side
from polarcheck.table import moves
from polarcheck.table.arcs import Arcs
from polarcheck.table.columns import Columns
from polarcheck.table.entry import Entry
from polarcheck.table.feeds import Feeds
from polarcheck.table.filling import before, fill_down, positions
from polarcheck.table.increments import Increments
from polarcheck.table.infeed import InfeedCycle
from polarcheck.table.lexical import Lexical
from polarcheck.table.modes import Modes
from polarcheck.table.moves import Moves
from polarcheck.table.overcutting import Overcutting
from polarcheck.table.own_words import OwnWords
from polarcheck.table.ramps import Ramps
from polarcheck.table.reach import Reach
from polarcheck.table.sections import Marks, Sections, find_sections, section_column

_PLANE_AXES = ("X", "U")
_NOWHERE = complex("nan+nanj")
_PASSES = 8


class Trace(Columns):
    """The table of one file on one machine for one job; see the properties for its columns."""

    # ---- motion ----

    @cached_property
    def moves_plane(self) -> Mask:
        """Programs the linear or the virtual axis, an arc by its center alone included."""
        is_arc = np.isin(self.state("motion"), (Motion.CW, Motion.CCW))
        axes = self.has(*_PLANE_AXES, *self._virtual)
        return self.uses_axes & (axes | (is_arc & self.has("I", "J", "K") & ~self.has("Z", "W"))) & ~self.switches_on

    @cached_property
    def moves_z(self) -> Mask:
        """Programs Z."""
        return self.uses_axes & self.has("Z", "W")

    @cached_property
    def _virtual(self) -> tuple[str, str]:
        polar_mode = self.machine.polar
        return polar_mode.virtual_axis, polar_mode.virtual_axis_increment

    @cached_property
    def motion(self) -> States:
        """What the row does with its axis words (Motion); NONE without axis words."""
        moving = self.moves_plane | self.moves_z | (self.uses_axes & self.has("C", "H", "Y", "V"))
        motion = np.where(self.in_cycle, Motion.CYCLE, self.state("motion"))
        return np.where(moving, motion, Motion.NONE).astype(np.int8)

    @cached_property
    def moves(self) -> Mask:
        """Moves any axis."""
        return np.asarray(self.motion != Motion.NONE)

    # ---- polar sections ----

    @cached_property
    def switches_on(self) -> Mask:
        """G12.1."""
        return self.codes(*self.machine.polar.on)

    @cached_property
    def switches_off(self) -> Mask:
        """G13.1."""
        return self.codes(*self.machine.polar.off)

    @cached_property
    def sections(self) -> Sections:
        """The polar sections."""
        cutting = np.isin(self.motion, (Motion.LINE, Motion.CW, Motion.CCW))
        marks = Marks(
            on=self.switches_on & ~self.switches_off,
            off=self.switches_off,
            starts=self.starts,
            outside=self.codes("G27", "G28", "G30", "G53"),
            tool_ends=self.changes_tool | self.ends_program | self.codes("M1", "M6"),
            rapid=self.codes("G0"),
            cuts=cutting & self.has(*self._virtual),
            moves=cutting & self.moves_plane,
            returns=self.codes("M99"),
        )
        return find_sections(marks)

    @cached_property
    def section(self) -> Rows:
        """Number of the polar section, its G12.1 included; -1 outside."""
        return section_column(self.sections, len(self))

    @cached_property
    def enters(self) -> Mask:
        """The G12.1 that begins a section."""
        return self._rows(self.sections.enter)

    @cached_property
    def leaves(self) -> Mask:
        """The G13.1 that ends a section."""
        return self._rows(self.sections.leave[self.sections.left & ~self.sections.returned])

    @cached_property
    def enters_again(self) -> Mask:
        """A G12.1 inside a section."""
        return self._rows(self.sections.again)

    def _rows(self, rows: Rows) -> Mask:
        mask = np.zeros(len(self), bool)
        mask[rows[rows < len(self)]] = True
        return mask

    def first_in_section(self, mask: Mask) -> Mask:
        """Of the rows of a mask the first in each section."""
        rows = np.flatnonzero(mask & (self.section >= 0))
        first = np.ones(len(rows), bool)
        first[1:] = np.diff(self.section[rows]) > 0
        return self._rows(rows[first])

    @cached_property
    def in_polar(self) -> Mask:
        """Between a G12.1 and its G13.1, neither included."""
        return (self.section >= 0) & ~self.enters

    # ---- positions ----

    @cached_property
    def incremental(self) -> Mask:
        """G91 in systems B and C."""
        return np.asarray(self.state("distance") == Distance.INCREMENTAL)

    def _programmed(self, address: str, increment: str, factor: Floats | float, where: Mask) -> tuple[Floats, Floats]:
        """Absolute coordinates (NaN where none) and increments (0 where none) of an axis in the rows `where`."""
        value, step = self.length_of(address) * factor, self.length_of(increment) * factor
        where = where & self.uses_axes
        written = self.has(address) & where
        has_step = self.has(increment) & where
        absolute = np.where(written & ~self.incremental, value, np.nan)
        absolute[~where] = np.nan
        steps = np.where(written & self.incremental, value, 0.0) + np.where(has_step, step, 0.0)
        broken = written & np.isnan(value)
        return absolute, np.where(broken, np.nan, steps)

    def _forgets(self, axis: str, increment: str) -> Mask:
        """Rows after which an axis is not where its words say: references, shifts, cycles, blocks not executed."""
        named = self.has(axis, increment)
        setting = COORDINATE_SETTING[self.machine.control.g_code_system]
        lost = self.codes("G10", "G28", "G30", "G52", "G53", setting) & named
        work_offset = self.state("work_offset")
        lost |= self.sets("work_offset") & (work_offset != before(work_offset, self.starts, 0))
        if axis in "XZ":
            cycle = (self.motion == Motion.CYCLE) | self.codes("G70", "G71", "G72", "G73", "G74", "G75", "G76")
            lost |= cycle | self.changes_tool
        return (lost & (self.section < 0)) | self.run.unknown | self.starts

    def _set_by(self, axis: str) -> Floats:
        """What G50 (G92) or G28 make the coordinate of an axis; NaN where that is not known."""
        setting = self.codes(COORDINATE_SETTING[self.machine.control.g_code_system])
        return np.where(setting & self.has(axis), self.length_of(axis), np.nan)

    @cached_property
    def x_factor(self) -> Floats:
        """Radius per written X: a half where X is a diameter."""
        return self.own.x_factor

    @cached_property
    def _plane(self) -> tuple[Points, Points]:
        """Plane points after and before each row; the virtual coordinate is NaN outside the mode."""
        x_words = self._programmed("X", "U", self.x_factor, ~self.enters)
        c_words = self._programmed(*self._virtual, self.own.virtual_factor, self.in_polar)
        leave = self.sections.leave[self.sections.leave < len(self)]
        c = positions(*c_words, self.enters, np.zeros(len(self)))
        c = np.where(self.section >= 0, c, np.nan)
        resets = self._forgets("X", "U") | self._rows(leave)
        values = self._set_by("X") * self.x_factor
        for _ in range(_PASSES):
            x = positions(*x_words, resets, values)
            if not len(leave):
                break
            # The control leaves the mode with X where the machine stands: never negative (B-62764EN/01 p. 51).
            found = np.hypot(x[leave - 1], c[leave - 1])
            if np.array_equal(found, values[leave], equal_nan=True):
                break
            values[leave] = found
        else:
            values[leave] = np.nan  # sections that hang on each other by increments alone, one after another
            x = positions(*x_words, resets, values)
        end = np.empty(len(self), np.complex128)
        end.real, end.imag = x, c
        return end, before(end, self.starts, _NOWHERE)

    @cached_property
    def end(self) -> Points:
        """Programmed plane point after the row [mm]; NaN outside the mode or while unknown."""
        return np.where(self.section >= 0, self._plane[0], _NOWHERE)

    @cached_property
    def start(self) -> Points:
        """Programmed plane point before the row [mm]."""
        return np.where(self.in_polar, self._plane[1], _NOWHERE)

    @cached_property
    def x(self) -> Floats:
        """X after the row as a radius [mm]; the programmed one, so that it may be negative in the mode."""
        return self._plane[0].real

    @cached_property
    def z(self) -> Floats:
        """Z after the row [mm]; NaN while unknown."""
        words = self._programmed("Z", "W", 1.0, np.ones(len(self), bool))
        return positions(*words, self._forgets("Z", "W"), self._set_by("Z"))

    @cached_property
    def center(self) -> Points:
        """Center of an arc on the polar plane [mm]; NaN for lines and where it cannot be known."""
        arcs = self.is_arc
        center = np.full(len(self), _NOWHERE)
        if not arcs.any():
            return center
        i, j = (self.length_of(word)[arcs] for word in self.own.center_words)
        written = ~np.isnan(i) | ~np.isnan(j)
        start, end, kind = self.start[arcs], self.end[arcs], self.motion[arcs]
        by_center = np.where(written, start + np.nan_to_num(i) + 1j * np.nan_to_num(j), _NOWHERE)
        radius = self.length_of(self.machine.arcs.radius_word)[arcs]
        by_radius = polar.center_from_radius(start, end, radius, kind, np.inf)
        center[arcs] = np.where(np.isnan(radius), by_center, by_radius)
        return center

    @cached_property
    def is_arc(self) -> Mask:
        """An arc on the polar plane."""
        return self.in_polar & self.moves_plane & np.isin(self.motion, (Motion.CW, Motion.CCW))

    @cached_property
    def length(self) -> Floats:
        """Way of the row on the polar plane [mm]; 0 where it does not move there, NaN where unknown."""
        moving = self.in_polar & self.moves_plane
        length = np.zeros(len(self))
        length[moving] = polar.length(*self._move(moving))
        return length

    def _move(self, rows: Mask) -> tuple[Points, Points, Points, States]:
        return self.start[rows], self.end[rows], self.center[rows], self.motion[rows]

    @cached_property
    def c_angle(self) -> Floats:
        """C angle of the machine after the row [deg], continuous along a section; NaN while unknown."""
        moving = self.uses_axes & (self.section < 0)
        written, stepped = self.has("C") & moving, self.has("H") & moving
        absolute = np.where(written & ~self.incremental, self._degrees("C"), np.nan)
        turn = np.where(written & self.incremental, self._degrees("C"), 0.0)
        turn += np.where(stepped, self._degrees("H"), 0.0)
        on_plane = self.in_polar & self.moves_plane
        turn[on_plane] = polar.c_sweep(*self._move(on_plane))
        # G28 H0 takes C to its reference point, the zero of its angle (builder's guide: "zero return C-axis").
        referenced = self.codes("G28", "G30") & self.has("C", "H")
        values = np.where(referenced, 0.0, np.where(self.codes("G50", "G92"), self._degrees("C"), np.nan))
        return positions(absolute, turn, self._forgets("C", "H"), values)

    def _degrees(self, address: str) -> Floats:
        return self._column(f"degrees {address}", lambda: self._scatter(address, self._values))

    # ---- compensation ----

    @cached_property
    def side(self) -> States:
        """Cutter compensation in force (Side); after a section it is off, be it that its G40 was forgotten."""
        written = self.sets("side")
        state = np.where(written, self.state("side"), Side.OFF)
        return fill_down(state, written | self._rows(self.sections.leave) | self.starts, Side.OFF).astype(np.int8)

    @cached_property
    def side_before(self) -> States:
        """Cutter compensation in force before the row."""
        return before(self.side, self.starts, Side.OFF).astype(np.int8)

    @cached_property
    def cuts(self) -> Mask:
        """A move on the polar plane at feed."""
        return self.in_polar & self.moves_plane & np.isin(self.motion, (Motion.LINE, Motion.CW, Motion.CCW))

    @cached_property
    def starts_up(self) -> Mask:
        """The move in which compensation is built up."""
        return np.asarray(self.cuts & (self.side != Side.OFF) & (self.ramps.side_of_move_before == Side.OFF))

    @cached_property
    def cancels(self) -> Mask:
        """The move in which compensation is taken back."""
        return np.asarray(self.cuts & (self.side == Side.OFF) & (self.ramps.side_of_move_before != Side.OFF))

    @cached_property
    def cancels_standing(self) -> Mask:
        """A G40 after which nothing moves on the plane before the mode is left or compensation begins again."""
        return self.ramps.ends_standing

    # ---- moves ----

    @cached_property
    def section_entry(self) -> Floats:
        """C angle of each section at its G12.1 [deg]; 0 where it is not known."""
        return np.nan_to_num(self.c_angle[self.sections.enter])

    @cached_property
    def programmed_moves(self) -> Moves:
        """The moves of the programmed path inside sections."""
        return moves.programmed_moves(self)

    @cached_property
    def _compensated(self) -> tuple[Moves, ToolPath, Rows]:
        found, tool, row = moves.compensated(self)
        return self.infeed.with_passes(found), tool, row

    @property
    def tool_moves(self) -> Moves:
        """The moves of the tool center inside sections."""
        return self._compensated[0]

    def found_by_compensation(self, name: str) -> Mask:
        """What the control would object to while it compensates, per row (compensation.ToolPath)."""
        _, tool, row = self._compensated
        return self._rows(row[getattr(tool, name)])

    def _of_moves(self, name: str, none: float, largest: bool = True) -> Floats:
        values = getattr(self.tool_moves, name)
        return moves.per_row(values, self.tool_moves, len(self), none, largest)

    @cached_property
    def nearest(self) -> Floats:
        """Smallest distance of the tool center to the center of C [mm]; inf without movement, NaN unknown."""
        return self._of_moves("nearest", np.inf, largest=False)

    @cached_property
    def c_feed(self) -> Floats:
        """Highest rate of C [deg/min]; 0 without movement, NaN unknown."""
        return self._of_moves("c_feed", 0.0)

    @cached_property
    def c_acceleration(self) -> Floats:
        """Highest acceleration of C [deg/s2]; 0 without movement, NaN unknown."""
        return self._of_moves("c_acceleration", 0.0)

    @cached_property
    def c_feed_limit(self) -> float:
        """Limit of C [deg/min]: the machine's own, of which automatic override takes a share; else a suspicious one."""
        limits = self.machine.limits
        if np.isnan(limits.c_feed):
            return limits.c_feed_suspicious
        return limits.c_feed * (min(limits.override_share, 100) / 100 if limits.automatic_override else 1)

    @cached_property
    def feed_allowed(self) -> Floats:
        """Highest F that keeps C at or below its limit [mm/min]; inf without movement."""
        allowed = self.tool_moves.feed_allowed(self.c_feed_limit)
        return moves.per_row(allowed, self.tool_moves, len(self), np.inf, largest=False)

    # ---- what the control does in its own way ----

    own = cached_property(OwnWords)
    infeed = cached_property(InfeedCycle)
    other_machine = cached_property(OtherMachine)

    @cached_property
    def feed_number(self) -> Floats:
        """F in force as a number [mm per min or per revolution]; NaN before the first."""
        return self.own.feed_number(super().feed_number)

    # ---- flow ----

    def faults_of(self, rule: str) -> Mask:
        """Which of the faults that macro and flow found belong to a rule."""
        return np.array([fault.rule == rule for fault in self.run.faults], bool)

    def fault_text(self, index: int) -> str:
        """What is wrong, in words."""
        return self.run.faults[index].text

    # ---- what rules ask of the polar mode ----

    modes = cached_property(Modes)
    ramps = cached_property(Ramps)
    overcutting = cached_property(Overcutting)
    arcs = cached_property(Arcs)
    feeds = cached_property(Feeds)
    reach = cached_property(Reach)
    increments = cached_property(Increments)

    # ---- the state on entry, the text ----

    entry = cached_property(Entry)
    lexical = cached_property(Lexical)

    @property
    def whole_program(self) -> Mask:
        """The row belongs to a main program that is there from its head on."""
        return self.entry.whole_program

    @cached_property
    def feed(self) -> Floats:
        """F in force [mm/min]; NaN where none is or where it depends on a spindle."""
        return np.where(self.feeds.per_minute, self.feed_number, np.nan)
