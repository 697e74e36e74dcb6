"""Codes that are meant to switch the polar mode and do not: G121 or G12 for G12.1, and a code of the builder's own."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, cached_property, is_among
from polarcheck.program.machines.axis_table import AXES
from polarcheck.program.machines.code_tables import code, code_set

#: Characters of a code such as G121, of which the builder's other one is the number below.
_DIGITS = 4


class Slip(msgspec.Struct, frozen=True):
    """
    A code in the place of one that switches the mode.

    row: where it stands. meant: the code of this control. end: row at which what it begins ends.
    answer: row of the code in the place of the one that ends the mode, -1 where there is none or the right one.
    is_answered: a code behind it ends the mode, be it misspelled.
    is_of_builder: answer is the code with the number below: G121 and G120, which lathes have for their own mode.
    """

    row: int
    meant: str
    end: int
    answer: int = -1
    is_answered: bool = False
    is_of_builder: bool = False


class SwitchSlips(Columns, frozen=True):
    """
    Slips for codes with a point, that lose it or the digit behind it.

    One that begins the mode stands outside of it, in a block without an axis, and has a move of the virtual axis at
    feed behind it, up to the code that ends it; one that ends it stands in the mode.
    """

    trace: Trace

    @cached_property
    def _forms(self) -> tuple[dict[str, str], dict[str, str]]:
        """By misspelled code the code that is meant: those that begin the mode, and those that end it."""
        mode = self.trace.machine.polar
        is_of_machine = code_set([*mode.on, *mode.off, *self.trace.machine.listed_codes])
        native = self.trace.machine.control.native_words.values()
        first, second = (
            {
                form: name
                for name in names
                if "." in name and name not in native
                for form in (name.replace(".", ""), name.partition(".")[0])
                if not is_of_machine[code(form)]
            }
            for names in (mode.on, mode.off)
        )
        return first, {form: name for form, name in second.items() if form not in first}

    @cached_property
    def slips(self) -> dict[int, Slip]:
        """By row. Nothing is looked for in a program with none of the codes."""
        begins, ends = (self.trace.blocks.codes(*forms) for forms in self._forms)
        if not (begins.any() or ends.any()):
            return {}
        begins = begins & (self.trace.mode.section < 0) & ~self.trace.blocks.has(*AXES)
        slips = [slip for row in np.flatnonzero(begins).tolist() for slip in self._begun_at(row, begins, ends)]
        alone = ends & self.trace.mode.in_polar & ~self.trace.blocks.has(*AXES)
        slips += [Slip(row, self._intended(row, 1), row) for row in np.flatnonzero(alone).tolist()]
        return {slip.row: slip for slip in slips}

    def _begun_at(self, row: int, begins: Mask, ends: Mask) -> list[Slip]:
        """The slip of a row that may begin the mode; none where no contour follows."""
        trace, forms = self.trace, self._forms[0]
        builder = {f"G{int(form[1:]) - 1}" for form in forms if trace.blocks.codes(form)[row] and len(form) == _DIGITS}
        of_builder = trace.blocks.codes(*builder) & ~trace.blocks.has(*AXES)
        stops = begins | trace.mode.enters | trace.tools.changes_tool | trace.blocks.ends_program | trace.blocks.starts
        answers = trace.axes.switches_off | ends | of_builder
        following = np.flatnonzero((stops | answers)[row + 1 :]) + row + 1
        end = int(following[0]) if len(following) else len(trace)
        is_answered = end < len(trace) and bool(answers[end])
        cuts = trace.axes.at_feed & trace.axes.programs_virtual_axis & trace.modal.uses_axes
        if not cuts[row + 1 : end].any():
            return []
        answer = end if is_answered and not trace.axes.switches_off[end] else -1
        return [Slip(row, self._intended(row, 0), end, answer, is_answered, answer >= 0 and bool(of_builder[end]))]

    def _intended(self, row: int, which: int) -> str:
        """The code that is meant in a row."""
        forms = self._forms[which]
        return next(name for form, name in forms.items() if self.trace.blocks.codes(form)[row])

    def meant_in(self, row: int) -> str:
        """The code that is meant in the place of the one of a row, be it the answer of a slip."""
        slip = self.slips.get(row)
        return slip.meant if slip else self._intended(row, 1)

    @cached_property
    def begins(self) -> Mask:
        """Rows with a slip."""
        return self.trace.blocks.mask_of(sorted(self.slips))

    @cached_property
    def within(self) -> Mask:
        """Rows behind the slip of a code that begins the mode, up to the code that ends it, which is among them."""
        mask = np.zeros(len(self.trace), bool)
        for slip in self.slips.values():
            mask[slip.row + 1 : slip.end + 1] = True
        return mask

    @cached_property
    def is_certain(self) -> Mask:
        """Rows with a slip that a code behind it, or the mode, shows to be one."""
        rows = [row for row, slip in self.slips.items() if not slip.is_of_builder]
        rows = [row for row in rows if self.slips[row].is_answered or self.trace.mode.in_polar[row]]
        return self.trace.blocks.mask_of(sorted(rows))

    @cached_property
    def words(self) -> Mask:
        """Per executed word: the code of a slip, and that of its answer."""
        first, second = self._forms
        codes = [*first, *second, *(f"G{int(form[1:]) - 1}" for form in first if len(form) == _DIGITS)]
        index = self.trace.blocks.code_indices(*codes)
        is_slip = self.trace.blocks.mask_of(
            [row for slip in self.slips.values() for row in (slip.row, slip.answer) if row >= 0]
        )
        return self.trace.blocks.words_at(index[is_slip[self.trace.run.row[index]]])

    @cached_property
    def explained(self) -> Mask:
        """Per word of the file: the code of a slip or of its answer. That it is no code of this control follows."""
        starts = self.trace.text.words.start
        if not self.slips:
            return np.zeros(len(starts), bool)
        return is_among(starts, self.trace.run.words.start[self.words].tolist())
