"""Coordinates as lengths and angles: what a number without a decimal point counts."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows, computed, is_among
from polarcheck.machines.modal import Units
from polarcheck.table.called_tools import CalledTools
from polarcheck.table.filling import fill_down

#: Without a point, a length of this many units can only be meant in least increments: no lathe moves a meter.
MEANT_IN_INCREMENTS = 1000.0
#: No lathe goes so far [mm, inch, deg]: where such a word leads is not known, and nothing overflows by it.
_FARTHEST = 1e7


class Lengths(CalledTools):
    """What the coordinates of the rows are, in mm and degrees."""

    @cached_property
    def is_coordinate(self) -> Mask:
        """Per word: the end, the center or the radius of a move, or the infeed beside G12.1."""
        words = self.run.words
        mode = self.machine.polar
        is_length = is_among(words.address, [*b"XYZUVWIJKR", *map(self.machine.address_number, mode.axis_addresses)])
        is_offset_number = (words.address == ord("H")) & self.switches_length_offset[self.run.row]
        moves = self.uses_axes & ~self.in_cycle
        found = np.asarray(is_length & ~is_offset_number & moves[self.run.row])
        if mode.infeed_word:
            is_infeed = words.address == ord(mode.infeed_word)
            found |= is_infeed & self.codes(*mode.on)[self.run.row]
        return found

    @cached_property
    def is_unpointed(self) -> Mask:
        """Per word: a coordinate other than 0 without a point, on a control that reads it in least increments."""
        words = self.run.words
        if self.machine.control.number_without_point == "whole-unit":
            return np.zeros(len(words), bool)
        return np.asarray(self.is_coordinate & ~words.has_point & (np.nan_to_num(words.value) != 0))

    @cached_property
    def is_large_unpointed(self) -> Mask:
        """Per word: without a point and so large that it can only be meant in least increments."""
        return self.is_unpointed & (np.abs(self.run.words.value) >= MEANT_IN_INCREMENTS)

    def written_once(self, words: Mask, group: Rows) -> tuple[Rows, Rows]:
        """
        Some of the executed words, each once in each group of rows, however often a loop or a call runs it: their
        indices in the order in which they run, and the group of each. Rows of a negative group are left out.
        """
        index = np.flatnonzero(words)
        own = group[self.run.row[index]]
        index, own = index[own >= 0], own[own >= 0]
        key = self.run.words.start[index] * (own.max(initial=0) + 1) + own
        first = np.sort(np.unique(key, return_index=True)[1])
        return index[first], own[first]

    def writes_no_points(self, group: Rows, count: int) -> Mask:
        """Per group of rows: more than one of its coordinates other than 0, and most of them, have no point."""
        is_coordinate = self.is_coordinate & (np.nan_to_num(self.run.words.value) != 0)
        unpointed, all_of_them = (
            np.bincount(self.written_once(words, group)[1], minlength=count)
            for words in (self.is_unpointed, is_coordinate)
        )
        return np.asarray((unpointed > 1) & (2 * unpointed > all_of_them))

    @cached_property
    def in_increments(self) -> Mask:
        """
        The program is written in least increments, so that its small numbers without a point count those, too.

        It writes its coordinates without points, throughout or in the polar mode, and most of these numbers are too
        large for anything else. A single one is a slip.
        """
        if not self.is_large_unpointed.any():
            return np.zeros(len(self), bool)
        program, count = self.program, int(self.program[-1]) + 1
        unpointed, large = (
            np.bincount(self.written_once(words, program)[1], minlength=count)
            for words in (self.is_unpointed, self.is_large_unpointed)
        )
        mode = self.machine.polar
        on, off = self.codes(*mode.on), self.codes(*mode.off, *mode.ended_by)
        inside = fill_down(on & ~off, on | off | self.starts, False)
        in_the_mode = self.writes_no_points(np.where(inside, program, -1), count)
        without_points = self.writes_no_points(program, count) | in_the_mode
        return np.asarray((without_points & (2 * large > unpointed))[program])

    @cached_property
    def _counts_increments(self) -> Mask:
        """
        Per word: its number is read in least increments.

        Of the other numbers without a point it is taken that they are meant as if they had one.
        """
        if not self.is_large_unpointed.any():
            return self.is_large_unpointed
        return self.is_large_unpointed | (self.is_unpointed & self.in_increments[self.run.row])

    def _meant(self, least: Floats | float) -> Floats:
        """Per word: the value that is meant; least: what an increment is."""
        value, in_increments = self.run.words.value, self._counts_increments
        meant = np.where(in_increments, value * least, value) if in_increments.any() else value
        too_far = np.abs(meant) > _FARTHEST
        return np.where(too_far, np.nan, meant) if too_far.any() else meant

    def length_of(self, address: str) -> Floats:
        """A word as a length [mm], as written: a diameter stays one."""
        return self._column(f"length {address}", lambda: self._length_of(address))

    def _length_of(self, address: str) -> Floats:
        if not len(self.word_indices(address)):
            return self._scatter(address, self._lengths)
        return self._scatter(address, self._lengths) * self.scale

    @cached_property
    def least_increment(self) -> Floats:
        """Per row: least input increment of lengths, in the units in force [mm or inch]."""
        least, of_inch = self.machine.control.least_increment, self.machine.control.least_increment_inch
        return computed(lambda units: np.where(units == Units.INCH, of_inch, least), self.units)

    @cached_property
    def least_step(self) -> Floats:
        """Per row: the same [mm]."""
        return computed(np.multiply, self.least_increment, self.scale)

    @cached_property
    def _lengths(self) -> Floats:
        return self._meant(self.least_increment[self.run.row])

    def angle_of(self, address: str) -> Floats:
        """A word as an angle [deg]."""
        return self._column(f"angle {address}", lambda: self._scatter(address, self._angles))

    @cached_property
    def _angles(self) -> Floats:
        return self._meant(self.machine.control.least_increment)
