"""The lengths of each executed block in mm: units in force, and X as a diameter or a radius."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import fill_down, happened
from polarcheck.columns.lookups import Lookups
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.coordinates import Coordinates
from polarcheck.foundation.arrays import Floats, Points, Rows, States, cached_property, computed, folded, is_repeated
from polarcheck.foundation.states import MM_PER_INCH, Units
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.code_lists import numbers
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine

#: Radius per length along an axis.
RADIUS_FACTOR = {"diameter": 0.5, "radius": 1.0}
#: Nobody means a coarser digit than this many least increments: X20. is 20, and no number between 19.5 and 20.5.
_COARSEST = 10
#: Least and greatest distance that counts as the same place [mm], in halves of the last digit.
_SAME, _SAME_AT_MOST, _DIGITS = 0.005, 0.03, 5


def same_place(half_of_digit: complex) -> float:
    """How far two points may be apart that are the same place [mm]. half_of_digit: of X and the virtual axis [mm]."""
    return float(np.clip(_DIGITS * abs(half_of_digit), _SAME, _SAME_AT_MOST))


def _scale(units: States) -> Floats:
    """mm per unit of length."""
    return computed(lambda units: np.where(units == Units.INCH, MM_PER_INCH, 1.0), units)


class Lengths(Lookups, frozen=True):
    """
    Words as lengths. The units in force and those written differ where a section refuses a code of units.
    """

    run: Run
    machine: Machine
    job: Job
    blocks: ExecutedBlocks
    modal: ModalStates
    coordinates: Coordinates
    axes: PlaneAxes
    mode: PolarMode

    @cached_property
    def units(self) -> States:
        """
        Units.INCH or Units.MM in force: those written, but for a code that cannot stand in the mode. That has a
        finding, and changes none: with it the contour would be another.
        """
        written = self.modal.written_units
        allowed = set(numbers(self.machine.polar.allowed_codes))
        codes = [code for key in ("inch", "mm") for code in self.machine.codes(key)]
        not_allowed = [code for code in codes if not allowed.issuperset(numbers([code]))]
        refused = self.blocks.codes(*not_allowed) & self.mode.in_polar
        if not refused.any():
            return written
        in_force = self.modal.sets("units") & ~refused
        return fill_down(written, in_force | self.blocks.starts, written[0])

    @cached_property
    def scale(self) -> Floats:
        """mm per unit of length."""
        return _scale(self.units)

    @cached_property
    def feed_units(self) -> States:
        """Units.INCH or Units.MM of F: those in force, or those of the lathe where the code of units leaves F alone."""
        codes = self.machine.control.units_of_lengths_alone
        alone = self.blocks.codes(*codes) if codes else None
        if alone is None or not alone.any():
            return self.units
        basic = Units.INCH if (self.job.program_units or self.machine.control.units) == "inch" else Units.MM
        changes = self.modal.sets("units") & (self.units == self.modal.written_units)
        is_alone = fill_down(alone, changes | self.blocks.starts, False).astype(bool)
        return np.where(is_alone, basic, self.units).astype(np.int16)

    @cached_property
    def feed_scale(self) -> Floats:
        """mm per unit of length that F counts."""
        return self.scale if self.feed_units is self.units else _scale(self.feed_units)

    @cached_property
    def job_scale(self) -> Floats | float:
        """mm per unit of the lengths of the job."""
        return {"mm": 1.0, "inch": MM_PER_INCH}[self.job.units] if self.job.units else self.scale

    @property
    def stock_diameter(self) -> Floats:
        """Diameter of the stock [mm]; NaN where the job gives none."""
        return np.broadcast_to(self.job.stock.diameter * self.job_scale, len(self.run))

    @cached_property
    def least_increment(self) -> Floats:
        """Per row: least input increment of lengths, in the units in force [mm or inch]."""
        least, of_inch = self.machine.control.least_increment, self.machine.control.least_increment_inch
        return computed(lambda units: np.where(units == Units.INCH, of_inch, least), self.units)

    @cached_property
    def least_step(self) -> Floats:
        """Per row: the same [mm]."""
        return computed(np.multiply, self.least_increment, self.scale)

    @cached_property
    def _lengths(self) -> Floats:
        least = self.least_increment
        return self.coordinates.meant(least[0] if is_repeated(least) else least[self.run.row])

    def length_of(self, address: str) -> Floats:
        """A word as a length [mm], as written: a diameter stays one."""
        return self._column(f"length {address}", lambda: self._length_of(address))

    def _length_of(self, address: str) -> Floats:
        if self._lengths is self.run.words.value:
            lengths = self.blocks.word(address)
        else:
            lengths = self.blocks.in_rows(address, self._lengths)
        is_in_mm = is_repeated(self.scale) and self.scale[0] == 1.0
        return lengths if is_in_mm or not len(self.blocks.word_indices(address)) else lengths * self.scale

    @cached_property
    def x_factor(self) -> Floats:
        """Radius per written X, or other linear axis of the polar plane: a half where X is a diameter."""
        control = self.machine.control
        factor = np.where(self.mode.section >= 0, RADIUS_FACTOR[self.machine.polar.x], RADIUS_FACTOR[control.x])
        factor[self.axes.linear_axis != ord("X")] = 1.0
        if not (control.x_radius_words or control.x_diameter_words or control.x_absolute_diameter_words):
            return factor
        radius = self.blocks.codes(*control.x_radius_words)
        diameter = self.blocks.codes(*control.x_diameter_words, *control.x_absolute_diameter_words)
        if control.x_without_words:
            has_none = ~self.blocks.anywhere_in_program(radius | diameter) & (self.mode.section < 0)
            factor = np.where(has_none, RADIUS_FACTOR[control.x_without_words], factor)
        switched = radius | diameter | self.blocks.starts
        if set(self.machine.polar.off) & set(control.x_diameter_words):
            # The mode has an X of its own, up to where it was meant to end.
            switched |= self.mode.enters | self.blocks.mask_of(self.mode.sections.leave)
        chosen = fill_down(np.where(radius, 1.0, np.where(diameter, 0.5, np.nan)), switched, np.nan)
        return np.asarray(np.where(np.isnan(chosen), factor, chosen), np.float64)

    @cached_property
    def x_step_factor(self) -> Floats | None:
        """The same of X as a distance, where words make a diameter of the coordinate alone, as DIAM90; else None."""
        control = self.machine.control
        both = self.blocks.codes(*control.x_absolute_diameter_words)
        if not both.any():
            return None
        lasting = self.blocks.codes(*control.x_radius_words, *control.x_diameter_words)
        return np.where(happened(both, lasting | self.blocks.starts), 1.0, self.x_factor)

    def half_of_last_digit(self, rows: Rows) -> Points:
        """
        Half of the last digit in X, as a radius, and in the virtual axis, in these rows [mm]; NaN outside of sections.

        It is that of the number with the most decimals in the section, since posts leave out zeros at the end. Numbers
        without any are taken as exact to the least increment.
        """
        section, least = self.mode.section[rows], self.least_increment[rows]
        x, virtual = (
            np.where((decimals > 0)[section], np.minimum((10.0**-decimals)[section], _COARSEST * least), least)
            for decimals in self._decimals
        )
        half = (x * self.x_factor[rows] + 1j * virtual) * self.scale[rows] / 2
        return np.where(section >= 0, half, complex("nan+nanj"))

    @cached_property
    def _decimals(self) -> tuple[Rows, ...]:
        """Per section, and outside of all, the most decimals of X and of the virtual axis."""
        return self._most_decimals(self.blocks.word_indices("X", "U")), self._most_decimals(self.axes.virtual_words)

    def _most_decimals(self, words: Rows) -> Rows:
        section = self.mode.section[self.run.row[words]]
        own = np.where(section >= 0, self.run.words.decimals[words], 0)
        return folded(np.maximum, section, own, len(self.mode.sections) + 1, 0)
