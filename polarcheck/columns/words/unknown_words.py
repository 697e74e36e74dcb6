"""The words whose value rests on variables that have none: on unknown ones, and on vacant ones that nothing sets."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, is_among
from polarcheck.program.machines.axis_table import INCREMENTS, NO_AXIS

#: What these say changes no metal that a check follows: speeds, dwells and repeats, numbers of blocks and programs.
_HARMLESS = tuple("SPNO/")


class UnknownWords(Columns, frozen=True):
    """Columns with one element per executed word of unknown value; and the words that rest on vacant variables."""

    trace: Trace

    @cached_property
    def with_vacant(self) -> Mask:
        """Per executed word: a coordinate in a polar section, the first that rests on its vacant variable."""
        first: dict[int, int] = {}
        run, inside = self.trace.run, self.trace.mode.in_polar
        for index, variable in run.never_set.items():
            if inside[run.row[index]] and self.trace.coordinates.is_coordinate[index]:
                first.setdefault(variable, index)
        return self.trace.blocks.words_at(np.array(list(first.values()), np.int64))

    @cached_property
    def index(self) -> Rows:
        """The number of the executed word, ascending."""
        trace, words = self.trace, self.trace.blocks.unknown_words
        address = trace.run.words.address[words]
        # The rules that need an offset say that it is not known; nothing else says it of the origin.
        is_data = trace.blocks.listed("data_input")[trace.run.row[words]] & ~self._sets_origin[words]
        return np.asarray(words[(address != NO_AXIS) & ~is_data])

    @cached_property
    def _sets_origin(self) -> Mask:
        """Per executed word: X of data input of a work offset."""
        trace = self.trace
        kinds = (0, *trace.machine.g_codes.data_input_work_offset)
        rows = trace.blocks.listed("data_input") & np.isin(np.nan_to_num(trace.blocks.word("L")), kinds)
        return np.asarray(rows[trace.run.row] & trace.blocks.words_at(trace.blocks.word_indices("X", "U")))

    @cached_property
    def row(self) -> Rows:
        """The row of the word."""
        return self.trace.run.row[self.index]

    @cached_property
    def matters(self) -> Mask:
        """True for a word that stands in a polar section, that leads to one, or that is in force in one."""
        trace, row = self.trace, self.row
        in_section = trace.mode.section >= 0
        if not in_section.any():
            return np.zeros(len(row), bool)
        address = trace.run.words.address[self.index]
        is_position = trace.modal.uses_axes[row] & ~is_among(address, self._numbers(*_HARMLESS))
        # An unknown code may be any code, and leave anything in force.
        is_code = is_among(address, self._numbers("G", "M"))
        lasts = is_code | self._sets_origin[self.index]
        matters = (in_section[row] & is_position) | (lasts & (in_section | trace.mode.comes_before_section)[row])
        lasting = [np.zeros(0, np.int64)]
        polar = trace.machine.polar
        positions = trace.modal.uses_axes | trace.blocks.listed("machine_coordinates")
        for pair in dict.fromkeys((*INCREMENTS.items(), polar.rotary_words)):
            lasting.append(self._lasting(pair, positions, in_section))
            for key in ("coordinate_setting", "local_shift"):
                lasting.append(self._lasting(pair, trace.blocks.listed(key), in_section))
        lasting.append(self._lasting(("T",), trace.tools.calls_offset, in_section))
        lasting.append(self._lasting(("D",), trace.tools.calls_edge, in_section))
        lasting.append(self._lasting(("F",), positions, trace.path.moves_at_feed))
        return np.asarray(matters | np.isin(self.index, np.concatenate(lasting)))

    def _numbers(self, *addresses: str) -> list[int]:
        return [self.trace.machine.address_number(address) for address in addresses]

    def _lasting(self, addresses: tuple[str, ...], rows: Mask, where: Mask) -> Rows:
        """
        The words of unknown value that are in force in some row of `where`.

        addresses: of the absolute word, then of the increment. rows: those in which the words count. A known absolute
        word ends what is not known.
        """
        blocks, starts = self.trace.blocks, self.trace.blocks.starts
        words = blocks.word_indices(*filter(None, addresses))
        words = words[rows[self.trace.run.row[words]]]
        is_unknown = np.isin(words, self.index)
        if not is_unknown.any():
            return words[:0]
        absolute = blocks.words_at(blocks.word_indices(addresses[0]))[words]
        absolute &= ~self.trace.modal.is_step(addresses[0])[self.trace.run.row[words]]
        row = self.trace.run.row[words]
        last, written = np.full(len(starts), -1), starts.copy()
        written[row[absolute]] = True
        written[row[is_unknown]], last[row[is_unknown]] = True, words[is_unknown]
        return fill_down(last, written, -1)[where]
