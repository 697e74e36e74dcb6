"""Ramps of cutter compensation that stand in the wrong block of a contour, or in none."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, cached_property
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import SHARE

#: Points nearer than this [mm] are meant to be one point: words are rounded.
_SAME = 0.005
#: Least number of moves at feed of a contour that a cancel ends: one of them may be the ramp.
_MOVES_OF_CONTOUR = 2
#: Least number of blocks of a loop that tells where its start-up should have ended.
_MOVES_OF_LOOP = 3
#: A contour begins with so many moves of an approach.
_LEADS = 4
#: A size that is meant is a multiple of this share of a unit (mm, inch).
_DIGITS = (0, 1, 2, 3, 4)
_ROUND = 2e-4
#: Sizes of drawings in inch are parts of this.
_FRACTION = 32
#: Most rows that are examined; a program with more is written so on purpose.
_MOST = 2000


class _Moves(msgspec.Struct, frozen=True):
    """
    The moves on the plane in the mode, n of them, in order.

    row: int[n]. section: int[n]. start, end: complex128[n] [mm]. compensated: bool[n], G41 or G42 is in force in it.
    starts_up, cancels: bool[n]. at_feed: bool[n]. feed: float64[n].
    """

    row: Rows
    section: Rows
    start: Points
    end: Points
    compensated: Mask
    starts_up: Mask
    cancels: Mask
    at_feed: Mask
    feed: Floats


class MisplacedRamps(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    arcs: Arcs

    @cached_property
    def _moves(self) -> _Moves:
        trace = self.trace
        row = np.flatnonzero(trace.path.on_plane)
        return _Moves(
            row=row,
            section=trace.mode.section[row],
            start=trace.path.start[row],
            end=trace.path.end[row],
            compensated=(trace.compensation.side != Side.OFF)[row],
            starts_up=trace.compensation.starts_up[row],
            cancels=trace.compensation.cancels[row],
            at_feed=trace.path.cuts[row],
            feed=trace.feedrate.feed_number[row],
        )

    # ---- a cancel without its start-up ----

    @cached_property
    def cancel_alone(self) -> Mask:
        """
        G40 with a move in the mode, nothing in force since G12.1 or the cancel before, and a contour cut in between.

        Many write G40 for safety. So it counts only where another witness stands beside it: the move leaves the contour
        as a ramp does, or as that of another pass, or another section of the program compensates; and not where R is 0,
        or where the contour is a size with R taken off it, and none as it is written.
        """
        trace = self.trace
        rows = trace.compensation.writes_cancel & trace.path.on_plane & (trace.axes.motion == Motion.LINE)
        rows &= (trace.compensation.side_of_move_before == Side.OFF) & (trace.compensation.side_before == Side.OFF)
        if not rows.any():
            return np.zeros(len(trace), bool)
        since = last_row(trace.mode.enters | trace.compensation.cancels, trace.blocks.starts)
        count = np.cumsum(trace.path.cuts)
        rows &= count - trace.path.cuts - np.where(since >= 0, count[since], 0) >= _MOVES_OF_CONTOUR
        rows &= ~(trace.offsets.radius_of_offset == 0)
        candidates = np.flatnonzero(rows)[:_MOST]
        return trace.blocks.mask_of([row for row in candidates.tolist() if self._has_witness(row, int(since[row]))])

    def lead_of(self, row: int) -> int:
        """
        The row of the move that leads to the contour before a G40 without its start-up.

        It ends where the contour is left, or is the first one behind the last move of Z down.
        """
        trace, moves = self.trace, self._moves
        begins = trace.mode.enters | trace.compensation.cancels | (trace.path.moves_z & ~trace.path.travels)
        since = int(last_row(begins, trace.blocks.starts)[row])
        first, last = np.searchsorted(moves.row, (since, row), side="right").tolist()
        # The last move of the contour, before that of G40, ends there in any case.
        ends = np.abs(moves.end[first : max(last - 2, first + 1)] - trace.path.start[row]) <= _SAME
        return int(moves.row[first + int(np.argmax(ends))])

    def _has_witness(self, row: int, since: int) -> bool:
        trace, moves = self.trace, self._moves
        first, last = np.searchsorted(moves.row, (since, row), side="right").tolist()
        last -= 1  # the contour, the move of G40 excluded
        if self._is_path_of_center(row, first, last):
            return False
        if bool(np.any(trace.compensation.starts_up & (trace.mode.section != trace.mode.section[row]))):
            return True
        leaves_from, leaves_to = trace.path.start[row], trace.path.end[row]
        likes = _mirrors(trace.path.start, leaves_from) & _mirrors(trace.path.end, leaves_to)
        if bool(np.any(trace.compensation.cancels & likes)):
            return True
        before_end = np.append(moves.start[first : first + 1], moves.end[first : last - 1])
        closes = bool(np.any(np.abs(before_end - leaves_from) <= _SAME))
        # A contour that runs on past its start ends on its first wall.
        begin, end = (column[first : max(last - _MOVES_OF_LOOP, first)] for column in (moves.start, moves.end))
        aside = np.abs(begin - leaves_from) + np.abs(end - leaves_from) - np.abs(end - begin)
        is_line = trace.axes.motion[moves.row[first : first + len(begin)]] == Motion.LINE
        closes |= bool(np.any(is_line & (aside <= _SAME**2)))
        # Above Z0 nothing is cut on most programs: only a contour that closes shows there that one is meant.
        in_air = float(trace.path.z[row]) > 0
        return closes or (
            not in_air and any(_mirrors(leaves_to, approach) for approach in self._approaches(row, since, first, last))
        )

    def _approaches(self, row: int, since: int, first: int, last: int) -> list[complex]:
        """Where the tool stands behind G12.1, where it goes down to the contour, and where its first moves begin."""
        trace = self.trace
        down = np.flatnonzero(trace.path.moves_z[since:row] & ~trace.path.travels[since:row]) + since
        leads = self._moves.start[first : min(first + _LEADS, last)]
        return [*(complex(trace.path.end[index]) for index in (since, *down.tolist()[-_LEADS:])), *leads.tolist()]

    def _is_path_of_center(self, row: int, first: int, last: int) -> bool:
        """The contour is no round size as written, and one with R taken off either side."""
        radius = abs(float(self.trace.offsets.radius_of_offset[row]))
        if np.isnan(radius) or last - first < 2:
            return False
        scale = float(self.trace.lengths.scale[row])
        ends = self._moves.end[first:last]
        same = np.flatnonzero(np.abs(ends - self.trace.path.start[row]) <= _SAME)
        ends = ends[same[0] :] if len(same) > 1 else ends  # a closed contour without its lead
        sizes = [size for size in (float(np.ptp(ends.real)), float(np.ptp(ends.imag)), _across_flats(ends)) if size > 0]
        written = [_digits(size / scale) for size in sizes]
        intended = [min(_digits((size + sign * 2 * radius) / scale) for sign in (-1, 1)) for size in sizes]
        return bool(sizes) and min(written) > min(intended) + 1

    # ---- a start-up that comes late, or is taken back at once ----

    @cached_property
    def cancelled_at_once(self) -> Mask:
        """Start-ups after which the next move on the plane is the offset cancel."""
        trace, moves = self.trace, self._moves
        same = moves.section[:-1] == moves.section[1:]
        follows = np.append(moves.starts_up[:-1] & moves.cancels[1:] & same, False)[: len(moves.row)]
        # Between them nothing may move but Z: a block of which it is not known where it leads may be the contour.
        opens = np.append(0, np.cumsum((trace.axes.moves & ~trace.axes.commands_z) | trace.run.unknown))
        following_rows = np.flatnonzero(follows)
        follows[following_rows] = opens[moves.row[following_rows + 1]] == opens[moves.row[following_rows] + 1]
        return trace.blocks.mask_of(moves.row[follows])

    @cached_property
    def begun_without(self) -> Rows:
        """
        Start-ups behind a block that cuts the contour without compensation: the row of that block; -1 elsewhere.

        The contour comes back to a point from which a move without compensation has led, and not to the end of its own
        start-up; or the move before the start-up is the mirror image of the way out, and F of the contour begins there.
        """
        trace, moves = self.trace, self._moves
        late = np.full(len(trace), -1)
        n = len(moves.row)
        if n < _MOVES_OF_LOOP:
            return late
        starts = np.flatnonzero(moves.starts_up)
        # A G40 ends the pass before, be it one that takes nothing back.
        bare = ~moves.compensated & moves.at_feed & ~trace.compensation.writes_cancel[moves.row]
        has_bare = np.append(False, bare[:-1] & (moves.section[1:] == moves.section[:-1]))
        starts = starts[has_bare[starts]]
        if not len(starts):
            return late
        # The last move of each loop with compensation: the one before the next move without.
        ends = np.flatnonzero(~moves.compensated | np.append(moves.section[1:] != moves.section[:-1], True))
        until = np.append(ends, n)[np.searchsorted(ends, starts)]
        whole = until - starts >= 2  # fewer are judged by cancelled_at_once
        starts, until = starts[whole], until[whole]
        final = moves.start[np.minimum(until, n - 1)]
        near = np.abs(moves.end[starts] - final) <= _SAME
        for start, end, point, closes in zip(
            starts.tolist(), until.tolist(), final.tolist(), near.tolist(), strict=True
        ):
            row = -1 if closes else self._cut_before(start, end, point, bare)
            if row >= 0:
                late[moves.row[start]] = row
        return late

    def _cut_before(self, start: int, end: int, final: complex, bare: Mask) -> int:
        """The row of the move that has cut the contour of the start-up `start` before it; -1 for none."""
        moves = self._moves
        first = start
        while first and bare[first - 1] and moves.section[first - 1] == moves.section[start] and start - first < _MOST:
            first -= 1
        vertices = moves.end[start:end]
        if np.any(np.abs(vertices[1:] - vertices[0]) <= _SAME):
            return -1
        touched = np.flatnonzero(np.abs(moves.end[first:start] - final) <= _SAME)
        if len(touched):
            return int(moves.row[first + int(touched[0])])
        lead, leave = start - 1, end
        if leave >= len(moves.row) or not moves.cancels[leave] or first == lead:
            return -1
        begins = moves.feed[lead] < moves.feed[lead - 1] * (1 - SHARE) and moves.feed[start] == moves.feed[lead]
        symmetrical = _mirrors(complex(moves.start[lead]), complex(moves.end[leave])) and _mirrors(
            complex(moves.end[lead]), complex(moves.start[leave])
        )
        return int(moves.row[lead]) if begins and symmetrical else -1

    # ---- a start-up that ends off the contour ----

    @cached_property
    def x_of_contour(self) -> Floats:
        """
        Start-ups that end at another X than their contour, which would be closed with it: that X [mm]; NaN elsewhere.

        The way out leads back to where the start-up began; X is half or twice as large, or the contour goes round the
        center and does not overlap.
        """
        trace, moves = self.trace, self._moves
        column = np.full(len(trace), np.nan)
        n = len(moves.row)
        starts = np.flatnonzero(moves.starts_up)
        if not len(starts):
            return column
        cancels = np.flatnonzero(moves.cancels)
        leave = np.append(cancels, n)[np.searchsorted(cancels, starts)]
        keep = (leave < n) & (leave - starts >= _MOVES_OF_LOOP)
        starts, leave = starts[keep], leave[keep]
        begin, end = moves.end[starts], moves.start[leave]
        off = (moves.section[starts] == moves.section[leave]) & (
            np.abs(moves.start[starts] - moves.end[leave]) <= _SAME
        )
        off &= (np.abs(begin.imag - end.imag) <= _SAME) & (np.abs(begin.real - end.real) > _SAME)
        # The arc that begins at this X is no circle; another one tells of another mistake.
        wrong = np.append(0, np.cumsum(self.arcs.is_no_circle[moves.row]))
        off &= wrong[leave] == wrong[np.minimum(starts + 2, leave)]
        halved = (np.abs(begin.real * 2 - end.real) <= _SAME) | (np.abs(begin.real - end.real * 2) <= _SAME)
        halved &= (leave - starts > _MOVES_OF_LOOP) & (np.abs(begin.real) > _SAME)
        for index in np.flatnonzero(off & ~halved)[:_MOST].tolist():
            off[index] = self._is_closed_but_for_ramp(int(starts[index]) + 1, int(leave[index]))
        column[moves.row[starts[off]]] = end.real[off]
        return column

    def _is_closed_but_for_ramp(self, first: int, last: int) -> bool:
        """The moves from first to last, exclusive, go round the center, and neither end lies on any other of them."""
        rows, blocks = self._moves.row[first:last], self.trace.blocks
        if (blocks.has("U", "V", "H") | self.trace.modal.incremental)[rows].any():
            return False  # what is wrong in one step shifts all that follow
        path = self.trace.path.moves_of(rows)
        inner = range(1, len(path) - 1)
        ends = ((complex(path.end[-1]), (0, *inner)), (complex(path.start[0]), (*inner, -1)))
        return path.goes_round() and not any(_is_on(path, move, point) for point, moves in ends for move in moves)


def _is_on(path: PlanePath, move: int, point: complex) -> bool:
    """A point lies on a line, or on the circle of an arc."""
    start, end, center = complex(path.start[move]), complex(path.end[move]), complex(path.center[move])
    if path.is_arc[move]:
        return bool(abs(abs(point - center) - abs(start - center)) <= _SAME)
    return bool(abs(point - start) + abs(point - end) - abs(end - start) <= _SAME)


def _mirrors(first: Points | complex, second: complex) -> Mask:
    """The points are the same, or mirror images about an axis of the plane or the center."""
    point = np.asarray(first)
    along_x, along_c = np.abs(point.real) - abs(second.real), np.abs(point.imag) - abs(second.imag)
    return np.asarray((np.abs(along_x) <= _SAME) & (np.abs(along_c) <= _SAME))


def _across_flats(ends: Points) -> float:
    """Twice the distance of the nearest long side of a path to the center [mm]; 0 where it has none."""
    side = np.diff(ends)
    length = np.abs(side)
    long = length > length.max(initial=0.0) / 2
    if not long.any():
        return 0.0
    distance = np.abs((np.conj(side[long]) * ends[:-1][long]).imag) / length[long]
    return 2 * float(distance.min())


def _digits(size: float) -> int:
    """
    How many digits behind the point a size needs; one more than all of _DIGITS where none suffice.

    Fractions as 1 5/16 are as round as a size of one digit.
    """
    if abs(size - round(size)) > _ROUND and abs(size - round(size * _FRACTION) / _FRACTION) <= _ROUND / 2:
        return 1
    return next((digits for digits in _DIGITS if abs(size - round(size, digits)) <= _ROUND), len(_DIGITS))
