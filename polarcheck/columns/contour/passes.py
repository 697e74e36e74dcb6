"""Passes: the moves along a contour at one depth, which of them close a ring, and which move follows which."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, States, cached_property, first_in_run
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.plane import angle_between
from polarcheck.geometry.tolerances import ADJUSTMENT, ROUNDING

#: Moves at either end of a pass that may be leads.
LEADS = 4
#: Largest gap of a ring [mm]: its points are rounded.
_CLOSED = 0.005


class Passes(Columns, frozen=True):
    """
    The passes of one trace, and their moves, n of them in the order of the program.

    A pass lasts from a start-up to the offset cancel, or without compensation from one rapid move, start-up or cancel
    to the next; a Z move of its own ends it, and so does a move that is not known. Start-ups and cancels belong to no
    pass.
    """

    trace: Trace

    @cached_property
    def row(self) -> Rows:
        """The row of each move."""
        trace = self.trace
        chosen = trace.path.on_plane & ~trace.compensation.starts_up & ~trace.compensation.cancels
        return np.flatnonzero(chosen & (trace.axes.motion != Motion.RAPID) & ~self._is_open)

    @cached_property
    def _is_open(self) -> Mask:
        """Rows of the trace with a move on the plane of which it is not known where or how it goes."""
        path = self.trace.path
        return np.asarray(path.on_plane & (np.isnan(path.start + path.end) | path.shape_is_unknown))

    @cached_property
    def moves_z_alone(self) -> Mask:
        """Rows of the trace that move Z and nothing on the plane."""
        trace = self.trace
        stays = np.abs(trace.path.z - trace.path.z_before) <= ROUNDING
        return np.asarray(trace.path.moves_z & ~trace.path.travels & ~stays)

    @cached_property
    def number(self) -> Rows:
        """The number of the pass of each move, from 0."""
        trace, row = self.trace, self.row
        breaks = trace.compensation.starts_up | trace.compensation.cancels | trace.mode.enters | self.moves_z_alone
        breaks |= (trace.axes.motion == Motion.RAPID) | (trace.compensation.side != trace.compensation.side_before)
        breaks |= self._is_open
        return first_in_run(np.cumsum(breaks)[row]).cumsum() - 1

    @cached_property
    def first(self) -> Rows:
        """The first move of each pass."""
        return first_in_run(self.number).nonzero()[0]

    @cached_property
    def last(self) -> Rows:
        """The last move of each pass."""
        return np.append(self.first[1:], len(self.row))[: len(self.first)] - 1

    @cached_property
    def start(self) -> Points:
        """Where each move begins [mm]."""
        return self.trace.path.start[self.row]

    @cached_property
    def end(self) -> Points:
        """Where each move ends [mm]."""
        return self.trace.path.end[self.row]

    @cached_property
    def center(self) -> Points:
        """The center of each arc [mm]; NaN for lines, and where it is not known."""
        return np.where(self.is_arc, self.trace.path.center[self.row], complex("nan+nanj"))

    @cached_property
    def motion(self) -> States:
        """Motion of each move."""
        return self.trace.axes.motion[self.row]

    @cached_property
    def is_arc(self) -> Mask:
        """The move is an arc, be its center known or not."""
        return self.trace.path.is_arc[self.row]

    @cached_property
    def half_of_last_digit(self) -> Floats:
        """How far the rounding of its words may shift the points of each move [mm]."""
        return np.abs(self.trace.lengths.half_of_last_digit(self.row))

    @cached_property
    def compensated(self) -> Mask:
        """Per pass: G41 or G42 is in force."""
        return np.asarray(self.trace.compensation.side[self.row[self.first]] != Side.OFF)

    @cached_property
    def is_wall(self) -> Mask:
        """Per pass: compensated with the R of a cutter, or with one that is not known, so that it is a wall."""
        radius = np.abs(self.trace.compensation.radius[self.row[self.first]])
        return np.asarray(self.compensated & ~(radius <= ADJUSTMENT + ROUNDING))

    @cached_property
    def shape(self) -> Rows:
        """Per pass a number of its moves, the same for passes of the same moves."""
        return self.shape_of(self.first, self.last)

    def shape_of(self, first: Rows, last: Rows) -> Rows:
        """Per pass a number of its moves from one to another, the same for the same moves; int[passes] all."""
        index = np.arange(len(self.row))
        chosen = (index >= first[self.number]) & (index <= last[self.number])
        weight = index - first[self.number] + 1.0
        center = np.where(np.isnan(self.center), 0, self.center)
        factors = (self.end, 1), (self.end, weight), (center, weight), (self.end, self.motion)
        sums = [np.add.reduceat(np.where(chosen, point * factor, 0), self.first) for point, factor in factors]
        return numbered([np.round(part, 4) for total in sums for part in (total.real, total.imag)])

    # ---- rings ----

    @cached_property
    def ring(self) -> tuple[Rows, Rows]:
        """
        Per pass the first and the last move of the ring that it closes; -1 where it closes none.

        A last line that runs on past the start of the first move, or begins before the end of that, closes it, too.
        """
        first, last = self.first, self.last
        if not len(first):
            return first, last
        i, j = (index.ravel() for index in np.mgrid[:LEADS, :LEADS])
        begin, end = first[:, None] + i, last[:, None] - j
        is_pair = end >= begin
        begin, end = np.minimum(begin, last[:, None]), np.maximum(end, first[:, None])
        is_pair &= (end > begin) | self.is_arc[begin]
        closes = is_pair & (np.abs(self.start[begin] - self.end[end]) <= _CLOSED)
        closes |= ~closes.any(axis=1)[:, None] & is_pair & (self._joins(begin, end) | self._joins(end, begin))
        length = np.where(closes, end - begin, -1)
        best, rows = np.argmax(length, axis=1), np.arange(len(first))
        closed = length[rows, best] >= 0
        return np.where(closed, begin[rows, best], -1), np.where(closed, end[rows, best], -1)

    def _joins(self, line: Rows, other: Rows) -> Mask:
        """Lines on which the other move begins, if it comes before, or ends."""
        point = np.where(line > other, self.start[other], self.end[other])
        way = self.end[line] - self.start[line]
        length = np.maximum(np.abs(way), _CLOSED)
        off = (point - self.start[line]) * way.conj() / length
        is_on = (np.abs(off.imag) <= _CLOSED) & (off.real > 0) & (off.real < length)
        return np.asarray(is_on & ~self.is_arc[line])

    @cached_property
    def closed(self) -> Mask:
        """Per pass: it closes a ring."""
        return np.asarray(self.ring[0] >= 0)

    @cached_property
    def in_ring(self) -> Mask:
        """Per move: it is part of the ring of its pass."""
        index, (first, last) = np.arange(len(self.row)), self.ring
        return np.asarray(self.closed[self.number] & (index >= first[self.number]) & (index <= last[self.number]))

    @cached_property
    def beside(self) -> tuple[Rows, Rows]:
        """Per move the one before it and the one after it in its pass, round the ring; -1 for none."""
        index = np.arange(len(self.row))
        previous, following = index - 1, index + 1
        previous[self.first], following[self.last] = -1, -1
        first, last = (ends[self.closed] for ends in self.ring)
        previous[first], following[last] = last, first
        return previous, following

    # ---- tangents ----

    @cached_property
    def tangents(self) -> tuple[Points, Points]:
        """Unit directions in which each move begins and ends; 0 for one of no length."""
        path = self.trace.path.moves_of(self.row)
        return path.leaving, path.arriving

    @cached_property
    def turns(self) -> tuple[Floats, Floats]:
        """Per move the turn from the one before it, and to the one after it [rad]; NaN where there is none."""
        begins, ends = self.tangents
        previous, following = self.beside
        into, out = angle_between(ends[previous], begins), angle_between(ends, begins[following])
        return np.where(previous < 0, np.nan, into), np.where(following < 0, np.nan, out)


def numbered(columns: Sequence[Floats | Rows]) -> Rows:
    """A number for each element, the same where all columns are equal; np.unique would load masked arrays."""
    order = np.lexsort(columns)
    differs = np.zeros(len(order), bool)
    for column in columns:
        differs[1:] |= np.diff(column[order]) != 0
    number = np.empty(len(order), np.int64)
    number[order] = np.cumsum(differs)
    return number
