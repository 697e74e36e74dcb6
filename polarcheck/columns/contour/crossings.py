"""Passes whose contour crosses itself, or turns back along itself."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.passes import LEADS, Passes
from polarcheck.columns.path.path import NOWHERE
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, Table, cached_property
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.plane import angle_between, arc_sweep

#: Turn [rad] from which on a block runs back the way that the one before it came, and how far it must do so [mm].
_BACK, _LEAST = np.radians(179.5), 0.05
#: Centers nearer to each other than this are one [mm].
_SAME = 0.02
#: Of chords of arcs [mm], as `segments` takes it.
_TOLERANCE = 0.02
#: A pass with more moves is searched only where it does not go round once.
_SHORT = 300
#: Passes that are searched, and their moves.
_MOST, _MOST_MOVES = 200, 20_000
#: Moves that end so near to each other meet there [mm].
_MEETS = 0.1
#: Moves at the ends of an open contour that may be leads.
_ENDS = 2


class _CrossingMoves(Table, frozen=True):
    """
    Blocks that cross, or run back along, an earlier block of their pass.

    move, into: int[n], moves of the passes. place: complex128[n] [mm]. back: bool[n], it runs back along the other one.
    """

    move: Rows
    into: Rows
    place: Points
    back: Mask


class Crossings(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    passes: Passes

    @cached_property
    def _hits(self) -> _CrossingMoves:
        return _CrossingMoves.concatenated([self._turning_back, *self._crossing])

    @cached_property
    def _turning_back(self) -> _CrossingMoves:
        """Moves that run back along the move before them."""
        passes = self.passes
        begins, ends = passes.tangents
        is_wall = passes.is_wall[passes.number]
        joined = (np.diff(passes.number) == 0) & is_wall[1:]
        # A move with an unknown end or start belongs to no pass, and leaves a gap.
        joined &= np.abs(passes.start[1:] - passes.end[:-1]) <= _SAME
        # Without R the path may be no wall, and a slot is milled to and fro along one line.
        radius = self.trace.compensation.radius[passes.row]
        joined &= passes.closed[passes.number][1:] | ~np.isnan(radius[1:])
        if not joined.any():
            return _nothing()
        back = np.abs(angle_between(ends[:-1], begins[1:])) >= _BACK
        lines = ~passes.is_arc[:-1] & ~passes.is_arc[1:]
        arcs = passes.is_arc[:-1] & passes.is_arc[1:] & (np.abs(np.diff(passes.center)) <= _SAME)
        # An arc of the wrong sense runs back along the lines on both sides, or one that is parted does.
        cusps = np.bincount(passes.number[1:][back & joined], minlength=len(passes.first))
        arcs |= (passes.closed & (cusps > 1))[passes.number[1:]]
        length = self.trace.path.length[passes.row]
        long = np.minimum(length[1:], length[:-1]) > _LEAST
        move = np.flatnonzero(joined & back & long & (lines | arcs)) + 1
        return _CrossingMoves(move, move - 1, passes.start[move], np.ones(len(move), bool))

    @cached_property
    def _crossing(self) -> list[_CrossingMoves]:
        """Moves that cross an earlier move of their pass: the first of each pass."""
        passes = self.passes
        first = np.where(passes.closed, passes.ring[0], passes.first)
        last = np.where(passes.closed, passes.ring[1], passes.last)
        count, all_count = last - first + 1, passes.last - passes.first + 1
        searched = (count > 3) & ((count <= _SHORT) | ~self._goes_round_once) & ~self._is_convex
        searched |= self._is_outer & (count < all_count) & (count <= _SHORT)
        chosen = np.flatnonzero(passes.is_wall & searched)
        if len(chosen) > 1:
            shape = passes.shape[chosen]
            order = np.argsort(shape, kind="stable")
            chosen = np.sort(chosen[order[np.append(True, np.diff(shape[order]) != 0)]])
        chosen = chosen[:_MOST]
        chosen = chosen[np.cumsum(all_count[chosen]) <= _MOST_MOVES]
        pairs = [self._crossing_of(which) for which in chosen.tolist()]
        return [crossing for crossing in pairs if crossing is not None]

    def _crossing_of(self, which: int) -> _CrossingMoves | None:
        """The first crossing of moves of a pass; where it closes a ring, of two of the ring, or of one and a lead."""
        from polarcheck.geometry.segments import Curves, segments
        from polarcheck.geometry.self_crossing import self_crossings

        passes, first, last = self.passes, self.passes.first[which], self.passes.last[which]
        moves = np.arange(first, last + 1)
        kind = np.where(np.isnan(passes.center[moves]), Motion.LINE, passes.motion[moves])
        loop = np.zeros(len(moves), np.int64)
        curves = Curves(passes.start[moves], passes.end[moves], passes.center[moves], kind, loop, passes.row[moves])
        parts = segments(curves, _TOLERANCE)
        crossing = self_crossings(parts.start, parts.end)
        earlier, later = moves[parts.move[crossing.earlier]], moves[parts.move[crossing.later]]
        keep = earlier != later
        if passes.closed[which]:
            rings = passes.in_ring[earlier].astype(int) + passes.in_ring[later]
            keep &= (rings == 2) | ((rings == 1) & self._is_outer[which])
            # Leads meet the ring where it begins or ends, be that within a line, and may themselves be closed.
            is_end = (earlier - first <= LEADS) & (last - later <= LEADS)
            of_ring = np.array([passes.start[passes.ring[0][which]], passes.end[passes.ring[1][which]]])
            ends = [np.stack((passes.start[of], passes.end[of])) for of in (earlier, later)]
            at = [np.abs(points - crossing.place).min(axis=0) <= _MEETS for points in (of_ring[:, None], *ends)]
            keep &= ~(is_end & (at[0] | at[1] & at[2]))
        else:
            keep &= (earlier >= first + _ENDS) & (later <= last - _ENDS)
        if not keep.any():
            return None
        nearest = np.flatnonzero(keep)[np.argmin(later[keep])]
        return _CrossingMoves(later[[nearest]], earlier[[nearest]], crossing.place[[nearest]], np.zeros(1, bool))

    @cached_property
    def _is_outer(self) -> Mask:
        """Per pass: it closes a ring that has the part inside. Into a pocket a lead may come through its open side."""
        side = self.trace.compensation.side[self.passes.row[self.passes.first]]
        return np.asarray(self.passes.closed & (self._turn * np.where(side == Side.RIGHT, 1, -1) > 0))

    # ---- cheap tests: which passes cannot cross themselves ----

    @cached_property
    def _turning(self) -> tuple[Floats, Floats]:
        """Per move how far it turns by itself, and at its end, round the ring [rad]; 0 outside the ring."""
        passes = self.passes
        sweep = arc_sweep(
            passes.start, passes.end, passes.center, np.where(np.isnan(passes.center), Motion.LINE, passes.motion)
        )
        return np.where(passes.in_ring, sweep, 0.0), np.where(passes.in_ring, np.nan_to_num(passes.turns[1]), 0.0)

    @cached_property
    def _turn(self) -> Floats:
        """Per pass how far its ring turns [rad]; 0 without one."""
        return np.asarray(np.add.reduceat(sum(self._turning), self.passes.first))

    @cached_property
    def _goes_round_once(self) -> Mask:
        """Per pass: it closes a ring that turns once, as a contour that does not cross itself does."""
        return np.asarray(self.passes.closed & (np.abs(np.abs(self._turn) - 2 * np.pi) < 0.1))

    @cached_property
    def _is_convex(self) -> Mask:
        """Per pass: it goes round once and turns to one side only, but for what rounding turns it."""
        slack = 1e-3
        low = np.minimum(*self._turning)
        high = np.maximum(*self._turning)
        first = self.passes.first
        one_side = (np.minimum.reduceat(low, first) > -slack) | (np.maximum.reduceat(high, first) < slack)
        return self._goes_round_once & one_side

    # ---- by rows ----

    @cached_property
    def crosses(self) -> Mask:
        """Rows that cross, or run back along, an earlier row of their pass."""
        if not self.passes.is_wall.any():
            return self.trace.blocks.nowhere
        return self.trace.blocks.mask_of(self.passes.row[self._hits.move])

    def of_row(self, row: int) -> tuple[int, complex, bool]:
        """The earlier row that a row crosses, the place, and whether it runs back along it."""
        index = int(np.flatnonzero(self.passes.row[self._hits.move] == row)[0])
        into = int(self.passes.row[self._hits.into[index]])
        return into, complex(self._hits.place[index]), bool(self._hits.back[index])


def _nothing() -> _CrossingMoves:
    none = np.zeros(0, np.int64)
    return _CrossingMoves(none, none, np.full(0, NOWHERE), np.zeros(0, bool))
