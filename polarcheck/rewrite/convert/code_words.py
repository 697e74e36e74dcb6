"""The G and M codes of a program as those of another machine: what each means there, in the words of the program."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from polarcheck.columns.trace import Trace
from polarcheck.program.machines.code_lists import numbers
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.call_words import Calls
from polarcheck.rewrite.convert.g_meanings import GMeanings, Meaning
from polarcheck.rewrite.convert.m_meanings import MMeanings
from polarcheck.rewrite.convert.measures import Measures
from polarcheck.rewrite.convert.spindle_roles import SpindleRoles

_OF_UNITS = ("inch", "mm")
OF_DISTANCE = ("absolute", "incremental")


class CodeWords:
    """
    The codes of a program as those of another machine.

    g: meanings of G codes. keeps_m6: codes of a tool change stay, since T words do.
    """

    def __init__(
        self, trace: Trace, target: Machine, measures: Measures, roles: SpindleRoles, calls: Calls, *, keeps_m6: bool
    ) -> None:
        self.trace, self.source, self.target = trace, trace.machine, target
        self.measures, self._calls = measures, calls
        self.g = GMeanings(self.source, target)
        self._m = MMeanings(trace, target, roles.of_live_tool)
        control = self.source.control
        switches = (*control.x_radius_words, *control.x_diameter_words, *control.x_absolute_diameter_words)
        self._x_switches = {number for word in switches for number in numbers([word.partition(" ")[0]])}
        #: The letters of words that stand beside such a code and move nothing: X of G10.9 X1.
        self._x_switch_letters = {word.partition(" ")[2][:1] for word in switches} - {""}
        self._left_out = set[int]() if keeps_m6 else set(numbers(self.source.m_codes.tool_change))
        self._in_mode = set(numbers(target.polar.allowed_codes))
        self._polar_off = set(numbers([*self.source.polar.off, *self.source.polar.ended_by]))

    def of_g(self, row: int, index: int) -> Meaning:
        """What a G code of a row is there; without anything where the moves or the words say it themselves."""
        number, written = self.measures.code_of(index), self.measures.written(index)
        has_words = any(self.measures.letter_of(word) not in "GMTF" for word in self.measures.words_of(row))
        key = self.g.key(number, has_words)
        if number in self._x_switches:
            if self.measures.same_x_switches:
                return Meaning((written,))
            return Meaning(note=f"X is written as {self.target.title} counts it")
        if number in self._polar_off and not key.startswith("plane"):
            return Meaning(tuple(self.target.writing.end.split()))
        if key in OF_DISTANCE:
            return self._distance(key)
        if key in _OF_UNITS:
            return self._units(row, written)
        meaning = self.g.meaning(number, has_words)
        if not key and self.trace.mode.whole_section[row] >= 0 and number not in self._in_mode:
            return Meaning(reason=meaning.reason or f"it may not stand in the polar mode of {self.target.title}")
        return self._as_written(index, meaning)

    def of_m(self, row: int, index: int) -> Meaning:
        """What an M code of a row is there."""
        number = self.measures.code_of(index)
        if self._calls.is_flow[row]:
            return Meaning((self.measures.written(index),))
        if number in self._left_out:
            return Meaning(note=f"T alone calls the tool on {self.target.title}")
        return self._as_written(index, self._m.meaning(row, number))

    def is_beside_m(self, row: int, letter: str) -> bool:
        """The other word of a code such as M3 P12, which goes with that code."""
        codes = (index for index in self.measures.words_of(row) if self.measures.letter_of(index) == "M")
        arguments = (self._m.word_beside(row, self.measures.code_of(index)) for index in codes)
        return any(word[:1] == letter for word in arguments)

    def letters_of_x_switch(self, row: int) -> set[str]:
        """The letters of words that a code in the row takes for what X counts; empty without such a code."""
        codes = (index for index in self.measures.words_of(row) if self.measures.letter_of(index) == "G")
        has_switch = any(self.measures.code_of(index) in self._x_switches for index in codes)
        return self._x_switch_letters if has_switch else set()

    def _distance(self, key: str) -> Meaning:
        """G90 and G91: what the program writes outside is absolute, but for blocks with their own G91."""
        codes = self.target.codes("absolute")
        is_written = key == "absolute" and self.target.control.g_code_system != "A" and codes
        return Meaning((self.g.named(codes[0]),)) if is_written else Meaning()

    def _units(self, row: int, written: str) -> Meaning:
        unit = "inch" if self.measures.writes_inch(row) else "mm"
        codes = self.target.codes(unit)
        if not codes:
            return Meaning(note=f"{self.target.title} has no code for it, and counts in {unit}")
        alone = bool(self.trace.lengths.feed_units[row] != self.trace.lengths.units[row])
        ours, theirs = (machine.control.units_of_lengths_alone for machine in (self.source, self.target))
        if written.upper() in codes and (written.upper() in ours) == (written.upper() in theirs):
            return Meaning((written,))
        chosen = [code for code in codes if (code in theirs) == alone] or codes
        return Meaning((written if written.upper() in chosen else chosen[0],))

    def _as_written(self, index: int, meaning: Meaning) -> Meaning:
        """The meaning of a code in the words of the program: the code as it stands where it is the same one."""
        written = self.measures.written(index)
        words = (written,) if self._is_spelling(written, meaning.words) else _styled(written, meaning.words)
        return msgspec.structs.replace(meaning, words=words) if meaning.words else meaning

    def _is_spelling(self, written: str, words: Sequence[str]) -> bool:
        """What is written for a code is the code itself, be it G01 for G1, or G18 for G18 ZC on the same control."""
        native = self.target.control.native_words
        if native == self.source.control.native_words and native.get(" ".join(words)) == written.upper():
            return True
        if len(words) != 1 or words[0][0] not in "GM":
            return False
        is_plain = written[:1].upper() == words[0][0] and written[1:].replace(".", "", 1).isdigit()
        return is_plain and words[0][1:].replace(".", "", 1).isdigit() and float(written[1:]) == float(words[0][1:])


def _styled(written: str, words: Sequence[str]) -> tuple[str, ...]:
    """Codes with two digits where that in their place has a leading zero: G98 for G94, G01 for G1."""
    if written[1:2] != "0" or len(written) < 3:
        return tuple(words)
    return tuple(
        f"{word[0]}0{word[1]}" if len(word) == 2 and word[1].isdigit() and word[0] in "GM" else word for word in words
    )
