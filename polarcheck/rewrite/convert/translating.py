"""The words of a block outside of the geometry of polar sections, as the other machine writes what they mean."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from polarcheck.checking.settings import Settings
from polarcheck.foundation.arrays import stretch
from polarcheck.foundation.states import NO_MOVE, FeedMode
from polarcheck.program.machines.code_lists import numbers
from polarcheck.program.machines.code_tables import code_numbers
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.axis_words import AxisWords, Translated
from polarcheck.rewrite.convert.call_words import Calls
from polarcheck.rewrite.convert.cycles import WITH_ARGUMENTS, CycleWords
from polarcheck.rewrite.convert.g_meanings import GMeanings, Meaning
from polarcheck.rewrite.convert.m_meanings import MMeanings
from polarcheck.rewrite.convert.measures import Measures
from polarcheck.rewrite.convert.number_text import number_of, rounded
from polarcheck.rewrite.convert.of_lathe import OfLathe
from polarcheck.rewrite.convert.speeds import SpeedWords
from polarcheck.rewrite.convert.spindle_roles import SpindleRoles
from polarcheck.rewrite.convert.tool_words import ToolWords
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import refused_at

#: The part of a second that a word counts; one with a point may count another.
_SECONDS = {"seconds": Fraction(1), "hundredths": Fraction(1, 100), "thousandths": Fraction(1, 1000)}
_THOUSANDTH = Fraction(1, 1000)


def counts_turns(machine: Machine, address: str, per_revolution: bool) -> bool:
    """The word of a dwell counts turns of the spindle."""
    by_mode = per_revolution and machine.feed.dwell_per_revolution == "turns"
    return machine.feed.dwell_words[address] == "turns" or by_mode


def amount(machine: Machine, address: str, number: str, least: Fraction) -> Fraction:
    """What the number of a dwell counts [s, or turns]. least: the least increment of lengths, in which X may count."""
    unit, value = machine.feed.dwell_words[address], Fraction(number)
    if unit == "as-lengths":
        in_increments = "." not in number and machine.control.number_without_point == "least-increment"
        return value * least if in_increments else value
    if unit == "thousandths-or-seconds":
        return value if "." in number else value * _THOUSANDTH
    return value * _SECONDS.get(unit, Fraction(1))


def word_for(machine: Machine, dwell: Fraction, is_turns: bool, per_revolution: bool, preferred: str) -> str:
    """
    The word of a dwell on a machine; empty where it has none for it.

    dwell: [s, or turns]. preferred: the address that the original has.
    """
    words = [word for word in machine.feed.dwell_words if counts_turns(machine, word, per_revolution) == is_turns]
    if not words:
        return ""
    address = preferred if preferred in words else words[0]
    unit = machine.feed.dwell_words[address]
    if unit in ("thousandths", "thousandths-or-seconds"):
        return f"{address}{round(dwell / _THOUSANDTH)}"
    if unit == "hundredths":
        return f"{address}{round(dwell * 100)}"
    return address + rounded(dwell, _THOUSANDTH)


#: Lists of codes that say what the other words of their block are for.
_OF_ITS_BLOCK = frozenset((*NO_MOVE, *WITH_ARGUMENTS, "thread_cutting"))
_OF_UNITS = ("inch", "mm")
_OF_DISTANCE = ("absolute", "incremental")


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
        self._g = GMeanings(self.source, self.target)
        self._m = MMeanings(self.trace, self.target, self.roles.of_live_tool)
        self._axes = AxisWords(self.trace, self.target, self.measures)
        self.calls = Calls(self.trace, self.target)
        self.notes: dict[str, int] = {}
        self.left_out: set[int] = set()
        #: Lines in which a speed is written that the original does not have there.
        self.added_speeds: set[int] = set()
        control = self.source.control
        switches = (*control.x_radius_words, *control.x_diameter_words, *control.x_absolute_diameter_words)
        self._x_switches = {number for word in switches for number in numbers([word.partition(" ")[0]])}
        #: The letters of words that stand beside such a code and move nothing: X of G10.9 X1.
        self._x_switch_letters = {word.partition(" ")[2][:1] for word in switches} - {""}
        self._tool_changes = set(numbers(self.source.m_codes.tool_change))
        self._in_mode = set(numbers(self.target.polar.allowed_codes))
        self._polar_off = set(numbers([*self.source.polar.off, *self.source.polar.ended_by]))
        self._of_lathe = OfLathe(self.trace, self.target, self.measures)
        self._unknown_moves = self.measures.unknown_moves
        self._moves = self.trace.modal.uses_axes & self.trace.blocks.has(*self.source.axis_words)
        self._speeds = SpeedWords(self.trace, self.target, self.measures, self.roles)
        self._cycles = CycleWords(self.trace, self.target, self.measures, self._g)

    # ---- interface ----

    def words_of(self, row: int) -> list[int]:
        """The executed words of a row without N, O and block skip, in the order in which they are written."""
        low, high = stretch(self.trace.run.row, row, row + 1)
        words = self.trace.run.words
        written = zip(words.start[low:high].tolist(), range(low, high), words.address[low:high].tolist(), strict=True)
        return [index for _, index, address in sorted(written) if address not in b"NO/"]

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
        elif bool(self._cycles.has_arguments[row]) and not self._beside_x_switch(row):
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
        index = int(self._unknown_moves.word[row])
        if self.is_same_lathe:
            return ""
        if index < 0 and self.calls.calls_foreign_macro(row):
            return f"the macro is not in the file: see whether {self.target.title} has it, and convert it, too"
        if index < 0:
            return self._of_lathe.why_not(row)
        return f"{self.measures.written(index)}: the profile of {self.source.title} does not say what it does"

    # ---- blocks of one meaning ----

    def _has_dwell(self, row: int, indices: Sequence[int]) -> bool:
        return bool(self.trace.blocks.listed("dwell")[row]) and any(self._letter(index) == "G" for index in indices)

    def _references_c_alone(self, row: int, indices: Sequence[int]) -> bool:
        """A reference return of the C axis alone, for a machine that has no code for it and does without."""
        if not self.trace.blocks.listed("c_axis_reference")[row] or not self._needs_no_reference:
            return False
        axis_indices = [index for index in indices if self._letter(index) != "G"]
        codes = [self._code(index) for index in indices if self._letter(index) == "G"]
        keys = [self._g.key(number) for number in codes]
        axes = [self.measures.axis_word(row, index) for index in axis_indices]
        is_alone = bool(axes) and all(word is not None and word.axis == "C" for word in axes)
        unknown = [not self._g.meaning(number).words for number in codes if self._g.key(number) == "reference_return"]
        return is_alone and any(unknown) and all(key in ("reference_return", *_OF_DISTANCE) for key in keys)

    @property
    def _needs_no_reference(self) -> bool:
        return self.target.severities.get("c-axis-not-referenced") == "off"

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
            letter = self._letter(index)
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
            if (letter := self._letter(index)) and letter in "GMST":
                self._word(row, index, result)
            else:
                result.words.append(self.measures.written(index))
        result.whole = result.whole or self._cycles.why_not(row)

    # ---- words ----

    def _one_by_one(self, row: int, indices: Sequence[int], in_steps: bool, result: Translated) -> None:
        letters = self._x_switch_letters if self._beside_x_switch(row) else set[str]()
        of_switch = [index for index in indices if self._letter(index) in letters]
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
            result.words.append(self._g.named(self.target.codes("incremental")[0]))
        for index in indices:
            if index in of_switch:
                result.words += [self.measures.written(index)] if self.measures.same_x_switches else []
            elif index in texts:
                result.words += texts[index]
            else:
                self._word(row, index, result)

    def _word(self, row: int, index: int, result: Translated) -> None:
        """A word by its address."""
        letter, written = self._letter(index), self.measures.written(index)
        if letter == "G":
            self._g_word(row, index, result)
        elif letter == "M":
            self._m_word(row, index, result)
        elif letter == "T" or (letter == "D" and bool(self.trace.tools.has_edges[row])):
            self._tool(row, index, result)
        elif self._speeds.is_speed(index):
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
            result.words.append(written)
        elif self._beside_m_code(row, letter):
            result.changed = True
        else:
            self._undecided(row, f"{written}: nothing says what it is on {self.target.title}", result)

    def _undecided(self, row: int, text: str, result: Translated) -> None:
        """A word without a counterpart goes alone beside a move, or beside codes; elsewhere its block goes with it."""
        if self._moves[row] or all(self._letter(index) in "GMST" for index in self.words_of(row)):
            result.decisions.append(text)
        else:
            result.whole = result.whole or text

    def _g_word(self, row: int, index: int, result: Translated) -> None:
        number, written = self._code(index), self.measures.written(index)
        has_words = any(self._letter(word) not in "GMTF" for word in self.words_of(row))
        key = self._g.key(number, has_words)
        if number in self._x_switches:
            if self.measures.same_x_switches:
                result.words.append(written)
            else:
                self._note(row, f"{written} is left out: X is written as {self.target.title} counts it")
            return
        if number in self._polar_off and not key.startswith("plane"):
            result.words += self.target.writing.end.split()
            return
        if key in _OF_DISTANCE:
            self._distance(key, result)
            return
        if key in _OF_UNITS:
            self._units(row, key, written, result)
            return
        meaning = self._g.meaning(number, has_words)
        if not key and self.trace.mode.whole_section[row] >= 0 and number not in self._in_mode:
            meaning = Meaning(reason=meaning.reason or f"it may not stand in the polar mode of {self.target.title}")
        if meaning.words:
            same = [written] if self._is_spelling(index, meaning.words) else self._styled(written, meaning.words)
            result.words += same
        elif meaning.note:
            self._note(row, f"{written} is left out: {meaning.note}")
        elif key in _OF_ITS_BLOCK:
            result.whole = result.whole or f"{written}: {meaning.reason}"
        elif not key:
            self._undecided(row, f"{written}: {meaning.reason}", result)
        else:
            result.decisions.append(f"{written}: {meaning.reason}")

    def _distance(self, key: str, result: Translated) -> None:
        """G90 and G91: what the program writes outside is absolute, but for blocks with their own G91."""
        if key == "absolute" and self.target.control.g_code_system != "A" and self.target.codes("absolute"):
            result.words.append(self._g.named(self.target.codes("absolute")[0]))

    def _units(self, row: int, key: str, written: str, result: Translated) -> None:
        is_inch = self.measures.writes_inch(row)
        codes = self.target.codes("inch" if is_inch else "mm")
        if not codes:
            unit = "inch" if is_inch else "mm"
            self._note(row, f"{written} is left out: {self.target.title} has no code for it, and counts in {unit}")
            return
        alone = bool(self.trace.lengths.feed_units[row] != self.trace.lengths.units[row])
        of_lengths_alone = self.target.control.units_of_lengths_alone
        ours = self.source.control.units_of_lengths_alone
        if written.upper() in codes and (written.upper() in ours) == (written.upper() in of_lengths_alone):
            result.words.append(written)
            return
        chosen = [code for code in codes if (code in of_lengths_alone) == alone] or codes
        result.words.append(written if written.upper() in chosen else chosen[0])

    def _m_word(self, row: int, index: int, result: Translated) -> None:
        number, written = self._code(index), self.measures.written(index)
        if self.calls.is_flow(row):
            result.words.append(written)
            return
        if number in self._tool_changes and not self.tools.is_same:
            self._note(row, f"{written} is left out: T alone calls the tool on {self.target.title}")
            return
        meaning = self._m.meaning(row, number)
        if bool(self.roles.of_live_tool[row]) and meaning.key.startswith("live_tool"):
            self.left_out.add(int(self.trace.blocks.line_in_file[row]))
        if meaning.words:
            if meaning.key in ("live_tool_on", "spindle_on"):
                self._add_speed(row, meaning.key == "live_tool_on", result)
            same = self._is_spelling(index, meaning.words)
            result.words += [written] if same else self._styled(written, meaning.words)
        else:
            result.decisions.append(f"{written}: {meaning.reason}")

    def _add_speed(self, row: int, is_live: bool, result: Translated) -> None:
        """Write the speed that is in force where a spindle starts without one."""
        if word := self._speeds.in_force(row, is_live):
            result.words.append(word)
            self.added_speeds.add(int(self.trace.blocks.line_in_file[row]))

    def _tool(self, row: int, index: int, result: Translated) -> None:
        if self.tools.is_same:
            result.words.append(self.measures.written(index))
            return
        low = min(word for word in self.words_of(row) if self._letter(word) in "TD")
        if index != low or not bool(self.trace.tools.calls_offset[row]):
            return
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

    # ---- helpers ----

    def _letter(self, index: int) -> str:
        number = int(self.trace.run.words.address[index])
        return chr(number) if number < 128 else ""

    def _code(self, index: int) -> int:
        return int(code_numbers(self.trace.run.words.value[index : index + 1])[0])

    def _beside_m_code(self, row: int, letter: str) -> bool:
        """The other word of a code such as M3 P12, which goes with that code."""
        codes = (index for index in self.words_of(row) if self._letter(index) == "M")
        arguments = (self._m.word_beside(row, self._code(index)) for index in codes)
        return any(word[:1] == letter for word in arguments)

    def _beside_x_switch(self, row: int) -> bool:
        codes = (index for index in self.words_of(row) if self._letter(index) == "G")
        return any(self._code(index) in self._x_switches for index in codes)

    def _is_spelling(self, index: int, words: Sequence[str]) -> bool:
        """What is written for a code is the code itself, be it G01 for G1, or G18 for G18 ZC on the same control."""
        written = self.measures.written(index)
        native = self.target.control.native_words
        if native == self.source.control.native_words and native.get(" ".join(words)) == written.upper():
            return True
        if len(words) != 1 or words[0][0] not in "GM":
            return False
        is_plain = written[:1].upper() == words[0][0] and written[1:].replace(".", "", 1).isdigit()
        return is_plain and words[0][1:].replace(".", "", 1).isdigit() and float(written[1:]) == float(words[0][1:])

    def _styled(self, written: str, words: Sequence[str]) -> list[str]:
        """Codes with two digits where that in their place has a leading zero: G98 for G94, G01 for G1."""
        if written[1:2] != "0" or len(written) < 3:
            return list(words)
        return [
            f"{word[0]}0{word[1]}" if len(word) == 2 and word[1].isdigit() and word[0] in "GM" else word
            for word in words
        ]

    def _note(self, row: int, text: str) -> None:
        line = int(self.trace.blocks.line_in_file[row])
        self.notes.setdefault(text, line)
        self.left_out.add(line)
