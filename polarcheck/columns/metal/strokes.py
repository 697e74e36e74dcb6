"""
Strokes: the tool is positioned, goes down to a depth by a block of Z alone, cuts, and is lifted.

Where several strokes of a tool go down to one depth, one says what another lacks: the lift before it, or its own F.
"""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.metal.workpiece import Workpiece
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Points, Rows, cached_property
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry import polar
from polarcheck.geometry.tolerances import ROUNDING

#: Strokes that have what one lacks, at least.
_LEAST = 2
#: F of positioning is as many times that of other strokes, or of the cut behind it.
_FASTER, _FASTER_THAN_CUT = 3.0, 5.0
#: A cutter of so much of R is in metal all around where its center is [share of R].
_CORE = 0.2
#: Places nearer to each other than this are one [mm].
_SAME = 0.01


class Strokes(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    workpiece: Workpiece

    @cached_property
    def row(self) -> Rows:
        """Rows of Z words alone to a known depth below the face, at feed and without compensation, in their order."""
        trace = self.trace
        path, axes = trace.path, trace.axes
        down = axes.commands_z & ~axes.moves_plane & ~path.travels & trace.mode.in_polar & (axes.motion == Motion.LINE)
        down &= ~(path.z > path.z_before + ROUNDING)
        down &= (path.z < self.workpiece.top - ROUNDING) & (trace.compensation.side == Side.OFF)
        return np.flatnonzero(down & ~np.isnan(path.start + path.z_before))

    @cached_property
    def sinks(self) -> Mask:
        """Per stroke: the tool goes down, and has not been there."""
        path = self.trace.path
        return np.asarray(path.z[self.row] < path.z_before[self.row] - ROUNDING)

    @cached_property
    def place(self) -> Points:
        """Where each stroke goes down, in the frame of the part [mm]."""
        path, section = self.trace.path, self.trace.mode.section[self.row]
        return np.asarray(path.start[self.row] * path.section_turn[section])

    @cached_property
    def _positions(self) -> Rows:
        """Per stroke the move at feed that leads to its place in the same section; -1 where there is none."""
        trace = self.trace
        moves = trace.path.travels & trace.path.cuts & trace.mode.in_polar
        last = last_row(moves, trace.mode.enters | trace.blocks.starts)[self.row]
        return np.where((last >= 0) & (trace.compensation.side[last] == Side.OFF), last, -1)

    @cached_property
    def _alike(self) -> list[Rows]:
        """The strokes of one tool call to one depth, where there are more of them than _LEAST."""
        z = np.rint(self.trace.path.z[self.row] / _SAME)
        call = self.workpiece.bar.tools.tool_call[self.row]
        order = np.lexsort((z, call))
        begins = np.flatnonzero((np.diff(z[order], prepend=np.inf) != 0) | (np.diff(call[order], prepend=-1) != 0))
        return [np.sort(group) for group in np.split(order, begins[1:]) if len(group) > _LEAST]

    # ---- the lift ----

    @cached_property
    def unlifted(self) -> dict[int, tuple[int, Rows]]:
        """
        Moves that lead to the next stroke at depth, with the row of that stroke and those of the strokes that the tool
        is lifted before.

        The stroke writes the Z at which the tool is, at a new place, and most of its like go down to it.
        """
        path, unlifted = self.trace.path, {}
        for group in self._alike:
            high = group[self.sinks[group]]
            low = group[~self.sinks[group] & (self._positions[group] >= 0)]
            if len(high) < max(_LEAST, 2 * len(low)):
                continue
            for stroke in low.tolist():
                earlier = group[group < stroke]
                position = int(self._positions[stroke])
                is_new = np.abs(self.place[earlier] - self.place[stroke]) > _SAME
                if len(earlier) and is_new.all() and self.row[earlier[-1]] < position and path.z[position] < 0:
                    unlifted[position] = int(self.row[stroke]), self.row[high]
        return unlifted

    @cached_property
    def lacks_lift(self) -> Mask:
        """Rows of these moves."""
        return self.trace.blocks.mask_of(sorted(self.unlifted))

    # ---- the feed ----

    @cached_property
    def _feed_of_positioning(self) -> Mask:
        """Per stroke: its F is not its own, but stands in the move that leads to its place, or higher up."""
        trace = self.trace
        written = last_row(trace.blocks.has("F"), trace.blocks.starts)[self.row]
        above = trace.path.z[written] > trace.path.z[self.row] + ROUNDING
        return np.asarray((written >= 0) & (written < self.row) & self.sinks & above)

    @cached_property
    def too_fast(self) -> dict[int, Rows]:
        """
        Rows of strokes that go down into metal with the F of positioning, with rows that say what was meant: the like
        strokes that have an F of their own, or the cut behind it where the bar is known.
        """
        if not self._feed_of_positioning.any():
            return {}
        return {**self._faster_than_cut, **self._faster_than_others}

    @property
    def _faster_than_others(self) -> dict[int, Rows]:
        feed, has_f = self.trace.feedrate.feed[self.row], self.trace.blocks.has("F")[self.row]
        found = {}
        for group in self._alike:
            slow = group[has_f[group] & self.sinks[group]]
            for stroke in group[self._feed_of_positioning[group]].tolist():
                rivals = slow[feed[slow] * _FASTER <= feed[stroke]]
                # Farther out it may go down beside the bar.
                within = np.abs(self.place[rivals]).max(initial=0) + 2 * self.workpiece.radius[self.row[stroke]]
                if (
                    len(rivals) >= max(_LEAST, len(slow))
                    and np.abs(self.place[stroke]) <= within
                    and self._is_untouched(stroke)
                ):
                    found[int(self.row[stroke])] = self.row[rivals]
        return found

    def _is_untouched(self, stroke: int) -> bool:
        """No cut above a stroke in its section has come nearer to its place than 2 R at its depth."""
        trace, row = self.trace, int(self.row[stroke])
        moves = self.workpiece.tool_center.moves
        earlier = moves[(moves.row < row) & (moves.section == trace.mode.section[row])]
        earlier = earlier[trace.path.z[earlier.row] <= trace.path.z[row] + ROUNDING]
        start, end, center, kind = earlier.shape
        place = trace.path.start[row]
        return not (
            polar.nearest(start - place, end - place, center - place, kind) < 2 * self.workpiece.radius[row]
        ).any()

    @property
    def _faster_than_cut(self) -> dict[int, Rows]:
        """Strokes from above the face into the known bar at several times the F of the cut behind them."""
        trace = self.trace
        cuts = np.flatnonzero(trace.path.travels & trace.axes.at_feed)
        cuts = np.append(cuts, -1)
        following = cuts[np.searchsorted(cuts[:-1], self.row)]
        feed = trace.feedrate.feed
        fast = self._feed_of_positioning & (following >= 0) & trace.blocks.has("F")[following]
        fast &= trace.mode.section[following] == trace.mode.section[self.row]
        fast &= feed[following] * _FASTER_THAN_CUT <= feed[self.row]
        # From depth to depth it goes down in what is cut already, but for the last step.
        fast &= trace.path.z_before[self.row] >= self.workpiece.top - ROUNDING
        rows = self.row[fast]
        stands = self.workpiece.stands_at(rows, _CORE) if len(rows) else np.zeros(0, bool)
        return {int(row): following[fast][number : number + 1] for number, row in enumerate(rows) if stands[number]}

    @cached_property
    def is_too_fast(self) -> Mask:
        """Rows of these strokes."""
        return self.trace.blocks.mask_of(sorted(self.too_fast))
