"""Lengths, angles and feeds of words as the other machine counts them: units, diameter or radius, letters."""

from __future__ import annotations

from fractions import Fraction

import msgspec
import numpy as np

from polarcheck.columns.path.lengths import RADIUS_FACTOR
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Distance, Units
from polarcheck.program.machines.axis_table import INCREMENTS
from polarcheck.program.machines.code_tables import code_numbers
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.block_texts import with_name
from polarcheck.rewrite.convert.doubtful_values import Basis
from polarcheck.rewrite.convert.number_text import number_of, rescaled, rounded
from polarcheck.rewrite.writing.outcome import refused_at
from polarcheck.rewrite.writing.unknown_moves import UnknownMoves
from polarcheck.rules.editing import words_behind_head

_MM_PER_INCH = Fraction(254, 10)
#: To which F in other units is rounded.
_FEED_STEP = Fraction(1, 10000)
#: Python converts no longer ones; no control reads as many.
_LONGEST = 1000


class AxisWord(msgspec.Struct, frozen=True):
    """
    A word that names a place on an axis, or a distance along it.

    index: of the executed word. axis: X, Y, Z, or C for the rotary axis of the polar mode. is_step: it is a distance.
    """

    index: int
    axis: str
    is_step: bool


class Measures:
    """
    The words of one machine that count lengths and angles, as those of another.

    basis: on which keys of the profiles their changed numbers rest.
    """

    def __init__(self, trace: Trace, target: Machine) -> None:
        self.trace, self.source, self.target = trace, trace.machine, target
        self.basis = Basis()
        rotary, step = self.source.polar.rotary_words
        self._axes = {**{axis: (axis, False) for axis in INCREMENTS}, rotary: ("C", False)}
        if self.source.control.g_code_system == "A":
            self._axes |= {letter: (axis, True) for axis, letter in INCREMENTS.items()}
            if step:
                self._axes[step] = ("C", True)
        self._letters = {
            self.source.address_number(letter): of_axis for letter, of_axis in self._axes.items() if letter
        }
        self._codes = {unit: bool(target.codes(unit)) for unit in ("inch", "mm")}
        self._c_ratio = Fraction(self.source.polar.c_sense * target.polar.c_sense)
        #: Radius and diameter are switched as on the other machine.
        self.same_x_switches = all(
            getattr(self.source.control, key) == getattr(target.control, key)
            for key in ("x", "x_radius_words", "x_diameter_words", "x_absolute_diameter_words", "x_without_words")
        )
        #: Both controls read a number without a point alike.
        self.unknown_moves = UnknownMoves(trace)
        letters = {"X": "X", "Z": "Z", "C": rotary}
        self._lost = {axis: self.unknown_moves.lost(letter) for axis, letter in letters.items()}
        self.pointless_is_same = self.source.control.number_without_point == target.control.number_without_point

    # ---- units ----

    def writes_inch(self, row: int) -> bool:
        """The lengths of a row are written in inch."""
        is_inch = bool(self.trace.lengths.units[row] == Units.INCH)
        is_usual = (self.target.control.units == "inch") == is_inch
        return is_inch if is_usual or self._codes["inch" if is_inch else "mm"] else not is_inch

    def unit_ratio(self, row: int, of_feed: bool = False) -> Fraction:
        """Return the factor from a length, or F, of a row to the units of the new program."""
        units = self.trace.lengths.feed_units if of_feed else self.trace.lengths.units
        ratio = _MM_PER_INCH if units[row] == Units.INCH else Fraction(1)
        ratio = ratio / _MM_PER_INCH if self.writes_inch(row) else ratio
        if ratio != 1:
            self.basis.add("control.units", row)
        return ratio

    def least(self, row: int) -> Fraction:
        """The least increment of lengths that the new program writes in a row, in its units."""
        control = self.target.control
        return fraction(control.least_increment_inch if self.writes_inch(row) else control.least_increment)

    def least_read(self, row: int) -> Fraction:
        """The least increment of lengths that the original counts in a row, in its units."""
        return fraction(float(self.trace.lengths.least_increment[row]))

    # ---- what a word is ----

    def words_of(self, row: int) -> list[int]:
        """The executed words of a row without N, O and block skip, in the order in which they are written."""
        return words_behind_head(self.trace.run, row)

    def letter_of(self, index: int) -> str:
        """The letter of an executed word; empty for a name."""
        number = int(self.trace.run.words.address[index])
        return chr(number) if number < 128 else ""

    def code_of(self, index: int) -> int:
        """A G or M word as a whole number (codes.code)."""
        return int(code_numbers(self.trace.run.words.value[index : index + 1])[0])

    def axis_word(self, row: int, index: int) -> AxisWord | None:
        """A word as one of an axis; None where it is none that both machines have."""
        number = int(self.trace.run.words.address[index])
        if number not in self._letters or (number == ord("H") and self.trace.blocks.numbers_by_h[row]):
            return None
        axis, is_step = self._letters[number]
        distance = self.trace.run.distance
        says = int(distance[index]) if distance is not None else 0
        if says:
            is_step = says == Distance.INCREMENTAL
        elif not is_step:
            is_step = bool(self.trace.modal.incremental[row])
        return AxisWord(index, axis, is_step)

    def letter(self, axis: str, is_step: bool) -> str:
        """The address of an axis on the other machine; empty where it has none for distances."""
        rotary, step = self.target.polar.rotary_words
        if is_step:
            return step if axis == "C" else INCREMENTS[axis]
        return rotary if axis == "C" else axis

    def ratio(self, row: int, word: AxisWord) -> Fraction:
        """What the number of a word is multiplied by."""
        number = number_of(self.written(word.index))
        is_zero = number is not None and not Fraction(number)
        if word.axis == "C":
            if self._c_ratio != 1 and not is_zero:
                self.basis.add("polar.zero_angle", row)
            return self._c_ratio
        ratio, of_x = self.unit_ratio(row), self.x_ratio(row, word.is_step) if word.axis == "X" else Fraction(1)
        if of_x != 1 and not is_zero:
            self.basis.add("control.x", row)
        return ratio * of_x

    def x_ratio(self, row: int, is_step: bool = False) -> Fraction:
        """What X outside of the mode is multiplied by where one machine counts a radius."""
        if self.same_x_switches:
            return Fraction(1)
        steps = self.trace.lengths.x_step_factor
        factor = (steps if is_step and steps is not None else self.trace.lengths.x_factor)[row]
        return fraction(float(factor)) / fraction(RADIUS_FACTOR[self.target.control.x])

    # ---- numbers ----

    def number(self, row: int, index: int, ratio: Fraction, is_angle: bool = False) -> str | None:
        """The number of a word multiplied by a ratio, as the other machine reads it; None where it is computed."""
        written = number_of(self.trace.text.source.excerpt(*self.span(index)))
        if written is None:
            return None
        if len(written) > _LONGEST:
            raise refused_at(self.trace, row, f"a number of {len(written)} characters is no coordinate")
        is_zero = not Fraction(written)
        same_reading = "." in written or is_zero or self.pointless_is_same
        if ratio == 1 and same_reading:
            return written
        coordinates = self.trace.coordinates
        if bool(coordinates.is_unpointed[index]) and not bool(coordinates.is_taken_as_pointed[index]):
            ratio *= fraction(self.source.control.least_increment) if is_angle else self.least_read(row)
            self.basis.add("control.number_without_point", row)
        least = fraction(self.target.control.least_increment) if is_angle else self.least(row)
        return rescaled(written, ratio, least, self.target.control.number_without_point == "least-increment")

    def feed(self, index: int, ratio: Fraction) -> str | None:
        """F in other units of length; None where it is computed, or no number that a control has."""
        number = number_of(self.written(index))
        return (
            None if number is None or len(number) > _LONGEST else rescaled(number, ratio, _FEED_STEP, needs_point=True)
        )

    def with_feed_point(self, number: str) -> str:
        """The number of an F with a point, where the other machine may count parts of a unit without one."""
        return f"{number}." if number.isdigit() and self.target.writing.feed_point else number

    def place(self, row: int, axis: str) -> str | None:
        """Where an axis stands at the end of a row, as the other machine reads it; None where that is not known."""
        path = self.trace.path
        if axis == "C":
            value, ratio = float(path.c_angle[row]), self._c_ratio
            if ratio != 1 and value and value == value:
                self.basis.add("polar.zero_angle", row)
        else:
            value = float(path.x[row] if axis == "X" else path.z[row]) if axis in "XZ" else np.nan
            ratio = 1 / _MM_PER_INCH if self.writes_inch(row) else Fraction(1)
            if axis == "X":
                ratio /= fraction(RADIUS_FACTOR[self.target.control.x])
                if self.x_ratio(row) != 1 and value and value == value:
                    self.basis.add("control.x", row)
        if np.isnan(value) or self.is_lost(row, axis):
            return None
        least = fraction(self.target.control.least_increment) if axis == "C" else self.least(row)
        has_point = self.target.control.number_without_point == "least-increment"
        return rounded(Fraction(value) * ratio, least, has_point=has_point)

    def is_lost(self, row: int, axis: str) -> bool:
        """Nobody knows where an axis stands before a row, behind a block that somebody has to decide."""
        return axis in self._lost and bool(self._lost[axis][row])

    def span(self, index: int) -> tuple[int, int]:
        """The characters of an executed word."""
        return int(self.trace.run.words.start[index]), int(self.trace.run.words.end[index])

    def written(self, index: int) -> str:
        """An executed word as it is written, without blanks."""
        return "".join(self.trace.text.source.excerpt(*self.span(index)).split())

    def named(self, index: int) -> str:
        """The same with all letters of its name."""
        (start, end), run = self.span(index), self.trace.run
        block = int(run.block[int(run.row[index])])
        return "".join(self.trace.text.source.excerpt(with_name(self.trace.text, block, start), end).split())


def fraction(value: float) -> Fraction:
    """A value of a profile as the fraction that was written."""
    return Fraction(repr(value)) if not value.is_integer() else Fraction(int(value))
