"""
The virtual axis of the polar plane: which addresses it has in each section.

They are those of the machine, unless a word beside G12.1 chooses others: D0 makes it Y, D1 the rotary axis, and Q names
the rotary axis by its number.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from itertools import zip_longest
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Mask, Rows, different, repeated
from polarcheck.machines.axes import axis_of
from polarcheck.table.filling import fill_down
from polarcheck.table.linear_axis import LinearAxis

#: The addresses of an axis, absolute and incremental.
Pair = tuple[str, str]

Element = TypeVar("Element", bound=np.generic)


class VirtualAxis(LinearAxis):
    """The columns of the virtual axis; see the properties."""

    @cached_property
    def _forms(self) -> list[Pair]:
        """The addresses of the virtual axis: of the machine, then those that a word beside G12.1 chooses; each once."""
        mode = self.machine.polar
        own = mode.virtual_axis, mode.virtual_axis_incremental
        return list(dict.fromkeys((own, *mode.virtual_axis_by_word.values())))

    @cached_property
    def _by_number(self) -> list[Pair]:
        """The addresses of other rotary axes than that of the machine, which Q beside a G12.1 of this file names."""
        mode, axes = self.machine.polar, self.machine.axes
        if mode.virtual_axis != mode.rotary_address or not axes or not self.takes_axes:
            return []
        numbers = different(self.rotary_number[self.switches_on]).tolist()
        names = [axis_of(axes, number) for number in numbers if number != mode.rotary_axis]
        return [(name, "") for name in names if name]

    @cached_property
    def _foreign(self) -> list[Pair]:
        """The addresses that it has on other controls."""
        elsewhere = self.machine.polar.virtual_axis_of_other_controls
        return list(zip_longest(elsewhere[::2], elsewhere[1::2], fillvalue=""))

    @cached_property
    def _form(self) -> Rows:
        """Per row which of its forms the virtual axis has; outside the mode that of the machine, 0."""
        form = np.zeros(len(self), np.int64)
        for word, pair in self.machine.polar.virtual_axis_by_word.items():
            form[self.switches_on & (self.word(word[0]) == float(word[1:]))] = self._forms.index(pair)
        names = (
            [axis_of(self.machine.axes, number) for number in self.rotary_number.tolist()] if self._by_number else []
        )
        for number, (name, _) in enumerate(self._by_number, len(self._forms)):
            form[self.switches_on & (np.array(names) == name)] = number
        if not form.any():
            return repeated(np.int64(0), len(self))
        return fill_down(form, self.switches_on | self.ends_mode | self.starts, 0).astype(np.int64)

    def _of_form(self, column: Callable[[Pair], NDArray[Element]]) -> NDArray[Element]:
        """Of a column for each form the values of the one of each row."""
        found = column(self._forms[0])
        for number, pair in enumerate((*self._forms[1:], *self._by_number), 1):
            if (self._form == number).any():
                found = np.where(self._form == number, column(pair), found)
        return found

    def virtual_axis_of(self, row: int) -> str:
        """The address of the virtual axis in a row."""
        return self.virtual_addresses(row)[0]

    def virtual_addresses(self, row: int) -> Pair:
        """The addresses of the virtual axis in a row, absolute and incremental."""
        return [*self._forms, *self._by_number][int(self._form[row])]

    def of_virtual_axis(self, column: Callable[[str], NDArray[Element]]) -> NDArray[Element]:
        """Of a column for each address the values of the virtual axis of each row."""
        return self._of_form(lambda pair: column(pair[0]))

    @cached_property
    def has_virtual_word(self) -> Mask:
        """Has a word of the virtual axis under the address that it has there."""
        return self._of_form(lambda pair: self.has(*pair))

    @cached_property
    def virtual_pairs(self) -> list[tuple[Pair, Mask]]:
        """
        The addresses under which the virtual axis is written, each with the rows that do so; in no two of them the same
        row.

        A row that names it by the address of another form or control has a finding for that, and means it nevertheless.
        """
        named = np.zeros(len(self), bool)
        pairs = []
        for number, pair in enumerate((*self._forms, *self._by_number)):
            rows = (self._form == number) & self.has(*pair)
            named |= rows
            pairs.append((pair, rows))
        for pair in dict.fromkeys((*self._forms, *self._foreign)):
            rows = self.has(*pair) & ~named & (self.linear_axis != self.machine.address_number(pair[0]))
            rows &= ~self._moves_itself(pair)
            named |= rows
            pairs.append((pair, rows))
        return pairs

    @cached_property
    def virtual_words(self) -> Rows:
        """The words of the virtual axis, be it under the address of another form or control."""
        if self._by_number:
            every = [self._words_of_pair(pair, rows) for pair, rows in self.virtual_pairs]
            words = np.sort(np.concatenate(every))
        else:
            words = self.word_indices(
                *dict.fromkeys(address for pair in (*self._forms, *self._foreign) for address in pair)
            )
        return words[~self.linear_words[words]] if self.other_linear_axes else words

    def _moves_itself(self, pair: Pair) -> Mask:
        """Rows of sections on another rotary axis, in which an axis of the lathe of these addresses moves by itself."""
        is_other = self._form >= len(self._forms)
        return is_other if pair[0] in self.machine.axes else np.zeros(len(self), bool)

    def _words_of_pair(self, pair: Pair, rows: Mask) -> Rows:
        at = self.word_indices(*pair)
        return at[rows[self.run.row[at]]]

    @cached_property
    def foreign_virtual_words(self) -> Mask:
        """Per executed word: of the virtual axis of a simulated mode, under an address of another form or control."""
        own = np.zeros(len(self.run.words), bool)
        for number, pair in enumerate((*self._forms, *self._by_number)):
            at = self.word_indices(*pair)
            own[at[self._form[self.run.row[at]] == number]] = True
        return self.words_at(self.virtual_words) & ~own & self.is_simulated[self.run.row]

    @cached_property
    def programs_virtual_axis(self) -> Mask:
        """Has a word of the virtual axis, be it under the address of another form or control."""
        return self.with_words(self.virtual_words)

    # ---- modes that are not simulated ----

    @cached_property
    def words_not_simulated(self) -> Mask:
        """
        Per executed word: beside G12.1, and makes another mode of it, which is not simulated: one that the machine
        names, or one that chooses the virtual axis by a number of which the machine does not say what it means.
        """
        mode = self.machine.polar
        letters = dict.fromkeys(word[0] for word in mode.virtual_axis_by_word)
        found = self.words_at(self.word_indices(*mode.not_simulated_beside)).copy()
        for letter in letters:
            at = self.word_indices(letter)
            known = [float(word[1:]) for word in mode.virtual_axis_by_word if word[0] == letter]
            found[at[~np.isin(self.run.words.value[at], known)]] = True
        return np.asarray(found & self.switches_on[self.run.row])

    @cached_property
    def is_simulated(self) -> Mask:
        """What the row does in the mode is simulated; True outside the mode."""
        if not self.words_not_simulated.any():
            return np.ones(len(self), bool)
        begins = self.with_words(self.words_not_simulated)
        return ~fill_down(begins, self.switches_on | self.ends_mode | self.starts, False).astype(bool)
