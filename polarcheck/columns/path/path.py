"""
The programmed path: where the tool is programmed to be before and after each executed block.

Inside everything is mm, deg and X as radius; points of the polar plane are complex, x + 1j*c.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.filling import before, fill_down, positions
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.coordinates import Coordinates
from polarcheck.columns.path.cycle_ends import CycleEnds, or_of_cycle
from polarcheck.columns.path.frames import AxisPath, Frames, along, find_frames, in_frame
from polarcheck.columns.path.lengths import RADIUS_FACTOR, Lengths
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Points,
    Rows,
    States,
    cached_property,
    column_at,
    is_among,
    repeated,
)
from polarcheck.foundation.states import Distance, FeedAxes, Motion
from polarcheck.geometry import polar
from polarcheck.geometry.plane import angle_between
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import ZERO
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.axis_table import INCREMENTS
from polarcheck.program.machines.code_lists import numbers
from polarcheck.program.machines.machine import Machine

if TYPE_CHECKING:
    from polarcheck.columns.path.entry_places import EntryPlaces

#: The point of a row of which none is known.
NOWHERE = complex("nan+nanj")
_PASSES = 8


class ProgrammedPath(Columns, frozen=True):
    """Positions, centers of arcs, and the moves on the polar plane."""

    run: Run
    machine: Machine
    blocks: ExecutedBlocks
    modal: ModalStates
    tools: CalledTools
    coordinates: Coordinates
    axes: PlaneAxes
    mode: PolarMode
    lengths: Lengths

    def _programmed(
        self, address: str, increment: str, factor: Floats | float, where: Mask, of_step: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """
        Absolute coordinates (NaN where none) and increments (0 where none) of an axis in the rows `where`.

        factor: what the words are multiplied by; of_step: those that are distances, where that is another.
        """
        is_step = self.modal.is_step(address)
        if of_step is not None:
            factor = np.where(is_step, of_step, factor)
        value, step = self.lengths.length_of(address) * factor, self.lengths.length_of(increment) * factor
        where = where & self.modal.uses_axes & ~self.cycles.returns
        if address == "Z" and self.modal.sets("drilling").any():
            where &= self.modal.drilling == 0  # the bottom of the hole, where the tool does not stay
        written = self.blocks.has(address) & where
        has_step = self.blocks.has(increment) & where
        absolute = np.where(written & ~is_step, value, np.nan)
        absolute[~where] = np.nan
        steps = np.where(written & is_step, value, 0.0) + np.where(has_step, step, 0.0)
        broken = written & np.isnan(value)
        return absolute, np.where(broken, np.nan, steps)

    @cached_property
    def cycles(self) -> CycleEnds:
        """Where cycles of turning end."""
        return CycleEnds(self.blocks, self.modal)

    @property
    def _virtual_coordinates(self) -> tuple[Floats, Floats]:
        """
        The virtual axis as _programmed gives an axis.

        A row that names it by the address of another control has a finding for that, and means it nevertheless.
        """
        factor = RADIUS_FACTOR[self.machine.polar.virtual_axis_programming]
        absolute, steps = np.full(len(self.run), np.nan), np.zeros(len(self.run))
        for pair, rows in self.axes.virtual_pairs:
            if rows.any():
                coordinates = self._programmed(*pair, factor, self.mode.in_polar & rows)
                absolute, steps = np.where(rows, coordinates[0], absolute), np.where(rows, coordinates[1], steps)
        return in_frame(self.frames, self.mode.in_polar, absolute, steps, along_virtual=True)

    def _forgets(self, axis: str, increment: str) -> Mask:
        """Rows after which an axis is not where its words say: references, shifts, cycles, blocks not executed."""
        named = self.blocks.has(axis, increment)
        lost = self.blocks.listed("data_input", "reference_return", "machine_coordinates", "coordinate_preset")
        lost = lost | self.modal.sets_coordinates | (self.blocks.listed("local_shift") & (axis != "X"))
        lost &= named
        work_offset = self.modal.state("work_offset")
        lost |= self.modal.sets("work_offset") & (work_offset != before(work_offset, self.blocks.starts, 0))
        if axis in "XZ":
            lost |= (self.cycles.loses(axis, increment) & self.axes.moves) | self.tools.changes_tool
        outside = self.mode.section < 0
        if (allowed := self._machine_coordinates_in_mode).any():
            outside |= allowed
        return (lost & outside) | self.run.unknown | self.blocks.starts

    @property
    def _machine_coordinates_in_mode(self) -> Mask:
        """Moves in machine coordinates in the mode, where the profile allows them there."""
        allowed = set(numbers(self.machine.polar.allowed_codes))
        codes = [code for code in self.machine.codes("machine_coordinates") if allowed.issuperset(numbers([code]))]
        return (self.blocks.codes(*codes) & self.mode.in_polar) | self.of_machine_z

    @cached_property
    def of_machine_z(self) -> Mask:
        """Blocks in the mode with Z alone in machine coordinates, where the profile allows them there."""
        if not self.machine.polar.z_of_machine:
            return self.blocks.nowhere
        further = [word for word in (*self.machine.axis_words, *self.machine.polar.axis_addresses) if word not in "ZW"]
        is_z = self.blocks.has("Z") & ~self.blocks.has(*further)
        return self.blocks.listed("machine_coordinates") & self.mode.in_polar & is_z

    def _set_by(self, axis: str) -> Floats:
        """The coordinate of an axis after G50 (G92) or G28; NaN where that is not known."""
        return np.where(self.modal.sets_coordinates & self.blocks.has(axis), self.lengths.length_of(axis), np.nan)

    @cached_property
    def center_shift(self) -> Points:
        """
        Where the program has the center of C on the polar plane of each row [mm]: at the origin, or at the coordinates
        beside G12.1 where the control knows such (5450#2 PLS; GSK: offsets of the linear and of the rotary axis).
        """
        polar, takes = self.machine.polar, set(self.machine.polar.words_beside_switch)
        if not len(self.mode.sections) or not takes:
            return repeated(np.complex128(0), len(self.run))
        enter = self.mode.sections.enter
        of_section = np.zeros(len(enter) + 1, np.complex128)
        if "X" in takes:
            linear = self.axes.of_linear_axis(lambda axis: self.lengths.length_of(axis)) * self.lengths.x_factor
            of_section[:-1] += np.nan_to_num(linear[enter])
        shifts = np.array([self.axes.virtual_axis_of(row) in takes for row in enter.tolist()])
        if shifts.any():
            virtual = self.axes.of_virtual_axis(self.lengths.length_of) * RADIUS_FACTOR[polar.virtual_axis_programming]
            of_section[:-1] += np.where(shifts, 1j * np.nan_to_num(virtual[enter]), 0)
        return of_section[self.mode.section] if of_section.any() else repeated(np.complex128(0), len(self.run))

    @property
    def _linear_coordinates(self) -> tuple[Floats, Floats]:
        """The linear axis of each row as _programmed gives an axis; X outside the mode."""
        is_x = ~self.mode.enters & (self.axes.linear_axis == ord("X"))
        absolute, steps = self._programmed("X", "U", self.lengths.x_factor, is_x, self.lengths.x_step_factor)
        shifted = np.diff(self.local_shift, prepend=0.0) * self.lengths.x_factor
        # In the mode that is a finding, and changes nothing of what is meant.
        steps = steps - np.where(self._shifts & (self.mode.section < 0), shifted, 0.0)
        for axis in self.axes.other_linear_axes:
            where = self.mode.in_polar & (self.axes.linear_axis == ord(axis))
            incremental = self._programmed(axis, INCREMENTS[axis], 1.0, where)
            absolute, steps = np.where(np.isnan(absolute), incremental[0], absolute), steps + incremental[1]
        return in_frame(self.frames, self.mode.in_polar, absolute, steps, along_virtual=False)

    @cached_property
    def is_absolute_on_plane(self) -> Mask:
        """Writes both axes of the plane, and neither in steps."""
        axes = self._linear_coordinates, self._virtual_coordinates
        return np.asarray(np.logical_and.reduce([~np.isnan(absolute) & (steps == 0) for absolute, steps in axes]))

    @cached_property
    def local_shift(self) -> Floats:
        """X of the G52 in force, as written [mm], by which the coordinate of a place is less; NaN where not known."""
        if not self._shifts.any():
            return repeated(np.float64(0), len(self.run))
        shift = np.where(self.blocks.listed("local_shift"), self.lengths.length_of("X"), 0.0)
        return fill_down(shift, self._shifts | self.blocks.starts, 0.0).astype(np.float64)

    @cached_property
    def _shifts(self) -> Mask:
        """G52 with X, and what takes it back."""
        return np.asarray((self.blocks.listed("local_shift") & self.blocks.has("X")) | self.modal.presets_x)

    @cached_property
    def frames(self) -> Frames | None:
        """The frame in force in each row; None where the program has none."""
        return find_frames(self.blocks, self.modal, self.axes, self.mode, self.lengths)

    def _alone(self, axis: str) -> Floats:
        """An axis after each row [mm] by what stands outside the mode."""
        where = self.mode.section < 0
        resets = self._forgets(axis, INCREMENTS[axis]) | self.mode.leaves
        return positions(*self._programmed(axis, INCREMENTS[axis], 1.0, where), resets, self._set_by(axis))

    @cached_property
    def _after(self) -> Points:
        """Plane point after each row; the virtual coordinate is NaN outside the mode."""
        return self._points[0]

    @cached_property
    def _points(self) -> tuple[Points, Points]:
        """Plane point after each row, and per section where the tool stands at its G12.1, X being positive."""
        shift = self.center_shift
        leave = self.mode.sections.leave[self.mode.sections.leave < len(self.run)]
        # On a plane that C does not turn the tool stands at its angle there, and not on the linear axis.
        places = self._entry_places
        direction = np.ones(len(self.mode.sections), np.complex128) if places is None else places.by_words
        off_axis = np.zeros(len(direction), bool) if places is None else places.off_axis
        enter = self.mode.sections.enter[off_axis]
        resets = self._forgets("X", "U") | self.blocks.mask_of(leave) | self.blocks.mask_of(enter)
        values, virtual = self._set_by("X") * self.lengths.x_factor, shift.imag.copy()
        # Another linear axis counts in its section and at its G12.1 only, where X is not followed.
        for axis in self.axes.other_linear_axes:
            begins = self.mode.enters & (self.axes.linear_axis == ord(axis))
            resets, values = resets | begins, np.where(begins, self._alone(axis), values)
        leave = leave[(self.axes.linear_axis == ord("X"))[leave - 1]]
        linear = self._linear_coordinates
        x_words = AxisPath(*self.cycles.without_contours(*linear), resets, values)
        c_words = AxisPath(*self._virtual_coordinates, self.mode.enters, virtual)
        alone = None if len(enter) else self._virtual(c_words)
        for _ in range(_PASSES):
            x, c = self._both(x_words, c_words, alone)
            # The control leaves the mode with X where the machine stands: never negative (B-62764EN/01 p. 51).
            last = leave - 1
            x_left = np.hypot(x[last] - shift.real[last], c[last] - shift.imag[last]) + shift.real[last]
            if places is not None:
                direction = places.directions((x - shift.real) + 1j * (c - shift.imag))
            entry = before(x, self.blocks.starts, np.nan)[enter] * direction[off_axis]
            assumed = np.concatenate((values[leave], values[enter], virtual[enter]))
            if np.array_equal(assumed, np.concatenate((x_left, entry.real, entry.imag)), equal_nan=True):
                break
            values[leave], values[enter], virtual[enter] = x_left, entry.real, entry.imag
        else:
            values[leave] = np.nan  # sections that hang on each other by increments alone, one after another
            x, c = self._both(x_words, c_words, alone)
        x = self.cycles.with_contours(x, *linear, resets, values)
        end = np.empty(len(self.run), np.complex128)
        end.real, end.imag = np.where(self.mode.is_followed, x, np.nan), c
        end -= shift
        if (corners := self.run.corners) is not None:
            end[corners.ended] = corners.end
        return end, direction

    @property
    def _entry_places(self) -> EntryPlaces | None:
        """Where the tool stands where sections begin, along another axis than X on that; None where always there."""
        if not self.c_axis.is_fixed:
            return None
        from polarcheck.columns.path.entry_places import entry_places

        referenced = self.blocks.listed("c_axis_reference") & self.blocks.has(*self.machine.polar.rotary_words)
        lost = self.run.unknown | self.blocks.starts | (self.axes.linear_axis != ord("X"))
        return entry_places(self.mode.sections, self.c_axis, self.c_words, referenced, lost)

    def _virtual(self, words: AxisPath) -> Floats:
        """The virtual axis after each row where no frame turns it; NaN outside the mode."""
        return np.where(self.mode.section >= 0, words.positions(), np.nan)

    def _both(self, x_words: AxisPath, c_words: AxisPath, alone: Floats | None) -> tuple[Floats, Floats]:
        """The linear and the virtual axis after each row; alone: the latter without frames, where it is known."""
        if self.frames is None or not np.any((self.frames.angle != 0) & self.mode.in_polar):
            return x_words.positions(), self._virtual(c_words) if alone is None else alone
        point = along(x_words, c_words, np.where(self.mode.in_polar, self.frames.turn, 1.0))
        return point.real, np.where(self.mode.section >= 0, point.imag, np.nan)

    @cached_property
    def end(self) -> Points:
        """Programmed plane point after the row [mm]; NaN outside the mode or while unknown."""
        return np.where(self.mode.section >= 0, self._after, NOWHERE)

    @cached_property
    def start(self) -> Points:
        """Programmed plane point before the row [mm]."""
        return np.where(self.mode.in_polar, before(self._after, self.blocks.starts, NOWHERE), NOWHERE)

    @cached_property
    def x(self) -> Floats:
        """X after the row as a radius [mm]; the programmed one, so that it may be negative in the mode."""
        after = self._after.real
        # A plane that does not turn with C has another X there than the lathe, which has not moved.
        turns = not self.machine.polar.plane_is_fixed
        return after if turns else np.where(self.mode.enters, self.x_before, after)

    @cached_property
    def x_before(self) -> Floats:
        """X before the row as a radius [mm]."""
        return self.cycles.before(self._after.real)

    @property
    def z_sense(self) -> float:
        """By which Z here is multiplied to become Z as it is written: -1 where it is turned over (path/upright)."""
        return 1.0

    @cached_property
    def z(self) -> Floats:
        """Z after the row [mm]; NaN while unknown."""
        return self._along_z(*self._z_words, self._set_by("Z"))

    @cached_property
    def depth(self) -> Floats:
        """
        Z after the row, counted from 0 where Z is not known [mm]: enough to tell depths apart.

        Increments show how much deeper one block is than another. A Z word without a known value moves nothing.
        """
        absolute, steps = self._z_words
        return self._along_z(absolute, np.nan_to_num(steps), np.nan_to_num(self._set_by("Z")))

    def _along_z(self, absolute: Floats, steps: Floats, values: Floats) -> Floats:
        """Z after each row by its words; values: where resets of it set it."""
        resets = self._forgets("Z", "W")
        stays = positions(*self.cycles.without_contours(absolute, steps), resets, values)
        return self.cycles.with_contours(stays, absolute, steps, resets, values)

    @property
    def _z_words(self) -> tuple[Floats, Floats]:
        absolute, steps = self._programmed("Z", "W", 1.0, np.ones(len(self.run), bool))
        if self.frames is None:
            return absolute, steps
        shifted = absolute + self.frames.z
        return shifted, np.where(np.isnan(shifted) & ~np.isnan(absolute), np.nan, steps)

    @cached_property
    def written_to_center(self) -> tuple[Floats, Floats]:
        """The words of the center of an arc along the linear and the virtual axis [mm]; NaN where not written."""
        along, across = (
            self.axes.of_linear_axis(lambda axis, at=at: self.lengths.length_of(self.axes.center_words_along(axis)[at]))  # type: ignore[misc]
            for at in (0, 1)
        )
        return along, across

    @cached_property
    def to_center(self) -> tuple[Floats, Floats]:
        """
        From the start of an arc to its center along the linear and the virtual axis [mm]; NaN where not written.

        Where the word says that it is a coordinate, I=AC(10), it is one of the program.
        """
        along, across = self.written_to_center
        if self.run.distance is None:
            return along, across
        start = self.start + self.center_shift
        if self.frames is not None:
            start = np.conj(self.frames.turn) * (start - self.frames.shift)
        is_place, is_place_across = (
            self.axes.of_linear_axis(lambda axis, at=at: self.is_coordinate_of_center(axis, at))  # type: ignore[misc]
            for at in (0, 1)
        )
        along = np.where(is_place, along * self.lengths.x_factor - start.real, along)
        return along, np.where(is_place_across, across - start.imag, across)

    def is_coordinate_of_center(self, axis: str, at: int) -> Mask:
        """True where a center word of an arc is a coordinate; at: 0 along the linear axis, 1 along the virtual one."""
        distance = self.blocks.distance(self.axes.center_words_along(axis)[at])
        return np.zeros(len(self.run), bool) if distance is None else distance == Distance.ABSOLUTE

    @cached_property
    def center(self) -> Points:
        """Center of an arc on the polar plane [mm]; NaN for lines and where it cannot be known."""
        arcs = self.is_arc
        center = np.full(len(self.run), NOWHERE)
        if not arcs.any():
            return center
        i, j = (words[arcs] for words in self.to_center)
        written = ~np.isnan(i) | ~np.isnan(j)
        start, end, kind = self.start[arcs], self.end[arcs], self.axes.motion[arcs]
        to_center = np.nan_to_num(i) + 1j * np.nan_to_num(j)
        if self.frames is not None:
            to_center = to_center * self.frames.turn[arcs]
        by_center = np.where(written, start + to_center, NOWHERE)
        radius = self.lengths.length_of(self.machine.arcs.radius_word)[arcs]
        by_radius = polar.center_from_radius(start, end, radius, kind, np.inf)
        center[arcs] = np.where(np.isnan(radius), by_center, by_radius)
        if (corners := self.run.corners) is not None:
            center[corners.round] = corners.center
        center[self.shape_is_unknown] = NOWHERE
        return center

    @cached_property
    def shape_is_unknown(self) -> Mask:
        """
        Moves on the polar plane of which the way from start to end is not known.

        The radius or the center of an arc rests on a variable without a value, or a modal code does.
        """
        if not len(self.blocks.unknown_words):
            return self.blocks.nowhere
        radius = self.machine.arcs.radius_word
        center = self.axes.of_linear_axis(lambda axis: self.blocks.is_unknown(*self.axes.center_words_along(axis)))
        of_arc = np.where(self.blocks.has(radius), self.blocks.is_unknown(radius), center)
        moves = self.mode.in_polar & self.axes.moves_plane
        return np.asarray((self.is_arc & of_arc) | (moves & self.modal.is_unknown))

    @cached_property
    def motion(self) -> States:
        """The motion of each row; that of a cycle along the contour that the cycle runs."""
        return np.where(self.cycles.contour, Motion.CYCLE, self.axes.motion).astype(np.int16)

    @cached_property
    def x_of_cycles(self) -> Floats:
        """X to which the cycle in force goes [mm, radius], where the row names it; NaN elsewhere."""
        return self._of_cycles("X", self.lengths.x_factor, lambda: self.x_before)

    @cached_property
    def z_of_cycles(self) -> Floats:
        """Z likewise [mm]."""
        return self._of_cycles("Z", 1.0, lambda: self.z_before)

    def _of_cycles(self, axis: str, factor: Floats | float, start: Callable[[], Floats]) -> Floats:
        """Where a cycle goes along an axis by its words; increments of a drilling cycle count from another place."""
        cycle = self.modal.in_cycle & self.modal.uses_axes & self.blocks.has(axis, INCREMENTS[axis])
        if not cycle.any():
            return repeated(np.float64(np.nan), len(self.run))
        value, step = (self.lengths.length_of(word) * factor for word in (axis, INCREMENTS[axis]))
        is_step = self.modal.is_step(axis)
        step = np.where(is_step, value, step) + np.where(self.modal.drilling != 0, np.nan, start())
        return np.where(cycle, np.where(is_step | np.isnan(value), step, value), np.nan)

    @cached_property
    def is_arc(self) -> Mask:
        """An arc on the polar plane."""
        of_plane = self.mode.in_polar & self.axes.moves_plane & self.axes.is_simulated
        return of_plane & is_among(self.axes.motion, (Motion.CW, Motion.CCW))

    @cached_property
    def travels(self) -> Mask:
        """
        A move on the polar plane of some length, round a full circle, or of a length that is not known.

        Words that name the present position are no movement (B-63664EN p. 170), nor is an arc by R to its start.
        """
        still = np.abs(self.end - self.start) <= ZERO
        is_full = self.is_arc & ~np.isnan(self.center)
        return np.asarray(self.mode.in_polar & self.axes.moves_plane & (~still | is_full))

    @cached_property
    def z_before(self) -> Floats:
        """Z before the row [mm]; NaN while unknown."""
        return self.cycles.before(self.z)

    @cached_property
    def c_angle_before(self) -> Floats:
        """C angle of the machine before the row [deg]; NaN while unknown."""
        return before(self.c_angle, self.blocks.starts, np.nan)

    @cached_property
    def moves_x(self) -> Mask:
        """
        The linear axis moves: a word of it names another place than the present one, or one of the two is not known.

        With moves_z and moves_c, and with travels on the polar plane, the test of all rules for a word that is a move.
        """
        return _differs(
            self.modal.uses_axes & self.axes.programs_linear_axis,
            lambda: (self.x_before, or_of_cycle(self.x, self.x_of_cycles)),
        )

    @cached_property
    def moves_z(self) -> Mask:
        """Z moves likewise, where that is not the linear axis; posts repeat the present Z in each block."""
        return _differs(self.axes.commands_z, lambda: (self.z_before, or_of_cycle(self.z, self.z_of_cycles)))

    @cached_property
    def moves_c(self) -> Mask:
        """The rotary axis moves likewise outside the mode."""
        commands = self.modal.uses_axes & self.blocks.has(*self.machine.polar.rotary_words) & (self.mode.section < 0)
        return _differs(commands, lambda: (np.zeros(len(self.run)), self.c_turn))

    @cached_property
    def c_turn(self) -> Floats:
        """Angle that C turns in the row [deg]; NaN while unknown."""
        return self.c_turn_from(self.c_angle_before, np.arange(len(self.run)))

    def c_turn_from(self, before: Floats, rows: Rows) -> Floats:
        """
        Angles that C turns in rows, from the angle at which it stands before each of them [deg].

        Where C rolls over, an angle outside the mode is reached the shorter way (B-63534EN/02 p. 531).
        """
        turn = self.c_angle[rows] - before
        if not self.machine.control.rotary_rolls_over:
            return turn
        axis = self.machine.polar.rotary_address
        is_angle = self.blocks.has(axis) & self.modal.uses_axes & (self.mode.section < 0) & ~self.modal.is_step(axis)
        return np.where(is_angle[rows], turn - 360 * np.ceil(turn / 360 - 0.5), turn)

    @cached_property
    def judged_z(self) -> Mask:
        """Z words that count beside a line of the plane: those that move Z, or all, where the block is forbidden."""
        moves = self.axes.commands_z if self.machine.polar.repeated_z == "forbidden" else self._surely_moves_z
        return moves & self.axes.is_simulated

    @cached_property
    def judged_z_of_arc(self) -> Mask:
        """The same beside an arc."""
        return self._surely_moves_z if self.machine.polar.repeated_z == "allowed" else self.axes.commands_z

    @cached_property
    def _surely_moves_z(self) -> Mask:
        """The same without rows of which a variable leaves open where Z goes, or stands before."""
        unknown = self.blocks.is_unknown("Z", "W")
        if not unknown.any():
            return self.moves_z
        is_open = fill_down(unknown, self.blocks.has("Z", "W") | self.blocks.starts, False).astype(bool)
        return np.asarray(self.moves_z & ~is_open & ~before(is_open, self.blocks.starts, False))

    @cached_property
    def ends_above_plunge(self) -> Mask:
        """Moves above Z0, behind which Z alone goes down: they cut nothing, whichever way the tool takes."""
        rows = np.flatnonzero(self.moves & self.mode.in_polar)
        here, following = rows[:-1], rows[1:]
        plunges = self.moves_z[following] & ~self.travels[following] & (self.z[following] < self.z[here])
        plunges &= self.mode.section[here] == self.mode.section[following]
        return self.blocks.mask_of(here[plunges & (self.z[here] > 0) & (self.z_before[here] > 0)])

    @cached_property
    def moves(self) -> Mask:
        """Moves any axis, or one that is not followed; words that name the present place of each are no move."""
        outside, rotary = self.mode.section < 0, self.blocks.has(*self.machine.polar.rotary_words)
        followed = self.travels | self.moves_z | self.moves_c | (self.moves_x & outside)
        not_followed = (self.blocks.has("Y", "V") & outside) | (rotary & ~outside & ~self.axes.moves_plane)
        return np.asarray(self.axes.moves & (followed | not_followed | self.modal.in_cycle))

    @cached_property
    def length(self) -> Floats:
        """Distance of the row on the polar plane [mm]; 0 where it does not move there, NaN where unknown."""
        moving = self.mode.in_polar & self.axes.moves_plane
        return column_at(len(self.run), moving, self.moves_of(moving).length, 0.0)

    @cached_property
    def rise(self) -> Floats:
        """Distance of Z in a move on the polar plane, where F measures it, too [mm]; 0 elsewhere, NaN unknown."""
        axes, in_space = self.modal.state("feed_axes"), self.machine.polar.feed_measures == "space"
        if not in_space and not axes.any():
            return repeated(np.float64(0), len(self.run))
        measured = (axes == FeedAxes.SPACE) | ((axes == FeedAxes.AS_MACHINE) & in_space)
        rises = self.mode.in_polar & self.axes.moves_plane & measured & self.moves_z
        return np.where(rises, np.abs(self.z - self.z_before), 0.0)

    def moves_of(self, rows: Mask | Rows) -> PlanePath:
        """The programmed moves of these rows."""
        return PlanePath(self.start[rows], self.end[rows], self.center[rows], self.axes.motion[rows])

    @property
    def c_words(self) -> tuple[Floats, Floats]:
        """C of the words outside the mode [deg]: coordinates, NaN where none, and increments, 0 where none."""
        axis, increment = self.machine.polar.rotary_words
        moving = self.modal.uses_axes & (self.mode.section < 0)
        if self.machine.polar.plane_is_fixed:
            moving |= self.modal.uses_axes & self.mode.enters
        written, stepped = self.blocks.has(axis) & moving, self.blocks.has(increment) & moving
        angle, is_step = self.coordinates.angle_of(axis), self.modal.is_step(axis)
        absolute = np.where(written & ~is_step, angle, np.nan)
        # From a word of unknown value on C is not known, as X and Z are not.
        turn = np.where(written & (is_step | np.isnan(angle)), angle, 0.0)
        return absolute, turn + np.where(stepped, self.coordinates.angle_of(increment), 0.0)

    @cached_property
    def c_angle(self) -> Floats:
        """C angle of the machine after the row [deg], continuous along a section; NaN while unknown."""
        axis, increment = self.machine.polar.rotary_words
        absolute, turn = self.c_words
        on_plane = self.mode.in_polar & self.axes.moves_plane
        turn = turn.copy()
        turn[on_plane] = self.c_axis.sense * polar.c_sweep(*self.moves_of(on_plane).shape)
        # G28 H0 takes C to its reference point, the zero of its angle (builder's guide: "zero return C-axis").
        referenced = self.blocks.listed("c_axis_reference") & self.blocks.has(axis, increment)
        set_to = np.where(self.modal.sets_coordinates, self.coordinates.angle_of(axis), np.nan)
        values = np.where(referenced, 0.0, set_to)
        resets, direction = self._forgets(axis, increment), self.machine.polar.direction_word
        turns_plane = self.mode.enters & self.blocks.has(direction)
        if turns_plane.any():
            # It does not give the position of the tool, but the direction of the first axis of the plane.
            resets, values = resets | turns_plane, np.where(turns_plane, self.coordinates.angle_of(direction), values)
        return positions(absolute, turn, resets, values)

    @property
    def c_axis(self) -> polar.CAxis:
        """How C stands to the angles of the polar plane."""
        return polar.CAxis(self.machine.polar.c_sense, self.machine.polar.plane_is_fixed)

    @cached_property
    def section_entry(self) -> Floats:
        """
        C angle [deg] of the linear axis of each section's plane: that at its G12.1, 0 where not known; of a plane that
        stands still on the part full turns.
        """
        angle = np.nan_to_num(self.c_angle[self.mode.sections.enter])
        if not self.c_axis.is_fixed:
            return angle
        direction = self._points[1]
        turned = np.degrees(angle_between(np.ones_like(direction), direction))
        return np.asarray(360 * np.round((angle - self.c_axis.sense * turned) / 360))

    @cached_property
    def section_turn(self) -> Points:
        """Direction of the x axis of each section in the frame of the part; 1 where C at its beginning is not known."""
        return np.exp(1j * np.radians(self.section_entry))

    @cached_property
    def knows_section_entry(self) -> Mask:
        """Sections of which it is known how their plane lies on the part; a boolean per section."""
        return ~np.isnan(self.c_angle[self.mode.sections.enter]) | self.c_axis.is_fixed

    @cached_property
    def on_plane(self) -> Mask:
        """
        A move on the polar plane, be it in rapid traverse; a cycle is none, and neither is a move of no length.

        At G0 most controls alarm. A start-up or offset cancel in it is one nevertheless: G1 was intended, and
        compensation itself requires G0 or G1 (B-63324EN/03 p. 402).
        """
        return np.asarray(self.travels & ~self.modal.in_cycle)

    @cached_property
    def cuts(self) -> Mask:
        """A move on the polar plane at feed."""
        return self.travels & self.axes.at_feed

    @cached_property
    def moves_at_feed(self) -> Mask:
        """A move in the polar mode at feed, that of Z alone included."""
        return self.mode.in_polar & self.moves & self.axes.at_feed


def _differs(commands: Mask, places: Callable[[], tuple[Floats, Floats]]) -> Mask:
    """Rows that command an axis and in which it moves; places: where it stands before and after each row."""
    if not commands.any():
        return commands
    before_row, after_row = places()
    return np.asarray(commands & ~(np.abs(after_row - before_row) <= ZERO))
