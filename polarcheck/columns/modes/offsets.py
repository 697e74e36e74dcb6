"""R and nose type of the tool offset in force, as the job, the comments and the program itself say."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec
import numpy as np

from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.offset_settings import (
    NOSE,
    RADIUS,
    RADIUS_WEAR,
    X_WEAR,
    Settings,
    Steps,
    X,
    in_order,
    of_list,
)
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.words.comments import Comments
from polarcheck.columns.words.radius_comments import StatedRadius, radii
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Rows,
    cached_property,
    column_at,
    computed,
    different,
    is_among,
    is_uniform,
    repeated,
)
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.execution.run import NO_VARIABLE, Run
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.offset_calls import place_in

#: R of no cutter: it is a length, which mills give in the same words [mm].
_LONGEST = 100.0
#: No cutter of a lathe is larger: what is set is not known [mm].
_LARGEST = 1000.0
#: What wear may add to R [mm], and more than any roughing leaves.
_WEAR, _MOST_LEFT = 0.25, 2.0
#: No control has as many offsets.
_LONGEST_NUMBER = 1e9
#: A larger X of the wear is where the tool has been touched off, likewise [mm].
_LARGEST_X_WEAR = 5.0


class _Set(msgspec.Struct, frozen=True):
    """The last setting of the offset in force by the program: its row, -1 where there is none, and the value."""

    row: Rows
    value: Floats


class ToolOffsets(Columns, frozen=True):
    """The contents of the tool offset in force."""

    run: Run
    machine: Machine
    job: Job
    blocks: ExecutedBlocks
    modal: ModalStates
    tools: CalledTools
    mode: PolarMode
    lengths: Lengths
    comments: Comments

    @cached_property
    def radius_of_offset(self) -> Floats:
        """R of the tool offset in force [mm]; NaN where neither program, job nor, if allowed, a comment gives it."""
        return np.where(self.radius_set_in >= 0, self._radius_set.value, self._radius_given)

    @cached_property
    def nose(self) -> Floats:
        """T of the tool offset in force (nose type); NaN unknown."""
        of_job = self._offset_column({n: t.nose for n, t in self.tools.of_job.items() if t.nose is not None})
        return np.where(self.nose_set_in >= 0, self._nose_set.value, of_job)

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
        from_comment = np.isnan(self._radius_of_job) & ~np.isnan(self._radius_of_comments)
        return np.asarray(from_comment & (self.radius_set_in < 0))

    @cached_property
    def sets_radius_after_call(self) -> Mask:
        """
        Between the call of the offset in force and the next, the program sets R of its offset before the mode needs it.

        A row of unknown effect may set it. An R of a comment does not count there.
        """
        call = np.cumsum(self.tools.calls_offset | self.blocks.starts)
        sets_radius = (self.radius_set_in == np.arange(len(self.run))) | self.run.unknown
        sets, needs = (
            np.bincount(call[rows], minlength=int(call[-1]) + 1 if len(call) else 1) > 0
            for rows in (sets_radius, self.mode.in_polar & self.radius_is_from_comment)
        )
        return np.asarray((sets & ~needs)[call])

    @cached_property
    def sizes_by_x(self) -> Mask:
        """
        X of an offset is changed that a polar section of the program uses: by a step, or as wear.

        X of the geometry is where the tool has been touched off, and so is one that is too large for wear. The wear of
        the job's table stands at the word that calls the offset, unless the program sets its own.
        """
        settings, sizes = self.offset_settings, np.zeros(len(self.run), bool)
        is_wear = (settings.kind == X_WEAR) & ~(np.abs(settings.value) > _LARGEST_X_WEAR)
        chosen = settings.of((settings.kind >= X) & (is_wear | settings.is_step) & (settings.value != 0))
        sizes[chosen.row[self._is_used(chosen.row, chosen.number)]] = True
        tools = self.tools
        for number, tool in tools.of_job.items():
            wear = np.abs(tool.x_wear * self.lengths.job_scale)
            if tool.x_wear and not np.any(settings.number[settings.kind == X_WEAR] == number):
                called = np.flatnonzero(
                    tools.calls_offset & (tools.offset_number == number) & (wear <= _LARGEST_X_WEAR)
                )
                sizes[called[self._is_used(called, np.full(len(called), number))][:1]] = True
        return sizes

    @cached_property
    def x_set_to_unknown(self) -> Rows:
        """The rows that set X of an offset, in force in a section of the program, to a value that is not known."""
        settings = self.offset_settings
        unknown = settings.of((settings.kind >= X) & np.isnan(settings.value))
        return different(unknown.row[self._is_used(unknown.row, unknown.number)])

    def _is_used(self, rows: Rows, numbers: Rows) -> Mask:
        """True for offsets, named in some rows, that are in force in the polar mode of the same program."""
        inside, most = self.mode.in_polar | self.mode.enters, self.tools.offset_count
        used = self.blocks.program[inside] * most + self.tools.offset_number[inside]
        return is_among(self.blocks.program[rows] * most + numbers, used)

    @cached_property
    def cutter_diameter(self) -> Floats:
        """Diameter of the cutter in force [mm], twice R where the job gives no other; NaN unknown."""
        diameters = {n: tool.diameter for n, tool in self.tools.of_job.items()}
        of_job = self._offset_column(diameters) * self.lengths.job_scale
        return np.where(np.isnan(of_job) & (self.radius_of_offset > 0), 2 * self.radius_of_offset, of_job)

    @cached_property
    def metal_left(self) -> Floats:
        """
        By how much R in force is larger than the cutter, so that as much is left for another tool [mm]; else 0.

        The cutter is that of the diameter that the job gives beside R, else that of a comment that says of the tool
        that it leaves metal.
        """
        radius, of_job = np.abs(self.radius_of_offset), self.tools.of_job
        left = np.nan_to_num(radius - self.cutter_diameter / 2)
        for number, comment in self.radii_in_comments.items():
            if comment.allowance and not (number in of_job and of_job[number].diameter > 0):
                excess = radius - comment.radius
                is_left = (self.tools.offset_number == number) & (excess < comment.allowance + _WEAR)
                left = np.where(is_left, excess, left)
        return np.where((left > ROUNDING) & (left < _MOST_LEFT), left, 0.0)

    @cached_property
    def teeth(self) -> Floats:
        """Teeth of the cutter in force; NaN where the job does not give them."""
        return self._offset_column({n: tool.teeth or np.nan for n, tool in self.tools.of_job.items()})

    def _offset_column(self, values: Mapping[int, float]) -> Floats:
        table = np.full(self.tools.offset_count, np.nan)
        for number, value in values.items():
            table[number] = value
        return repeated(table[0], len(self.run)) if is_uniform(table) else table[self.tools.offset_number]

    @property
    def _radius_given(self) -> Floats:
        return computed(_first_known, self._radius_of_job, self._radius_of_comments)

    @cached_property
    def _radius_of_job(self) -> Floats:
        return self._offset_column({n: tool.radius for n, tool in self.tools.of_job.items()}) * self.lengths.job_scale

    @cached_property
    def _radius_of_comments(self) -> Floats:
        return self._offset_column({number: comment.radius for number, comment in self.radii_from_comments.items()})

    @cached_property
    def radii_in_comments(self) -> dict[int, StatedRadius]:
        """R by offset number as comments give it."""
        return radii(self.comments, self.tools)

    @cached_property
    def radii_from_comments(self) -> dict[int, StatedRadius]:
        """R by offset number as comments give it, if they are to count."""
        return self.radii_in_comments if self.job.radius_from_comments else {}

    @cached_property
    def offset_settings(self) -> Settings:
        """
        Settings of tool offsets by the program, by data input and by system variables.

        A setting in the mode is a finding, and does not change the intended offset.
        """
        settings = in_order([*self._set_by_data_input(), self._set_by_variables()])
        settings = settings.of((settings.number > 0) & (settings.number < 10**self.machine.control.offset_digits))
        too_large = (settings.kind <= RADIUS_WEAR) & (np.abs(settings.value) > _LARGEST)
        return settings._replace(value=np.where(too_large, np.nan, settings.value))

    def _set_by_data_input(self) -> list[Settings]:
        rows = np.flatnonzero(self.blocks.listed("data_input") & self.blocks.has("P") & (self.mode.section < 0))
        if not len(rows):
            return []
        offsets, kind = self.machine.offsets, self.blocks.word("L")[rows]
        number_in_p = np.nan_to_num(self.blocks.word("P")[rows])
        base = offsets.geometry_from
        plain = ~self.blocks.has("L")[rows] & (base > 0)
        is_geometry = np.where(plain, number_in_p > base, is_among(kind, offsets.geometry))
        is_tool_offset = plain | is_geometry | is_among(kind, offsets.wear)
        is_tool_offset &= number_in_p < _LONGEST_NUMBER
        number = np.where(is_tool_offset, number_in_p - base * (plain & is_geometry), 0).astype(np.int64)
        # Mills give lengths as they give radii: in R.
        alone = is_among(kind, offsets.radius_alone)
        as_mill = self.blocks.mask_of(rows[alone])
        of_length = ~plain & ~alone & self.blocks.anywhere_in_program(as_mill)[rows]
        steps = self.modal.incremental[rows]
        settings = []
        for address, geometry, wear, always_step in (
            ("R", RADIUS, RADIUS_WEAR, False),
            ("C", RADIUS, RADIUS_WEAR, True),
            ("Q", NOSE, NOSE, False),
            ("X", X, X_WEAR, False),
            ("U", X, X_WEAR, True),
        ):
            value = self._data(address)[rows] if address != "Q" else self.blocks.word("Q")[rows]
            has = self.blocks.has(address)[rows]
            if address in "RC":
                has &= ~of_length & ~(~plain & ~alone & (np.abs(value) > _LONGEST))
            is_step = (steps | always_step) & (address != "Q")
            setting = Settings(
                rows, number, np.where(is_geometry, geometry, wear), value, np.broadcast_to(is_step, len(rows))
            )
            settings.append(setting.of(has))
        return settings

    def _data(self, address: str) -> Floats:
        """A word of data input as a length [mm]: without a point the control takes it in least increments."""
        index = self.blocks.word_indices(address)
        words, row = self.run.words, self.run.row[index]
        counts = ~words.has_point[index] & (self.machine.control.number_without_point == "least-increment")
        value = np.clip(words.value[index], -_LONGEST_NUMBER, _LONGEST_NUMBER)
        length = value * np.where(counts, self.lengths.least_increment[row], 1.0) * self.lengths.scale[row]
        return column_at(len(self.run), row, length, np.nan)

    def _set_by_variables(self) -> Settings:
        offsets = self.machine.offsets
        ranges = {
            RADIUS: offsets.radius_geometry_variables,
            RADIUS_WEAR: offsets.radius_wear_variables,
            NOSE: offsets.nose_variables,
            X: offsets.x_geometry_variables,
            X_WEAR: offsets.x_wear_variables,
        }
        settings = []
        for row, assigned in self.run.assigned.items():
            for of, spans in ranges.items():
                offset_number = place_in(spans, assigned.variable)
                if offset_number and self.mode.section[row] < 0:
                    value = assigned.value * (1.0 if of == NOSE else float(self.lengths.scale[row]))
                    settings.append((row, offset_number, of, value, assigned.is_step))
        return of_list(settings)

    @cached_property
    def sets_unknown_offset(self) -> Mask:
        """Sets R, nose type or X of an offset whose number is not known, above a polar section or, by #, in one."""
        blocks = self.blocks
        number_is_unknown = blocks.has("P") & np.isnan(blocks.word("P"))
        data = blocks.listed("data_input") & number_is_unknown & blocks.has("R", "C", "Q", "X", "U")
        sets = data & (self.mode.section < 0)
        sets[[row for row, assigned in self.run.assigned.items() if assigned.variable == NO_VARIABLE]] = True
        return np.asarray(sets & (self.mode.comes_before_section | self.mode.in_polar)) if sets.any() else sets

    def row_of_unknown_setting(self, number: int, row: int, key: str) -> int:
        """The last row, down to this one, that sets R or the nose type of an offset to what is not known; -1: none."""
        settings = self.offset_settings
        of_key = settings.kind == NOSE if key == "nose" else settings.kind <= RADIUS_WEAR
        program = self.blocks.program
        sets = of_key & (settings.number == number) & (settings.row <= row) & (program[settings.row] == program[row])
        rows = settings.row[sets & np.isnan(settings.value)]
        return int(rows[-1]) if len(rows) else -1

    @cached_property
    def _nothing_set(self) -> _Set:
        return _Set(repeated(np.int64(-1), len(self.run)), repeated(np.float64(np.nan), len(self.run)))

    def _numbers_in_force(self, chosen: Settings) -> list[int]:
        """The offsets of some settings that are in force anywhere."""
        in_force = set(self.tools.called_offsets)
        return sorted(in_force.intersection(chosen.number.tolist()))

    @cached_property
    def _nose_set(self) -> _Set:
        if not self.sets_offsets:
            return self._nothing_set
        chosen = self.offset_settings.of(self.offset_settings.kind == NOSE)
        row, value = np.full(len(self.run), -1), np.full(len(self.run), np.nan)
        for number in self._numbers_in_force(chosen):
            here = np.flatnonzero(self.tools.offset_number == number)
            row[here], value[here] = Steps(self.blocks.starts, chosen.of(chosen.number == number), here).last
        return _Set(row, value)

    @cached_property
    def sets_offsets(self) -> bool:
        """True if the program may set any offset."""
        return bool(self.run.assigned) or bool(self.blocks.listed("data_input").any())

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
        has_nose = self.blocks.has("Q")
        rows, values = np.full(len(self.run), -1), np.full(len(self.run), np.nan)
        for number in self._numbers_in_force(chosen):
            here = np.flatnonzero(self.tools.offset_number == number)
            given = self._radius_given[here]
            of_number = chosen.of(chosen.number == number)
            is_whole = has_nose[of_number.row] & np.isnan(given).any() & ~np.isnan(of_number.value)
            steps = Steps(self.blocks.starts, of_number, here)
            geometry, wear, is_absolute = steps.radius(is_whole, self.blocks.program[of_number.row])
            given = np.where(is_absolute, 0.0, given)
            changes = is_absolute | (geometry + wear != 0) | np.isnan(given)
            rows[here], values[here] = np.where(changes, steps.last[0], -1), given + geometry + wear
        return _Set(rows, values)

    @cached_property
    def nose_is_of_mill(self) -> Mask:
        """The nose type of the offset in force leaves the programmed point in the cutter center; False if unknown."""
        return is_among(self.nose, self.machine.compensation.nose_types)


def _first_known(first: Floats, second: Floats) -> Floats:
    return np.where(np.isnan(first), second, first)
