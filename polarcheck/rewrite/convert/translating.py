"""The words of a block outside of the geometry of polar sections, as the other machine writes what they mean."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property

import numpy as np

from polarcheck.checking.settings import Settings
from polarcheck.foundation.states import NO_MOVE, FeedMode
from polarcheck.rewrite.convert.axis_words import AxisWords, Translated
from polarcheck.rewrite.convert.call_words import Calls
from polarcheck.rewrite.convert.code_words import OF_DISTANCE, CodeWords
from polarcheck.rewrite.convert.cycles import WITH_ARGUMENTS, CycleWords
from polarcheck.rewrite.convert.dwells import amount, counts_turns, word_for
from polarcheck.rewrite.convert.measures import Measures
from polarcheck.rewrite.convert.number_text import number_of
from polarcheck.rewrite.convert.of_lathe import OfLathe
from polarcheck.rewrite.convert.speeds import SpeedWords
from polarcheck.rewrite.convert.spindle_roles import SpindleRoles
from polarcheck.rewrite.convert.tool_words import ToolWords
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import refused_at

#: Lists of codes that say what the other words of their block are for.
_OF_ITS_BLOCK = frozenset((*NO_MOVE, *WITH_ARGUMENTS, "thread_cutting"))


class Translation:
    """
    The words of a program as those of another machine.

    notes: what was left out -> the first line from which it was. left_out: all lines from which something was, or whose
    codes are for another spindle than the lists of codes say.
    """

    def __init__(self, original: Original, target: Settings) -> None:
        self.trace, self.target = original.trace, target.machine
        self.source = self.trace.machine
        self.is_same_lathe = self.source == self.target
        self.measures = Measures(self.trace, self.target)
        self.roles = SpindleRoles(self.trace)
        self.tools = ToolWords(self.trace, self.target)
        self._axes = AxisWords(self.trace, self.target, self.measures)
        self.calls = Calls(self.trace, self.target)
        of_program = self.trace, self.target, self.measures, self.roles
        self._codes = CodeWords(*of_program, self.calls, keeps_m6=self.tools.is_same)
        self.notes: dict[str, int] = {}
        self.left_out: set[int] = set()
        #: Lines in which a speed is written that the original does not have there.
        self.added_speeds: set[int] = set()
        self._of_lathe = OfLathe(self.trace, self.target, self.measures)
        self._moves = self.trace.modal.uses_axes & self.trace.blocks.has(*self.source.axis_words)
        self._speeds = SpeedWords(*of_program)
        self._cycles = CycleWords(self.trace, self.target, self.measures, self._codes.g)

    # ---- interface ----

    def words(self, row: int, indices: Sequence[int], in_steps: bool = False) -> Translated:
        """
        These words of a row; in_steps: distances stay distances where the other machine has them by G91 alone.

        Raises RefusedError for words that no line of the other program could stand for.
        """
        result = Translated()
        written = [self.measures.written(index) for index in indices]
        if self.is_same_lathe:
            result.words = written
        elif self._has_dwell(row, indices):
            self._dwell(row, indices, result)
        elif self._references_c_alone(row, indices):
            self._note(row, f"{' '.join(written)} is left out: {self.target.title} needs no reference return of C")
        elif reason := self.why_not(row):
            result.whole = reason
        elif bool(self._cycles.has_arguments[row]) and not self._codes.letters_of_x_switch(row):
            self._with_arguments(row, indices, result)
        else:
            self._one_by_one(row, indices, in_steps, result)
        if not result.whole and not self.is_same_lathe:
            axes = [word for index in indices if (word := self.measures.axis_word(row, index)) is not None]
            result.remarks = self._of_lathe.remarks(row, axes)
        result.changed |= result.words != written or bool(result.behind)
        return result

    def why_not(self, row: int) -> str:
        """Return why no words of a row can stand on the other machine, whatever they are; empty where some can."""
        return self._reasons.get(row, "")

    @cached_property
    def _reasons(self) -> dict[int, str]:
        """The rows of which no words can stand on the other machine -> why; the first reason of each counts."""
        if self.is_same_lathe:
            return {}
        foreign = f"the macro is not in the file: see whether {self.target.title} has it, and convert it, too"
        reasons: dict[int, str] = {}
        for mask, text in (*reversed(self._of_lathe.reasons), (self.calls.calls_foreign_macro, foreign)):
            reasons |= dict.fromkeys(np.flatnonzero(mask).tolist(), text)
        unknown = self.measures.unknown_moves.word
        for row in np.flatnonzero(unknown >= 0).tolist():
            word = self.measures.written(unknown[row])
            reasons[row] = f"{word}: the profile of {self.source.title} does not say what it does"
        return reasons

    # ---- blocks of one meaning ----

    def _has_dwell(self, row: int, indices: Sequence[int]) -> bool:
        is_dwell = bool(self.trace.blocks.listed("dwell")[row])
        return is_dwell and any(self.measures.letter_of(index) == "G" for index in indices)

    def _references_c_alone(self, row: int, indices: Sequence[int]) -> bool:
        """A reference return of the C axis alone, for a machine that has no code for it and does without."""
        needs_reference = self.target.severities.get("c-axis-not-referenced") != "off"
        if needs_reference or not self.trace.blocks.listed("c_axis_reference")[row]:
            return False
        meaning, letter_of = self._codes.g.meaning, self.measures.letter_of
        codes = [meaning(self.measures.code_of(index)) for index in indices if letter_of(index) == "G"]
        axes = [self.measures.axis_word(row, index) for index in indices if letter_of(index) != "G"]
        is_alone = bool(axes) and all(word is not None and word.axis == "C" for word in axes)
        is_unknown = any(code.key == "reference_return" and not code.words for code in codes)
        return is_alone and is_unknown and all(code.key in ("reference_return", *OF_DISTANCE) for code in codes)

    def _dwell(self, row: int, indices: Sequence[int], result: Translated) -> None:
        per_revolution = bool(self.trace.modal.state("feed_mode")[row] == FeedMode.PER_REVOLUTION)
        if (
            "F" in self.target.feed.dwell_words
            and "F" not in self.source.feed.dwell_words
            and self.trace.blocks.has("F")[row]
        ):
            result.whole = "F beside it would be the time of the dwell there: give F a block of its own"
            return
        for index in indices:
            letter = self.measures.letter_of(index)
            if letter not in self.source.feed.dwell_words:
                self._word(row, index, result)
                continue
            number = number_of(self.measures.written(index))
            if number is None:
                result.whole = "the time of the dwell is computed"
                return
            is_turns = counts_turns(self.source, letter, per_revolution)
            counted = amount(self.source, letter, number, self.measures.least_read(row))
            word = word_for(self.target, counted, is_turns, per_revolution, letter)
            if not word:
                kind = "turns of the spindle" if is_turns else "a time"
                result.whole = f"no word of a dwell of {self.target.title} counts {kind} here"
                return
            units = self.source.feed.dwell_words.get(letter), self.target.feed.dwell_words.get(letter)
            is_same = word[0] == letter and units[0] == units[1] and self.measures.pointless_is_same
            if not is_same and Fraction(word[1:]) != Fraction(number):
                self.measures.basis.add("feed.dwell_words", row)
            result.words.append(self.measures.written(index) if is_same else word)

    def _with_arguments(self, row: int, indices: Sequence[int], result: Translated) -> None:
        """A cycle, data input, a macro call: the arguments stay as they are, or the whole block is to be decided."""
        for index in indices:
            if (letter := self.measures.letter_of(index)) and letter in "GMST":
                self._word(row, index, result)
            else:
                result.words.append(self.measures.written(index))
        result.whole = result.whole or self._cycles.why_not(row)

    # ---- words ----

    def _one_by_one(self, row: int, indices: Sequence[int], in_steps: bool, result: Translated) -> None:
        letters = self._codes.letters_of_x_switch(row)
        of_switch = [index for index in indices if self.measures.letter_of(index) in letters]
        indices_of_axes = [index for index in indices if index not in of_switch]
        axes = [word for index in indices_of_axes if (word := self.measures.axis_word(row, index)) is not None]
        lost = [word for word in axes if word.is_step and self._moves[row] and self.measures.is_lost(row, word.axis)]
        if lost:
            step = self.measures.written(lost[0].index)
            result.whole = f"{step} begins where the tool stands behind a block that is to be decided"
        texts = {} if result.whole else self._axes.written(row, axes, in_steps, result)
        if result.whole:
            return
        if result.behind:
            result.words.append(self._codes.g.named(self.target.codes("incremental")[0]))
        for index in indices:
            if index in of_switch:
                result.words += [self.measures.written(index)] if self.measures.same_x_switches else []
            elif index in texts:
                result.words += texts[index]
            else:
                self._word(row, index, result)

    def _word(self, row: int, index: int, result: Translated) -> None:
        """A word by its address."""
        letter, written = self.measures.letter_of(index), self.measures.written(index)
        if letter in ("G", "M"):
            self._code_word(row, index, result)
        elif letter == "T" or (letter == "D" and self.tools.is_called_by_d(row)):
            self._tool(row, index, result)
        elif self._speeds.is_speed[index]:
            word = self._speeds.written(row, index)
            no_word = f"{written}: the profile of {self.target.title} has no word for it"
            (result.words if word else result.decisions).append(word or no_word)
        elif letter == "F":
            self._feed(row, index, result)
        elif (letter and letter in "IJKR") or letter == self.source.arcs.radius_word:
            self._axes.of_arc(row, index, letter, result)
        elif letter == "@" and self.source.control.native_words == self.target.control.native_words:
            # A word of the control's own language, as SETMS(2), on a control of the same language.
            result.words.append(written)
        elif letter == "H" and bool(self.trace.blocks.switches_length_offset[row]):
            # Alone it might turn C there.
            takes = bool(self.target.codes("tool_length_offset"))
            alone = f"{written}: {self.target.title} has no code for a length offset"
            (result.words if takes else result.decisions).append(written if takes else alone)
        elif self._codes.is_beside_m(row, letter):
            result.changed = True
        else:
            named = self.measures.named(index)
            self._undecided(row, f"{named}: nothing says what it is on {self.target.title}", result)

    def _undecided(self, row: int, text: str, result: Translated) -> None:
        """A word without a counterpart goes alone beside a move, or beside codes; elsewhere its block goes with it."""
        if self._moves[row] or all(self.measures.letter_of(index) in "GMST" for index in self.measures.words_of(row)):
            result.decisions.append(text)
        else:
            result.whole = result.whole or text

    def _code_word(self, row: int, index: int, result: Translated) -> None:
        """A G or M code by what it means there."""
        is_g, written = self.measures.letter_of(index) == "G", self.measures.written(index)
        meaning = self._codes.of_g(row, index) if is_g else self._codes.of_m(row, index)
        if not is_g and bool(self.roles.of_live_tool[row]) and meaning.key.startswith("live_tool"):
            self.left_out.add(self.trace.line(row))
        if meaning.words and meaning.key in ("live_tool_on", "spindle_on"):
            self._add_speed(row, meaning.key == "live_tool_on", result)
        result.words += meaning.words
        text = f"{written}: {meaning.reason}"
        if meaning.note:
            self._note(row, f"{written} is left out: {meaning.note}")
            if not is_g and bool(self.trace.tools.calls_tool[row]) and not self.trace.blocks.has("T")[row]:
                self._call_tool(row, result)
        elif meaning.reason and is_g and meaning.key in _OF_ITS_BLOCK:
            result.whole = result.whole or text
        elif meaning.reason and is_g and not meaning.key:
            self._undecided(row, text, result)
        elif meaning.reason:
            result.decisions.append(text)

    def _add_speed(self, row: int, is_live: bool, result: Translated) -> None:
        """Write the speed that is in force where a spindle starts without one."""
        if word := self._speeds.in_force(row, is_live):
            result.words.append(word)
            self.added_speeds.add(self.trace.line(row))

    def _tool(self, row: int, index: int, result: Translated) -> None:
        if self.tools.is_same:
            result.words.append(self.measures.written(index))
            return
        low, *others = sorted(word for word in self.measures.words_of(row) if self.measures.letter_of(word) in "TD")
        calls = bool(self.trace.tools.calls_offset[row])
        if index != low or not calls:
            if self.measures.letter_of(index) == "T" and (index in others or not calls):
                prepares = f"it prepares a tool, and T alone calls one on {self.target.title}"
                self._note(row, f"{self.measures.written(index)} is left out: {prepares}")
            return
        self._call_tool(row, result)

    def _call_tool(self, row: int, result: Translated) -> None:
        call = self.tools.call(row)
        if call.refusal:
            raise refused_at(self.trace, row, call.refusal)
        result.words += call.words
        if call.decision:
            result.decisions.append(call.decision)

    def _feed(self, row: int, index: int, result: Translated) -> None:
        ratio = self.measures.unit_ratio(row, of_feed=True)
        written = self.measures.written(index)
        if ratio == 1 or self.trace.modal.state("feed_mode")[row] == FeedMode.INVERSE_TIME:
            result.words.append(written[:1] + self.measures.with_feed_point(written[1:]))
            return
        text = self.measures.feed(index, ratio)
        if text is None:
            raise refused_at(self.trace, row, "its F is computed, in other units")
        result.words.append(f"F{text}")

    def _note(self, row: int, text: str) -> None:
        line = self.trace.line(row)
        self.notes.setdefault(text, line)
        self.left_out.add(line)
