"""Words of the virtual axis that look like angles, though the polar mode takes lengths."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.columns.words.series import Series, find_series
from polarcheck.foundation.arrays import Columns, Floats, Mask, cached_property, repeated
from polarcheck.foundation.states import Motion
from polarcheck.program.machines.codes import code_set

#: What is written where C turns by an angle [deg].
_USUAL = np.array([30, 45, 60, 90, 120, 135, 150, 180, 210, 225, 240, 270, 300, 315, 330, 360], np.float64)


class Angles(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace

    @cached_property
    def _written(self) -> Floats:
        """Value of the virtual axis as written in the mode, else NaN."""
        trace = self.trace
        return np.where(
            trace.mode.in_polar & trace.modal.uses_axes, trace.axes.of_virtual_axis(trace.blocks.word), np.nan
        )

    @cached_property
    def is_usual(self) -> Mask:
        """The virtual axis has the number of a usual angle in the mode, of either sign."""
        size = np.abs(self._written)
        whole = np.flatnonzero(size == np.rint(size))
        found = np.zeros(len(size), bool)
        # NumPy's isin would load its masked arrays for doubles.
        found[whole] = _USUAL[np.searchsorted(_USUAL, size[whole]) % len(_USUAL)] == size[whole]
        return found

    @cached_property
    def has_both_signs(self) -> Mask:
        """A usual angle that the section has with the other sign too, as lengths of a symmetrical contour are."""
        rows = np.flatnonzero(self.is_usual)
        value, section = self._written[rows], self.trace.mode.section[rows]
        which = np.searchsorted(_USUAL, np.abs(value))
        seen = np.zeros((2, len(self.trace.mode.sections), len(_USUAL)), bool)
        seen[(value < 0).astype(int), section, which] = True
        both = np.zeros(len(self.trace), bool)
        both[rows] = (seen[0] & seen[1])[section, which]
        return both

    @cached_property
    def series(self) -> Series:
        """Moves of the virtual axis in one direction, one after another."""
        return find_series(self.trace)

    @cached_property
    def in_series(self) -> Mask:
        """In a series that goes steadily to a turn, or to half of one, while X stays where it is."""
        if not self.series.is_angle.any():
            return np.zeros(len(self.trace), bool)
        return np.asarray(self.series.in_rows(self.series.is_angle.astype(np.float64), len(self.trace)) == 1.0)

    @cached_property
    def is_positioning(self) -> Mask:
        """G0 to a usual angle of the virtual axis: the approach of a contour, meant before G12.1."""
        return np.asarray(self.is_usual & (self.trace.axes.motion == Motion.RAPID))

    @cached_property
    def virtual_length(self) -> Floats:
        """The virtual axis as a length [mm], without its sign; NaN where it is not written."""
        return np.abs(self.trace.axes.of_virtual_axis(self.trace.lengths.length_of))

    @cached_property
    def farthest(self) -> Floats:
        """How far the row goes, or the series that it belongs to, as a length of the virtual axis [mm]."""
        if not self.in_series.any():
            return self.virtual_length
        ends = np.abs(self.series.in_rows(self.series.end, len(self.trace))) * self.trace.lengths.scale
        return np.where(self.in_series, ends, self.virtual_length)

    @cached_property
    def reach(self) -> Floats:
        """
        How far the section lies from the center without what may be angles [mm].

        NaN outside sections, and in those in which nothing may be an angle.
        """
        trace = self.trace
        may_be_angle = self.is_usual | self.in_series
        if not may_be_angle.any():
            return repeated(np.float64(np.nan), len(trace))
        rows = np.flatnonzero(trace.mode.anywhere_in_section(may_be_angle))
        section, virtual = trace.mode.section[rows], np.where(may_be_angle[rows], np.nan, self.virtual_length[rows])
        farthest = np.zeros(len(trace.mode.sections))
        for column in (np.abs(trace.path.x[rows]), virtual):
            known = np.isfinite(column)
            np.maximum.at(farthest, section[known], column[known])
        reach = np.full(len(trace), np.nan)
        reach[rows] = farthest[section]
        return reach

    @cached_property
    def in_misplaced_cycle(self) -> Mask:
        """In a drilling cycle that the mode does not allow: C is an angle once the cycle stands outside."""
        allowed = code_set(self.trace.machine.polar.allowed_codes)
        cycle = self.trace.modal.drilling
        return np.asarray((cycle != 0) & ~allowed[cycle * 10])
