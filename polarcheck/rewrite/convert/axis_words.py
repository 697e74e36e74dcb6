"""Words of axes and of arcs outside of polar sections, as the other machine writes the same places and distances."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import NO_MOVE, Motion
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.measures import AxisWord, Measures
from polarcheck.rewrite.writing.outcome import refused_at

_ARCS = (Motion.CW, Motion.CCW)


class Translated(msgspec.Struct):
    """
    The words of a row on the other machine.

    words: in order.
    behind: of a block that follows it, as G90 behind a block of distances.
    decisions: what is to be decided of single words, which do not stand among them.
    remarks: what is to be decided though its words stay.
    changed: some word is another one.
    whole: why the whole block is to be decided; or empty.
    """

    words: list[str] = []
    behind: list[str] = []
    decisions: list[str] = []
    remarks: list[str] = []
    changed: bool = False
    whole: str = ""

    @property
    def comment(self) -> str:
        """What the new block says of what is to be decided; empty where nothing is."""
        return ". ".join((*self.decisions, *self.remarks))


class AxisWords:
    """The axis words of a program as those of another machine."""

    def __init__(self, trace: Trace, target: Machine, measures: Measures) -> None:
        self.trace, self.target, self.measures = trace, target, measures
        self._has_letters = target.control.g_code_system == "A"
        self._no_move = trace.blocks.listed(*NO_MOVE)

    def written(self, row: int, axes: Sequence[AxisWord], in_steps: bool, result: Translated) -> dict[int, list[str]]:
        """
        The words by the index of that in whose place they stand.

        Distances are U, V, W and H, or coordinates where the place is known, or stand in a block with G91; then
        `result.behind` has G90. Where none of that can be, `result.whole` says why.
        """
        steps = [word for word in axes if word.is_step]
        texts: dict[int, list[str]] = {}
        places: dict[int, str] = {}
        if steps and not (self._has_letters and all(self.measures.letter(word.axis, True) for word in steps)):
            in_block = len(steps) == len(axes) and bool(self.target.codes("incremental"))
            if not (in_block and (in_steps or bool(self._no_move[row]))):
                destinations = {} if self._no_move[row] else self._places(row, steps)
                places = destinations or {}
            if not places:
                if not in_block:
                    result.whole = "distances and coordinates stand in one block, and where it begins is not known"
                    return {}
                result.behind = [self.target.codes("absolute")[0]]
        for word in axes:
            is_step = word.is_step and word.index not in places
            number = places.get(word.index) or self.measures.number(
                row, word.index, self.measures.ratio(row, word), word.axis == "C"
            )
            if number is None:
                texts[word.index] = [self._computed(row, word)]
                continue
            letter = self.measures.letter(word.axis, is_step and self._has_letters)
            texts[word.index] = [f"{letter}{'=' * (len(letter) > 1)}{number}"]
        return texts

    def _places(self, row: int, steps: Sequence[AxisWord]) -> dict[int, str] | None:
        places = {word.index: self.measures.place(row, word.axis) for word in steps}
        return None if None in places.values() else {index: text for index, text in places.items() if text}

    def _computed(self, row: int, word: AxisWord) -> str:
        """A computed word stays as it is, where no value has to change."""
        written = self.measures.written(word.index)
        languages = self.trace.machine.macro.language, self.target.macro.language
        is_same_letter = written[:1].upper() == self.measures.letter(word.axis, word.is_step and self._has_letters)
        if self.measures.ratio(row, word) == 1 and languages[0] == languages[1] and is_same_letter:
            return written
        raise refused_at(self.trace, row, f"{written} is computed, and has to be another number there")

    def of_arc(self, row: int, index: int, letter: str, result: Translated) -> None:
        """I, J, K and R of an arc; anything else that they say, as a corner, is a thing to decide."""
        trace, written = self.trace, self.measures.written(index)
        says = trace.run.distance is not None and bool(trace.run.distance[index])
        is_arc = int(trace.modal.state("motion")[row]) in _ARCS and not self._no_move[row]
        number = self.measures.number(row, index, self.measures.unit_ratio(row)) if is_arc and not says else None
        if number is None:
            result.whole = f"{written} has no counterpart there"
            return
        is_radius = letter == trace.machine.arcs.radius_word
        word = self.target.writing.arc_radius if is_radius else letter
        result.words.append(f"{word}{number}")
