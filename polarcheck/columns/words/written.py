"""Faults of words and characters that show in the text of a file, before it is executed."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import (
    Mask,
    Rows,
    cached_property,
    column_at,
    first_in_run,
    is_among,
    mask_at,
    repeated,
    side_by_side,
)
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.execution.programs import block_text, find_programs
from polarcheck.program.machines.code_lists import is_code
from polarcheck.program.machines.code_tables import NO_CODE, code_numbers, code_set, modal_tables
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.source import OTHER
from polarcheck.program.reading.surroundings import BLANKS
from polarcheck.program.reading.words import NumberFault, Text

#: A bit for each address that should stand once in a block: A to Z, and a to z behind a comma, are 58 neighbours.
_ADDRESS_BITS = np.zeros(256, np.uint64)
_ADDRESS_BITS[65:123] = np.uint64(1) << np.arange(58, dtype=np.uint64)
_ADDRESS_BITS[list(b"GMN")] = 0
#: In macro calls, argument specification II.
_ARGUMENT_SETS = b"IJK"
#: Tools in the block of a tool change: the one it changes to, and the next one.
_TOOLS_OF_CHANGE = 2
#: A fault that occurs more often than this is a habit of a post or an author, and is reported once.
_HABIT = 5
#: Groups whose codes have other meanings on lathes with two turrets, or take arguments.
_UNSURE_GROUPS = ("scaling", "rotation", "mirror")
#: Cycles whose codes in system A other systems and mills write beside G0 and G1, in another meaning.
_OF_OTHER_SYSTEMS = ("turning_cycle", "threading_cycle", "facing_cycle")
#: The two languages of a Siemens control.
_LANGUAGES = lazy_pattern(r"(?<![A-Z0-9])G29[01](?![0-9.])", re.IGNORECASE)
_PARAMETER = lazy_pattern(r"[A-Z]\s?[-+]?[.\d]", re.IGNORECASE)
_COMMENT = lazy_pattern(rb"\([^)\n]*+\)?")
_LETTER_OR_DIGIT = lazy_pattern(rb"[0-9A-Za-z\x80-\xff]")
#: RTS returns in user tasks.
_JUMP = r"GOTO|GO\s*\d|(?<![A-Z0-9])RTS(?![A-Z0-9])"


class Written:
    """Columns over the words, characters and comments of a text."""

    def __init__(self, text: Text, machine: Machine) -> None:
        self.text = text
        self.words = text.words
        self.machine = machine

    @property
    def contents(self) -> Rows:
        """One element, the file: how many words and blocks of macro it has."""
        return np.array([len(self.words) + np.count_nonzero(self.text.blocks.is_macro)])

    def _habits(self, index: Rows, *kinds: NDArray[Any], block: Rows | None = None, often: int = _HABIT) -> Rows:
        """
        Per element: the number of blocks that a reported fault stands for, 0 where none is reported.

        index: faulty elements, ascending.
        kinds: kinds of each faulty element; more than `often` of one kind are reported once, at the first.
        block: block of each element, if the elements are not words.
        """
        all_blocks = self.words.block if block is None else block
        if not len(index):
            return repeated(np.int64(0), len(all_blocks))
        order = np.lexsort((index, *kinds))
        blocks, begins = all_blocks[index[order]], np.zeros(len(index), bool)
        begins[0] = True
        for kind in kinds:
            begins[1:] |= np.diff(kind[order].astype(np.int64)) != 0
        of_kind = np.cumsum(begins) - 1
        in_new_block = begins | first_in_run(blocks)
        is_habit = (np.bincount(of_kind) > often)[of_kind]
        count = np.where(is_habit, np.bincount(of_kind, in_new_block)[of_kind], 1)
        return column_at(len(all_blocks), index[order], np.where(begins | ~is_habit, count, 0), 0)

    # ---- the own language of a control that reads another one, too ----

    def _in_other_language(self, at: NDArray[np.integer]) -> Mask:
        """Positions behind the code of the other language, and before the one that takes it back: G291, G290."""
        code = self.machine.macro.other_language
        if not code:
            return np.zeros(len(at), bool)
        changes = [
            (match.start(), match[0].upper() == code)
            for match in _LANGUAGES.finditer(self.text.source.code.tobytes().decode("latin-1"))
        ]
        if not changes:
            return np.zeros(len(at), bool)
        places, is_other = zip(*changes, strict=True)
        return np.array((False, *is_other), bool)[np.searchsorted(np.array(places), at)]

    @cached_property
    def parentheses_count(self) -> Rows:
        """At the first comment in parentheses that the control does not read as one the number of them, else 0."""
        counts = np.zeros(len(self.text.comments), np.int64)
        if self.machine.control.parentheses_are_comments or not len(counts):
            return counts
        start = self.text.comments.start
        at = np.flatnonzero((self.text.source.code[start] == ord("(")) & ~self._in_other_language(start))
        if len(at):
            counts[at[0]] = len(at)
        return counts

    @cached_property
    def lacks_equal_sign(self) -> Mask:
        """Words with the letter of arithmetic parameters, and a number right behind it: R10."""
        letter, words = self.machine.macro.parameter_letter, self.words
        if not letter:
            return np.zeros(len(words), bool)
        at = np.flatnonzero(words.address == ord(letter))
        # CR= and RPL= are read as R, too: what is written tells them apart.
        excerpt = self.text.source.excerpt
        numbered = [
            index
            for index, start in side_by_side(at, words.start[at])
            if _PARAMETER.match(excerpt(start, start + 4)) is not None
        ]
        is_readable = ~words.is_unreadable | self._has_blank
        return np.asarray(mask_at(len(words), numbered) & is_readable & ~self._in_other_language(words.start))

    @cached_property
    def _has_blank(self) -> Mask:
        return np.asarray(self.words.fault == NumberFault.BLANK_INSIDE)

    # ---- words of a block ----

    @cached_property
    def unreadable_count(self) -> Rows:
        """Per word: the number of blocks with unreadable numbers where one is reported, else 0."""
        is_explained = self._has_blank & (self.lacks_equal_sign | self._in_other_language(self.words.start))
        index = np.flatnonzero(self.words.is_unreadable & ~is_explained)
        return self._habits(index, self.words.fault[index], self.words.address[index])

    @cached_property
    def wrong_dash_count(self) -> Rows:
        """The same for words with a typographic dash."""
        return self._habits(np.flatnonzero(self.words.has_wrong_dash))

    def _in_broken_block(self, index: Rows) -> Mask:
        """True for words in a block with anything unreadable: its other words are not reliable."""
        return self._broken_blocks[self.words.block[index]]

    @cached_property
    def _broken_blocks(self) -> Mask:
        """Per block of the file: anything in it is unreadable."""
        unreadable = self.words.block[self.words.is_unreadable]
        return mask_at(len(self.text.blocks), np.append(unreadable, self.text.strays.block))

    def first_beyond(self, counted: Mask, limit: int) -> Mask:
        """The first counted word of each block that exceeds the limit."""
        index = np.flatnonzero(counted)
        block = self.words.block[index]
        is_next = np.append(np.ones(min(limit, len(index)), bool), block[limit:] != block[: max(len(block) - limit, 0)])
        beyond = ~is_next
        beyond[1:] &= is_next[:-1]
        index = index[beyond]
        return mask_at(len(self.words), index[~self._in_broken_block(index)])

    def in_block(self, counted: Mask, asked: Mask) -> Rows:
        """Per word of the mask `asked`: the number of counted words in its block; 0 for other words."""
        if not asked.any():
            return repeated(np.int64(0), len(asked))
        block = self.words.block
        return np.where(asked, np.bincount(block[counted], minlength=int(block[-1]) + 1)[block], 0)

    def _suspects(self, index: Rows, bits: NDArray[np.uint64]) -> Rows:
        """Words with bits in blocks that have a bit twice; not in blocks with anything unreadable."""
        if not len(index):
            return index
        block = self.words.block[index]
        head = np.flatnonzero(first_in_run(block))
        # The sum of bits equals their bitwise or if all are different.
        differs = np.add.reduceat(bits, head) != np.bitwise_or.reduceat(bits, head)
        differs &= ~self._broken_blocks[block[head]]
        if not differs.any():
            return index[:0]
        return index[np.repeat(differs, np.diff(np.append(head, len(index)))) & (bits > 0)]

    def _again(self, index: Rows, kind: NDArray[Any]) -> tuple[Rows, Rows]:
        """Words that follow a word of the same kind in their block, and the word before each of them."""
        order = np.lexsort((index, kind, self.words.block[index]))
        index, kind = index[order], kind[order]
        block = self.words.block[index]
        same = (block[1:] == block[:-1]) & (kind[1:] == kind[:-1])
        return index[1:][same], index[:-1][same]

    @cached_property
    def repeat_count(self) -> Rows:
        """
        Per word: 1 at the first word of a block that repeats an address of the block, else 0.

        If an address is repeated in many blocks, the first word has the number of these blocks, and the others have 0.
        """
        words = self.words
        suspects = self._suspects(np.arange(len(words)), _ADDRESS_BITS[words.address])
        calls = words.block[self._g_words[code_set(self.machine.macro.macro_call_codes)[self._g_codes]]]
        is_argument = is_among(words.address[suspects], list(_ARGUMENT_SETS)) & is_among(words.block[suspects], calls)
        suspects = suspects[~(is_argument | self._is_next_tool(suspects))]
        again = np.sort(self._again(suspects, words.address[suspects])[0])
        first = again[first_in_run(words.block[again])]
        return self._habits(first, words.address[first])

    def _is_next_tool(self, index: Rows) -> Mask:
        """T of a tool change in whose block the next tool stands, too."""
        if self.machine.offsets.called_by != "tool-change":
            return np.zeros(len(index), bool)
        words, m = self.words, np.flatnonzero(self.words.address == ord("M"))
        changes = words.block[m[code_set(self.machine.m_codes.tool_change)[code_numbers(words.value[m])]]]
        t = words.block[words.address == ord("T")]
        changes = changes[np.bincount(t, minlength=len(self.text.blocks))[changes] == _TOOLS_OF_CHANGE]
        return np.asarray((words.address[index] == ord("T")) & is_among(words.block[index], changes))

    # ---- G codes ----

    @cached_property
    def _g_words(self) -> Rows:
        return np.flatnonzero(self.words.address == ord("G"))

    @cached_property
    def _g_codes(self) -> NDArray[np.int32]:
        return code_numbers(self.words.value[self._g_words])

    @cached_property
    def overruled(self) -> Rows:
        """Per word: the word before it in the block that is another code of the same modal group, else -1."""
        group = self.machine.cached("groups that exclude", lambda: _groups_that_exclude(self.machine))
        kind = group[self._g_codes]
        bits = np.where(kind > 0, np.uint64(1) << kind.astype(np.uint64), np.uint64(0))
        suspects = self._suspects(self._g_words, bits)
        later, other = self._again(suspects, kind[np.searchsorted(self._g_words, suspects)])
        differs = self.words.value[other] != self.words.value[later]
        if not differs.any():
            return repeated(np.int64(-1), len(self.words))
        return column_at(len(self.words), later[differs], other[differs], -1)

    @cached_property
    def unknown_code_count(self) -> Rows:
        """Per word: the number of times that an unknown G code occurs, at its first word in the file, else 0."""
        known = self.machine.cached("known G codes", lambda: _known_g_codes(self.machine))
        wrong = ~known[self._g_codes] & (self.words.fault[self._g_words] == NumberFault.NONE)
        words = self._g_words[wrong]
        if not len(words):
            return repeated(np.int64(0), len(self.words))
        _, first, count = np.unique(self.words.value[words], return_index=True, return_counts=True)
        return column_at(len(self.words), words[first], count, 0)

    @cached_property
    def overruled_count(self) -> Rows:
        """Per word: the number of blocks with the same two codes where an overruled code is reported, else 0."""
        index = np.flatnonzero(self.overruled >= 0)
        later, other = (code_numbers(self.words.value[at]) for at in (index, self.overruled[index]))
        return self._habits(index, later, other)

    # ---- digits, case ----

    @cached_property
    def long_number_digits(self) -> Rows:
        """
        Per word: the number of digits where it exceeds the limit of the control, else 0.

        Leading zeros and digits beyond the least increment do not count. Blocks with anything unreadable are left out.
        """
        control, words = self.machine.control, self.words
        long = np.flatnonzero(words.digits > control.digit_limit)
        counted = np.minimum(words.decimals[long], round(-np.log10(control.least_increment)))
        digits = words.digits[long] - words.decimals[long] + counted
        # The value of a number of more than 22 digits is only approximate.
        is_large = np.abs(words.value[long]) >= 10.0 ** (control.digit_limit - counted)
        is_too_long = (digits > control.digit_limit) & is_large & ~self._in_broken_block(long)
        if not is_too_long.any():
            return repeated(np.int64(0), len(words))
        return column_at(len(words), long[is_too_long], digits[is_too_long], 0)

    @cached_property
    def is_first_lower_case(self) -> Mask:
        """The first word of the file with a lower case letter."""
        letter = self.text.source.code[self.words.start]
        index = np.flatnonzero((letter >= ord("a")) & (letter <= ord("z")))
        index = index[~is_among(self.words.block[index], self.text.prose.block)]
        return mask_at(len(self.words), index[~self._in_broken_block(index)][:1])

    @cached_property
    def letter_count(self) -> Rows:
        """Per word: the number of blocks with letters for digits where one is reported, else 0."""
        starts, letters = self.words.start, self.text.letters
        index, first = np.unique(np.searchsorted(starts, letters, side="right") - 1, return_index=True)
        return self._habits(index, self._characters(letters[first]))

    # ---- the end of a program ----

    @cached_property
    def lacks_end(self) -> Mask:
        """
        The last word of a program with a head, or between %, that has no code for its end or for a return, or none
        behind a part that it calls itself.
        """
        m_words = np.flatnonzero(self.words.address == ord("M"))
        ends = code_set([*self.machine.m_codes.program_end, *self.machine.macro.program_returns])
        ending = self.words.block[m_words[ends[code_numbers(self.words.value[m_words])]]]
        programs = find_programs(self.text).programs
        first = np.array([program.first for program in programs], np.int64)
        end = np.array([program.end for program in programs], np.int64)
        has_end = np.searchsorted(ending, first) < np.searchsorted(ending, end)
        called = self._called_parts
        behind = np.searchsorted(first, called, side="right") - 1
        has_end[behind[np.searchsorted(ending, called) == np.searchsorted(ending, end[behind])]] = False
        in_tape = len(self.text.tape_marks) > 0
        lacking = ~has_end & (np.array([program.has_head for program in programs], bool) | in_tape)
        # A head alone is no program.
        words_before = np.searchsorted(self.words.block, np.array([first, end]))
        lacking &= words_before[1] - words_before[0] > 1
        mask = np.zeros(len(self.words), bool)
        for index in np.flatnonzero(lacking).tolist():
            mask[words_before[1, index] - 1] = not self._ends_in_macro(int(first[index]), int(end[index]))
        return mask

    @property
    def _called_parts(self) -> Rows:
        """The blocks with the N numbers at which calls of a part of the own program begin: M98 Q100, M97 P100."""
        words, macro = self.words, self.machine.macro
        m_words = np.flatnonzero(words.address == ord("M"))
        numbers = code_numbers(words.value[m_words])
        called = []
        for codes, address in ((macro.subprogram_calls, macro.sequence_word), (macro.local_calls, "P")):
            calls = words.block[m_words[code_set(codes)[numbers]]]
            if address and len(calls):
                of_number = (words.address == ord(address)) & is_among(words.block, calls.tolist())
                if address != "P":
                    of_number &= ~is_among(words.block, words.block[words.address == ord("P")].tolist())
                called += words.value[of_number].tolist()
        if not called:
            return words.block[:0]
        return np.asarray(words.block[(words.address == ord("N")) & is_among(words.value, called)])

    def _ends_in_macro(self, first: int, end: int) -> bool:
        """True if a macro block ends the program, returns or jumps, or may do so by a code that it calculates."""
        macro = np.flatnonzero(self.text.blocks.is_macro[first:end]) + first
        codes = (*self.machine.m_codes.program_end, *self.machine.macro.program_returns)
        spelled_out = "|".join(rf"{code[0]}\s*(?:[=#\[]|0*{re.escape(code[1:])}(?![.\d]))" for code in codes)
        ends = re.compile(rf"{_JUMP}|{spelled_out}", re.IGNORECASE)
        return any(ends.search(block_text(self.text, int(block))) for block in macro)

    # ---- characters ----

    @cached_property
    def stray_count(self) -> Rows:
        """
        Per stray character: the number of blocks in which it is the first stray one, at its first place, else 0.

        Left out are blocks with an unreadable word, and a ) that remains of a nested comment.
        """
        strays = self.text.strays
        first = first_in_run(strays.block)
        unreadable = self.words.block[self.words.is_unreadable]
        is_left_over = self.text.source.code[strays.start] == ord(")")
        is_left_over &= is_among(strays.block, self.text.comments.block[self.text.nested])
        index = np.flatnonzero(first & ~is_among(strays.block, unreadable) & ~is_left_over)
        return self._habits(index, self._characters(strays.start[index]), block=strays.block, often=1)

    def _characters(self, at: Rows) -> Rows:
        """The characters at some positions, as numbers."""
        source = self.text.source
        code = source.code[at].astype(np.int64)
        if np.any(code == OTHER):
            code[code == OTHER] = [ord(source.excerpt(place, place + 1)) for place in at[code == OTHER].tolist()]
        return code

    @cached_property
    def nested_count(self) -> Rows:
        """Per comment: the number of blocks with nested comments where one is reported, else 0."""
        block = self.text.comments.block
        return self._habits(np.flatnonzero(self.text.nested), block=block)

    @cached_property
    def unclosed_count(self) -> Rows:
        """The same for comments that are not closed."""
        block = self.text.comments.block
        return self._habits(np.flatnonzero(self.text.unclosed), block=block)

    @cached_property
    def prose_count(self) -> Rows:
        """
        Per text without parentheses: the number of blocks with such text, at the first of the file, else 0.

        Remains of nested or unclosed comments are counted separately, since they are consequences.
        """
        text = self.text
        broken = text.comments.block[text.nested | text.unclosed]
        is_left_over = is_among(text.prose.block, broken)
        return self._habits(np.arange(len(text.prose)), is_left_over, block=text.prose.block, often=0)

    @cached_property
    def is_first_dots(self) -> Mask:
        """The first of successive lines of dots."""
        first = np.ones(len(self.text.dots), bool)
        first[1:] = np.diff(self.text.dots.block) > 1
        return first

    @cached_property
    def is_text_outside(self) -> Mask:
        """Letters or digits outside a program, other than in comments."""
        outside = self.text.outside
        data = self.text.source.code.tobytes()
        places = side_by_side(outside.start, outside.end)
        texts = (_COMMENT.sub(b"", data[start:end]) for start, end in places)
        return np.array([_LETTER_OR_DIGIT.search(text) is not None for text in texts], bool)

    @cached_property
    def foreign_count(self) -> Rows:
        """
        Per run of foreign characters: the number of them on its line, at the first run of the line, else 0.

        Left out are stray characters, wrong dashes, text without parentheses and text outside a program. Characters
        before the first %, the leader of a tape, count as one line.
        """
        text, spans = self.text, self.text.foreign
        code = text.source.code[spans.start]
        is_blank = is_among(code, list(BLANKS))
        is_counted = (is_blank | _inside(spans.start, text.comments) | _inside(spans.start, text.names)) & ~_inside(
            spans.start, text.outside
        )
        is_counted &= ~_inside(spans.start, text.prose)
        leader = text.tape_marks[0] if len(text.tape_marks) else 0
        line = np.where(spans.start < leader, 0, text.blocks.line[spans.block])
        index = np.flatnonzero(is_counted)
        length = (spans.end - spans.start)[index]
        first = np.flatnonzero(first_in_run(line[index]))
        return column_at(len(spans), index[first], np.add.reduceat(length, first) if len(first) else 0, 0)

    @cached_property
    def foreign_line_count(self) -> Rows:
        """Per run of foreign characters: the number of lines that a reported line stands for, else 0."""
        return self._habits(np.flatnonzero(self.foreign_count > 0), block=self.text.foreign.block)


def _inside(at: Rows, spans: object) -> Mask:
    """True for positions in any of the spans; the spans may have any order."""
    start, end = np.sort(spans.start), np.sort(spans.end)  # type: ignore[attr-defined]
    return np.asarray(np.searchsorted(start, at, side="right") > np.searchsorted(end, at, side="right"))


def _groups_that_exclude(machine: Machine) -> NDArray[np.uint8]:
    """For each code number its modal group, from 1; 0 for none, and where two codes of it may stand in one block."""
    names, group_of, _ = modal_tables(machine)
    group = group_of.copy()
    group[is_among(group, [names.index(name) + 1 for name in _UNSURE_GROUPS])] = 0
    if machine.control.g_code_system == "A":
        group[code_set(code for key in _OF_OTHER_SYSTEMS for code in machine.codes(key))] = 0
    group[NO_CODE] = 0
    return group


def _known_g_codes(machine: Machine) -> Mask:
    """For each code number: a G or M code that the profile names anywhere."""
    control, polar = machine.control, machine.polar
    native = [text for text in control.native_words.values() if is_code(text)]
    listed = (*control.known_codes, *control.motion_codes, *machine.listed_codes, *native)
    return code_set((*listed, *polar.on, *polar.off, *polar.ended_by, *polar.allowed_codes))
