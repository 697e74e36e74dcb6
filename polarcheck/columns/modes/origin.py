"""The known position of X0: the work offset in force, changed by the job, G10, variables, G52 and G50."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np

from polarcheck.columns.filling import fill_down, positions
from polarcheck.columns.modes.offset_settings import Settings, X, in_order, of_list
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, different, is_among, repeated
from polarcheck.program.machines.code_lists import numbers
from polarcheck.program.machines.offset_calls import steps_above

#: Numbers of further work offsets begin here: G54.1 P1 is 1001.
_EXTENDED = 1000
#: The work offset that is added to all others, and the work shift, which is added, too.
_EXTERNAL, _SHIFT = 0, -1
#: The largest number of further work offsets of any control.
_MOST_EXTENDED = 300
#: P of no work offset.
_LONGEST = 1e9
#: A setting by G10 beyond it [mm] is the distance from the reference position of the lathe, which is unknown.
_NEAR = 50.0


class Origin(Columns, frozen=True):
    """Columns of one trace, one value per row; lengths are as they are written, diameters of X included [mm]."""

    trace: Trace

    @cached_property
    def _number(self) -> Floats:
        """The work offset in force: 54 for G54, 1001 for G54.1 P1."""
        trace = self.trace
        state = np.where(trace.modal.state("work_offset") == 0, self._plain[0], trace.modal.state("work_offset"))
        extended = trace.blocks.listed("work_offset_extended") | self._is_extended_by_p
        is_extended = fill_down(extended, trace.modal.sets("work_offset") | trace.blocks.starts, False).astype(bool)
        number = fill_down(np.nan_to_num(trace.blocks.word("P")), extended, 0.0)
        return np.where(is_extended, _EXTENDED + number, state).astype(np.float64)

    @property
    def _is_extended_by_p(self) -> Mask:
        """G54 P1 is G54.1 P1; beside a call P is the number of a program."""
        trace, machine = self.trace, self.trace.machine
        if not machine.codes("work_offset_extended"):
            return np.zeros(len(trace), bool)
        first = trace.blocks.codes(*machine.codes("work_offset")[:1]) & (trace.blocks.word("P") >= 1)
        return (
            first & ~trace.blocks.codes(*sorted(machine.macro.call_codes)) & ~trace.blocks.listed("data_input", "dwell")
        )

    @cached_property
    def _plain(self) -> list[int]:
        """The numbers of G54 to G59; the first is in force where the program selects none."""
        return [number // 10 for number in numbers(self.trace.machine.codes("work_offset"))] or [0]

    @cached_property
    def _of_job(self) -> dict[float, tuple[str, float]]:
        """The work offsets that the job gives, by number: their names, and X."""
        offsets = {}
        for name, offset in self.trace.job.work_offsets.items():
            written, _, extension = name.upper().partition(" P")
            number = _number(extension) + _EXTENDED if extension else _number(written)
            if number == number:
                offsets[number] = name.upper(), offset.x
        return offsets

    # ---- G10, and the variables of work offsets ----

    @cached_property
    def _settings(self) -> Settings:
        """Settings of X of work offsets by the program outside the mode, in order of the rows."""
        return in_order([self._set_by_data_input(), self._set_by_variables()])

    def _set_by_data_input(self) -> Settings:
        trace = self.trace
        kinds = trace.machine.g_codes.data_input_work_offset
        rows = np.flatnonzero(trace.blocks.listed("data_input") & trace.blocks.has("X", "U") & (trace.mode.section < 0))
        rows = rows[~trace.blocks.is_unknown("P")[rows]]
        kind, p = trace.blocks.word("L")[rows], np.minimum(np.nan_to_num(trace.blocks.word("P")[rows]), _LONGEST)
        # Without L a lathe takes P0 as the work shift; other numbers are tool offsets.
        is_shift = np.isnan(kind) & (p == 0)
        is_external = np.isin(kind, kinds[:1]) & (p == 0)
        is_plain = np.isin(kind, kinds[:1]) & (p >= 1) & (p <= len(self._plain))
        is_extended = np.isin(kind, kinds[1:]) & (p >= 1)
        plain = np.array(self._plain)[np.where(is_plain, p - 1, 0).astype(np.int64)]
        number = np.select((is_shift, is_external, is_plain), (_SHIFT, _EXTERNAL, plain), _EXTENDED + p)
        has_x = trace.blocks.has("X")[rows]
        value = np.where(has_x, trace.lengths.length_of("X")[rows], trace.lengths.length_of("U")[rows])
        settings = Settings(
            rows, number.astype(np.int64), np.full(len(rows), X), value, trace.modal.incremental[rows] | ~has_x
        )
        return settings.of(is_shift | is_external | is_plain | is_extended)

    def _set_by_variables(self) -> Settings:
        trace, offsets = self.trace, self.trace.machine.offsets
        first, step = offsets.work_offset_variable, offsets.work_offset_step
        settings = []
        for row, assigned in trace.run.assigned.items():
            plain = steps_above(assigned.variable, first, step)
            extended = steps_above(assigned.variable, offsets.work_offset_extended_variable, step)
            number = None
            if assigned.variable == offsets.work_shift_variable:
                number = _SHIFT
            elif 0 <= plain <= len(self._plain):
                number = self._plain[plain - 1] if plain else _EXTERNAL
            elif 0 <= extended < _MOST_EXTENDED:
                number = _EXTENDED + extended + 1
            if number is not None and trace.mode.section[row] < 0:
                settings.append((row, number, X, assigned.value * float(trace.lengths.scale[row]), assigned.is_step))
        return of_list(settings)

    @cached_property
    def set_to_unknown(self) -> Rows:
        """The rows that set X of a work offset that counts in a section to a value that is not known."""
        number = self._settings.number
        # Of G54.1 P#500 it may be any of the further ones.
        counts = is_among(number, sorted(self._in_sections)) | ((_EXTENDED in self._in_sections) & (number > _EXTENDED))
        return different(self._settings.row[np.isnan(self._settings.value) & counts])

    @cached_property
    def _in_sections(self) -> set[int]:
        """The numbers of the work offsets in force where sections begin, and of what is added to them."""
        return {_EXTERNAL, _SHIFT, *self._number[self.trace.mode.sections.enter].astype(np.int64).tolist()}

    def _x_of(self, number: float) -> tuple[Floats, Rows]:
        """X of a work offset in each row, NaN where it is not known, and the row that has set it; -1 where none has."""
        trace = self.trace
        row, _, _, value, is_step = self._settings.of(self._settings.number == number)
        # The way from the reference position puts X0 on the axis; what is added to it puts X0 beside it.
        is_way = np.abs(value) > _NEAR
        absolute, steps = np.full(len(trace), np.nan), np.zeros(len(trace))
        sets = is_way | ~is_step
        absolute[row[sets]] = np.where(is_way, 0.0, value)[sets]
        steps[row[~sets]] = value[~sets]
        steps[row[sets & np.isnan(value)]] = np.nan
        forgets = trace.blocks.starts | trace.run.unknown
        given = self._of_job.get(number, ("", 0.0))[1] * np.broadcast_to(trace.lengths.job_scale, len(trace))
        written, setter = forgets.copy(), np.full(len(trace), -1)
        written[row], setter[row] = True, row
        x = positions(absolute, steps, forgets, given)
        setter = fill_down(setter, written, -1)
        return np.where((setter >= 0) & (np.abs(x) > _NEAR), 0.0, x), setter

    @cached_property
    def work_offset(self) -> tuple[Floats, Rows]:
        """
        X0 of the work offset in force, and the row that has set it; 0 where neither the job nor the program says it.

        Only of those that are in force at a G12.1: a program may set many more.
        """
        trace = self.trace
        selected = self._in_sections - {_EXTERNAL, _SHIFT}
        x, setter = np.zeros(len(trace)), np.full(len(trace), -1)
        for number in sorted({*self._of_job, *self._settings.number.tolist()} & selected):
            in_force = self._number == number
            x_of_offset, row = self._x_of(number)
            x[in_force], setter[in_force] = x_of_offset[in_force], row[in_force]
        return x, setter

    @cached_property
    def external(self) -> tuple[Floats, Rows]:
        """X of the offset that is added to all work offsets, and the row that has set it."""
        return self._added(_EXTERNAL)

    @cached_property
    def work_shift(self) -> tuple[Floats, Rows]:
        """X of the work shift, and the row that has set it."""
        return self._added(_SHIFT)

    def _added(self, number: int) -> tuple[Floats, Rows]:
        if np.any(self._settings.number == number):
            return self._x_of(number)
        return repeated(np.float64(0), len(self.trace)), repeated(np.int64(-1), len(self.trace))

    def _set_in(self, row: int, setter: int) -> str:
        """The setter of the work offset that counts in a row: `G10 on G54`, `G10 P0`, `#5221`, or the job."""
        number = float(self._number[row])
        if setter < 0:
            return self._name(number)
        if setter in self.trace.run.assigned:
            return self.trace.run.assigned[setter].name
        numbers = self._settings.number[self._settings.row == setter]
        on = f"on {self._name(number)}" if numbers[-1] > 0 else "P0"
        return f"{self._code('data_input')} {on}"

    def _name(self, number: float) -> str:
        if number in self._of_job:
            return self._of_job[number][0]
        extended = self.trace.machine.codes("work_offset_extended")
        return f"{extended[0]} P{number - _EXTENDED:g}" if number > _EXTENDED and extended else f"G{number:g}"

    def _code(self, key: str) -> str:
        """The first code of a list of the machine, which may be empty."""
        return next(iter(self.trace.machine.codes(key)), "")

    # ---- G52, G50 ----

    @cached_property
    def coordinate_setting(self) -> Floats:
        """
        How far G50 (G92) has moved X0: by the difference of where X stands and what it is said to be, or by U.

        What is set where it is not known where X stands tells nothing. After a tool change the new tool is meant.
        """
        trace = self.trace
        sets = trace.modal.sets_coordinates & trace.blocks.has("X", "U") & (trace.mode.section < 0)
        if not sets.any():
            return repeated(np.float64(0), len(trace))
        is_step = trace.modal.incremental | ~trace.blocks.has("X")
        step = -np.where(trace.blocks.has("X"), trace.lengths.length_of("X"), trace.lengths.length_of("U"))
        moved = np.where(is_step, step, trace.path.x_before / trace.lengths.x_factor + step)
        # How far X0 moves is not known where the word is not; elsewhere it is where X stands that is not known.
        by_unknown = sets & np.isnan(step) & (is_step | ~np.isnan(trace.path.x_before))
        forgets = (
            trace.tools.changes_tool
            | trace.run.unknown
            | trace.modal.presets_x
            | (sets & np.isnan(moved) & ~by_unknown)
        )
        steps = np.where(sets & ~forgets, moved, 0.0)
        return positions(np.full(len(trace), np.nan), steps, forgets | trace.blocks.starts, np.zeros(len(trace)))

    @cached_property
    def frame(self) -> Floats:
        """X of the frame in force; 0 in the mode, where frames are intended, and where it is unknown."""
        trace = self.trace
        if trace.path.frames is None:
            return repeated(np.float64(0), len(trace))
        return np.where(trace.mode.in_polar, 0.0, np.nan_to_num(trace.path.frames.shift.real / trace.lengths.x_factor))

    # ---- all of them ----

    @cached_property
    def shift(self) -> Floats:
        """The known distance of X0 from the spindle axis; NaN where the program sets an unknown value."""
        trace = self.trace
        shifts = trace.blocks.listed("data_input", "local_shift", "coordinate_setting")
        # G50 S2000 is a speed.
        is_shifted = (
            trace.path.frames
            or trace.job.work_offsets
            or trace.run.assigned
            or (shifts.any() and (shifts & trace.blocks.has("X", "U")).any())
        )
        return (
            sum((part for part, _ in self._parts), np.zeros(len(trace)))
            if is_shifted
            else repeated(np.float64(0), len(trace))
        )

    @cached_property
    def _parts(self) -> tuple[tuple[Floats, Callable[[int], str]], ...]:
        """The parts of the shift, each with a function that names its cause in a row."""
        offsets = (self.work_offset, self.external, self.work_shift)
        return (
            *((x, functools.partial(self._of_offset, setter)) for x, setter in offsets),
            (self.trace.path.local_shift, lambda row: self._code("local_shift")),
            (self.coordinate_setting, lambda row: self._code("coordinate_setting")),
            (self.frame, self._frame_code),
        )

    def _of_offset(self, setter: Rows, row: int) -> str:
        return self._set_in(row, int(setter[row]))

    def _frame_code(self, row: int) -> str:
        from polarcheck.program.machines.own_language import shown  # few programs shift their frame

        return shown(self.trace.machine.control.native_words, self._code("frame_shift"))

    def causes(self, row: int) -> list[str]:
        """Names of the causes of the shift in a row: a work offset, G10, a variable, G52, G50."""
        return list(dict.fromkeys(name(row) for part, name in self._parts if part[row]))

    def unknown_causes(self, row: int) -> list[str]:
        """Names of the causes whose value is not known."""
        return list(dict.fromkeys(name(row) for part, name in self._parts if np.isnan(part[row])))


def _number(text: str) -> float:
    digits = text.lstrip("GP ")
    return float(digits) if digits.replace(".", "", 1).isdecimal() else float("nan")
