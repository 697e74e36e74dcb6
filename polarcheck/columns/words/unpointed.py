"""Numbers without a decimal point: which to report, and for how many others each stands."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.coordinates import MEANT_IN_INCREMENTS
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, is_among, mask_at, repeated
from polarcheck.foundation.states import FeedMode, Units
from polarcheck.program.reading.numbers import NumberFault


class Unpointed(Columns, frozen=True):
    """Columns over the words of the file: which numbers lack a point, and for how many others one of them stands."""

    trace: Trace

    @cached_property
    def in_increments(self) -> Rows:
        """The first coordinate without a point of each program that is written in least increments, for all of it."""
        trace = self.trace
        if not trace.coordinates.in_increments.any():
            return self._none
        reported = np.zeros(len(trace.text.words), np.int64)
        words = trace.coordinates.is_unpointed & trace.coordinates.in_increments[trace.run.row]
        self._add(reported, words, trace.blocks.program)
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
        self._add(reported, is_length & (value >= MEANT_IN_INCREMENTS), group)
        return reported

    @property
    def is_in_meters(self) -> Mask:
        """Rows of the programs whose sections are meters wide."""
        reported = np.flatnonzero(self.in_meters)
        if not len(reported):
            return self.trace.blocks.nowhere
        blocks = self.trace.text.words.block[reported]
        return self.trace.blocks.anywhere_in_program(is_among(self.trace.run.block, blocks))

    @property
    def _none(self) -> Rows:
        return repeated(np.int64(0), len(self.trace.text.words))

    @cached_property
    def slips(self) -> Mask:
        """
        The numbers without a point of programs with polar sections that are not written in least increments.

        It is the coordinates in and outside of the sections; in inch the F of the mode; R of a tool offset that G10
        sets. Beside a number that cannot be read nothing is: what the others mean is open, too.
        """
        return self._of_file(self._coordinates | self._feeds | self._radii_of_offsets)

    @property
    def rank(self) -> Floats:
        """How well a number of `slips` stands for the others: a small coordinate of a section best."""
        small = self._coordinates & ~self.trace.coordinates.is_large_unpointed
        in_section = self._coordinates & (self._sections >= 0)[self.trace.run.row]
        kinds = self._coordinates, small, in_section
        return np.asarray(np.sum([self._of_file(words) for words in kinds], axis=0, dtype=np.float64))

    def of_program(self, index: int) -> Rows:
        """The words of the file among `slips` that belong to the program of one of them."""
        row = self.trace.blocks.row_of_block[self.trace.text.words.block]
        program = np.where(row >= 0, self.trace.blocks.program[row], -1)
        return np.flatnonzero(self.slips & (program == program[index]))

    def stands_for(self, index: int) -> list[int]:
        """
        The words of the file that lack nothing but their point, for which a reported one stands: all of its kind in the
        program. None where it is large, so that least increments may be meant.
        """
        if not self.slips[index] or self._is_large[index]:
            return []
        same = self.of_program(index)
        chosen: list[int] = same[(self.is_feed[same] == self.is_feed[index]) & ~self._is_large[same]].tolist()
        return chosen

    @cached_property
    def is_feed(self) -> Mask:
        """Per word of the file: F, whose point matters in inch alone."""
        return np.asarray(self.trace.text.words.address == ord("F"))

    @cached_property
    def _is_large(self) -> Mask:
        return self._of_file(self.trace.coordinates.is_large_unpointed)

    @cached_property
    def _is_slip(self) -> Mask:
        """Per executed word: not of a program in least increments, nor beside a number that cannot be read."""
        slips = ~self.trace.coordinates.in_increments[self.trace.run.row]
        if self.trace.run.words.fault.any():
            unreadable = self.trace.blocks.with_words(self.trace.run.words.is_unreadable)
            slips &= ~unreadable[self.trace.run.row]
        return np.asarray(slips)

    @cached_property
    def _is_judged(self) -> Mask:
        """Per executed word: of a program with polar sections, on a control that reads least increments."""
        trace = self.trace
        if not len(trace.mode.sections) or trace.machine.control.number_without_point == "whole-unit":
            return trace.blocks.no_words
        has_section = is_among(trace.blocks.program, trace.blocks.program[trace.mode.sections.enter])
        return np.asarray(self._is_slip & has_section[trace.run.row])

    @cached_property
    def _coordinates(self) -> Mask:
        return np.asarray(self._is_judged & self.trace.coordinates.is_unpointed)

    @cached_property
    def _feeds(self) -> Mask:
        """Per executed word: F of the mode in inch."""
        trace, words = self.trace, self.trace.run.words
        is_inch = (trace.lengths.feed_units == Units.INCH) & (trace.feedrate.feed_mode == FeedMode.PER_MINUTE)
        rows = is_inch & (self._sections >= 0)
        return np.asarray(
            self._is_judged & (words.address == ord("F")) & ~words.has_point & (words.value > 0) & rows[trace.run.row]
        )

    @cached_property
    def _radii_of_offsets(self) -> Mask:
        """Per executed word: R of a tool offset that G10 sets, too small to be meant in least increments."""
        trace, words = self.trace, self.trace.run.words
        if not (data_input := trace.blocks.listed("data_input")).any():
            return trace.blocks.no_words
        kinds = trace.machine.g_codes.data_input_tool_offset
        sets = (
            data_input
            & (is_among(trace.blocks.word("L"), kinds) | ~trace.blocks.has("L"))
            & (trace.blocks.word("P") > 0)
        )
        is_small = ~words.has_point & (words.value != 0) & (np.abs(words.value) < MEANT_IN_INCREMENTS)
        radii = trace.blocks.words_at(trace.blocks.word_indices("R")) & is_small & sets[trace.run.row]
        return np.asarray(self._is_judged & radii)

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

    def _add(self, reported: Rows, words: Mask, group: Rows) -> None:
        """Report the first executed word of each group of rows, for all of them."""
        index, own = self.trace.coordinates.written_once(words, group)
        count = np.bincount(own)
        at, found = self._in_file(index)
        own, first = np.unique(own[found], return_index=True)
        np.maximum.at(reported, at[first], count[own])

    def _of_file(self, words: Mask) -> Mask:
        """The words of the file that executed words are."""
        return mask_at(len(self.trace.text.words), self._in_file(np.flatnonzero(words))[0])

    def _in_file(self, index: Rows) -> tuple[Rows, Mask]:
        """Where executed words stand among the words of the file, and which do: those of macro statements do not."""
        own = self.trace.text.words.start
        start = self.trace.run.words.start[index]
        at = np.searchsorted(own, start)
        found = np.append(own, -1)[at] == start
        return at[found], found
