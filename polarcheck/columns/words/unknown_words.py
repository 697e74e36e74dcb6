"""What rests on variables without a value: words and settings of offsets; unknown variables, and vacant ones."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.modes.origin import Origin
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, is_among, side_by_side
from polarcheck.program.execution.arithmetic import Unknown
from polarcheck.program.execution.run import NO_VARIABLE
from polarcheck.program.machines.axis_table import INCREMENTS, NO_AXIS, OF_SPINDLE
from polarcheck.program.machines.code_lists import FRAME_LISTS

#: What these say changes no metal that a check follows: speeds, dwells and repeats, numbers of blocks and programs.
_HARMLESS = tuple("SPNO/")


class UnknownItem(msgspec.Struct, frozen=True):
    """
    A word of unknown value, or a block that sets an offset to one.

    row: of the trace. start, end: its characters. variable: that it rests on; None where it is not known which.
    matters: a polar section rests on it. is_data: the rules that need the offset say that it is not known.
    """

    row: int
    start: int
    end: int
    variable: int | None
    matters: bool
    is_data: bool


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
        words = self.trace.blocks.unknown_words
        return np.asarray(words[self.trace.run.words.address[words] != NO_AXIS])

    @cached_property
    def items(self) -> list[UnknownItem]:
        """All of them, in order."""
        if not self.trace.run.unknown_words and not self.trace.run.assigned:
            return []
        return sorted([*self._words(), *self._settings()], key=lambda item: (item.row, item.start))

    def _words(self) -> Iterator[UnknownItem]:
        trace, words = self.trace, self.trace.run.words
        # The rules that need an offset say that it is not known; nothing else says it of where X0 lies.
        is_data = trace.blocks.listed("data_input") & ~self._sets_tool
        for index, row, matters in side_by_side(self.index, self.row, self.matters):
            variable = trace.run.unknown_words[index]
            of_data = bool(is_data[row]) and not self._sets_origin[index]
            yield UnknownItem(row, int(words.start[index]), int(words.end[index]), variable, matters, of_data)

    def _settings(self) -> Iterator[UnknownItem]:
        trace, blocks = self.trace, self.trace.text.blocks
        of_origin = set(Origin(trace).set_to_unknown.tolist())
        shifts_tool = set(trace.offsets.x_set_to_unknown.tolist())
        for row, assigned in trace.run.assigned.items():
            if assigned.value == assigned.value or assigned.variable == NO_VARIABLE:
                continue
            matters = row in shifts_tool or (row in of_origin and bool(trace.mode.comes_before_section[row]))
            variable = assigned.value.variable if isinstance(assigned.value, Unknown) else None
            block = int(trace.run.block[row])
            start, end = int(blocks.start[block]), int(blocks.end[block])
            yield UnknownItem(row, start, end, variable, matters, not matters)

    @cached_property
    def _sets_origin(self) -> Mask:
        """Per executed word: X of data input of a work offset that counts in a section, or of an unknown one."""
        trace = self.trace
        kind, number = trace.blocks.word("L"), trace.blocks.word("P")
        # Without L P0 is the work shift; other numbers are tool offsets.
        is_origin = np.isin(kind, (0, *trace.machine.g_codes.data_input_work_offset)) | (np.isnan(kind) & ~(number > 0))
        counts = trace.blocks.is_unknown("P") | trace.blocks.mask_of(Origin(trace).set_to_unknown)
        rows = trace.blocks.listed("data_input") & is_origin & (counts | (trace.mode.section >= 0))
        return np.asarray(rows[trace.run.row] & trace.blocks.words_at(trace.blocks.word_indices("X", "U")))

    @cached_property
    def _sets_tool(self) -> Mask:
        """Per row: data input of X of an offset that is in force in a section, or of any offset, in any table."""
        trace = self.trace
        of_any = (trace.offsets.sets_unknown_offset & trace.blocks.is_unknown("P")) | trace.blocks.is_unknown("L")
        sets = of_any | trace.blocks.mask_of(trace.offsets.x_set_to_unknown)
        return np.asarray(sets & trace.blocks.listed("data_input"))

    @cached_property
    def row(self) -> Rows:
        """The row of the word."""
        return self.trace.run.row[self.index]

    @cached_property
    def matters(self) -> Mask:
        """True for a word that stands in a polar section, that leads to one, or that is in force in one."""
        trace, row = self.trace, self.row
        in_section = trace.mode.section >= 0
        address = trace.run.words.address[self.index]
        if not in_section.any():
            # An unknown G may begin the contour that a G13.1 ends.
            return np.asarray(is_among(address, self._numbers("G")) & trace.mode.comes_before_open_end[row])
        is_position = (trace.modal.uses_axes | trace.blocks.listed(*FRAME_LISTS))[row]
        is_position &= ~is_among(address, self._numbers(*_HARMLESS, "F"))  # F where a move runs at it, below
        # An unknown code may be any code, and leave anything in force.
        letter = trace.text.source.code[trace.run.words.start[self.index]]
        is_code = is_among(address, self._numbers("G", "M", "@"))
        is_code |= (address == OF_SPINDLE) & is_among(letter, (ord("M"), ord("m")))
        lasts = is_code | self._sets_origin[self.index] | self._sets_tool[row]
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
        for word, kind in trace.machine.arcs.made_corners.items():
            if kind == "modal-radius":
                lasting.append(self._lasting((word,), ~trace.blocks.nowhere, in_section))
        return np.asarray(matters | np.isin(self.index, np.concatenate(lasting)))

    @cached_property
    def around_section(self) -> Mask:
        """
        The rows of polar sections in which a word of unknown value stands that says where the tool goes, and the rows
        on the way to them and from them.
        """
        sections = self.trace.mode.sections
        number = self.trace.mode.section[self.row[self.matters]]
        is_unknown = np.append(np.bincount(number[number >= 0], minlength=len(sections)) > 0, False)
        row = np.arange(len(self.trace))
        begun = np.searchsorted(sections.enter, row, side="right")
        # The last section begun; outside of it also the next one.
        return is_unknown[begun - 1] | (is_unknown[begun] & (self.trace.mode.section < 0))

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
