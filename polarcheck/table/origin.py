"""Where X0 lies: the work offset in force, what the job, G10, G52 and G50 make of it, as far as it can be computed."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Floats, Mask
from polarcheck.machines.code_lists import numbers
from polarcheck.table.filling import fill_down, positions
from polarcheck.table.trace import Trace

#: Numbers of further work offsets begin here: G54.1 P1 is 1001.
_EXTENDED = 1000
#: The work offset that is added to all others.
_EXTERNAL = 0
#: What G10 sets beyond it [mm] is the way from the reference position of the lathe, of which nothing is known.
_NEAR = 50.0


class Origin:
    """Columns of one trace, one value per row; lengths are as they are written, diameters of X included [mm]."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    @cached_property
    def _number(self) -> Floats:
        """The work offset in force: 54 for G54, 1001 for G54.1 P1."""
        trace = self.trace
        state = np.where(trace.state("work_offset") == 0, self._plain[0], trace.state("work_offset"))
        extended = trace.listed("work_offset_extended")
        is_extended = fill_down(extended, trace.sets("work_offset") | trace.starts, False).astype(bool)
        number = fill_down(np.nan_to_num(trace.word("P")), extended, 0.0)
        return np.where(is_extended, _EXTENDED + number, state).astype(np.float64)

    @cached_property
    def _plain(self) -> list[int]:
        """The numbers of G54 to G59; the first is in force where the program selects none."""
        return [number // 10 for number in numbers(self.trace.machine.codes("work_offset"))] or [0]

    @cached_property
    def _of_job(self) -> dict[float, tuple[str, float]]:
        """The work offsets that the job gives, by number: their names, and X."""
        found = {}
        for name, offset in self.trace.job.work_offsets.items():
            written, _, extension = name.upper().partition(" P")
            number = _number(extension) + _EXTENDED if extension else _number(written)
            if number == number:
                found[number] = name.upper(), offset.x
        return found

    # ---- G10 ----

    @cached_property
    def _set_by_program(self) -> tuple[Mask, Floats]:
        """Rows in which G10 sets X of a work offset, and its number."""
        trace = self.trace
        kinds = trace.machine.g_codes.data_input_work_offset
        kind, p = trace.word("L"), np.nan_to_num(trace.word("P"))
        # Without L a lathe takes P0 as the work shift; other numbers are tool offsets.
        is_external = (np.isnan(kind) | np.isin(kind, kinds[:1])) & (p == 0)
        is_plain = np.isin(kind, kinds[:1]) & (p >= 1) & (p <= len(self._plain))
        is_extended = np.isin(kind, kinds[1:]) & (p >= 1)
        plain = np.array(self._plain, np.float64)[np.where(is_plain, p - 1, 0).astype(np.int64)]
        number = np.where(is_external, _EXTERNAL, np.where(is_plain, plain, _EXTENDED + p))
        sets = trace.listed("data_input") & trace.has("X", "U") & (is_external | is_plain | is_extended)
        return sets & (trace.section < 0), number

    def _x_of(self, number: float) -> tuple[Floats, Mask]:
        """X of a work offset in each row, and whether G10 has set it by then."""
        trace = self.trace
        sets, numbers_set = self._set_by_program
        sets = sets & (numbers_set == number)
        is_step = trace.incremental | ~trace.has("X")
        absolute = np.where(sets & ~is_step, trace.length_of("X"), np.nan)
        step = np.where(trace.has("X"), trace.length_of("X"), trace.length_of("U"))
        steps = np.where(sets & is_step, np.nan_to_num(step), 0.0)
        given = self._of_job.get(number, ("", 0.0))[1] * np.broadcast_to(trace.job_scale, len(trace))
        forgets = trace.starts | trace.run.unknown
        is_set = fill_down(sets, sets | forgets, False).astype(bool)
        x = positions(absolute, steps, forgets, given)
        return np.where(is_set & ~(np.abs(x) <= _NEAR), 0.0, x), is_set

    @cached_property
    def work_offset(self) -> tuple[Floats, NDArray[np.object_]]:
        """
        X0 of the work offset in force, and its name; 0 where neither the job nor the program says it.

        Only of those that are in force at a G12.1: a program may set many more.
        """
        trace = self.trace
        asked = set(self._number[trace.sections.enter].tolist()) - {_EXTERNAL}
        x, name = np.zeros(len(trace)), np.full(len(trace), "", object)
        sets, set_numbers = self._set_by_program
        for number in sorted({*self._of_job, *set_numbers[sets].tolist()} & asked):
            in_force = self._number == number
            given, is_set = self._x_of(number)
            x[in_force], name[in_force] = given[in_force], self._name(number)
            name[in_force & is_set] = f"{self._code('data_input')} on {self._name(number)}"
        return x, name

    @cached_property
    def external(self) -> Floats:
        """X of the offset that is added to all work offsets."""
        return self._x_of(_EXTERNAL)[0] if self._set_by_program[0].any() else np.zeros(len(self.trace))

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
    def local(self) -> Floats:
        """X of the G52 in force."""
        trace = self.trace
        written = trace.listed("local_shift") & trace.has("X")
        shift = np.where(written, np.nan_to_num(trace.length_of("X")), 0.0)
        return fill_down(shift, written | trace.starts, 0.0).astype(np.float64)

    @cached_property
    def coordinate_setting(self) -> Floats:
        """
        How far G50 (G92) has moved X0: by the difference of where X stands and what it is said to be, or by U.

        What is set where it is not known where X stands tells nothing. After a tool change the new tool is meant.
        """
        trace = self.trace
        sets = trace.sets_coordinates & trace.has("X", "U") & (trace.section < 0)
        if not sets.any():
            return np.zeros(len(trace))
        is_step = trace.incremental | ~trace.has("X")
        step = -np.where(trace.has("X"), trace.length_of("X"), trace.length_of("U"))
        moved = np.where(is_step, step, trace.x_before / trace.x_factor + step)
        forgets = trace.changes_tool | trace.run.unknown | (sets & np.isnan(moved))
        steps = np.where(sets & ~forgets, moved, 0.0)
        return positions(np.full(len(trace), np.nan), steps, forgets | trace.starts, np.zeros(len(trace)))

    # ---- all of them ----

    @cached_property
    def shift(self) -> Floats:
        """How far X0 is known to lie off the spindle axis."""
        trace = self.trace
        shifts = trace.listed("data_input", "local_shift", "coordinate_setting")
        # G50 S2000 is a speed.
        if not trace.job.work_offsets and not (shifts.any() and (shifts & trace.has("X", "U")).any()):
            return np.zeros(len(trace))
        return self.work_offset[0] + self.external + self.local + self.coordinate_setting

    def causes(self, row: int) -> list[str]:
        """What shifts the origin in a row: a work offset by its name, G10, G52, G50."""
        parts = (
            (self.work_offset[0], self.work_offset[1][row]),
            (self.external, f"{self._code('data_input')} P0"),
            (self.local, self._code("local_shift")),
            (self.coordinate_setting, self._code("coordinate_setting")),
        )
        return [name for part, name in parts if part[row]]


def _number(text: str) -> float:
    digits = text.lstrip("GP ")
    return float(digits) if digits.replace(".", "", 1).isdecimal() else float("nan")
