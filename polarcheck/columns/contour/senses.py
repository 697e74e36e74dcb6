"""Arcs of a contour against their neighbours: which are tangent to them, and which would be the other way round."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Points,
    Rows,
    States,
    cached_property,
    column_at,
    is_among,
)
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import angle_between

#: A turn that is meant as a corner [rad]: 10 degrees, and this many times what rounding turns a tangent by.
_CORNER, _CLEARLY = np.radians(10), 4
#: Further slack for the direction of a tangent [rad], as from an I that is rounded to another digit.
_SLACK = 2e-3


class Senses(Columns, frozen=True):
    """Columns of one trace, one value per row; arcs count between two blocks of the same contour in offset mode."""

    trace: Trace
    arcs: Arcs

    @cached_property
    def _loop(self) -> Rows:
        """Number of the loop of each block of a contour in offset mode, -1 elsewhere; another depth is another one."""
        trace = self.trace
        in_contour = trace.compensation.compensates & trace.path.on_plane & ~trace.compensation.starts_up
        begins = trace.compensation.starts_up | trace.mode.enters | (trace.path.moves_z & ~trace.path.travels)
        return np.where(in_contour, np.cumsum(begins), -1)

    @cached_property
    def _arc(self) -> Rows:
        """The candidates: arcs that are circles, with a block of their contour on either side."""
        rows = self._moving
        if not self.trace.path.is_arc[rows].any():
            return np.zeros(0, np.int64)
        loop = self._loop[rows]
        joined = (loop[1:] == loop[:-1]) & (loop[1:] >= 0)
        between = np.append(False, joined) & np.append(joined, False)
        is_candidate = (
            self.trace.path.is_arc
            & ~self.arcs.is_no_circle
            & ~self.arcs.ends_at_start
            & ~np.isnan(self.trace.path.center)
        )
        return np.flatnonzero(between & is_candidate[rows])

    @cached_property
    def _moving(self) -> Rows:
        return np.flatnonzero(self.trace.path.on_plane)

    def _tangents(self, index: Rows) -> tuple[Points, Points]:
        """Directions in which some of the moving rows begin and end."""
        trace, rows = self.trace, self._moving[index]
        return _tangents(trace.path.start[rows], trace.path.end[rows], trace.path.center[rows], trace.axes.motion[rows])

    @cached_property
    def _turns(self) -> tuple[Floats, Floats, Floats]:
        """Angles at the ends of each candidate [rad]: the larger one if reversed, the smaller and larger as written."""
        trace, arc = self.trace, self._arc
        row = self._moving[arc]
        start, end, center, motion = (
            trace.path.start[row],
            trace.path.end[row],
            trace.path.center[row],
            trace.axes.motion[row],
        )
        by_radius = self.arcs.by_radius[row]
        # By R it is the other circle through both ends, by I and J the same circle the other way round.
        opposite_center = np.where(by_radius, start + end - center, center)
        begins, ends = _tangents(start, end, opposite_center, np.where(motion == Motion.CW, Motion.CCW, Motion.CW))
        into, out = self._tangents(arc - 1)[1], self._tangents(arc + 1)[0]
        reversed_ = np.maximum(_angle(into, begins), _angle(ends, out))
        leaving, arriving = self._tangents(arc)
        written = _angle(into, leaving), _angle(arriving, out)
        return reversed_, np.minimum(*written), np.maximum(*written)

    @cached_property
    def _tolerance(self) -> Floats:
        """How much rounding may turn a candidate arc against its neighbours [rad]."""
        trace, arc = self.trace, self._arc
        if not len(arc):
            return np.zeros(0)
        row = self._moving[arc]
        digit = 2 * np.abs(trace.lengths.half_of_last_digit[row])
        shortest = np.minimum(trace.path.length[self._moving[arc - 1]], trace.path.length[self._moving[arc + 1]])
        radius = np.abs(trace.path.start[row] - trace.path.center[row])
        half_chord = np.abs(trace.path.end[row] - trace.path.start[row]) / 2
        # By R the center hangs on how far the chord is from it: little of that is left of half a circle.
        apart = np.sqrt(np.maximum(radius**2 - half_chord**2, digit * radius))
        with np.errstate(divide="ignore", invalid="ignore"):  # of no length, or without a digit, anything turns
            return np.asarray(_SLACK + digit * (1 / shortest + 1 / apart + 1 / half_chord))

    def _column(self, arcs: Mask) -> Mask:
        return self.trace.blocks.mask_of(self._moving[self._arc[arcs]])

    @cached_property
    def is_tangent(self) -> Mask:
        """Arcs that are tangent to the blocks on both sides."""
        return self._column(self._turns[2] <= self._tolerance)

    @cached_property
    def fits_reversed(self) -> Mask:
        """Arcs that turn a corner at either end, where the other sense is tangent to the blocks on both sides."""
        reversed_, least, _ = self._turns
        limit = self._tolerance
        return self._column((reversed_ <= limit) & (least > np.maximum(_CORNER, _CLEARLY * limit)))

    @cached_property
    def turns_back(self) -> Mask:
        """Arcs that go round the rest of the circle, back along the blocks on both sides, which is never intended."""
        back = self._column(self._turns[1] >= np.pi - self._tolerance)
        return np.asarray(back & self.fits_reversed & (self.arcs.sweep > 180))

    @cached_property
    def tangent_in_loop(self) -> Rows:
        """How many arcs of the loop of each row are tangent on both sides."""
        return self._count(self.is_tangent)

    @cached_property
    def fitting_reversed_in_loop(self) -> Rows:
        """How many of them fit the other way round."""
        return self._count(self.fits_reversed)

    def _count(self, rows: Mask) -> Rows:
        loop = self._loop
        return np.bincount(loop[rows], minlength=int(loop.max(initial=0)) + 1)[loop]

    @cached_property
    def corner(self) -> Floats:
        """The smaller of the turns at the ends of an arc [deg]; NaN for other rows."""
        return column_at(len(self.trace), self._moving[self._arc], np.degrees(self._turns[1]), np.nan)


def _tangents(start: Points, end: Points, center: Points, motion: States) -> tuple[Points, Points]:
    """Directions at start and end; not of length one."""
    turning = np.where(motion == Motion.CCW, 1j, -1j)
    is_arc = is_among(motion, (Motion.CW, Motion.CCW)) & ~np.isnan(center)
    return (
        np.where(is_arc, turning * (start - center), end - start),
        np.where(is_arc, turning * (end - center), end - start),
    )


def _angle(before: Points, after: Points) -> Floats:
    return np.abs(angle_between(before, after))
