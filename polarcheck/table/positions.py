"""
Where the axes stand: the polar sections, and the programmed position after each row.

Columns are made when they are first asked for. Inside everything is mm, deg, min and X as radius.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask, Points, Rows, States, is_among, repeated
from polarcheck.machines.axes import INCREMENTS
from polarcheck.machines.code_lists import numbers
from polarcheck.machines.modal import Motion
from polarcheck.table.filling import before, fill_down, happened, positions
from polarcheck.table.frames import Frames, Way, along, find_frames, in_frame
from polarcheck.table.sections import Marks, Sections, find_sections, section_column
from polarcheck.table.virtual_axis import VirtualAxis

_FACTOR = {"diameter": 0.5, "radius": 1.0}
#: The point of a row of which none is known.
NOWHERE = complex("nan+nanj")
_PASSES = 8


class Positions(VirtualAxis):
    """The columns of where the tool is programmed to be; see the properties."""

    # ---- motion ----

    @cached_property
    def moves_plane(self) -> Mask:
        """Programs the linear or the virtual axis, an arc by its center alone included."""
        is_arc = is_among(self.state("motion"), (Motion.CW, Motion.CCW))
        axes = self.programs_linear_axis | self.programs_virtual_axis
        return self.uses_axes & (axes | (is_arc & self.has("I", "J", "K") & ~self.programs_z)) & ~self.switches_on

    @cached_property
    def moves_z(self) -> Mask:
        """Programs Z, where that is not the linear axis."""
        return self.uses_axes & self.programs_z

    @cached_property
    def motion(self) -> States:
        """What the row does with its axis words (Motion); NONE without axis words."""
        moving = (
            self.moves_plane | self.moves_z | (self.uses_axes & self.has(*self.machine.polar.rotary_words, "Y", "V"))
        )
        motion = np.where(self.in_cycle, Motion.CYCLE, self.state("motion"))
        return np.where(moving, motion, Motion.NONE).astype(np.int16)

    @cached_property
    def moves(self) -> Mask:
        """Moves any axis."""
        return np.asarray(self.motion != Motion.NONE)

    # ---- polar sections ----

    @cached_property
    def sections(self) -> Sections:
        """The polar sections."""
        m_codes = self.machine.m_codes
        cutting = is_among(self.motion, (Motion.LINE, Motion.CW, Motion.CCW))
        marks = Marks(
            on=self.switches_on & ~self.ends_mode,
            off=self.ends_mode,
            starts=self.starts,
            outside=self.listed("reference_check", "reference_return", "machine_coordinates")
            | self.codes(*m_codes.c_axis_off),
            tool_ends=self.changes_tool | self.ends_program | self.codes(*m_codes.tool_change),
            stops=self.codes(*m_codes.optional_stop),
            rapid=self.listed("rapid"),
            cuts=cutting & self.programs_virtual_axis,
            moves=cutting & self.moves_plane,
            returns=self.codes(*self.machine.macro.program_returns) & (self.run.depth == 0),
            broken_off=np.zeros(len(self), bool) if self.run.broken_off is None else self.run.broken_off,
        )
        return find_sections(marks)

    @cached_property
    def section(self) -> Rows:
        """Number of the polar section, its G12.1 included; -1 outside."""
        return section_column(self.sections, len(self))

    @cached_property
    def whole_section(self) -> Rows:
        """The same, with its G13.1."""
        return np.where(self.leaves, before(self.section, self.starts, -1), self.section)

    def anywhere_in_section(self, mask: Mask) -> Mask:
        """Rows of sections in which any row is in the mask."""
        hit = np.zeros(len(self.sections) + 1, bool)
        hit[self.section[mask & (self.section >= 0)]] = True
        return hit[self.section]

    def nowhere_in_section(self, mask: Mask) -> Mask:
        """Rows of sections in which no row is in the mask, and none of unknown effect, which might be."""
        return ~self.anywhere_in_section(mask | self.run.unknown)

    def count_in_section(self, mask: Mask) -> Rows:
        """Per section how many of its rows are in the mask."""
        return np.bincount(self.section[mask & (self.section >= 0)], minlength=len(self.sections))

    @cached_property
    def enters(self) -> Mask:
        """The G12.1 that begins a section."""
        return self.mask_of(self.sections.enter)

    @cached_property
    def leaves(self) -> Mask:
        """The G13.1 that ends a section."""
        return self.mask_of(self.sections.leave[self.sections.left & ~self.sections.returned])

    @cached_property
    def enters_again(self) -> Mask:
        """A G12.1 inside a section."""
        return self.mask_of(self.sections.again)

    def mask_of(self, rows: Rows) -> Mask:
        """Per row: whether it is one of these; those beyond the last are left out."""
        mask = np.zeros(len(self), bool)
        mask[rows[rows < len(self)]] = True
        return mask

    def first_in_section(self, mask: Mask) -> Mask:
        """Of the rows of a mask the first in each section."""
        rows = np.flatnonzero(mask & (self.section >= 0))
        first = np.ones(len(rows), bool)
        first[1:] = np.diff(self.section[rows]) > 0
        return self.mask_of(rows[first])

    @cached_property
    def in_polar(self) -> Mask:
        """Between a G12.1 and its G13.1, neither included."""
        return (self.section >= 0) & ~self.enters

    # ---- positions ----

    @cached_property
    def units(self) -> States:
        """
        Units.INCH or Units.MM. A code that cannot stand in the mode has a finding for that, and changes none: with it
        the contour would be another.
        """
        assumed: States = super().units
        allowed = set(numbers(self.machine.polar.allowed_codes))
        codes = [code for key in ("inch", "mm") for code in self.machine.codes(key)]
        refused = self.codes(*(code for code in codes if not allowed.issuperset(numbers([code])))) & self.in_polar
        if not refused.any():
            return assumed
        written = self.sets("units") & ~refused
        return fill_down(assumed, written | self.starts, assumed[0])

    def _programmed(
        self, address: str, increment: str, factor: Floats | float, where: Mask, of_step: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """
        Absolute coordinates (NaN where none) and increments (0 where none) of an axis in the rows `where`.

        factor: what the words are multiplied by; of_step: those that are distances, where that is another.
        """
        is_step = self.is_step(address)
        if of_step is not None:
            factor = np.where(is_step, of_step, factor)
        value, step = self.length_of(address) * factor, self.length_of(increment) * factor
        where = where & self.uses_axes
        written = self.has(address) & where
        has_step = self.has(increment) & where
        absolute = np.where(written & ~is_step, value, np.nan)
        absolute[~where] = np.nan
        steps = np.where(written & is_step, value, 0.0) + np.where(has_step, step, 0.0)
        broken = written & np.isnan(value)
        return absolute, np.where(broken, np.nan, steps)

    @property
    def _virtual_coordinates(self) -> tuple[Floats, Floats]:
        """
        The virtual axis as _programmed gives an axis.

        A row that names it by the address of another control has a finding for that, and means it nevertheless.
        """
        factor = _FACTOR[self.machine.polar.virtual_axis_programming]
        absolute, steps = np.full(len(self), np.nan), np.zeros(len(self))
        for pair, rows in self.virtual_pairs:
            if rows.any():
                found = self._programmed(*pair, factor, self.in_polar & rows)
                absolute, steps = np.where(rows, found[0], absolute), np.where(rows, found[1], steps)
        return in_frame(self.frames, self.in_polar, absolute, steps, along_virtual=True)

    def _forgets(self, axis: str, increment: str) -> Mask:
        """Rows after which an axis is not where its words say: references, shifts, cycles, blocks not executed."""
        named = self.has(axis, increment)
        lost = self.listed("data_input", "reference_return", "machine_coordinates", "coordinate_preset")
        lost = lost | self.sets_coordinates | (self.listed("local_shift") & (axis != "X"))
        lost &= named
        work_offset = self.state("work_offset")
        lost |= self.sets("work_offset") & (work_offset != before(work_offset, self.starts, 0))
        if axis in "XZ":
            cycle = (self.motion == Motion.CYCLE) | self.listed("repetitive_cycle")
            lost |= cycle | self.changes_tool
        return (lost & (self.section < 0)) | self.run.unknown | self.starts

    @cached_property
    def is_followed(self) -> Mask:
        """
        Where the tool goes on the plane is followed: its linear axis is known, the mode is simulated, and both axes are
        followed. Where another axis stands in a section that does not program both of its own, it may be that of the
        plane.
        """
        known = self.linear_is_known & self.is_simulated
        if not len(self.words_not_followed):
            return known
        beside = self.anywhere_in_section(self.with_words(self.words_not_followed))
        own = self.anywhere_in_section(self.programs_linear_axis) & self.anywhere_in_section(self.programs_virtual_axis)
        return np.asarray(known & (~beside | own))

    @cached_property
    def sets_coordinates(self) -> Mask:
        """G50 (G92): axis words say where the tool stands, or with S how fast the spindle may turn."""
        return self.listed("coordinate_setting")

    def _set_by(self, axis: str) -> Floats:
        """What G50 (G92) or G28 make the coordinate of an axis; NaN where that is not known."""
        return np.where(self.sets_coordinates & self.has(axis), self.length_of(axis), np.nan)

    @cached_property
    def x_factor(self) -> Floats:
        """Radius per written X, or other linear axis of the polar plane: a half where X is a diameter."""
        control = self.machine.control
        factor = np.where(self.section >= 0, _FACTOR[self.machine.polar.x], _FACTOR[control.x])
        factor[self.linear_axis != ord("X")] = 1.0
        if not (control.x_radius_words or control.x_diameter_words or control.x_absolute_diameter_words):
            return factor
        radius = self.codes(*control.x_radius_words)
        diameter = self.codes(*control.x_diameter_words, *control.x_absolute_diameter_words)
        if control.x_without_words:
            has_none = ~self.anywhere_in_program(radius | diameter) & (self.section < 0)
            factor = np.where(has_none, _FACTOR[control.x_without_words], factor)
        switched = radius | diameter | self.starts
        if set(self.machine.polar.off) & set(control.x_diameter_words):
            # The mode has an X of its own, up to where it was meant to end.
            switched |= self.enters | self.mask_of(self.sections.leave)
        chosen = fill_down(np.where(radius, 1.0, np.where(diameter, 0.5, np.nan)), switched, np.nan)
        return np.asarray(np.where(np.isnan(chosen), factor, chosen), np.float64)

    @cached_property
    def x_step_factor(self) -> Floats | None:
        """The same of X as a distance, where words make a diameter of the coordinate alone, as DIAM90; else None."""
        control = self.machine.control
        both = self.codes(*control.x_absolute_diameter_words)
        if not both.any():
            return None
        others = self.codes(*control.x_radius_words, *control.x_diameter_words)
        return np.where(happened(both, others | self.starts), 1.0, self.x_factor)

    @cached_property
    def center_shift(self) -> Points:
        """
        Where the program has the center of C on the polar plane of each row [mm]: at the origin, or at the coordinates
        beside G12.1 where the control knows such (5450#2 PLS; GSK: offsets of the linear and of the rotary axis).
        """
        own, takes = self.machine.polar, set(self.machine.polar.words_beside_switch)
        if not len(self.sections) or not takes:
            return repeated(np.complex128(0), len(self))
        enter = self.sections.enter
        of_section = np.zeros(len(enter) + 1, np.complex128)
        if "X" in takes:
            linear = self._of_axis(lambda axis: self.length_of(axis)) * self.x_factor
            of_section[:-1] += np.nan_to_num(linear[enter])
        shifts = np.array([self.virtual_axis_of(row) in takes for row in enter.tolist()])
        if shifts.any():
            virtual = self.of_virtual_axis(self.length_of) * _FACTOR[own.virtual_axis_programming]
            of_section[:-1] += np.where(shifts, 1j * np.nan_to_num(virtual[enter]), 0)
        return of_section[self.section] if of_section.any() else repeated(np.complex128(0), len(self))

    @property
    def _linear_coordinates(self) -> tuple[Floats, Floats]:
        """The linear axis of each row as _programmed gives an axis; X outside the mode."""
        is_x = ~self.enters & (self.linear_axis == ord("X"))
        absolute, steps = self._programmed("X", "U", self.x_factor, is_x, self.x_step_factor)
        shifted = np.diff(self.local_shift, prepend=0.0) * self.x_factor
        # In the mode that is a finding, and changes nothing of what is meant.
        steps = steps - np.where(self._shifts & (self.section < 0), shifted, 0.0)
        for axis in self.other_linear_axes:
            other = self._programmed(axis, INCREMENTS[axis], 1.0, self.in_polar & (self.linear_axis == ord(axis)))
            absolute, steps = np.where(np.isnan(absolute), other[0], absolute), steps + other[1]
        return in_frame(self.frames, self.in_polar, absolute, steps, along_virtual=False)

    @cached_property
    def local_shift(self) -> Floats:
        """X of the G52 in force, as written [mm], by which the coordinate of a place is less; NaN where not known."""
        if not self._shifts.any():
            return repeated(np.float64(0), len(self))
        shift = np.where(self.listed("local_shift"), self.length_of("X"), 0.0)
        return fill_down(shift, self._shifts | self.starts, 0.0).astype(np.float64)

    @cached_property
    def _shifts(self) -> Mask:
        """G52 with X, and what takes it back."""
        return np.asarray((self.listed("local_shift") & self.has("X")) | self.presets_x)

    @cached_property
    def frames(self) -> Frames | None:
        """The frame in force in each row; None where the program has none."""
        return find_frames(self, self.x_factor, self.in_polar)

    def _alone(self, axis: str) -> Floats:
        """An axis after each row [mm] by what stands outside the mode."""
        where = self.section < 0
        resets = self._forgets(axis, INCREMENTS[axis]) | self.leaves
        return positions(*self._programmed(axis, INCREMENTS[axis], 1.0, where), resets, self._set_by(axis))

    @cached_property
    def _after(self) -> Points:
        """Plane point after each row; the virtual coordinate is NaN outside the mode."""
        shift, turn = self.center_shift, self.c_direction
        leave = self.sections.leave[self.sections.leave < len(self)]
        # Where C does not turn the plane, the tool stands at its angle there, and not on the linear axis.
        enter = self.sections.enter[turn[self.sections.enter] != 1]
        resets = self._forgets("X", "U") | self.mask_of(leave) | self.mask_of(enter)
        values, virtual = self._set_by("X") * self.x_factor, shift.imag.copy()
        # Outside its section nobody asks where another linear axis is but at G12.1, and X is not followed within.
        for axis in self.other_linear_axes:
            begins = self.enters & (self.linear_axis == ord(axis))
            resets, values = resets | begins, np.where(begins, self._alone(axis), values)
        leave = leave[(self.linear_axis == ord("X"))[leave - 1]]
        x_words = Way(*self._linear_coordinates, resets, values)
        c_words = Way(*self._virtual_coordinates, self.enters, virtual)
        alone = None if len(enter) else self._virtual(c_words)
        for _ in range(_PASSES):
            x, c = self._both(x_words, c_words, alone)
            # The control leaves the mode with X where the machine stands: never negative (B-62764EN/01 p. 51).
            last = leave - 1
            found = np.hypot(x[last] - shift.real[last], c[last] - shift.imag[last]) + shift.real[last]
            entry = before(x, self.starts, np.nan)[enter] * turn[enter]
            told = np.concatenate((values[leave], values[enter], virtual[enter]))
            if np.array_equal(told, np.concatenate((found, entry.real, entry.imag)), equal_nan=True):
                break
            values[leave], values[enter], virtual[enter] = found, entry.real, entry.imag
        else:
            values[leave] = np.nan  # sections that hang on each other by increments alone, one after another
            x, c = self._both(x_words, c_words, alone)
        end = np.empty(len(self), np.complex128)
        end.real, end.imag = np.where(self.is_followed, x, np.nan), c
        end -= shift
        return end

    def _virtual(self, words: Way) -> Floats:
        """The virtual axis after each row where no frame turns it; NaN outside the mode."""
        return np.where(self.section >= 0, positions(*words), np.nan)

    def _both(self, x_words: Way, c_words: Way, alone: Floats | None) -> tuple[Floats, Floats]:
        """The linear and the virtual axis after each row; alone: the latter without frames, where it is known."""
        if self.frames is None or not np.any((self.frames.angle != 0) & self.in_polar):
            return positions(*x_words), self._virtual(c_words) if alone is None else alone
        found = along(x_words, c_words, np.where(self.in_polar, self.frames.turn, 1.0))
        return found.real, np.where(self.section >= 0, found.imag, np.nan)

    @cached_property
    def end(self) -> Points:
        """Programmed plane point after the row [mm]; NaN outside the mode or while unknown."""
        return np.where(self.section >= 0, self._after, NOWHERE)

    @cached_property
    def start(self) -> Points:
        """Programmed plane point before the row [mm]."""
        return np.where(self.in_polar, before(self._after, self.starts, NOWHERE), NOWHERE)

    @cached_property
    def x(self) -> Floats:
        """X after the row as a radius [mm]; the programmed one, so that it may be negative in the mode."""
        after = self._after.real
        # A plane that does not turn with C has another X there than the lathe, which has not moved.
        turns = self.machine.polar.zero_angle == "at-switch"
        return after if turns else np.where(self.enters, self.x_before, after)

    @cached_property
    def x_before(self) -> Floats:
        """X before the row as a radius [mm]."""
        return before(self._after.real, self.starts, np.nan)

    @cached_property
    def z(self) -> Floats:
        """Z after the row [mm]; NaN while unknown."""
        absolute, steps = self._programmed("Z", "W", 1.0, np.ones(len(self), bool))
        if self.frames is not None:
            absolute = absolute + self.frames.z
        return positions(absolute, steps, self._forgets("Z", "W"), self._set_by("Z"))
