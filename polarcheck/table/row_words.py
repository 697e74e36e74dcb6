"""Which words the rows of a program have, by address and by code: looked up once for all that ask."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Floats, Mask, Rows, States, repeated
from polarcheck.execution.run import Run
from polarcheck.machines.axes import FIRST_NAMED, NO_AXIS, NOT_NAMED
from polarcheck.machines.codes import code, code_numbers, code_set, renumbered
from polarcheck.machines.machine import Machine

Column = TypeVar("Column")

_NOT_WRITTEN = np.float64(np.nan)


class RowWords:
    """Words and codes of the rows of one file on one machine."""

    def __init__(self, run: Run, machine: Machine) -> None:
        self.run = run
        self.text = run.text
        self.machine = machine
        self._columns: dict[str, Any] = {}

    def __len__(self) -> int:
        return len(self.run)

    # ---- words ----

    @cached_property
    def _by_address(self) -> tuple[Rows, Rows]:
        """Word indices grouped by address in order of the rows, and where each address begins."""
        address = self.run.words.address
        return np.argsort(address, kind="stable"), np.cumsum(np.bincount(address, minlength=256))

    def word_indices(self, *addresses: str) -> Rows:
        """The words of an address, in order, then those of the next; `,R` is an address of its own."""
        found = [self._words_of(address) for address in addresses]
        return found[0] if len(found) == 1 else np.concatenate((np.zeros(0, np.int64), *found))

    def _words_of(self, address: str) -> Rows:
        order, ends = self._by_address
        if not address:  # of a machine that has none for it
            return order[:0]
        number = self.machine.address_number(address)
        found = order[ends[number - 1] : ends[number]]
        # H beside G43 is the number of an offset, and no increment of C.
        return found[~self.switches_length_offset[self.run.row[found]]] if address == "H" and len(found) else found

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
        found = np.flatnonzero((address >= FIRST_NAMED) & (address != NO_AXIS))
        own = [*map(self.machine.address_number, self.machine.polar.axis_addresses)]
        return found[~np.isin(address[found], own)] if len(found) else found

    def words_at(self, indices: Rows) -> Mask:
        """Per executed word: whether it is one of these."""
        if not len(indices):
            return self.no_words
        found = np.zeros(len(self.run.words), bool)
        found[indices] = True
        return found

    @cached_property
    def no_words(self) -> Mask:
        """None of the executed words: one mask for all that is not in the program, which cannot be written to."""
        mask = np.zeros(len(self.run.words), bool)
        mask.flags.writeable = False
        return mask

    def with_words(self, words: Rows | Mask) -> Mask:
        """Per row: whether it has one of these executed words, given by indices or as a mask."""
        words = np.flatnonzero(words) if words.dtype == np.bool_ else words
        if not len(words):
            return self.nowhere
        found = np.zeros(len(self), bool)
        found[self.run.row[words]] = True
        return found

    @cached_property
    def nowhere(self) -> Mask:
        """No row: one mask for all that is not in the program, which cannot be written to."""
        mask = np.zeros(len(self), bool)
        mask.flags.writeable = False
        return mask

    def word(self, address: str) -> Floats:
        """The written value per row, the last where it is repeated; NaN where it is not written."""
        return self._column(f"word {address}", lambda: self._scatter(address, self.run.words.value))

    def distance(self, address: str) -> States | None:
        """Per row what the word of an address says of itself (modal.Distance), 0 where nothing; None in most files."""
        own = self.run.distance
        if own is None:
            return None
        return self._column(f"distance {address}", lambda: self._distance(address, own))

    def _distance(self, address: str, own: NDArray[np.int16]) -> States:
        column = np.zeros(len(self), np.int16)
        at = self.word_indices(address)
        column[self.run.row[at]] = own[at]
        return column

    def has(self, *addresses: str) -> Mask:
        """Whether a row has a word of any of the addresses."""
        return self.with_words(self.word_indices(*addresses))

    def consists_of(self, *addresses: str) -> Mask:
        """Whether a row has words of these addresses and no others; N and block skip may stand beside them."""
        beside = np.zeros(256, bool)
        named = [self.machine.address_number(address) for address in (*addresses, "N", "/") if address]
        beside[named] = True
        return self.has(*addresses) & ~self.with_words(~beside[self.run.words.address])

    def _scatter(self, address: str, values: Floats) -> Floats:
        at = self.word_indices(address)
        if not len(at):
            return repeated(_NOT_WRITTEN, len(self))
        column = np.full(len(self), np.nan)
        column[self.run.row[at]] = values[at]
        return column

    def _column(self, name: str, make: Callable[[], Column]) -> Column:
        if name not in self._columns:
            self._columns[name] = make()
        column: Column = self._columns[name]
        return column

    def assigns(self, ranges: Iterable[tuple[int, int]]) -> Mask:
        """Whether a row assigns a variable of an offset in one of these ranges."""
        found = np.zeros(len(self), bool)
        spans = list(ranges)
        for row, assigned in self.run.assigned.items():
            found[row] = any(first <= assigned.variable <= last for first, last in spans)
        return found

    # ---- codes ----

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

        `M3 P12` asks for the word beside the code, too. What the machine lists so is not the M code alone.
        """
        found = [np.zeros(0, np.int64)]
        for letter, indices, numbers in (("G", self.g_words, self.g_codes), ("M", self.m_words, self.m_codes)):
            asked = [word for word in words if word[0] == letter and " " not in word]
            if asked:
                found.append(self._of_codes(letter, code_set(asked)))
            found += [
                indices[self._beside(word, indices, numbers)] for word in words if word[0] == letter and " " in word
            ]
        return np.concatenate(found)

    def _of_codes(self, letter: str, asked: Mask) -> Rows:
        """The G or M words, in order, whose codes are asked for (codes.code_set), and listed without another word."""
        order, present, begins = self._by_code[letter]
        found = [
            order[begin:end] for begin, end in (begins[at : at + 2] for at in np.flatnonzero(asked[present]).tolist())
        ]
        if not found:
            return order[:0]
        at = found[0] if len(found) == 1 else np.sort(np.concatenate(found))
        if letter == "G":
            return self.g_words[at]
        return self.m_words[at[~self._with_own_word[at]]]

    @cached_property
    def _by_code(self) -> dict[str, tuple[Rows, NDArray[np.int32], Rows]]:
        """By letter the G or M words grouped by their codes, the codes that there are, and where each begins."""
        found = {}
        for letter, numbers in (("G", self.g_codes), ("M", self.m_codes)):
            order = np.argsort(numbers.astype(np.int16), kind="stable")  # of small numbers in linear time
            rising = numbers[order]
            begins = np.flatnonzero(np.append(True, rising[1:] != rising[:-1])) if len(rising) else order
            found[letter] = order, rising[begins], np.append(begins, len(order))
        return found

    def _beside(self, word: str, indices: Rows, numbers: NDArray[np.int32]) -> Mask:
        """Per G or M word: it is the code of `M3 P12`, and that other word stands in its row."""
        first, _, other = word.partition(" ")
        return np.asarray((numbers == code(first)) & (self.word(other[0])[self.run.row[indices]] == float(other[1:])))

    @cached_property
    def _with_own_word(self) -> Mask:
        """Per M word: the machine lists it with a word that stands beside it."""
        found = np.zeros(len(self.m_words), bool)
        for word in self.machine.m_codes.with_words:
            found |= self._beside(word, self.m_words, self.m_codes)
        return found

    def codes(self, *words: str) -> Mask:
        """Whether a row has any of these G or M codes."""
        return self.with_words(self.code_indices(*words))

    def listed(self, *keys: str) -> Mask:
        """Whether a row has a G code of any of these lists of the machine, as in `reference_return`."""
        return self.codes(*(code for key in keys for code in self.machine.codes(key)))

    @cached_property
    def switches_length_offset(self) -> Mask:
        """G43, G44, G49."""
        return self.listed("tool_length_offset", "tool_length_offset_off")
