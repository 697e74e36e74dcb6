"""Words of the virtual axis that look like angles, though the polar mode takes lengths."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Rows,
    cached_property,
    column_at,
    first_in_run,
    is_among,
    repeated,
)
from polarcheck.foundation.states import Motion
from polarcheck.program.machines.code_tables import code_set

#: So many moves one after another are a series.
_LEAST_COUNT = 3
#: X of a series stays within this share of its end.
_BAND = 0.1
#: X of points of a circle is off by no more than this share of its radius.
_OFF_CIRCLE = 0.002
#: What lies as far on the other side of the center, as a share of the end of a series, makes a contour of it.
_OTHER_SIDE = 0.5
_FULL_TURN, _PARTS_OF_TURN = 360.0, (180.0, 270.0)
#: A series that ends nearer is no turn: three equal steps to a full turn but for one reach beyond half of it.
_LEAST_END = 180.0
_SAME = 1e-6


class Series(msgspec.Struct, frozen=True):
    """
    Moves of the virtual axis in one direction, one after another in a section; an element each.

    rows: all their rows, in order. first: where in these each series begins. count: its moves. end: the farthest that
    it goes, as the number that is written. is_angle: it looks like a turn. on_circle: read as angles, its numbers and
    X are points of one circle.
    """

    rows: Rows
    first: Rows
    count: Rows
    end: Floats
    is_angle: Mask
    on_circle: Mask

    def __len__(self) -> int:
        return len(self.first)

    def in_rows(self, values: Floats, count: int) -> Floats:
        """A value of each series in its rows; NaN in the others of `count` rows."""
        return column_at(count, self.rows, np.repeat(values, self.count), np.nan)


_NOTHING = np.zeros(0, np.int64)
_NO_SERIES = Series(_NOTHING, _NOTHING, _NOTHING, np.zeros(0), *np.zeros((2, 0), bool))


def find_series(trace: Trace) -> Series:
    """
    The series of a trace.

    A turn begins where the mode does, at 0, and goes to 360 or beyond, to one of its equal steps before 360, to 180 or
    270. X stays where it is. A contour that goes so far has another side across the center. Where nothing goes so far,
    no series is looked for.
    """
    written = trace.lengths.scale * (0.5 if trace.machine.polar.virtual_axis_programming == "diameter" else 1.0)
    end = trace.path.end.imag / written
    if not np.any(trace.path.on_plane & (np.abs(end) > _LEAST_END - _SAME)):
        return _NO_SERIES
    start = trace.path.start.imag / written
    rows = np.flatnonzero(trace.path.on_plane & (np.abs(end - start) > _SAME))
    start, end, x, section = start[rows], end[rows], trace.path.x[rows] / written[rows], trace.mode.section[rows]
    is_arc = is_among(trace.axes.motion[rows], (Motion.CW, Motion.CCW))
    direction = np.where(is_arc, 0, np.sign(end - start))
    begins = first_in_run(direction, section)
    first = np.flatnonzero(begins)
    count = np.diff(first, append=len(rows))
    if not len(rows):
        return _NO_SERIES
    last = first + count - 1
    size, step = np.abs(end[last]), np.abs(end - start)
    most, least = np.maximum.reduceat(step, first), np.minimum.reduceat(step, first)
    is_turn = (size > _FULL_TURN - _SAME) | np.any([np.abs(size - part) < _SAME for part in _PARTS_OF_TURN], axis=0)
    is_turn |= (most - least < _SAME) & (np.abs(size + most - _FULL_TURN) < _SAME)
    from_zero = (direction[first] * end[last] > 0) & (np.abs(start[first]) < most + _SAME)
    band = np.maximum.reduceat(x, first) - np.minimum.reduceat(x, first)
    farthest = np.zeros((2, len(trace.mode.sections)))
    for side, value in ((0, end), (1, -end)):
        np.maximum.at(farthest[side], section, value)
    other_side = farthest[(end[last] > 0).astype(np.int64), section[last]]
    is_steady = (count >= _LEAST_COUNT) & (band <= _BAND * size) & (other_side <= _OTHER_SIDE * size)
    on_circle = (count > _LEAST_COUNT) & _are_on_circle(x, np.radians(end), first, count)
    on_circle &= np.maximum.reduceat(end, first) - np.minimum.reduceat(end, first) >= _LEAST_END
    farthest_end = np.where(on_circle, np.maximum.reduceat(np.abs(end), first), end[last])
    return Series(rows, first, count, farthest_end, is_turn & from_zero & is_steady, on_circle)


def _are_on_circle(x: Floats, angle: Floats, first: Rows, count: Rows) -> Mask:
    """Per series: each X is that of a circle about the center at the angle, but for those at 0, which may begin it."""
    cosine = np.where(np.abs(angle) > _SAME, np.cos(angle), 0.0)
    radius = np.add.reduceat(x * cosine, first) / np.maximum(np.add.reduceat(cosine**2, first), _SAME)
    off = np.maximum.reduceat(np.abs(x - np.repeat(radius, count) * cosine) * (cosine != 0), first)
    # Not on a line through the center, of which every X is 0.
    return np.asarray(off < _OFF_CIRCLE * radius)


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
        return column_at(
            len(size), whole, _USUAL[np.searchsorted(_USUAL, size[whole]) % len(_USUAL)] == size[whole], False
        )

    @cached_property
    def has_both_signs(self) -> Mask:
        """A usual angle that the section has with the other sign too, as lengths of a symmetrical contour are."""
        rows = np.flatnonzero(self.is_usual)
        value, section = self._written[rows], self.trace.mode.section[rows]
        which = np.searchsorted(_USUAL, np.abs(value))
        seen = np.zeros((2, len(self.trace.mode.sections), len(_USUAL)), bool)
        seen[(value < 0).astype(int), section, which] = True
        return column_at(len(self.trace), rows, (seen[0] & seen[1])[section, which], False)

    @cached_property
    def series(self) -> Series:
        """Moves of the virtual axis in one direction, one after another."""
        return find_series(self.trace)

    @cached_property
    def in_series(self) -> Mask:
        """In a series that goes steadily to a turn, or to half of one, while X stays, or is that of a circle."""
        is_angle = self.series.is_angle | self.series.on_circle
        if not is_angle.any():
            return np.zeros(len(self.trace), bool)
        return np.asarray(self.series.in_rows(is_angle.astype(np.float64), len(self.trace)) == 1.0)

    @cached_property
    def beside_points(self) -> Mask:
        """In a section with a series of points of a circle: where C is an angle in these, it is one everywhere."""
        trace, series = self.trace, self.series
        if not series.on_circle.any():
            return trace.blocks.nowhere
        of_points = series.in_rows(series.on_circle.astype(np.float64), len(trace)) == 1.0
        return np.asarray(trace.mode.anywhere_in_section(of_points))

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
        section = trace.mode.section[rows]
        virtual = np.where((may_be_angle | self.beside_points)[rows], np.nan, self.virtual_length[rows])
        farthest = np.zeros(len(trace.mode.sections))
        for column in (np.abs(trace.path.x[rows]), virtual):
            known = np.isfinite(column)
            np.maximum.at(farthest, section[known], column[known])
        return column_at(len(trace), rows, farthest[section], np.nan)

    @cached_property
    def in_misplaced_cycle(self) -> Mask:
        """In a drilling cycle that the mode does not allow: C is an angle once the cycle stands outside."""
        allowed = code_set(self.trace.machine.polar.allowed_codes)
        cycle = self.trace.modal.drilling
        return np.asarray((cycle != 0) & ~allowed[cycle * 10])
