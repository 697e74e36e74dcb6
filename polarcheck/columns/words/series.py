"""Moves of the virtual axis that go steadily to a full turn while X stays where it is: angles, written as lengths."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows, is_among
from polarcheck.foundation.states import Motion

#: So many moves one after another are a series.
_LEAST_COUNT = 3
#: X of a series stays within this share of its end.
_BAND = 0.1
#: What lies as far on the other side of the center, as a share of the end of a series, makes a contour of it.
_OTHER_SIDE = 0.5
_FULL_TURN, _PARTS_OF_TURN = 360.0, (180.0, 270.0)
#: A series that ends nearer is no turn: three equal steps to a full turn but for one reach beyond half of it.
_LEAST_END = 180.0
_SAME = 1e-6


class Series(msgspec.Struct, frozen=True):
    """
    Moves of the virtual axis in one direction, one after another in a section; an element each.

    rows: all their rows, in order. first: where in these each series begins. count: its moves. end: where it ends, as
    the number that is written. is_angle: it looks like a turn.
    """

    rows: Rows
    first: Rows
    count: Rows
    end: Floats
    is_angle: Mask

    def __len__(self) -> int:
        return len(self.first)

    def in_rows(self, values: Floats, count: int) -> Floats:
        """A value of each series in its rows; NaN in the others of `count` rows."""
        column = np.full(count, np.nan)
        column[self.rows] = np.repeat(values, self.count)
        return column


_NOTHING = np.zeros(0, np.int64)
_NO_SERIES = Series(_NOTHING, _NOTHING, _NOTHING, np.zeros(0), np.zeros(0, bool))


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
    begins = np.ones(len(rows), bool)
    begins[1:] = (direction[1:] != direction[:-1]) | (section[1:] != section[:-1])
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
    return Series(rows, first, count, end[last], is_turn & from_zero & is_steady)
