"""The contents of each executed block: its words by address and its codes, its line and its program."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.filling import fill_down
from polarcheck.columns.lookups import Lookups
from polarcheck.foundation.arrays import (
    Floats,
    Mask,
    Rows,
    States,
    cached_property,
    column_at,
    first_in_run,
    mask_at,
    repeated,
)
from polarcheck.program.execution.programs import find_programs
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.axis_table import FIRST_NAMED, NO_AXIS, NOT_NAMED
from polarcheck.program.machines.code_lists import numbers as numbers_of
from polarcheck.program.machines.code_tables import code, code_numbers, renumbered
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.words import Text

_NOT_WRITTEN = np.float64(np.nan)


class ExecutedBlocks(Lookups, frozen=True):
    """
    The words and codes of the executed blocks of one file on one machine; each is looked up once for all that need it.
    """

    run: Run
    text: Text
    machine: Machine

    def __len__(self) -> int:
        return len(self.run)

    @cached_property
    def _by_address(self) -> tuple[NDArray[np.int32], Rows]:
        """Word indices grouped by address in order of the rows, and where each address begins."""
        address = self.run.words.address
        # Positions in int32: half of a large column, which stays as long as the program is checked.
        return np.argsort(address, kind="stable").astype(np.int32), np.cumsum(np.bincount(address, minlength=256))

    def word_indices(self, *addresses: str) -> Rows:
        """The words of an address, in order, then those of the next; `,R` is an address of its own."""
        indices = [self._words_of(address) for address in addresses]
        return indices[0] if len(indices) == 1 else np.concatenate((np.zeros(0, np.int64), *indices))

    def _words_of(self, address: str) -> Rows:
        order, ends = self._by_address
        if not address:  # of a machine that has none for it
            return np.zeros(0, np.int64)
        number = self.machine.address_number(address)
        words = order[ends[number - 1] : ends[number]].astype(np.int64)
        return words[~self.numbers_by_h[self.run.row[words]]] if address == "H" and len(words) else words

    @cached_property
    def words_not_named(self) -> Rows:
        """The words of axes that control.named_axes does not have, in order."""
        return np.flatnonzero(self.run.words.address == NOT_NAMED)

    @cached_property
    def words_of_no_axis(self) -> Rows:
        """The words with = whose names no axis has, as in R1=5, in order."""
        return np.flatnonzero(self.run.words.address == NO_AXIS)

    @cached_property
    def moves_unnamed(self) -> Mask:
        """Has a word of an axis that control.named_axes does not have: it may be any axis of the lathe."""
        return self.with_words(self.words_not_named)

    @cached_property
    def words_not_followed(self) -> Rows:
        """The words of axes that are not followed, by control.named_axes or since it does not have them, in order."""
        address = self.run.words.address
        end = FIRST_NAMED + len(self.machine.control.named_axes)
        named = np.flatnonzero(((address >= FIRST_NAMED) & (address < end)) | (address == NOT_NAMED))
        of_plane = [*map(self.machine.address_number, self.machine.polar.axis_addresses)]
        return named[~np.isin(address[named], of_plane)] if len(named) else named

    def words_at(self, indices: Rows) -> Mask:
        """Per executed word: whether it is one of these."""
        if not len(indices):
            return self.no_words
        return mask_at(len(self.run.words), indices)

    @cached_property
    def no_words(self) -> Mask:
        """None of the executed words: one mask for all that is not in the program, which cannot be written to."""
        mask = np.zeros(len(self.run.words), bool)
        mask.flags.writeable = False
        return mask

    @cached_property
    def unknown_words(self) -> Rows:
        """The words whose value is not known since a variable has none, in order."""
        return np.array(sorted(self.run.unknown_words), np.int64)

    def is_unknown(self, *addresses: str) -> Mask:
        """True where the row has a word of any of the addresses, and its value is not known."""
        if not len(self.unknown_words):
            return self.nowhere
        words = self.word_indices(*addresses)
        return self.with_words(words[np.isin(words, self.unknown_words)])

    def with_words(self, words: Rows | Mask) -> Mask:
        """Per row: whether it has one of these executed words, given by indices or as a mask."""
        words = words.nonzero()[0] if words.dtype.kind == "b" else words
        if not len(words):
            return self.nowhere
        return mask_at(len(self.run), self.run.row[words])

    @cached_property
    def nowhere(self) -> Mask:
        """No row: one mask for all that is not in the program, which cannot be written to."""
        mask = np.zeros(len(self.run), bool)
        mask.flags.writeable = False
        return mask

    def word(self, address: str) -> Floats:
        """The written value per row, the last where it is repeated; NaN where it is not written."""
        return self._column(f"word {address}", lambda: self.in_rows(address, self.run.words.value))

    def distance(self, address: str) -> States | None:
        """Per row what the word of an address says of itself (modal.Distance), 0 where nothing; None in most files."""
        of_words = self.run.distance
        if of_words is None:
            return None
        return self._column(f"distance {address}", lambda: self._distance(address, of_words))

    def _distance(self, address: str, of_words: NDArray[np.int16]) -> States:
        index = self.word_indices(address)
        return column_at(len(self.run), self.run.row[index], of_words[index], np.int16(0))

    def has(self, *addresses: str) -> Mask:
        """True where the row has a word of any of the addresses; cannot be written to."""
        return self._column(f"has {' '.join(addresses)}", lambda: self._has(*addresses))

    def _has(self, *addresses: str) -> Mask:
        mask = self.with_words(self.word_indices(*addresses))
        mask.flags.writeable = False
        return mask

    def consists_of(self, *addresses: str) -> Mask:
        """True where the row has words of these addresses and no others, except N and block skip."""
        allowed = mask_at(256, [self.machine.address_number(address) for address in (*addresses, "N", "/") if address])
        return self.has(*addresses) & ~self.with_words(~allowed[self.run.words.address])

    def in_rows(self, address: str, values: Floats) -> Floats:
        """Per row the value of an address, given values per executed word: the last where repeated, NaN without it."""
        index = self.word_indices(address)
        if not len(index):
            return repeated(_NOT_WRITTEN, len(self.run))
        return column_at(len(self.run), self.run.row[index], values[index], np.nan)

    def assigns(self, ranges: Iterable[tuple[int, int]]) -> Mask:
        """True where the row assigns a variable of an offset in one of these ranges."""
        mask = np.zeros(len(self.run), bool)
        spans = list(ranges)
        for row, assigned in self.run.assigned.items():
            mask[row] = any(first <= assigned.variable <= last for first, last in spans)
        return mask

    @cached_property
    def g_words(self) -> Rows:
        """Indices of the G words."""
        return self.word_indices("G")

    @cached_property
    def g_codes(self) -> NDArray[np.int32]:
        """Their codes as whole numbers (codes.code)."""
        written = code_numbers(self.run.words.value[self.g_words])
        return renumbered(written, self.machine.control.motion_codes)

    @cached_property
    def m_words(self) -> Rows:
        """Indices of the M words."""
        return self.word_indices("M")

    @cached_property
    def m_codes(self) -> NDArray[np.int32]:
        """Their codes as whole numbers."""
        return code_numbers(self.run.words.value[self.m_words])

    def code_indices(self, *words: str) -> Rows:
        """
        The executed words that are any of these G or M codes (`G54-G59` is a range).

        `M3 P12` requires the word beside the code, too. A word with a listed one beside it is not the code alone.
        """
        parts: list[Rows] = []
        for letter, alone, with_others in _by_letter(words):
            if alone:
                parts.append(self._of_codes(letter, alone))
            if with_others:
                indices, numbers = (self.g_words, self.g_codes) if letter == "G" else (self.m_words, self.m_codes)
                parts += [indices[self._with_second_word(word, indices, numbers)] for word in with_others]
        return parts[0] if len(parts) == 1 else np.concatenate((np.zeros(0, np.int64), *parts))

    def _of_codes(self, letter: str, codes: frozenset[int]) -> Rows:
        """The G or M words with these codes, in order, but not those listed with another word."""
        by_code = self._by_code[letter]
        groups = [by_code[number] for number in by_code.keys() & codes]
        if not groups:
            return np.zeros(0, np.int64)
        number = groups[0] if len(groups) == 1 else np.sort(np.concatenate(groups))
        if letter == "G":
            return self.g_words[number]
        return self.m_words[number[~self._with_other_word[number]]]

    @cached_property
    def _by_code(self) -> dict[str, dict[int, NDArray[np.int32]]]:
        """By letter and code the positions of the words of the code among those of the letter."""
        groups = {}
        for letter, numbers in (("G", self.g_codes), ("M", self.m_codes)):
            # Small numbers are sorted in linear time.
            order = np.argsort(numbers.astype(np.int16), kind="stable").astype(np.int32)
            rising = numbers[order]
            begins = first_in_run(rising).nonzero()[0]
            spans = zip(rising[begins].tolist(), pairwise([*begins.tolist(), len(order)]), strict=True)
            groups[letter] = {number: order[begin:end] for number, (begin, end) in spans}
        return groups

    def _with_second_word(self, word: str, indices: Rows, numbers: NDArray[np.int32]) -> Mask:
        """Per G or M word: it is the code of `M3 P12`, and that other word stands in its row."""
        first, _, second = word.partition(" ")
        return np.asarray((numbers == code(first)) & (self.word(second[0])[self.run.row[indices]] == float(second[1:])))

    @cached_property
    def _with_other_word(self) -> Mask:
        """Per M word: the machine lists it with a word that stands beside it."""
        mask = np.zeros(len(self.m_words), bool)
        for word in self.machine.m_codes.with_words:
            mask |= self._with_second_word(word, self.m_words, self.m_codes)
        return mask

    def codes(self, *words: str) -> Mask:
        """True where the row has any of these G or M codes."""
        return self.with_words(self.code_indices(*words))

    def listed(self, *keys: str) -> Mask:
        """True where the row has a G code of any of these lists of the machine, as in `reference_return`."""
        return self.with_words(self.listed_indices(*keys))

    def listed_indices(self, *keys: str) -> Rows:
        """The executed words that are a G code of any of these lists of the machine."""
        machine = self.machine
        return self.code_indices(
            *machine.cached(" ".join(keys), lambda: tuple(code for key in keys for code in machine.codes(key)))
        )

    @cached_property
    def switches_length_offset(self) -> Mask:
        """G43, G44, G49."""
        return self.listed("tool_length_offset", "tool_length_offset_off")

    @cached_property
    def numbers_by_h(self) -> Mask:
        """H is no increment of C: the number of an offset beside G43, or the N number that M98 H100 calls."""
        calls = self.machine.macro.subprogram_calls if self.machine.macro.sequence_word == "H" else ()
        return self.switches_length_offset | self.codes(*calls)

    @property
    def starts(self) -> Mask:
        """Rows at which a program begins."""
        return self.run.starts

    @cached_property
    def line(self) -> Rows:
        """Line in the file, from 1."""
        return self.text.blocks.line[self.run.block]

    @cached_property
    def line_in_file(self) -> Rows:
        """Line of the file itself; in a program that is called from another file, that of the call."""
        source = self.text.source
        if not source.parts:
            return self.line
        line, is_own = self.line.copy(), self.line < source.parts[0].first_line
        for first, until in pairwise([*(part.first_line for part in source.parts), len(source.line_starts) + 1]):
            if source.is_own(source.part_of(first) or ("", 0)):  # of another channel
                rows = (self.line >= first) & (self.line < until)
                line[rows] -= first - 1
                is_own |= rows
        return fill_down(line, is_own, 1)

    @cached_property
    def row_of_block(self) -> Rows:
        """Per block of the file the first row that runs it, -1 where none does."""
        return column_at(len(self.text.blocks), self.run.block[::-1], np.arange(len(self.run) - 1, -1, -1), -1)

    @cached_property
    def program(self) -> Rows:
        """Number of the program in the file, from 0."""
        return np.cumsum(self.starts) - 1

    @cached_property
    def whole_program(self) -> Mask:
        """
        The row belongs to a main program that is there from its head on: with O number, <name> or %, not left by M99.

        Of an excerpt, and of a subprogram, it is not known what was in force before its first block.
        """
        programs = find_programs(self.text).programs
        first = np.array([program.first for program in programs], np.int64)
        has_head = np.array([program.has_head for program in programs], bool)
        start = self.run.block[np.flatnonzero(self.starts)]
        whole = has_head[np.maximum(np.searchsorted(first, start, side="right") - 1, 0)]
        whole |= len(self.text.tape_marks) > 0
        whole[self.program[self.codes(*self.machine.macro.program_returns) & (self.run.depth == 0)]] = False
        if self.run.broken_off is not None:
            whole[self.program[self.run.broken_off]] = False  # an M99 may come behind the bound
        return whole[self.program]

    def anywhere_in_program(self, mask: Mask) -> Mask:
        """Rows of programs in which any row is in the mask."""
        programs = mask_at(int(np.count_nonzero(self.starts)) + 1, self.program[mask])
        return programs[self.program]

    @cached_property
    def ends_program(self) -> Mask:
        """M02, M30."""
        return self.codes(*self.machine.m_codes.program_end)

    def mask_of(self, rows: Rows | Sequence[int]) -> Mask:
        """Per row: whether it is one of these; those beyond the last are left out."""
        rows = np.asarray(rows, np.int64)
        return mask_at(len(self.run), rows[rows < len(self.run)])


@functools.lru_cache(1000)
def _by_letter(words: tuple[str, ...]) -> tuple[tuple[str, frozenset[int], tuple[str, ...]], ...]:
    """By letter the codes that stand alone, and the words of those with a word beside them, as `M3 P12`."""
    split = []
    for letter in "GM":
        of_letter = [word for word in words if word[0] == letter]
        if of_letter:
            alone = frozenset(numbers_of(word for word in of_letter if " " not in word))
            split.append((letter, alone, tuple(word for word in of_letter if " " in word)))
    return tuple(split)
