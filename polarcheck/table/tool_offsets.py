"""R and nose type of the tool offset in force, as the job, the comments and the program itself say."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows, computed, is_uniform, repeated
from polarcheck.execution.run import NO_VARIABLE
from polarcheck.machines.offsets import place_in
from polarcheck.table.offset_settings import NOSE, RADIUS, RADIUS_WEAR, X_WEAR, Settings, Steps, X, in_order, of_list
from polarcheck.table.rotary_axis import RotaryAxis

if TYPE_CHECKING:
    from polarcheck.table.radius_comments import Found

#: R of no cutter: it is a length, which mills give in the same words [mm].
_LONGEST = 100.0
#: No cutter of a lathe is larger: what is set is not known [mm].
_LARGEST = 1000.0
#: No control has as many offsets.
_LONGEST_NUMBER = 1e9
#: A larger X of the wear is where the tool has been touched off, likewise [mm].
_LARGEST_X_WEAR = 5.0


class _Set(NamedTuple):
    """What the program has set of the offset in force: the row that did so last, -1 where none has, and the value."""

    row: Rows
    value: Floats


class ToolOffsets(RotaryAxis):
    """What the tool offset in force holds; the columns of RotaryAxis besides."""

    # ---- R and nose type ----

    @cached_property
    def radius_of_offset(self) -> Floats:
        """R of the tool offset in force [mm]; NaN where neither program, job nor, if asked, a comment tells it."""
        return np.where(self.radius_set_in >= 0, self._radius_set.value, self._radius_given)

    @cached_property
    def nose(self) -> Floats:
        """T of the tool offset in force (nose type); NaN unknown."""
        given = self._offset_column({n: t.nose for n, t in self.tools.items() if t.nose is not None})
        return np.where(self.nose_set_in >= 0, self._nose_set.value, given)

    @property
    def radius_set_in(self) -> Rows:
        """The row in which the program has set R of the offset in force; -1 where it has not."""
        return self._radius_set.row

    @property
    def nose_set_in(self) -> Rows:
        """The row in which the program has set the nose type of the offset in force; -1 where it has not."""
        return self._nose_set.row

    @cached_property
    def radius_is_from_comment(self) -> Mask:
        """R of the offset in force is from a comment."""
        told = np.isnan(self._radius_of_job) & ~np.isnan(self._radius_of_comments)
        return np.asarray(told & (self.radius_set_in < 0))

    @cached_property
    def sets_radius_after_call(self) -> Mask:
        """
        Between the call of the offset in force and the next, the program sets R of its offset before the mode needs it.

        A row of unknown effect may set it. What a comment tells of R is not taken there.
        """
        call = np.cumsum(self.calls_offset | self.starts)
        sets_radius = (self.radius_set_in == np.arange(len(self))) | self.run.unknown
        sets, needs = (
            np.bincount(call[rows], minlength=int(call[-1]) + 1 if len(call) else 1) > 0
            for rows in (sets_radius, self.in_polar & self.radius_is_from_comment)
        )
        return np.asarray((sets & ~needs)[call])

    @cached_property
    def sizes_by_x(self) -> Mask:
        """
        X of an offset is changed that a polar section of the program uses: by a step, or as wear.

        X of the geometry is where the tool has been touched off, and so is one that is too large for wear. The wear of
        the job's table stands at the word that calls the offset, unless the program sets its own.
        """
        found, sizes = self.offset_settings, np.zeros(len(self), bool)
        is_wear = (found.kind == X_WEAR) & ~(np.abs(found.value) > _LARGEST_X_WEAR)
        chosen = found.of((found.kind >= X) & (is_wear | found.is_step) & (found.value != 0))
        sizes[chosen.row[self._is_used(chosen.row, chosen.number)]] = True
        for number, tool in self.tools.items():
            wear = np.abs(tool.x_wear * self.job_scale)
            if tool.x_wear and not np.any(found.number[found.kind == X_WEAR] == number):
                called = np.flatnonzero(self.calls_offset & (self.offset_number == number) & (wear <= _LARGEST_X_WEAR))
                sizes[called[self._is_used(called, np.full(len(called), number))][:1]] = True
        return sizes

    def _is_used(self, rows: Rows, numbers: Rows) -> Mask:
        """Whether offsets that are named in some rows are in force in the polar mode of the same program."""
        inside, most = self.in_polar | self.enters, self.offset_count
        used = self.program[inside] * most + self.offset_number[inside]
        return np.isin(self.program[rows] * most + numbers, used)

    @cached_property
    def cutter_diameter(self) -> Floats:
        """Diameter of the cutter in force [mm], twice R where the job gives no other; NaN unknown."""
        given = self._offset_column({n: tool.diameter for n, tool in self.tools.items()}) * self.job_scale
        return np.where(np.isnan(given) & (self.radius_of_offset > 0), 2 * self.radius_of_offset, given)

    @cached_property
    def teeth(self) -> Floats:
        """Teeth of the cutter in force; NaN where the job does not give them."""
        return self._offset_column({n: tool.teeth or np.nan for n, tool in self.tools.items()})

    # ---- what is given ----

    def _offset_column(self, values: Mapping[int, float]) -> Floats:
        table = np.full(self.offset_count, np.nan)
        for number, value in values.items():
            table[number] = value
        return repeated(table[0], len(self)) if is_uniform(table) else table[self.offset_number]

    @cached_property
    def _radius_given(self) -> Floats:
        return computed(_first_known, self._radius_of_job, self._radius_of_comments)

    @cached_property
    def _radius_of_job(self) -> Floats:
        return self._offset_column({n: tool.radius for n, tool in self.tools.items()}) * self.job_scale

    @cached_property
    def _radius_of_comments(self) -> Floats:
        return self._offset_column({number: found.radius for number, found in self.radius_comments.items()})

    @cached_property
    def radius_told(self) -> dict[int, Found]:
        """What the comments say of R by offset number."""
        from polarcheck.table.radius_comments import Called, radii

        rows = np.flatnonzero(self.calls_offset)
        called = Called(self.run.block[rows], self.offset_number[rows], self.tool[rows], self.scale[rows] != 1.0)
        return radii(self.text, called)

    @cached_property
    def radius_comments(self) -> dict[int, Found]:
        """What the comments say of R by offset number, if that is asked for."""
        return self.radius_told if self.job.radius_from_comments else {}

    # ---- what the program sets ----

    @cached_property
    def offset_settings(self) -> Settings:
        """
        What the program sets of tool offsets, by data input and by system variables.

        What it sets in the mode is a finding, and changes nothing of what is meant.
        """
        found = in_order([*self._set_by_data_input(), self._set_by_variables()])
        found = found.of((found.number > 0) & (found.number < 10**self.machine.control.offset_digits))
        too_large = (found.kind <= RADIUS_WEAR) & (np.abs(found.value) > _LARGEST)
        return found._replace(value=np.where(too_large, np.nan, found.value))

    def _set_by_data_input(self) -> list[Settings]:
        rows = np.flatnonzero(self.listed("data_input") & self.has("P") & (self.section < 0))
        if not len(rows):
            return []
        offsets, kind, place = self.machine.offsets, self.word("L")[rows], np.nan_to_num(self.word("P")[rows])
        base = offsets.geometry_from
        plain = ~self.has("L")[rows] & (base > 0)
        is_geometry = np.where(plain, place > base, np.isin(kind, offsets.geometry))
        known = plain | is_geometry | np.isin(kind, offsets.wear)
        known &= place < _LONGEST_NUMBER
        number = np.where(known, place - base * (plain & is_geometry), 0).astype(np.int64)
        # Mills give lengths as they give radii: in R.
        alone = np.isin(kind, offsets.radius_alone)
        as_mill = np.zeros(len(self), bool)
        as_mill[rows[alone]] = True
        of_length = ~plain & ~alone & self.anywhere_in_program(as_mill)[rows]
        steps = self.incremental[rows]
        found = []
        for address, geometry, wear, always_step in (
            ("R", RADIUS, RADIUS_WEAR, False),
            ("C", RADIUS, RADIUS_WEAR, True),
            ("Q", NOSE, NOSE, False),
            ("X", X, X_WEAR, False),
            ("U", X, X_WEAR, True),
        ):
            value = self._data(address)[rows] if address != "Q" else self.word("Q")[rows]
            has = self.has(address)[rows]
            if address in "RC":
                has &= ~of_length & ~(~plain & ~alone & (np.abs(value) > _LONGEST))
            is_step = (steps | always_step) & (address != "Q")
            one = Settings(
                rows, number, np.where(is_geometry, geometry, wear), value, np.broadcast_to(is_step, len(rows))
            )
            found.append(one.of(has))
        return found

    def _data(self, address: str) -> Floats:
        """A word of data input as a length [mm]: without a point the control takes it in least increments."""
        at = self.word_indices(address)
        words, row = self.run.words, self.run.row[at]
        counts = ~words.has_point[at] & (self.machine.control.number_without_point == "least-increment")
        column = np.full(len(self), np.nan)
        value = np.clip(words.value[at], -_LONGEST_NUMBER, _LONGEST_NUMBER)
        column[row] = value * np.where(counts, self.least_increment[row], 1.0) * self.scale[row]
        return column

    def _set_by_variables(self) -> Settings:
        offsets = self.machine.offsets
        ranges = {
            RADIUS: offsets.radius_geometry_variables,
            RADIUS_WEAR: offsets.radius_wear_variables,
            NOSE: offsets.nose_variables,
            X: offsets.x_geometry_variables,
            X_WEAR: offsets.x_wear_variables,
        }
        found = []
        for at, assigned in self.run.assigned.items():
            for of, spans in ranges.items():
                place = place_in(spans, assigned.variable)
                if place and self.section[at] < 0:
                    value = assigned.value * (1.0 if of == NOSE else float(self.scale[at]))
                    found.append((at, place, of, value, assigned.is_step))
        return of_list(found)

    @cached_property
    def sets_unknown_offset(self) -> Mask:
        """Sets R, nose type or X of an offset whose number is not known, above a polar section of its program."""
        data = self.listed("data_input") & self.has("P") & np.isnan(self.word("P")) & self.has("R", "C", "Q", "X", "U")
        found = data & (self.section < 0)
        found[[row for row, assigned in self.run.assigned.items() if assigned.variable == NO_VARIABLE]] = True
        ahead = np.searchsorted(self.sections.enter, np.arange(len(self)))
        program = np.append(self.program[self.sections.enter], -1)[ahead]
        return np.asarray(found & (program == self.program))

    def row_of_unknown_setting(self, number: int, row: int, key: str) -> int:
        """The last row, down to this one, that sets R or the nose type of an offset to what is not known; -1: none."""
        found = self.offset_settings
        of_key = found.kind == NOSE if key == "nose" else found.kind <= RADIUS_WEAR
        own = of_key & (found.number == number) & (found.row <= row) & (self.program[found.row] == self.program[row])
        rows = found.row[own & np.isnan(found.value)]
        return int(rows[-1]) if len(rows) else -1

    @cached_property
    def _nothing_set(self) -> _Set:
        return _Set(repeated(np.int64(-1), len(self)), repeated(np.float64(np.nan), len(self)))

    def _numbers_in_force(self, chosen: Settings) -> list[int]:
        """The offsets of some settings that are in force anywhere."""
        in_force = set(self.called_offsets)
        return sorted(in_force.intersection(chosen.number.tolist()))

    @cached_property
    def _nose_set(self) -> _Set:
        if not self.sets_offsets:
            return self._nothing_set
        chosen = self.offset_settings.of(self.offset_settings.kind == NOSE)
        row, value = np.full(len(self), -1), np.full(len(self), np.nan)
        for number in self._numbers_in_force(chosen):
            here = np.flatnonzero(self.offset_number == number)
            row[here], value[here] = Steps(self.starts, chosen.of(chosen.number == number), here).last
        return _Set(row, value)

    @cached_property
    def sets_offsets(self) -> bool:
        """Whether the program may set any offset."""
        return bool(self.run.assigned) or bool(self.listed("data_input").any())

    @cached_property
    def _radius_set(self) -> _Set:
        """
        R from what the program sets of it: the sum of geometry and wear. A wear of 0 changes nothing of what is given.

        The wear alone is added to the R that is given. But one that is too large for a wear is R itself, on a control
        that keeps both in one number; and so is one beside which the nose type is set, where no R is given.
        """
        if not self.sets_offsets:
            return self._nothing_set
        chosen = self.offset_settings.of(self.offset_settings.kind <= RADIUS_WEAR)
        has_nose = self.has("Q")
        rows, values = np.full(len(self), -1), np.full(len(self), np.nan)
        for number in self._numbers_in_force(chosen):
            here = np.flatnonzero(self.offset_number == number)
            given = self._radius_given[here]
            own = chosen.of(chosen.number == number)
            is_whole = has_nose[own.row] & np.isnan(given).any() & ~np.isnan(own.value)
            steps = Steps(self.starts, own, here)
            geometry, wear, is_absolute = steps.radius(is_whole, self.program[own.row])
            given = np.where(is_absolute, 0.0, given)
            changes = is_absolute | (geometry + wear != 0) | np.isnan(given)
            rows[here], values[here] = np.where(changes, steps.last[0], -1), given + geometry + wear
        return _Set(rows, values)


def _first_known(one: Floats, other: Floats) -> Floats:
    return np.where(np.isnan(one), other, one)
