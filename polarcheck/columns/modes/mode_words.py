"""Words in the polar mode and beside its switches: what they do, and which of them the profile does not allow."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import before
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, cached_property, is_among
from polarcheck.program.machines.code_lists import is_code, numbers
from polarcheck.program.machines.code_tables import NO_CODE, code_set
from polarcheck.program.reading.words import NumberFault


class ModeWords(Columns, frozen=True):
    """Columns over the executed words of a trace, one value per word; `rows` and `in_rows` lead to rows and back."""

    trace: Trace

    def rows(self, words: Mask) -> Mask:
        """Per row: whether it has one of these words."""
        return self.trace.blocks.with_words(words)

    def in_rows(self, rows: Mask) -> Mask:
        """Stands in one of these rows."""
        return rows[self.trace.run.row] if np.count_nonzero(rows) else self.trace.blocks.no_words

    def codes(self, *names: str) -> Mask:
        """One of these G or M codes; `G54-G59` is a range."""
        return self.trace.blocks.words_at(self.trace.blocks.code_indices(*names))

    def listed(self, *keys: str) -> Mask:
        """A G code of any of these lists of the machine, as in `plane_xy`."""
        return self.trace.blocks.words_at(self.trace.blocks.listed_indices(*keys))

    def first_of(self, *names: str) -> Mask:
        """Words of the first of these names that stands in their row; `G91` is a code, `U` an address, or none."""
        trace = self.trace
        row = trace.run.row
        first, listed = np.zeros(len(row), bool), np.zeros(len(trace), bool)
        for name in names:
            blocks = trace.blocks
            index = blocks.code_indices(name) if len(name) > 1 else blocks.word_indices(name)
            index = index[~listed[row[index]]]
            first[index] = True
            listed[row[index]] = True
        return first

    # ---- G codes in the mode ----

    @cached_property
    def not_allowed(self) -> Mask:
        """A G code in the mode that the profile does not allow there."""
        trace = self.trace
        allowed = code_set(trace.machine.polar.allowed_codes)
        forbidden = ~allowed[trace.blocks.g_codes] & (trace.blocks.g_codes != NO_CODE)
        in_mode = self.in_rows(trace.mode.in_polar & ~trace.path.of_machine_z)
        return trace.blocks.words_at(trace.blocks.g_words[forbidden]) & in_mode

    @cached_property
    def only_outside(self) -> Mask:
        """Not allowed in the mode, and of no rule that says more of its code."""
        polar = self.trace.machine.polar
        has_its_own_rule = (
            self.listed("rapid")
            | self.codes(*polar.on, *polar.off)
            | self.selects_plane
            | self.sets_length_offset
            | self.shifts_origin
            | self.changes_tool_offset
            | self.ends_drilling
            | self.unknown
        )
        return self.not_allowed & ~has_its_own_rule

    @cached_property
    def ends_drilling(self) -> Mask:
        """G80 of a drilling cycle that is in force: it was that which cannot stand in the mode."""
        trace = self.trace
        drills = before(trace.modal.drilling, trace.blocks.starts, 0) != 0
        return self.listed("drilling_cycle_off") & self.in_rows(drills)

    @cached_property
    def unknown(self) -> Mask:
        """A G code that the control does not know; none where the profile does not list all that it knows."""
        trace = self.trace
        if not trace.machine.control.unknown_codes_are_errors:
            return np.zeros(len(trace.run.words), bool)
        return trace.blocks.words_at(trace.blocks.g_words) & ~self.codes(*trace.machine.control.known_codes)

    @cached_property
    def selects_plane(self) -> Mask:
        """G17, G18, G19."""
        return self.listed("plane_xy", "plane_zx", "plane_yz")

    @cached_property
    def sets_length_offset(self) -> Mask:
        """G43, G44, G49."""
        return self.listed("tool_length_offset", "tool_length_offset_off")

    @cached_property
    def sets_coordinates(self) -> Mask:
        """G50 (G92): axis words say where the tool stands, or with S how fast the spindle may turn."""
        return self.listed("coordinate_setting")

    @cached_property
    def shifts_origin(self) -> Mask:
        """
        Not allowed in the mode, and changes the coordinate system: G50 (G92) with axis words, G52 to G59, a work offset
        by G10. G50 with S in the block of another of them is no mistake of its own, and counts with it.
        """
        trace = self.trace
        if not self.not_allowed.any():
            return trace.blocks.no_words
        kind = trace.blocks.word("L")
        # Without L a lathe takes P0 as the work shift, other numbers as tool offsets.
        is_work_offset = is_among(kind, trace.machine.g_codes.data_input_work_offset) | (
            np.isnan(kind) & (trace.blocks.word("P") == 0)
        )
        sets = self.sets_coordinates
        shifts = self.listed("local_shift", "machine_coordinates", "work_offset", "work_offset_extended")
        shifts = shifts | self.listed("coordinate_preset")
        shifts |= sets & self.in_rows(trace.blocks.has(*trace.machine.axis_words, *trace.machine.control.named_axes))
        shifts |= self.listed("data_input") & self.in_rows(is_work_offset)
        shifts &= self.not_allowed
        return shifts | (sets & self.not_allowed & self.in_rows(self.rows(shifts)))

    @cached_property
    def selects_other_work_offset(self) -> Mask:
        """Per row: selects another work offset than the one in force, in the mode, where the profile allows that."""
        trace = self.trace
        first = next(iter(numbers(trace.machine.codes("work_offset"))), 0) // 10
        offset = np.where(trace.modal.state("work_offset") == 0, first, trace.modal.state("work_offset"))
        changes = trace.mode.in_polar & (offset != before(offset, trace.blocks.starts, first))
        return np.asarray(changes & self.rows(self.listed("work_offset") & ~self.not_allowed))

    @cached_property
    def changes_tool_offset(self) -> Mask:
        """G10 that changes a tool offset."""
        kind, number = self.trace.blocks.word("L"), self.trace.blocks.word("P")
        is_tool_offset = is_among(kind, self.trace.machine.g_codes.data_input_tool_offset) | (
            np.isnan(kind) & (number > 0)
        )
        return self.listed("data_input") & self.in_rows(is_tool_offset)

    # ---- the switches ----

    @cached_property
    def switches(self) -> Mask:
        """Per row: a G12.1, or the G13.1 of a section; one outside the mode, as at the head of a program, is none."""
        trace = self.trace
        return trace.mode.enters | trace.mode.enters_again | (trace.mode.leaves & trace.axes.switches_off)

    @cached_property
    def may_stand_beside_switch(self) -> Mask:
        """
        Is the G12.1 or G13.1 itself, or may share its block: N, O, block skip, the words that the profile names, and
        words without a good number, which have rules of their own. Addresses that the profile names are for the G12.1.
        """
        words, polar = self.trace.run.words, self.trace.machine.polar
        of_address, of_begin = np.zeros((2, 256), bool)
        of_address[[ord(name) for name in ("N", "O", "/")]] = True
        codes = [name for name in polar.words_beside_switch if is_code(name, "GM")]
        addresses = [name for name in polar.words_beside_switch if name not in codes]
        of_begin[[self.trace.machine.address_number(name) for name in addresses]] = True
        of_code = self.codes(*polar.on, *polar.off, *codes)
        # X stands for the linear axis, whichever that is.
        of_linear = (words.address == self.trace.axes.linear_axis[self.trace.run.row]) & of_begin[ord("X")]
        begins = (of_begin[words.address] | of_linear) & ~self.in_rows(self.trace.mode.leaves)
        return np.asarray(of_address[words.address] | begins | of_code | (words.fault != NumberFault.NONE))

    # ---- the virtual axis ----

    @cached_property
    def of_other_axis(self) -> Mask:
        """A coordinate under the address that other controls give the virtual axis."""
        trace = self.trace
        return trace.axes.foreign_virtual_words & ~trace.axes.linear_words & self.in_rows(trace.modal.uses_axes)
