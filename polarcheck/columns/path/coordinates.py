"""The coordinates among the words: which count in least increments since they have no decimal point, and angles."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.lookups import Lookups
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.foundation.arrays import Floats, Mask, Rows, cached_property, is_among
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine

#: Without a point, a length of this many units can only be meant in least increments: no lathe moves a meter.
MEANT_IN_INCREMENTS = 1000.0
#: No lathe goes so far [mm, inch, deg]: where such a word leads is not known, and nothing overflows by it.
_FARTHEST = 1e7


class Coordinates(Lookups, frozen=True):
    """Units of the numbers of coordinates. Most columns have one element per executed word."""

    run: Run
    machine: Machine
    blocks: ExecutedBlocks
    modal: ModalStates

    @cached_property
    def is_coordinate(self) -> Mask:
        """Per word: the end, the center or the radius of a move, a chamfer or corner, or the infeed beside G12.1."""
        words = self.run.words
        mode = self.machine.polar
        is_length = is_among(words.address, [*b"XYZUVWIJKRrc", *map(self.machine.address_number, mode.axis_addresses)])
        is_offset_number = (words.address == ord("H")) & self.blocks.numbers_by_h[self.run.row]
        moves = self.modal.uses_axes & ~self.modal.in_cycle
        is_axis_word = np.asarray(is_length & ~is_offset_number & moves[self.run.row])
        if mode.infeed_word:
            is_infeed = words.address == ord(mode.infeed_word)
            is_axis_word |= is_infeed & self.blocks.codes(*mode.on)[self.run.row]
        return is_axis_word

    @cached_property
    def is_unpointed(self) -> Mask:
        """Per word: a coordinate other than 0 without a point, on a control that reads it in least increments."""
        words = self.run.words
        if self.machine.control.number_without_point == "whole-unit":
            return np.zeros(len(words), bool)
        without = self.is_coordinate & ~words.has_point
        index = np.flatnonzero(without)
        without[index] = np.nan_to_num(words.value[index]) != 0
        return without

    @cached_property
    def is_large_unpointed(self) -> Mask:
        """Per word: without a point and so large that it can only be meant in least increments."""
        index = np.flatnonzero(self.is_unpointed)
        return self.blocks.words_at(index[np.abs(self.run.words.value[index]) >= MEANT_IN_INCREMENTS])

    def written_once(self, words: Mask, group: Rows) -> tuple[Rows, Rows]:
        """
        Some of the executed words, each once in each group of rows, however often a loop or a call runs it: their
        indices in the order in which they run, and the group of each. Rows of a negative group are left out.
        """
        index = np.flatnonzero(words)
        group_of_word = group[self.run.row[index]]
        index, group_of_word = index[group_of_word >= 0], group_of_word[group_of_word >= 0]
        key = self.run.words.start[index] * (group_of_word.max(initial=0) + 1) + group_of_word
        first = np.sort(np.unique(key, return_index=True)[1])
        return index[first], group_of_word[first]

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
            return np.zeros(len(self.run), bool)
        program, count = self.blocks.program, int(self.blocks.program[-1]) + 1
        unpointed, large = (
            np.bincount(self.written_once(words, program)[1], minlength=count)
            for words in (self.is_unpointed, self.is_large_unpointed)
        )
        mode = self.machine.polar
        on, off = self.blocks.codes(*mode.on), self.blocks.codes(*mode.off, *mode.ended_by)
        inside = fill_down(on & ~off, on | off | self.blocks.starts, False)
        in_the_mode = self.writes_no_points(np.where(inside, program, -1), count)
        without_points = self.writes_no_points(program, count) | in_the_mode
        return np.asarray((without_points & (2 * large > unpointed))[program])

    @cached_property
    def is_taken_as_pointed(self) -> Mask:
        """Per word: a coordinate without a point that is followed as if it had one, though the control reads less."""
        return np.asarray(self.is_unpointed & ~self._counts_increments)

    @cached_property
    def _counts_increments(self) -> Mask:
        """
        Per word: its number is read in least increments.

        Of the other numbers without a point it is taken that they are meant as if they had one.
        """
        if not self.is_large_unpointed.any():
            return self.is_large_unpointed
        return self.is_large_unpointed | (self.is_unpointed & self.in_increments[self.run.row])

    def meant(self, least: Floats | float) -> Floats:
        """Per word: the intended value; least: the length of an increment."""
        value, in_increments = self.run.words.value, self._counts_increments
        values = np.where(in_increments, value * least, value) if in_increments.any() else value
        too_far = (values > _FARTHEST) | (values < -_FARTHEST)
        return np.where(too_far, np.nan, values) if too_far.any() else values

    def angle_of(self, address: str) -> Floats:
        """A word as an angle [deg]."""
        if self._angles is self.run.words.value:
            return self.blocks.word(address)
        return self._column(f"angle {address}", lambda: self.blocks.in_rows(address, self._angles))

    @cached_property
    def _angles(self) -> Floats:
        return self.meant(self.machine.control.least_increment)
