"""The words beside G12.1, where the control takes some: the two axes, the shift of the center, the infeed."""

from __future__ import annotations

import sys

import numpy as np

from polarcheck.columns.path.infeed import CUT, Infeed
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, cached_property, is_among
from polarcheck.foundation.states import Distance
from polarcheck.program.machines.axis_table import INCREMENTS, numbers_of
from polarcheck.program.reading.words import NumberFault

#: The words that name axes, each with the kind of its axis.
_KINDS = {"P": "linear", "Q": "rotary"}


class SwitchWords(Columns, frozen=True):
    """Columns of one trace, over its executed words or its rows, as each says."""

    trace: Trace
    infeed: Infeed

    def _words_at_switch(self, *addresses: str) -> Mask:
        """Per executed word: of one of these addresses, with a good number, beside a G12.1 that begins a section."""
        trace = self.trace
        words = trace.run.words
        named = trace.blocks.words_at(trace.blocks.word_indices(*addresses)) & (words.fault == NumberFault.NONE)
        return np.asarray(named & trace.mode.enters[trace.run.row])

    @property
    def _taken(self) -> list[str]:
        return self.trace.machine.polar.words_beside_switch

    # ---- the axes ----

    @cached_property
    def names_axis(self) -> Mask:
        """Per word: P or Q where both name axes."""
        return self._words_at_switch(*_KINDS) if self.trace.axes.takes_axes else self._words_at_switch()

    @cached_property
    def names_no_axis(self) -> Mask:
        """Per word: P or Q that is not the number of an axis, a whole one from 1 to that of the last axis."""
        if not self.names_axis.any():
            return self.names_axis
        number = self.trace.run.words.value
        is_axis = (number >= 1) & (number <= self.trace.axes.most_axes) & (number == np.rint(number))
        return np.asarray(self.names_axis & ~is_axis)

    @cached_property
    def names_axis_of_other_kind(self) -> Mask:
        """Per word: P that names no linear axis, or Q that names no rotary one, by the names of the axes."""
        words, axes = self.trace.run.words, self.trace.machine.control.axes
        of_other_kind = self.names_axis & ~self.names_no_axis
        index = np.flatnonzero(of_other_kind)
        for address, kind in _KINDS.items():
            of_other_kind[index] &= (words.address[index] != ord(address)) | ~is_among(
                words.value[index], numbers_of(axes, kind)
            )
        return np.asarray(of_other_kind)

    @cached_property
    def names_axis_twice(self) -> Mask:
        """Per word: P and Q of a G12.1 that makes one axis both linear and rotary."""
        other_fault = self.names_no_axis | self.names_axis_of_other_kind
        linear, rotary = self.trace.axes.axes_written
        is_one = (linear == rotary) & ~self.trace.blocks.with_words(other_fault)
        return np.asarray(self.names_axis & is_one[self.trace.run.row])

    # ---- the shift of the center ----

    @property
    def shifts(self) -> dict[str, str]:
        """The addresses of axes that shift the center beside G12.1, each with that of its incremental word."""
        mode = self.trace.machine.polar
        pairs = {**INCREMENTS, mode.virtual_axis: mode.virtual_axis_incremental}
        return {axis: pairs[axis] for axis in self._taken if axis in pairs}

    @cached_property
    def shifts_incrementally(self) -> Mask:
        """Per word: a shift of the center by an incremental word, or by an absolute one while G91 is in force."""
        absolute = self._words_at_switch(*self.shifts)
        if absolute.any():
            is_incremental = self.trace.modal.state("distance") == Distance.INCREMENTAL
            absolute = absolute & is_incremental[self.trace.run.row]
        return np.asarray(self._words_at_switch(*self.shifts.values()) | absolute)

    # ---- the infeed ----

    @property
    def _increments(self) -> Floats:
        return self.infeed.written / self.trace.lengths.least_step

    @property
    def _most_increments(self) -> float:
        # A float holds no number of more digits.
        return 10.0 ** min(self.trace.machine.control.digit_limit, sys.float_info.max_10_exp - 1) - 1

    @cached_property
    def infeed_limit(self) -> Floats:
        """Per row: the largest infeed [mm], as many least increments as have the most digits of a number."""
        return self._most_increments * self.trace.lengths.least_step

    @cached_property
    def infeed_too_large(self) -> Mask:
        """Per row: the infeed beside G12.1 is beyond what its word can hold."""
        return np.asarray(self._increments > self._most_increments + 0.5)

    @cached_property
    def infeed_too_fine(self) -> Mask:
        """Per row: the infeed beside G12.1 has digits below the least increment, which are dropped."""
        finer = self._increments - np.floor(self._increments + CUT)
        return np.asarray(~self.infeed_too_large & (finer > CUT))
