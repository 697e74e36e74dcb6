"""
The linear axis of the polar plane: which axis it is, and the words of arc centers that follow it.

X on nearly every lathe. Parameter 5460, P beside G12.1 and, on Mitsubishi, parameter 1533 name another one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cached_property
from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Floats, Mask, Points, States, computed, different, is_among, repeated
from polarcheck.geometry import polar
from polarcheck.machines.axes import AXES, INCREMENTS, numbers_of
from polarcheck.machines.modal import Distance
from polarcheck.machines.polar_keys import LinearAddress
from polarcheck.machines.values import MOST_AXES
from polarcheck.table.filling import fill_down, happened
from polarcheck.table.lengths import Lengths

_X = ord("X")
_UNKNOWN = 0
#: So that a quarter of a turn is one.
_DIGITS = 15

Element = TypeVar("Element", bound=np.generic)


class LinearAxis(Lengths):
    """The columns of the linear axis; see the properties."""

    @cached_property
    def switches_on(self) -> Mask:
        """G12.1; none of a code that means something else beside axis words."""
        mode = self.machine.polar
        elsewhere = [name for name in mode.on if name in mode.on_of_other_meaning]
        found = self.codes(*mode.on)
        return found & ~(self.codes(*elsewhere) & self.has(*AXES)) if elsewhere else found

    @cached_property
    def switches_off(self) -> Mask:
        """G13.1."""
        return self.codes(*self.machine.polar.off)

    @cached_property
    def ends_mode(self) -> Mask:
        """G13.1, or what ends the mode beside what it does elsewhere: the code of another plane."""
        mode = self.machine.polar
        return self.switches_off | self.codes(*mode.ended_by) if mode.ended_by else self.switches_off

    @cached_property
    def incremental(self) -> Mask:
        """G91 in systems B and C."""
        return np.asarray(self.state("distance") == Distance.INCREMENTAL)

    def is_step(self, address: str) -> Mask:
        """Whether the word of an address is a distance, by G91 or as the word itself says: X=IC(10)."""
        own = self.distance(address)
        return self.incremental if own is None else np.where(own, own == Distance.INCREMENTAL, self.incremental)

    @cached_property
    def c_direction(self) -> Points:
        """
        Where the tool stands on the polar plane in the row of a switch, X being positive, as a number of length 1.

        1, on the linear axis, where C turns the plane with it, where C is not known, and along another axis than X.
        """
        if self.machine.polar.zero_angle == "at-switch" or not self.switches_on.any():
            return repeated(np.complex128(1), len(self))
        axis, words = self.machine.polar.rotary_address, self.machine.polar.rotary_words
        referenced = self.listed("c_axis_reference") & self.has(*words)
        positioned = self.has(axis) & self.uses_axes & ~self.is_step(axis)
        angle = np.where(referenced, 0.0, np.where(positioned, self.angle_of(axis), np.nan))
        angle = fill_down(angle, self.has(*words) | self.ends_mode | self.run.unknown | self.starts, np.nan)
        angle = np.where(self.linear_axis == _X, np.nan_to_num(angle), 0.0)
        sense = -1 if self.machine.polar.zero_angle == "at-c0-reversed" else 1
        return np.round(polar.to_plane(np.ones(len(self)), sense * angle, 0.0), _DIGITS)

    @cached_property
    def kept_angle(self) -> Floats:
        """
        How far C stands from where the linear axis of the plane points in the row of a switch [deg].

        0 on its negative side, too, where a section begins with C as it is (polar.c_angles).
        """
        return computed(
            lambda direction: np.where(direction.imag == 0, 0.0, np.degrees(np.angle(direction))), self.c_direction
        )

    @cached_property
    def on_sub_spindle(self) -> Mask:
        """The C axis is that of the sub-spindle, by the last code that says so."""
        codes, main = self.machine.m_codes, [*self.machine.m_codes.sub_c_axis_off, *self.machine.m_codes.c_axis_on]
        engaged = happened(self.codes(*codes.sub_c_axis_on), self.codes(*main) | self.starts)
        return engaged | happened(self.listed("sub_spindle"), self.listed("sub_spindle_off") | self.starts)

    @cached_property
    def enters_other_axes(self) -> Mask:
        """Rows that switch the mode on for a spindle whose axes are not followed, and where no own one follows."""
        mode = self.machine.polar
        enters = self.switches_on & self.on_sub_spindle & (mode.sub_spindle_plane == "not-followed")
        if not enters.any():
            return enters
        stretch = np.cumsum(self.switches_on | self.ends_mode | self.starts)
        has_own = np.zeros(int(stretch[-1]) + 1, bool)
        has_own[stretch[self.has(mode.virtual_axis)]] = True
        return enters & ~has_own[stretch]

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
            computed(lambda word, own=own: np.where(np.isnan(word), float(own), word), word)
            for word, own in ((self.word("P"), mode.linear_axis), (self.word("Q"), mode.rotary_axis))
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
        other = self.enters_other_axes
        if set(addresses.values()) <= {"X"} and not other.any():
            return repeated(np.int16(_X), len(self))
        axis = np.full(len(self), _X, np.int16)
        for number, address in addresses.items():
            axis[self.switches_on & (self.linear_number == number)] = ord(address) if address else _UNKNOWN
        axis[other] = _UNKNOWN
        return fill_down(axis, self.switches_on | self.ends_mode | self.starts, _X)

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

    def _of_axis(self, column: Callable[[str], NDArray[Element]]) -> NDArray[Element]:
        """Of a column for each axis the values of the linear axis of each row."""
        found = column("X")
        for axis in self.other_linear_axes:
            found = np.where(self.linear_axis == ord(axis), column(axis), found)
        return found

    @cached_property
    def programs_linear_axis(self) -> Mask:
        """Has a word of the linear axis."""
        return self._of_axis(lambda axis: self.has(axis, INCREMENTS[axis]))

    @cached_property
    def linear_words(self) -> Mask:
        """Per executed word: one of the linear axis of its row."""
        return self._words_of_axis(lambda axis: (axis, INCREMENTS[axis]))

    def _words_of_axis(self, addresses: Callable[[str], Iterable[str]]) -> Mask:
        """Per executed word: of the addresses that the linear axis of its row has."""
        words = np.zeros(len(self.run.words), bool)
        for axis in ("X", *self.other_linear_axes):
            at = self.word_indices(*addresses(axis))
            words[at[self.linear_axis[self.run.row[at]] == ord(axis)]] = True
        return words

    @cached_property
    def programs_z(self) -> Mask:
        """Has a word of Z, where that is not the linear axis."""
        return np.asarray(self.has("Z", "W") & (self.linear_axis != ord("Z")))

    # ---- words of arc centers ----

    def center_words(self, row: int) -> tuple[str, str]:
        """The addresses of arc centers in a row, along the linear and along the virtual axis: I and J with X."""
        return self._center_words(chr(self.linear_axis[row]))

    def _center_words(self, axis: str) -> tuple[str, str]:
        return self.machine.polar.center_words[cast(LinearAddress, axis)]

    def _other_center_word(self, axis: str) -> str:
        return next(word for word in ("K", "I", "J") if word not in self._center_words(axis))

    @cached_property
    def has_center(self) -> Mask:
        """Has a word of the center of an arc on the polar plane."""
        return self._of_axis(lambda axis: self.has(*self._center_words(axis)))

    @cached_property
    def to_center(self) -> tuple[Floats, Floats]:
        """The words of the center of an arc along the linear and the virtual axis [mm]; NaN where not written."""
        along, across = (
            self._of_axis(lambda axis, at=at: self.length_of(self._center_words(axis)[at]))  # type: ignore[misc]
            for at in (0, 1)
        )
        return along, across

    @cached_property
    def other_center_word(self) -> Floats:
        """The word of arc centers of the axis that is not of the polar plane, as written; NaN where there is none."""
        return self._of_axis(lambda axis: self.word(self._other_center_word(axis)))

    @cached_property
    def other_center_words(self) -> Mask:
        """Per executed word: one of those."""
        return self._words_of_axis(self._other_center_word)
