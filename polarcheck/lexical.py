"""What the words and characters of a file say of themselves, without being executed."""

from __future__ import annotations

import re
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from polarcheck.codes import NO_CODE, code_numbers, code_set, group_tables, spelled
from polarcheck.frame import BLANKS
from polarcheck.programs import block_text, find_programs
from polarcheck.words import Fault

if TYPE_CHECKING:
    from polarcheck.trace import Trace

Mask = NDArray[np.bool_]
Numbers = NDArray[np.int64]

#: Words that may stand in a block as often as there is reason to.
_MAY_REPEAT = b"GMN/"
#: In macro calls, argument specification II.
_ARGUMENT_SETS = b"IJK"
_MACRO_CALLS = ("G65", "G66", "G66.1")
#: Groups whose codes have other meanings on lathes with two turrets, or take arguments.
_UNSURE_GROUPS = ("scaling", "rotation", "mirror")
#: Codes of group 01 in system A that other systems and mills write beside G0 and G1, in another meaning.
_OF_OTHER_SYSTEMS = ("G90", "G92", "G94")
#: Controls have no codes of their own from here on; programs that call macros by a G code have (parameter 6050).
_OWN_CODES_END = 200
_RETURN = "M99"
_COMMENT = re.compile(rb"\([^)\n]*+\)?")
_LETTER_OR_DIGIT = re.compile(rb"[0-9A-Za-z\x80-\xff]")
_END_IN_MACRO = re.compile(r"M\s*0*99(?!\d)|GOTO|GO\s*\d", re.IGNORECASE)


