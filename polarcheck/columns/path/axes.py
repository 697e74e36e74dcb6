"""
The axes of the polar plane in each executed block, and what its words do with them.

The linear axis is X on nearly every lathe; parameter 5460, P beside G12.1 and, on Mitsubishi, parameter 1533 name
another one. The virtual axis has the addresses of the machine, unless a word beside G12.1 chooses others: D0 makes it
Y, D1 the rotary axis, and Q names the rotary axis by its number.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import zip_longest
from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.filling import fill_down, happened
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.path.coordinates import Coordinates
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Rows,
    States,
    cached_property,
    computed,
    different,
    is_among,
    mask_at,
    repeated,
)
from polarcheck.foundation.states import Motion
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.axis_table import AXES, INCREMENTS, axis_of, numbers_of
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.polar_keys import LinearAddress
from polarcheck.program.machines.value_checks import MOST_AXES

_X = ord("X")
_UNKNOWN = 0

#: The addresses of an axis, absolute and incremental.
Pair = tuple[str, str]

Element = TypeVar("Element", bound=np.generic)


class PlaneAxes(Columns, frozen=True):
    """Which axes span the polar plane, their words and those of arc centers, and which of them a block moves."""

    run: Run
    machine: Machine
    blocks: ExecutedBlocks
    modal: ModalStates
    coordinates: Coordinates

    @cached_property
    def switches_on(self) -> Mask:
        """G12.1; none of a code that means something else beside axis words."""
        mode = self.machine.polar
        elsewhere = [name for name in mode.on if name in mode.on_of_other_meaning]
        switches = self.blocks.codes(*mode.on)
        return switches & ~(self.blocks.codes(*elsewhere) & self.blocks.has(*AXES)) if elsewhere else switches

    @cached_property
    def switches_off(self) -> Mask:
        """G13.1."""
        return self.blocks.codes(*self.machine.polar.off)

    @cached_property
    def ends_mode(self) -> Mask:
        """G13.1, or what ends the mode beside what it does elsewhere: the code of another plane."""
        mode = self.machine.polar
        return self.switches_off | self.blocks.codes(*mode.ended_by) if mode.ended_by else self.switches_off

    @cached_property
    def enters_other_axes(self) -> Mask:
        """Rows that switch the mode on for a spindle whose axes are not followed, and where no own one follows."""
        mode = self.machine.polar
        enters = self.switches_on & self.modal.on_sub_spindle & (mode.sub_spindle_plane == "not-followed")
        if not enters.any():
            return enters
        stretch = np.cumsum(self.switches_on | self.ends_mode | self.blocks.starts)
        has_virtual_axis = mask_at(int(stretch[-1]) + 1, stretch[self.blocks.has(mode.virtual_axis)])
        return enters & ~has_virtual_axis[stretch]

    @property
    def most_axes(self) -> int:
        """How many axes the control has: the highest number of one."""
        return len(self.machine.control.axes) or MOST_AXES

    @property
    def takes_axes(self) -> bool:
        """P and Q beside G12.1 name both axes; where it takes one of them alone that may be anything, as a spindle."""
        return {"P", "Q"} <= set(self.machine.polar.words_beside_switch)

    @cached_property
    def axes_written(self) -> tuple[Floats, Floats]:
        """Numbers that P and Q in the row give the linear and the rotary axis; those of the machine without them."""
        mode = self.machine.polar
        linear, rotary = (
            computed(lambda word, number=number: np.where(np.isnan(word), float(number), word), word)
            for word, number in ((self.blocks.word("P"), mode.linear_axis), (self.blocks.word("Q"), mode.rotary_axis))
        )
        return linear, rotary

    @cached_property
    def _axis_numbers(self) -> tuple[Floats, Floats]:
        """
        Numbers of the linear and of the rotary axis that a G12.1 in the row means by P and Q; those of the machine
        where one of them gives no such axis, or both give one, which is a finding.
        """
        mode, axes = self.machine.polar, self.machine.control.axes

        def is_pair(p: Floats, q: Floats) -> Mask:
            both = is_among(p, numbers_of(axes, "linear")) & is_among(q, numbers_of(axes, "rotary")) & (p != q)
            return np.asarray(both & self.takes_axes)

        return (
            computed(lambda p, q: np.where(is_pair(p, q), p, float(mode.linear_axis)), *self.axes_written),
            computed(lambda p, q: np.where(is_pair(p, q), q, float(mode.rotary_axis)), *self.axes_written),
        )

    @property
    def linear_number(self) -> Floats:
        """Number of the linear axis of a G12.1 in the row."""
        return self._axis_numbers[0]

    @property
    def rotary_number(self) -> Floats:
        """Number of the rotary axis of a G12.1 in the row."""
        return self._axis_numbers[1]

    @cached_property
    def _named_axis(self) -> States:
        """The character of the linear axis, from a G12.1 up to its G13.1; that of X elsewhere, 0 where unknown."""
        numbers = different(self.linear_number[self.switches_on]).tolist()
        addresses = {number: self.machine.linear_address_of(number) for number in numbers}
        is_other_plane = self.enters_other_axes
        if set(addresses.values()) <= {"X"} and not is_other_plane.any():
            return repeated(np.int16(_X), len(self.run))
        axis = np.full(len(self.run), _X, np.int16)
        for number, address in addresses.items():
            axis[self.switches_on & (self.linear_number == number)] = ord(address) if address else _UNKNOWN
        axis[is_other_plane] = _UNKNOWN
        return fill_down(axis, self.switches_on | self.ends_mode | self.blocks.starts, _X)

    @cached_property
    def linear_is_known(self) -> Mask:
        """The linear axis of the row is one that is followed: X, Y or Z by the names in control.axes."""
        return np.asarray(self._named_axis != _UNKNOWN)

    @cached_property
    def linear_axis(self) -> States:
        """
        The address of the linear axis, as its character; X outside the mode and where it is not known.

        P beside G12.1 says it by the number of the axis, else the machine (parameter 5460).
        """
        return computed(lambda named: np.where(named != _UNKNOWN, named, _X).astype(np.int16), self._named_axis)

    @cached_property
    def other_linear_axes(self) -> list[str]:
        """The addresses of linear axes other than X in this file."""
        return [axis for axis in INCREMENTS if axis != "X" and (self.linear_axis == ord(axis)).any()]

    def of_linear_axis(self, column: Callable[[str], NDArray[Element]]) -> NDArray[Element]:
        """Per row the value of its linear axis, from a column for each axis."""
        values = column("X")
        for axis in self.other_linear_axes:
            values = np.where(self.linear_axis == ord(axis), column(axis), values)
        return values

    @cached_property
    def programs_linear_axis(self) -> Mask:
        """Has a word of the linear axis."""
        return self.of_linear_axis(lambda axis: self.blocks.has(axis, INCREMENTS[axis]))

    @cached_property
    def linear_words(self) -> Mask:
        """Per executed word: one of the linear axis of its row."""
        return self._words_of_axis(lambda axis: (axis, INCREMENTS[axis]))

    def _words_of_axis(self, addresses: Callable[[str], Iterable[str]]) -> Mask:
        """Per executed word: of the addresses that the linear axis of its row has."""
        words = np.zeros(len(self.run.words), bool)
        for axis in ("X", *self.other_linear_axes):
            index = self.blocks.word_indices(*addresses(axis))
            words[index[self.linear_axis[self.run.row[index]] == ord(axis)]] = True
        return words

    @cached_property
    def programs_z(self) -> Mask:
        """Has a word of Z, where that is not the linear axis."""
        return np.asarray(self.blocks.has("Z", "W") & (self.linear_axis != ord("Z")))

    def center_words(self, row: int) -> tuple[str, str]:
        """The addresses of arc centers in a row, along the linear and along the virtual axis: I and J with X."""
        return self.center_words_along(chr(self.linear_axis[row]))

    def center_words_along(self, axis: str) -> tuple[str, str]:
        """The addresses of arc centers where this is the linear axis: along it, and along the virtual axis."""
        return self.machine.polar.center_words[cast(LinearAddress, axis)]

    def _other_center_word(self, axis: str) -> str:
        return next(word for word in ("K", "I", "J") if word not in self.center_words_along(axis))

    @cached_property
    def has_center(self) -> Mask:
        """Has a word of the center of an arc on the polar plane."""
        has_center = self.of_linear_axis(lambda axis: self.blocks.has(*self.center_words_along(axis)))
        return has_center | self.makes_corner if self.run.corners is not None else has_center

    @cached_property
    def makes_corner(self) -> Mask:
        """A corner that the control makes between two blocks; it has no words."""
        return self.blocks.nowhere if self.run.corners is None else self.blocks.mask_of(self.run.corners.row)

    @cached_property
    def other_center_word(self) -> Floats:
        """The word of arc centers of the axis that is not of the polar plane, as written; NaN where there is none."""
        return self.of_linear_axis(lambda axis: self.blocks.word(self._other_center_word(axis)))

    @cached_property
    def other_center_words(self) -> Mask:
        """Per executed word: one of those."""
        return self._words_of_axis(self._other_center_word)

    @cached_property
    def _forms(self) -> list[Pair]:
        """The addresses of the virtual axis: of the machine, then those that a word beside G12.1 chooses; each once."""
        mode = self.machine.polar
        of_machine = mode.virtual_axis, mode.virtual_axis_incremental
        return list(dict.fromkeys((of_machine, *mode.virtual_axis_by_word.values())))

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
        form = np.zeros(len(self.run), np.int64)
        for word, pair in self.machine.polar.virtual_axis_by_word.items():
            form[self.switches_on & (self.blocks.word(word[0]) == float(word[1:]))] = self._forms.index(pair)
        names = (
            [axis_of(self.machine.axes, number) for number in self.rotary_number.tolist()] if self._by_number else []
        )
        for number, (name, _) in enumerate(self._by_number, len(self._forms)):
            form[self.switches_on & (np.array(names) == name)] = number
        if not form.any():
            return repeated(np.int64(0), len(self.run))
        return fill_down(form, self.switches_on | self.ends_mode | self.blocks.starts, 0).astype(np.int64)

    def _of_form(self, column: Callable[[Pair], NDArray[Element]]) -> NDArray[Element]:
        """Per row the value of its form, from a column for each form."""
        values = column(self._forms[0])
        for number, pair in enumerate((*self._forms[1:], *self._by_number), 1):
            if (self._form == number).any():
                values = np.where(self._form == number, column(pair), values)
        return values

    def virtual_axis_of(self, row: int) -> str:
        """The address of the virtual axis in a row."""
        return self.virtual_addresses(row)[0]

    def virtual_addresses(self, row: int) -> Pair:
        """The addresses of the virtual axis in a row, absolute and incremental."""
        return [*self._forms, *self._by_number][int(self._form[row])]

    def of_virtual_axis(self, column: Callable[[str], NDArray[Element]]) -> NDArray[Element]:
        """Per row the value of its virtual axis, from a column for each address."""
        return self._of_form(lambda pair: column(pair[0]))

    @cached_property
    def has_virtual_word(self) -> Mask:
        """Has a word of the virtual axis under the address that it has there."""
        return self._of_form(lambda pair: self.blocks.has(*pair))

    @cached_property
    def virtual_pairs(self) -> list[tuple[Pair, Mask]]:
        """
        The addresses under which the virtual axis is written, each with the rows that do so; in no two of them the same
        row.

        A row that names it by the address of another form or control has a finding for that, and means it nevertheless.
        """
        named = np.zeros(len(self.run), bool)
        pairs = []
        for number, pair in enumerate((*self._forms, *self._by_number)):
            rows = (self._form == number) & self.blocks.has(*pair)
            named |= rows
            pairs.append((pair, rows))
        for pair in dict.fromkeys((*self._forms, *self._foreign)):
            rows = self.blocks.has(*pair) & ~named & (self.linear_axis != self.machine.address_number(pair[0]))
            rows &= ~self._moves_itself(pair)
            named |= rows
            pairs.append((pair, rows))
        return pairs

    @cached_property
    def virtual_words(self) -> Rows:
        """The words of the virtual axis, be it under the address of another form or control."""
        if self._by_number:
            words = self.followed_virtual_words
        else:
            words = self.blocks.word_indices(
                *dict.fromkeys(address for pair in (*self._forms, *self._foreign) for address in pair)
            )
        return words[~self.linear_words[words]] if self.other_linear_axes else words

    @property
    def followed_virtual_words(self) -> Rows:
        """Words of the virtual axis that count: if Y and C stand in one block, only the address of the axis there."""
        return np.sort(np.concatenate([self._words_of_pair(pair, rows) for pair, rows in self.virtual_pairs]))

    def _moves_itself(self, pair: Pair) -> Mask:
        """Rows of sections on another rotary axis, in which an axis of the lathe of these addresses moves by itself."""
        is_other = self._form >= len(self._forms)
        return is_other if pair[0] in self.machine.axes else np.zeros(len(self.run), bool)

    def _words_of_pair(self, pair: Pair, rows: Mask) -> Rows:
        index = self.blocks.word_indices(*pair)
        return index[rows[self.run.row[index]]]

    @cached_property
    def foreign_virtual_words(self) -> Mask:
        """Per executed word: of the virtual axis of a simulated mode, under an address of another form or control."""
        is_address_of_row = np.zeros(len(self.run.words), bool)
        for number, pair in enumerate((*self._forms, *self._by_number)):
            index = self.blocks.word_indices(*pair)
            is_address_of_row[index[self._form[self.run.row[index]] == number]] = True
        return self.blocks.words_at(self.virtual_words) & ~is_address_of_row & self.is_simulated[self.run.row]

    @cached_property
    def programs_virtual_axis(self) -> Mask:
        """Has a word of the virtual axis, be it under the address of another form or control."""
        return self.blocks.with_words(self.virtual_words)

    @cached_property
    def words_not_simulated(self) -> Mask:
        """
        Per executed word: beside G12.1, and makes another mode of it, which is not simulated: one that the machine
        names, or one that chooses the virtual axis by a number of which the machine does not say what it means.
        """
        mode = self.machine.polar
        letters = dict.fromkeys(word[0] for word in mode.virtual_axis_by_word)
        changes_mode = self.blocks.words_at(self.blocks.word_indices(*mode.not_simulated_beside)).copy()
        for letter in letters:
            index = self.blocks.word_indices(letter)
            simulated = [float(word[1:]) for word in mode.virtual_axis_by_word if word[0] == letter]
            changes_mode[index[~np.isin(self.run.words.value[index], simulated)]] = True
        return np.asarray(changes_mode & self.switches_on[self.run.row])

    @cached_property
    def is_simulated(self) -> Mask:
        """The effect of the row in the mode is simulated; True outside the mode."""
        ends = self.switches_on | self.ends_mode | self.blocks.starts
        if not (self.words_not_simulated.any() or self.selects_plane_not_simulated.any()):
            return np.ones(len(self.run), bool)
        begins = self.blocks.with_words(self.words_not_simulated)
        is_other_mode = fill_down(begins, ends, False).astype(bool)
        other_plane = self.selects_plane_not_simulated
        return ~(is_other_mode | happened(other_plane, ends | (self.blocks.listed("plane_xy") & ~other_plane)))

    @cached_property
    def selects_plane_not_simulated(self) -> Mask:
        """Rows of the mode that select a plane which is not simulated, as that of a cylinder."""
        selects = self.blocks.codes(*self.machine.polar.planes_not_simulated)
        return selects & happened(self.switches_on, self.ends_mode | self.blocks.starts) if selects.any() else selects

    @cached_property
    def moves_plane(self) -> Mask:
        """Programs the linear or the virtual axis, an arc by its center alone included."""
        is_arc = is_among(self.modal.state("motion"), (Motion.CW, Motion.CCW))
        of_plane = self.has_center & ~self.blocks.with_words(self.other_center_words)
        by_center_alone = is_arc & self.blocks.has("I", "J", "K") & (~self.programs_z | of_plane)
        moves = self.programs_linear_axis | self.programs_virtual_axis | by_center_alone | self.makes_corner
        return self.modal.uses_axes & moves & ~self.switches_on

    @cached_property
    def commands_z(self) -> Mask:
        """Programs Z, where that is not the linear axis, be it the Z at which the tool stands."""
        return self.modal.uses_axes & self.programs_z

    @cached_property
    def motion(self) -> States:
        """The motion of the row's axis words (Motion); NONE without axis words."""
        moves_others = self.modal.uses_axes & self.blocks.has(*self.machine.polar.rotary_words, "Y", "V")
        moving = self.moves_plane | self.commands_z | moves_others
        motion = np.where(self.modal.in_cycle, Motion.CYCLE, self.modal.state("motion"))
        if self.run.corners is not None:
            motion[self.run.corners.row] = self.run.corners.motion
        return np.where(moving, motion, Motion.NONE).astype(np.int16)

    @cached_property
    def at_feed(self) -> Mask:
        """A line or an arc at feed is the motion of the row's axis words."""
        return is_among(self.motion, (Motion.LINE, Motion.CW, Motion.CCW))

    @cached_property
    def moves(self) -> Mask:
        """Moves any axis."""
        return np.asarray(self.motion != Motion.NONE)
