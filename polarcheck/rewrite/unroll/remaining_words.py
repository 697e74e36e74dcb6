"""The words of a section that stay without the mode: M codes, dwells, and all else that does not move the tool."""

from __future__ import annotations

import math

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.foundation.states import MOVES, NO_MOVE, STATES
from polarcheck.rewrite.writing.outcome import refused_at
from polarcheck.rules.editing import is_plain, words_behind_head, written_word

_GROUPS = ("plane", "side", "corner", "feed_mode", "feed_axes", "arc_feed", "distance")
#: Lists of G codes to drop: they mean nothing without the mode, or the new blocks write their own.
_DROPPED = (
    *MOVES.values(),
    *(key for group in _GROUPS for key in STATES[group]),
    *("frame_shift", "frame_shift_added", "frame_rotation", "frame_rotation_added"),
)
#: Why a block with a word that a statement computes is refused.
_COMPUTED = "a word that cannot be written without the statement around it: write it as a number first"


class RemainingWords:
    """The words of sections that are written again: all but those of moves, of compensation and of the mode."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace
        machine, polar = trace.machine, trace.machine.polar
        codes = [code for key in _DROPPED for code in machine.codes(key)]
        of_codes = trace.blocks.words_at(trace.blocks.code_indices(*codes, *polar.on, *polar.off))
        centers = [word for pair in polar.center_words.values() for word in pair]
        addresses = {*polar.axis_addresses, "X", "U", "Z", "W", *centers, machine.arcs.radius_word, "F"}
        addresses |= {machine.arcs.larger_arc_word, machine.offsets.allowance_word, *machine.arcs.made_corners}
        numbers = [machine.address_number(address) for address in addresses if address]
        self._is_dropped = of_codes | np.isin(trace.run.words.address, numbers)
        self._switches = trace.mode.enters | trace.mode.leaves
        # R of G10 P3 R4. is no radius: the words beside such a code are no end of a move.
        self._untouched = trace.blocks.listed(*NO_MOVE) & ~trace.blocks.codes(*trace.machine.macro.flow_codes)
        self._beside_offset = trace.blocks.listed("compensation_left", "compensation_right")
        macro = machine.macro
        calls = [*macro.subprogram_calls, *macro.macro_calls, *macro.program_returns]
        indices = trace.blocks.code_indices(*calls)
        self._of_call = trace.blocks.words_at(indices)
        # A return to the beginning of the same program keeps the depth: its code marks it.
        depth = trace.run.depth
        self._hands_over = np.append(depth[1:] != depth[:-1], False)[: len(trace)]
        self._hands_over[trace.run.row[indices]] = True

    def is_changed(self, row: int) -> bool:
        """True if some word of the row does not stay."""
        if self._hands_over[row]:
            return True
        if self._untouched[row]:
            return False
        return bool(self._is_dropped[slice(*stretch(self.trace.run.row, row, row + 1))].any())

    def of_row(self, row: int) -> list[str]:
        """
        The words of a row that stay, as written.

        Raises RefusedError for a word, other than a code, whose value a statement computes.
        """
        run = self.trace.run
        plain, hands_over = is_plain(run, row), self._hands_over[row]
        words = words_behind_head(run, row)
        if self._untouched[row]:
            if words and not plain:
                raise refused_at(self.trace, row, f"{written_word(run, words[0])}: {_COMPUTED}")
            return [written_word(run, index) for index in words]
        texts = []
        for index in words:
            letter = chr(int(run.words.address[index]))
            if self._is_dropped[index] or (letter == "D" and self._beside_offset[row]):
                continue
            # Words beside a switch of the mode, or of a call, mean nothing without it; codes, S and T stay.
            if (self._switches[row] or hands_over) and (letter not in "GMST" or self._of_call[index]):
                continue
            texts.append(written_word(run, index) if plain else self._computed(row, index))
        return texts

    def _computed(self, row: int, index: int) -> str:
        """The text of a code whose value a statement computes. Raises RefusedError for other words."""
        words = self.trace.run.words
        letter, value = chr(int(words.address[index])), float(words.value[index])
        if letter not in "GMST" or not math.isfinite(value):
            raise refused_at(self.trace, row, f"{written_word(self.trace.run, index)}: {_COMPUTED}")
        return f"{letter}{value:.15g}"