class Lexical:
    """Columns over the words, characters and comments of a text; the methods give words for a message about one."""

    def __init__(self, trace: Trace) -> None:
        self.text = trace.text
        self.words = trace.text.words
        self.machine = trace.machine

    # ---- words of a block ----

    @cached_property
    def _first_of_block(self) -> Numbers:
        """Index of the first word of the block of each word."""
        block = self.words.block
        is_first = np.ones(len(block), bool)
        is_first[1:] = block[1:] != block[:-1]
        first = np.flatnonzero(is_first)
        return np.repeat(first, np.diff(np.append(first, len(block))))

    @cached_property
    def _broken_block(self) -> Mask:
        """Per word: something in its block cannot be read, so that what else is there means little."""
        broken = np.zeros(len(self.text.blocks), bool)
        broken[self.words.block[self.words.is_unreadable]] = True
        broken[self.text.strays.block] = True
        return broken[self.words.block]

    def _place(self, counted: Mask) -> Numbers:
        """Of the counted words the number of each in its block, from 1; 0 for the others."""
        total = np.cumsum(counted)
        at_head: Numbers = (total - counted)[self._first_of_block]
        return np.where(counted & ~self._broken_block, total - at_head, 0)

    @cached_property
    def place_in_block(self) -> Numbers:
        """The number of the word in its block, block skip not counted."""
        return self._place(self.words.address != ord("/"))

    @cached_property
    def place_of_m_code(self) -> Numbers:
        """The number of the M word among those of its block."""
        return self._place(self.words.address == ord("M"))

    def _how_many(self, index: int, counted: Mask) -> int:
        first = int(self._first_of_block[index])
        same = self._first_of_block[first:] == first
        return int(np.count_nonzero(counted[first:][same]))

    def words_in_block(self, index: int) -> int:
        """How many words the block of a word has."""
        return self._how_many(index, self.words.address != ord("/"))

    def m_codes_in_block(self, index: int) -> int:
        """How many M words."""
        return self._how_many(index, self.words.address == ord("M"))

    def _repeated(self, words: Numbers, kind: NDArray[np.uint64]) -> Numbers:
        """Of the words those in whose block a word of the same kind (below 64) stands before; where that one is."""
        none = np.full(len(self.words), -1)
        if not len(words):
            return none
        block = self.words.block[words]
        head = np.flatnonzero(np.append(True, block[1:] != block[:-1]))
        bit = np.uint64(1) << kind
        # Bits that are all different add up to what they are joined by `or`.
        differs = np.add.reduceat(bit, head) != np.bitwise_or.reduceat(bit, head)
        if not differs.any():
            return none
        suspect = np.flatnonzero(np.repeat(differs, np.diff(np.append(head, len(words)))))
        order = suspect[np.lexsort((suspect, kind[suspect], block[suspect]))]
        same = (block[order][1:] == block[order][:-1]) & (kind[order][1:] == kind[order][:-1])
        none[words[order[1:][same]]] = words[order[:-1][same]]
        return none

    @cached_property
    def repeats(self) -> Mask:
        """A word whose address stood in the block before."""
        address = self.words.address
        in_call = np.zeros(len(self.text.blocks), bool)
        in_call[self.words.block[self._g_words[code_set(_MACRO_CALLS)[self._g_codes]]]] = True
        counted = ~np.isin(address, list(_MAY_REPEAT)) & (address > 0) & ~self._broken_block
        counted &= ~(np.isin(address, list(_ARGUMENT_SETS)) & in_call[self.words.block])
        index = np.flatnonzero(counted)
        # A to Z, and a to z behind a comma, are 58 neighbours.
        return self._repeated(index, (address[index] - np.uint8(ord("A"))).astype(np.uint64)) >= 0

    # ---- G codes ----

    @cached_property
    def _g_words(self) -> Numbers:
        return np.flatnonzero(self.words.address == ord("G"))

    @cached_property
    def _g_codes(self) -> NDArray[np.int32]:
        return code_numbers(self.words.value[self._g_words])

    @cached_property
    def _overruled(self) -> Numbers:
        """Per word: the word of another code of the same modal group that stands before it in the block, else -1."""
        system = self.machine.control.g_code_system
        names, group_of, _ = group_tables(system)
        group = group_of.copy()
        group[np.isin(group, [names.index(name) + 1 for name in _UNSURE_GROUPS])] = 0
        if system == "A":
            group[code_set(_OF_OTHER_SYSTEMS)] = 0
        group[NO_CODE] = 0
        kind = group[self._g_codes]
        counted = (kind > 0) & ~self._broken_block[self._g_words]
        other = self._repeated(self._g_words[counted], kind[counted].astype(np.uint64))
        same_code = self.words.value[other] == self.words.value
        return np.where(same_code, -1, other)

    @cached_property
    def overrules(self) -> Mask:
        """A G code after another one of its modal group."""
        return np.asarray(self._overruled >= 0)

    def overruled(self, index: int) -> str:
        """The code before it, as in G0."""
        return self._code(int(self._overruled[index]))

    def code(self, index: int) -> str:
        """The code itself."""
        return self._code(index)

    def _code(self, index: int) -> str:
        number = int(code_numbers(self.words.value[index : index + 1])[0])
        return spelled("G", number) if number >= 0 else self._written(index)

    def _written(self, index: int) -> str:
        return self.text.source.excerpt(int(self.words.start[index]), int(self.words.end[index]))

    @cached_property
    def _unknown(self) -> tuple[Mask, Numbers]:
        """Per word: the first of an unknown G code in the file; how often the code stands there."""
        machine = self.machine
        known = code_set([*machine.control.known_codes, *machine.control.motion_codes])
        known |= code_set([*machine.polar.on, *machine.polar.off, *machine.polar.allowed_codes])
        wrong = ~known[self._g_codes] & (self.words.fault[self._g_words] == Fault.NONE)
        words = self._g_words[wrong]
        _, first, count = np.unique(self.words.value[words], return_index=True, return_counts=True)
        mask, counts = np.zeros(len(self.words), bool), np.zeros(len(self.words), np.int64)
        mask[words[first]], counts[words[first]] = True, count
        return mask, counts

    @property
    def is_unknown_code(self) -> Mask:
        """The first of an unknown G code in the file."""
        return self._unknown[0]

    @cached_property
    def may_call_macro(self) -> Mask:
        """A G code that can only be a macro of the builder or the shop."""
        value = self.words.value
        return np.asarray((self.words.address == ord("G")) & (value >= _OWN_CODES_END) & (value == np.floor(value)))

    def times(self, index: int) -> str:
        """How often the code stands in the file, where it is more than once."""
        count = int(self._unknown[1][index])
        return f" ({count} times in this file)" if count > 1 else ""

    # ---- digits, case ----

    @cached_property
    def has_too_many_digits(self) -> Mask:
        """More digits than a word can have; leading zeros and digits beyond the least increment do not count."""
        control = self.machine.control
        places = round(-np.log10(control.least_increment))
        counted = np.minimum(self.words.decimals, places)
        digits = self.words.digits - self.words.decimals + counted
        large = np.abs(np.nan_to_num(self.words.value)) >= 10.0 ** (control.digit_limit - counted)
        return np.asarray((digits > control.digit_limit) & large & ~self._broken_block)

    @cached_property
    def is_first_lower_case(self) -> Mask:
        """The first word of the file with a lower case letter."""
        found = np.zeros(len(self.words), bool)
        code = self.text.source.code
        letter = code[self.words.start]
        index = np.flatnonzero((letter >= ord("a")) & (letter <= ord("z")) & ~self._broken_block)
        found[index[:1]] = True
        return found

    # ---- the end of a program ----

    @cached_property
    def lacks_end(self) -> Mask:
        """The last word of a program that has a head, or stands between %, and no M02, M30 or M99 anywhere."""
        m_words = np.flatnonzero(self.words.address == ord("M"))
        ends = code_set([*self.machine.m_codes.program_end, _RETURN])
        ending = self.words.block[m_words[ends[code_numbers(self.words.value[m_words])]]]
        found = np.zeros(len(self.words), bool)
        in_tape = len(self.text.tape_marks) > 0
        for program in find_programs(self.text).programs:
            low, high = np.searchsorted(ending, (program.first, program.end))
            last = int(np.searchsorted(self.words.block, program.end)) - 1
            is_empty = last < 1 or self.words.block[last - 1] < program.first
            if low == high and (program.has_head or in_tape) and not is_empty:
                found[last] = not self._ends_in_macro(program.first, program.end)
        return found

    def _ends_in_macro(self, first: int, end: int) -> bool:
        """A block with macro ends the program or leads back."""
        macro = np.flatnonzero(self.text.blocks.is_macro[first:end]) + first
        return any(_END_IN_MACRO.search(block_text(self.text, int(block))) for block in macro)

    # ---- characters ----

    @cached_property
    def is_first_stray(self) -> Mask:
        """
        The first stray character of its block.

        Not where a word of the block cannot be read for itself, nor a ) that a nested comment has left over.
        """
        strays = self.text.strays
        first = np.ones(len(strays), bool)
        first[1:] = strays.block[1:] != strays.block[:-1]
        unreadable = np.unique(self.words.block[self.words.is_unreadable])
        is_left_over = self.text.source.code[strays.start] == ord(")")
        is_left_over &= np.isin(strays.block, self.text.comments.block[self.text.nested])
        return np.asarray(first & ~np.isin(strays.block, unreadable) & ~is_left_over)

    def stray(self, index: int) -> str:
        """What the control does with a stray character."""
        at = int(self.text.strays.start[index])
        character = self.text.source.excerpt(at, at + 1)
        if character == "%":
            return "% inside a block: for the control the program ends here"
        return f"{character} is no character of a word"

    @cached_property
    def is_first_dots(self) -> Mask:
        """The first of lines of points that follow each other."""
        first = np.ones(len(self.text.dots), bool)
        first[1:] = np.diff(self.text.dots.block) > 1
        return first

    @cached_property
    def is_text_outside(self) -> Mask:
        """Letters or digits outside a program, other than in comments."""
        outside = self.text.outside
        data = self.text.source.code.tobytes()
        places = zip(outside.start.tolist(), outside.end.tolist(), strict=True)
        texts = (_COMMENT.sub(b"", data[start:end]) for start, end in places)
        return np.array([_LETTER_OR_DIGIT.search(text) is not None for text in texts], bool)

    @cached_property
    def _foreign(self) -> tuple[Mask, Numbers]:
        """
        Per run of foreign characters: the first on its line; how many there are on the line.

        Those that are reported as stray characters, wrong dashes or text outside a program are left out, and all before
        the first % are taken together: the leader of a tape.
        """
        text, spans = self.text, self.text.foreign
        code = text.source.code[spans.start]
        is_blank = np.isin(code, list(BLANKS))
        kept = (is_blank | _inside(spans.start, text.comments) | _inside(spans.start, text.names)) & ~_inside(
            spans.start, text.outside
        )
        leader = text.tape_marks[0] if len(text.tape_marks) else 0
        line = np.where(spans.start < leader, 0, text.blocks.line[spans.block])
        index = np.flatnonzero(kept)
        length = (spans.end - spans.start)[index]
        first = np.flatnonzero(np.append(True, line[index][1:] != line[index][:-1])) if len(index) else index
        mask, count = np.zeros(len(spans), bool), np.zeros(len(spans), np.int64)
        mask[index[first]] = True
        count[index[first]] = np.add.reduceat(length, first) if len(first) else 0
        return mask, count

    @property
    def is_first_foreign(self) -> Mask:
        """The first run of foreign characters on its line."""
        return self._foreign[0]

    def foreign_characters(self, index: int) -> str:
        """How many there are on the line."""
        count = int(self._foreign[1][index])
        return "1 character that is" if count == 1 else f"{count} characters that are"


def _inside(at: Numbers, spans: object) -> Mask:
    """Whether the positions lie in one of the spans, which may stand in any order."""
    start, end = np.sort(spans.start), np.sort(spans.end)  # type: ignore[attr-defined]
    return np.asarray(np.searchsorted(start, at, side="right") > np.searchsorted(end, at, side="right"))
