"""
The unit of length that the sizes of a program imply, where it is another than the one in force.

No single size tells the unit: a program of small parts is no program in inches. A lathe, a cutter and a bar have sizes
of their own, though, and several of them that fit in the other unit alone are no chance.
"""

from __future__ import annotations

import numpy as np

from polarcheck.columns.modes.entry import Entry
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, column_at, folded
from polarcheck.foundation.states import MM_PER_INCH, FeedMode, Units
from polarcheck.geometry.tolerances import ROUNDING

#: Ratios of lengths that differ by less than this share are equal.
_SAME_SHARE = 0.02
#: Contours reach this many times R from the center at most, or R lies wholly inside of them.
_MOST_RADII = 60.0
#: A program in inches comes out to its bar with some X, and no X is so many times the bar; nor is a contour in mm.
_LEAST_OF_BAR, _MOST_OF_BAR = 0.9, 8.0
#: All X of a program in inches [in]; X of contours in inches [mm]: a lathe with a C axis turns no larger ones.
_SMALL_X, _LARGE_X = 12.0, 500.0
#: F of mills in inches [in/min], as its number; F of mills in mm [mm/min].
_SMALL_FEED, _FAST_IN_INCH = 20.0, 100.0
_LARGE_FEED, _FAST_IN_MM = 40.0, 400.0
#: Coordinates in mm have fewer digits behind the point, but for a few.
_FINE = 4
_FEW = 2
#: Sizes that must speak for the other unit: more where the program itself selects the one in force.
_ENOUGH, _ENOUGH_AGAINST_CODE = 2, 3


