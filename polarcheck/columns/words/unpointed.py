"""Numbers without a decimal point: which to report, and for how many others each stands."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.coordinates import MEANT_IN_INCREMENTS
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, different, repeated
from polarcheck.foundation.states import FeedMode, Units
from polarcheck.program.reading.numbers import NumberFault


class Unpointed(Columns, frozen=True):
    """Columns over the words of the file: for how many numbers without a point each is reported, 0 where it is not."""

    trace: Trace

    @cached_property
    def in_increments(self) -> Rows:
        """The first coordinate without a point of each program that is written in least increments, for all of it."""
        trace = self.trace
        if not trace.coordinates.in_increments.any():
            return self._none
        reported = np.zeros(len(trace.text.words), np.int64)
        words = trace.coordinates.is_unpointed & trace.coordinates.in_increments[trace.run.row]
        self._add(reported, words, trace.blocks.program, np.ones(int(trace.blocks.program[-1]) + 1, bool))
        return reported

    @cached_property
    def in_meters(self) -> Rows:
        """
        The first coordinate without a point in the sections of each program that are meters wide, for all of them.

        Of a control that reads whole units. Most of the coordinates are so large that least increments were meant.
        """
        trace, words = self.trace, self.trace.run.words
        if not len(trace.mode.sections) or trace.machine.control.number_without_point != "whole-unit":
            return self._none
        is_length = trace.coordinates.is_coordinate & ~words.has_point & (words.fault == NumberFault.NONE)
        value = np.abs(np.nan_to_num(words.value))
        program = np.where(trace.mode.section >= 0, trace.blocks.program, -1)
        count = int(trace.blocks.program[-1]) + 1
        written, large = (
            np.bincount(trace.coordinates.written_once(is_length & chosen, program)[1], minlength=count)
            for chosen in (value != 0, value >= MEANT_IN_INCREMENTS)
        )
        is_wide = (large > 1) & (2 * large > written)
        reported = np.zeros(len(trace.text.words), np.int64)
        group = np.where((program >= 0) & np.append(is_wide, False)[program], program, -1)
        self._add(reported, is_length & (value >= MEANT_IN_INCREMENTS), group, np.ones(count, bool))
        return reported

    @property
    def is_in_meters(self) -> Mask:
        """Rows of the programs whose sections are meters wide."""
        reported = np.flatnonzero(self.in_meters)
        if not len(reported):
            return self.trace.blocks.nowhere
        blocks = self.trace.text.words.block[reported]
        return self.trace.blocks.anywhere_in_program(np.isin(self.trace.run.block, blocks))

    @property
    def _none(self) -> Rows:
        return repeated(np.int64(0), len(self.trace.text.words))

    @property
    def slips(self) -> Rows:
        """
        The numbers without a point of other programs, each by itself.

        It is the coordinates of polar sections and of the blocks that position X and C for them; in inch the F of the
        mode; R of a tool offset that G10 sets. Where more than half of the coordinates of a section are without, that
        is one habit, reported at the first of them, and at the first large one, which is read otherwise. Those
        elsewhere are reported one by one if they are large, and else by one of them for the program, which is one of a
        section where there is one. Beside a number that cannot be read nothing is: what the others mean is open, too.
        """
        elsewhere = self._elsewhere
        if not elsewhere:
            return self._in_sections
        reported = self._in_sections.copy()
        for index, words in elsewhere.items():
            reported[index] += len(words)
        return reported

    @cached_property
    def _is_slip(self) -> Mask:
        """Per executed word: not of a program in least increments, nor beside a number that cannot be read."""
        slips = ~self.trace.coordinates.in_increments[self.trace.run.row]
        if self.trace.run.words.fault.any():
            unreadable = self.trace.blocks.with_words(self.trace.run.words.is_unreadable)
            slips &= ~unreadable[self.trace.run.row]
        return np.asarray(slips)

    @cached_property
    def _in_sections(self) -> Rows:
        """The same without the small ones outside of sections."""
        trace, words = self.trace, self.trace.run.words
        if not len(trace.mode.sections) or trace.machine.control.number_without_point == "whole-unit":
            return self._none
        count, section = len(trace.mode.sections), self._sections
        reported = np.zeros(len(trace.text.words), np.int64)
        slips = self._is_slip
        inch_feed = (words.address == ord("F")) & ~words.has_point & (words.value > 0) & slips
        inch_feed &= ((trace.lengths.feed_units == Units.INCH) & (trace.feedrate.feed_mode == FeedMode.PER_MINUTE))[
            trace.run.row
        ]
        self._add(reported, inch_feed, section, np.zeros(count, bool))
        self._add(
            reported,
            slips & self._radii_of_offsets,
            trace.blocks.program,
            np.zeros(int(trace.blocks.program[-1]) + 1, bool),
        )
        if trace.coordinates.is_unpointed.any():
            large, is_habit = trace.coordinates.is_large_unpointed, trace.coordinates.writes_no_points(section, count)
            has_section = np.isin(trace.blocks.program, trace.blocks.program[trace.mode.sections.enter])
            section_or_rest = np.where(has_section & (section < 0), count, section)
            self._add(reported, slips & trace.coordinates.is_unpointed & ~large, section, is_habit)
            self._add(reported, slips & large, section_or_rest, np.append(is_habit, False))
        return reported if reported.any() else self._none

    def stands_for(self, index: int) -> list[int]:
        """
        The words of the file that lack nothing but their point, for which a reported one stands; none where it is
        large, so that least increments may be meant, or its program is written in them.
        """
        trace, start = self.trace, self.trace.text.words.start[index]
        executed = np.flatnonzero(trace.run.words.start == start)
        if not self.slips[index] or not len(executed) or trace.coordinates.is_large_unpointed[executed].any():
            return []
        elsewhere = self._elsewhere.get(index, [])
        if self._in_sections[index] <= 1:
            return sorted({index, *elsewhere})
        own = self._sections == self._sections[trace.run.row[executed[0]]]
        words = trace.coordinates.is_unpointed & ~trace.coordinates.is_large_unpointed & own[trace.run.row]
        at, _ = self._in_file(np.flatnonzero(words))
        return different(np.append(at, elsewhere).astype(np.int64)).tolist()  # type: ignore[no-any-return]

    @cached_property
    def _radii_of_offsets(self) -> Mask:
        """Per executed word: R of a tool offset that G10 sets, too small to be meant in least increments."""
        trace, words = self.trace, self.trace.run.words
        if not (data_input := trace.blocks.listed("data_input")).any():
            return trace.blocks.no_words
        kinds = trace.machine.g_codes.data_input_tool_offset
        sets = (
            data_input
            & (np.isin(trace.blocks.word("L"), kinds) | ~trace.blocks.has("L"))
            & (trace.blocks.word("P") > 0)
        )
        is_small = ~words.has_point & (words.value != 0) & (np.abs(words.value) < MEANT_IN_INCREMENTS)
        return np.asarray(trace.blocks.words_at(trace.blocks.word_indices("R")) & is_small & sets[trace.run.row])

    @cached_property
    def _sections(self) -> Rows:
        """
        The section of each row of the mode and of the rows that position X and C for it, and of its G12.1 where the
        control takes words beside it; -1 of all others.
        """
        trace = self.trace
        takes_words = bool(trace.machine.polar.words_beside_switch)
        column = np.where(trace.mode.in_polar | (trace.mode.enters & takes_words), trace.mode.section, -1)
        enter = trace.mode.sections.enter
        for addresses in (("X", "U"), trace.machine.polar.rotary_words):
            rows = np.append(
                -1, np.flatnonzero(trace.modal.uses_axes & trace.blocks.has(*addresses) & ~trace.mode.in_polar)
            )
            last = rows[np.searchsorted(rows, enter) - 1]
            own = (last >= 0) & (trace.blocks.program[last] == trace.blocks.program[enter])
            column[last[own]] = np.flatnonzero(own)
        return column

    def _add(self, reported: Rows, words: Mask, group: Rows, as_one: Mask) -> None:
        """Report executed words, those of a group of rows that counts as one at its first word, for all of them."""
        index, own = self.trace.coordinates.written_once(words, group)
        count = np.where(as_one, np.bincount(own, minlength=len(as_one)), 1)
        at, found = self._in_file(index)
        own = own[found]
        is_first = np.zeros(len(own), bool)
        is_first[np.unique(own, return_index=True)[1]] = True
        shown = is_first | ~as_one[own]
        np.maximum.at(reported, at[shown], count[own[shown]])

    @cached_property
    def _elsewhere(self) -> dict[int, list[int]]:
        """The small numbers outside of sections by the one word of each program that is reported for them."""
        trace = self.trace
        if not len(trace.mode.sections) or not trace.coordinates.is_unpointed.any():
            return {}
        program = trace.blocks.program
        has_section = np.isin(program, program[trace.mode.sections.enter])
        words = self._is_slip & trace.coordinates.is_unpointed & ~trace.coordinates.is_large_unpointed
        outside = np.where(has_section & (self._sections < 0), program, -1)
        index, own = trace.coordinates.written_once(words, outside)
        at, found = self._in_file(index)
        of_program: dict[int, list[int]] = {}
        for number, word in zip(own[found].tolist(), at.tolist(), strict=True):
            of_program.setdefault(number, []).append(word)
        reported = np.flatnonzero(self._in_sections)
        program_of_word = program[trace.blocks.row_of_block[trace.text.words.block[reported]]]
        result = {}
        for number, words_of_program in of_program.items():
            first = reported[program_of_word == number]
            result[int(first[0]) if len(first) else min(words_of_program)] = words_of_program
        return result

    def _in_file(self, index: Rows) -> tuple[Rows, Mask]:
        """Where executed words stand among the words of the file, and which do: those of macro statements do not."""
        own = self.trace.text.words.start
        start = self.trace.run.words.start[index]
        at = np.searchsorted(own, start)
        found = np.append(own, -1)[at] == start
        return at[found], found
