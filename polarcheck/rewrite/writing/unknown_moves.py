"""Where nobody knows to what axis words lead: beside codes of a builder, which may be macros with arguments."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import before, happened
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows, mask_at
from polarcheck.foundation.states import MOVES, Distance
from polarcheck.program.machines.code_lists import expanded, is_code
from polarcheck.program.machines.m_codes import OF_EVERY_LATHE, MCodes
from polarcheck.program.machines.machine import Machine


class UnknownMoves:
    """
    The blocks of a program that move the tool to where its control alone knows, or its builder.

    word: int[n], per row the executed word of the code that is not known; -1 for a row without one. Beside a G code
    without a meaning in the profile, and without G0 to G3, axis words may be arguments of a macro; so may those behind
    an M code without a meaning in a block without a G code.
    is_skip: bool[n], the row has axis words that are no end of a move by a list of the profile, as those of G31.
    """

    def __init__(self, trace: Trace) -> None:
        self.trace = trace
        blocks, count = trace.blocks, len(trace)
        machine = trace.machine
        self._has_axes = blocks.has(*machine.axis_words)
        g_words, m_words = (self._unlisted(letter) for letter in "GM")
        is_special = ~trace.modal.uses_axes | blocks.codes(*machine.control.motion_codes)
        # Beside a code of motion the axis words of a block are its end.
        is_special |= blocks.listed(*MOVES.values())
        self.word = np.full(count, -1, np.int64)
        rows = trace.run.row
        m_words = m_words[trace.run.words.start[m_words] < self._first_axis(count)[rows[m_words]]]
        m_words = m_words[~blocks.has("G")[rows[m_words]]]
        for words in (m_words, g_words):
            words = words[(self._has_axes & ~is_special)[rows[words]]]
            self.word[rows[words]] = words
        control = machine.control
        # X beside G10.9 says what X words count, and moves nothing.
        switches = (word.partition(" ")[0] for word in (*control.x_radius_words, *control.x_diameter_words))
        self.is_skip = self._has_axes & blocks.listed("axis_words_no_move") & ~blocks.codes(*switches)
        enters = np.append(np.diff(trace.run.depth) > 0, False)[:count]
        self._is_call = blocks.codes(*machine.macro.call_codes) & ~enters

    def _unlisted(self, letter: str) -> Rows:
        """The executed G or M words that no list of the profile has."""
        blocks = self.trace.blocks
        words = blocks.g_words if letter == "G" else blocks.m_words
        listed = [code for code in listed_codes(self.trace.machine) if code.startswith(letter)]
        known = mask_at(len(self.trace.run.words), blocks.code_indices(*listed))
        return words[~known[words]]

    def _first_axis(self, count: int) -> Rows:
        """Per row the character where its first axis word begins."""
        words, machine = self.trace.run.words, self.trace.machine
        is_axis = np.isin(words.address, [machine.address_number(axis) for axis in machine.axis_words])
        first = np.full(count, np.iinfo(np.int64).max)
        np.minimum.at(first, self.trace.run.row[is_axis], words.start[is_axis])
        return first

    def lost(self, axis: str) -> Mask:
        """Rows before which nobody knows where an axis stands: behind such a block, up to a coordinate of the axis."""
        trace = self.trace
        loses = (self.word >= 0) | self.is_skip | self._is_call
        distance = trace.blocks.distance(axis)
        is_step = trace.modal.incremental if distance is None else distance == Distance.INCREMENTAL
        finds = trace.blocks.has(axis) & ~is_step & trace.modal.uses_axes & ~loses
        return before(happened(loses, finds | trace.blocks.starts), trace.blocks.starts, False)


def listed_codes(machine: Machine) -> list[str]:
    """Return all G and M codes to which the profile of a machine gives a meaning; `M3 P12` with the word beside it."""
    polar, macro, control = machine.polar, machine.macro, machine.control
    m_codes = (code for key in MCodes.__struct_fields__ for code in getattr(machine.m_codes, key))
    words = (
        *machine.listed_codes, *m_codes, *OF_EVERY_LATHE, *polar.on, *polar.off, *polar.ended_by, *polar.allowed_codes,
        *macro.flow_codes, *macro.subprogram_calls, *control.motion_codes, *control.native_words.values(),
        *control.x_radius_words, *control.x_diameter_words, *control.x_absolute_diameter_words,
        *machine.writing.corner_codes,
    )  # fmt: skip
    return expanded(word for word in words if is_code(word.partition(" ")[0], "GM"))