class ImpliedUnits(Columns, frozen=True):
    """
    Columns of one trace: what each size says of its program, a value per executed block, which its program shares.

    A size is a witness where it fits in the other unit and not in the one in force. Only sizes whose own unit does not
    hang on that of the program are compared: those of a job with `units`, and of a lathe.
    """

    trace: Trace
    entry: Entry

    @cached_property
    def is_other(self) -> Mask:
        """The first block of each program whose sizes say that its unit is the other one."""
        trace = self.trace
        if not len(trace.mode.sections):
            return trace.blocks.nowhere
        # Numbers alone say nothing: a lathe that powers up in the other unit reads them as they are meant.
        of_bodies = np.stack((self.by_cutter, self.by_comment, self.by_bar)).sum(axis=0)
        says = self._is_judged & (of_bodies > 0)
        if not says.any():
            return trace.blocks.nowhere
        of_numbers = np.stack((self.by_digits, self.by_feed, self.by_x)).sum(axis=0)
        # F and X of a small part in mm are those of inches; nothing else is.
        is_small = np.stack((self.by_feed, self.by_x & ~self.in_inch)).sum(axis=0)
        is_selected = trace.blocks.anywhere_in_program(trace.modal.sets("units"))
        count = of_bodies + of_numbers
        enough = np.where(
            is_selected, (count >= _ENOUGH_AGAINST_CODE) & (count - is_small >= _ENOUGH), count >= _ENOUGH
        )
        return np.asarray(says & enough & self._is_first)

    @cached_property
    def _is_first(self) -> Mask:
        """The row that selects the unit in force, else the first of the program that writes a G code or a length."""
        trace = self.trace
        selects = trace.modal.sets("units")
        writes = trace.blocks.has("G", "X", "Z", "U", "W", "C", "H")
        has_code = trace.blocks.anywhere_in_program(selects)
        rows = np.flatnonzero(np.where(has_code, selects, writes))
        first = rows[np.unique(trace.blocks.program[rows], return_index=True)[1]]
        return trace.blocks.mask_of(first)

    @cached_property
    def in_inch(self) -> Mask:
        """Inches are in force at the first section of the program."""
        return self._of_first_section(self.trace.lengths.units == Units.INCH)

    @cached_property
    def _is_judged(self) -> Mask:
        """Rows of programs with sections, all in one unit, which nothing that is not known may have changed."""
        trace = self.trace
        inside = trace.mode.in_polar
        mixed = inside & ((trace.lengths.units == Units.INCH) != self.in_inch)
        open_state = inside & (trace.modal.is_unknown | trace.run.unknown)
        return np.asarray(
            trace.blocks.anywhere_in_program(inside) & ~trace.blocks.anywhere_in_program(mixed | open_state)
        )

    # ---- bodies: what has a size of its own ----

    @cached_property
    def by_cutter(self) -> Mask:
        """Every compensated contour lies within R of the center, or farther out than any cutter mills."""
        trace = self.trace
        radius = np.abs(trace.offsets.radius_of_offset)
        rows = trace.mode.in_polar & trace.compensation.compensates & (radius > ROUNDING) & self._radius_is_of_job
        ratio = self._reach / np.where(rows, radius, 1.0)
        nearest, farthest = self._extremes(ratio, rows)
        is_small = farthest < 1
        is_large = (nearest > _MOST_RADII) & ~np.isinf(nearest)
        return np.where(self.in_inch, is_large, is_small & (farthest > 1 / MM_PER_INCH))

    @property
    def _radius_is_of_job(self) -> Mask:
        """R of the offset in force is that of a job that says its unit."""
        offsets = self.trace.offsets
        return np.asarray(
            (offsets.radius_set_in < 0) & ~offsets.radius_is_from_comment & (self.trace.job.units is not None)
        )

    @property
    def _reach(self) -> Floats:
        """How far from the center the moves of each section go [mm]."""
        trace = self.trace
        distance = np.where(trace.mode.in_polar, np.abs(trace.path.end), 0.0)
        farthest = folded(np.fmax, trace.mode.section, distance, len(trace.mode.sections) + 1, 0.0)
        return np.asarray(farthest[trace.mode.section])

    @cached_property
    def by_comment(self) -> Mask:
        """A comment states R of a cutter as a number that is that of its offset in the other unit."""
        ratio = np.abs(self.entry.radius_in_mode) / self.entry.radius_told
        factor = np.where(self.in_inch, 1 / MM_PER_INCH, MM_PER_INCH)
        return self.trace.blocks.anywhere_in_program(np.abs(ratio / factor - 1) < _SAME_SHARE)

    @cached_property
    def by_bar(self) -> Mask:
        """No X comes near the bar, or every section goes far beyond it."""
        trace = self.trace
        if trace.job.units is None or np.isnan(trace.job.stock.diameter):
            return trace.blocks.nowhere
        bar = trace.lengths.stock_diameter
        _, farthest = self._extremes(self._x / bar * MM_PER_INCH, self._writes_x)
        nearest, _ = self._extremes(2 * self._reach / bar, trace.mode.in_polar)
        is_small = (farthest > _LEAST_OF_BAR) & (farthest < _MOST_OF_BAR)
        return np.where(self.in_inch, (nearest > _MOST_OF_BAR) & ~np.isinf(nearest), is_small)

    # ---- numbers: what programs of a unit are written with ----

    @cached_property
    def by_digits(self) -> Mask:
        """Coordinates in mm with more digits than the control has."""
        trace, words = self.trace, self.trace.run.words
        is_fine = trace.coordinates.is_coordinate & words.has_point & (words.decimals >= _FINE) & (words.value != 0)
        is_fine &= np.abs(words.value * 1000 - np.rint(words.value * 1000)) > ROUNDING
        count = np.bincount(trace.blocks.program[trace.run.row[is_fine]], minlength=self._program_count)
        return np.asarray((count > _FEW)[trace.blocks.program] & ~self.in_inch)

    @cached_property
    def by_feed(self) -> Mask:
        """Every F per minute of the sections is usual in the other unit alone."""
        trace = self.trace
        feed = trace.feedrate.feed_number / trace.lengths.feed_scale
        rows = trace.path.cuts & trace.mode.in_polar & ~np.isnan(feed)
        rows &= trace.feedrate.modal_feed_mode != FeedMode.PER_REVOLUTION
        least, most = self._extremes(feed, rows)
        is_small = (least < _SMALL_FEED) & (most <= _FAST_IN_INCH)
        is_large = (least >= _LARGE_FEED) & (most >= _FAST_IN_MM) & ~np.isinf(most)
        return np.where(self.in_inch, is_large, is_small & (most > 0))

    @cached_property
    def by_x(self) -> Mask:
        """No X of the program is larger than inches are on a lathe, or X of a section is larger than any in inches."""
        _, most = self._extremes(self._x, self._writes_x)
        _, most_inside = self._extremes(self._x, self._writes_x & self.trace.mode.in_polar)
        return np.where(self.in_inch, most_inside >= _LARGE_X, (most > 0) & (most <= _SMALL_X))

    # ---- columns ----

    @property
    def _x(self) -> Floats:
        """X as it is written [mm], without its sign."""
        return np.abs(self.trace.lengths.length_of("X"))

    @property
    def _writes_x(self) -> Mask:
        return self.trace.blocks.has("X") & ~np.isnan(self._x)

    @property
    def _program_count(self) -> int:
        return int(self.trace.blocks.program[-1]) + 1

    def _extremes(self, values: Floats, rows: Mask) -> tuple[Floats, Floats]:
        """The least and the largest of the values of some rows of each program, per row; inf and 0 without any."""
        program = self.trace.blocks.program
        least, most = np.full(self._program_count, np.inf), np.zeros(self._program_count)
        np.minimum.at(least, program[rows], values[rows])
        np.maximum.at(most, program[rows], values[rows])
        return least[program], most[program]

    def _of_first_section(self, column: Mask) -> Mask:
        """The value of a column at the first G12.1 of each program, for its rows."""
        trace = self.trace
        rows: Rows = trace.mode.sections.enter
        programs, first = np.unique(trace.blocks.program[rows], return_index=True)
        of_program = column_at(self._program_count, programs, column[rows[first]], False)
        return np.asarray(of_program[trace.blocks.program])
