"""Cycles and other codes whose words are arguments: these mean the same on both machines, or somebody decides."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows, column_at, stretch
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.g_meanings import GMeanings
from polarcheck.rewrite.convert.measures import Measures

#: Cycles whose words are the same on all controls that have them.
_PLAIN_CYCLES = ("turning_cycle", "threading_cycle", "facing_cycle", "drilling_cycle")
#: Lists of codes beside which the other words are arguments: all of them are the same on both machines, or none is.
WITH_ARGUMENTS = (
    *_PLAIN_CYCLES,
    "data_input",
    "repetitive_cycle",
    "motion_not_followed",
    "scaling",
    "rotation",
    "mirror_image",
    "frame_shift",
    "frame_shift_added",
    "frame_rotation",
    "frame_rotation_added",
    "frame_not_simulated",
    "cylindrical_interpolation",
    "axis_words_no_move",
    "work_offset_extended",
    "macro_calls",
    "modal_macro_calls",
    "modal_macro_calls_each_block",
)
#: Those of them that stay in force, and thread cutting.
_CYCLES = (*_PLAIN_CYCLES, "motion_not_followed", "thread_cutting")


class CycleWords:
    """The arguments of cycles, data input and macro calls on another machine. has_arguments: a boolean per row."""

    def __init__(self, trace: Trace, target: Machine, measures: Measures, meanings: GMeanings) -> None:
        self.trace, self.source, self.target = trace, trace.machine, target
        self.measures, self._g = measures, meanings
        self._is_repetitive = trace.blocks.listed("repetitive_cycle")
        moves_nothing = trace.blocks.listed("axis_words_no_move")
        is_limit = moves_nothing & ~trace.blocks.has(*self.source.axis_words)
        self.has_arguments = (trace.blocks.listed(*WITH_ARGUMENTS) & ~is_limit) | trace.modal.in_cycle

    def why_not(self, row: int) -> str:
        """Return why the arguments of a row do not mean the same on the other machine; empty where they do."""
        reason = self._why_no_cycle(row) or self._why_other_arguments(row)
        word = int(self._cycle_word[row])
        if reason or word < 0 or not bool(self.trace.modal.in_cycle[row]):
            return reason
        # Without the block that calls it the cycle does not go on.
        return self._why_other_arguments(int(self.trace.run.row[word]))

    def _why_no_cycle(self, row: int) -> str:
        """The code of the cycle in force has no counterpart."""
        word = int(self._cycle_word[row])
        if word < 0 or not bool(self.trace.modal.in_cycle[row]):
            return ""
        meaning = self._g.meaning(self.measures.code_of(word), has_words=True)
        return f"{self.measures.written(word)}: {meaning.reason}" if meaning.reason else ""

    @cached_property
    def _cycle_word(self) -> Rows:
        """Per row: the last word with the code of a cycle; -1 before the first."""
        blocks = self.trace.blocks
        words = blocks.code_indices(*(code for key in _CYCLES for code in self.source.codes(key)))
        word_of_row = column_at(len(self.trace), self.trace.run.row[words], words, -1)
        return fill_down(word_of_row, (word_of_row >= 0) | blocks.starts, -1).astype(np.int64)

    def _why_other_arguments(self, row: int) -> str:
        ours, theirs = self.source, self.target
        if ours.macro.language != theirs.macro.language:
            return "its words are those of another language"
        if self.measures.unit_ratio(row) != 1:
            return "its lengths are in other units there"
        if self.measures.x_ratio(row) != 1 and self.trace.blocks.has("X", "U")[row]:
            return "X counts otherwise there: diameter or radius"
        if not self.measures.pointless_is_same and not self._has_points(row):
            return "nothing says that its words mean the same there"
        if ours.polar.rotary_words != theirs.polar.rotary_words:
            return "the rotary axis has another address there"
        systems = ours.control.g_code_system, theirs.control.g_code_system
        has_steps = self.trace.blocks.has("U", "W", "V", "H")[row] and not self._is_repetitive[row]
        if systems[0] != systems[1] and (has_steps or self.trace.modal.incremental[row]):
            return "U, V, W and H are other words there"
        return ""

    def _has_points(self, row: int) -> bool:
        """A plain cycle whose numbers have points, so that every control reads them alike."""
        is_plain = self.trace.blocks.listed(*_PLAIN_CYCLES)[row] or self.trace.modal.in_cycle[row]
        # R, I and K of a cycle are distances on one control and coordinates on another.
        if not is_plain or self._is_repetitive[row] or self.trace.blocks.has("R", "I", "K")[row]:
            return False
        words = self.trace.run.words
        indices = range(*stretch(self.trace.run.row, row, row + 1))
        arguments = (index for index in indices if chr(int(words.address[index]) % 128) not in "GMSTNO/")
        return all(
            "." in written or not written.strip("ABCDEFHIJKLPQRUVWXYZ0")
            for written in map(self.measures.written, arguments)
        )
