"""Contours that change Z on their way, so that one part of them is cut at another depth than the rest."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.passes import LEADS, Passes
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, column_at
from polarcheck.geometry.tolerances import ROUNDING

#: Largest gap of a ring [mm].
_CLOSED = 0.005
#: Least area of a ring, as a share of the square of its way.
_AREA = 1e-3
#: A ring of fewer moves may be a step on purpose; more changes of Z than this are a ramp.
_LEAST_MOVES, _MOST_CHANGES = 5, 2
#: Contours that are looked at.
_MOST = 2000


class ContourDepths(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    passes: Passes

    @cached_property
    def changes(self) -> Mask:
        """Rows that move Z in the middle of a contour that is closed only with both of its parts."""
        return self._z_alone | self._with_plane

    @cached_property
    def _z_alone(self) -> Mask:
        """Rows of their own that do so."""
        passes, trace = self.passes, self.trace
        if len(passes.first) < 2 or not (passes.moves_z_alone & trace.compensation.compensates).any():
            return trace.blocks.nowhere
        row = passes.row[passes.first]
        breaks = trace.compensation.starts_up | trace.compensation.cancels | trace.mode.enters
        breaks |= trace.compensation.side != trace.compensation.side_before
        contour = np.cumsum(breaks)[row]
        # Passes that close nothing, one after the other in one contour.
        opened = passes.compensated & ~passes.closed
        joined = np.append(False, (np.diff(contour) == 0) & opened[1:] & opened[:-1])
        begins = np.flatnonzero(opened & ~joined)
        until = np.searchsorted(np.cumsum(~joined), np.cumsum(~joined)[begins], side="right")
        chosen = np.flatnonzero(until - begins > 1)[:_MOST]
        rows = [self._break_of(int(begins[which]), int(until[which])) for which in chosen.tolist()]
        return trace.blocks.mask_of([row for row in rows if row is not None])

    def _break_of(self, begin: int, until: int) -> int | None:
        """The row in which Z moves between two passes that close a ring together; None where they close none."""
        passes, trace = self.passes, self.trace
        first, last = int(passes.first[begin]), int(passes.last[until - 1])
        head, tail = np.arange(first, min(first + LEADS, last)), np.arange(max(last - LEADS + 1, first), last + 1)
        gap = np.abs(passes.start[head][:, None] - passes.end[tail][None, :])
        gap[tail[None, :] - head[:, None] < 2] = np.inf
        if not (gap <= _CLOSED).any():
            return None
        i, j = np.unravel_index(int(np.argmax(np.where(gap <= _CLOSED, tail[None, :] - head[:, None], -1))), gap.shape)
        ring = np.arange(head[i], tail[j] + 1)
        points = passes.end[ring]
        length = np.abs(np.diff(points, append=points[:1])).sum()
        if abs(np.sum((points.conj() * np.roll(points, -1)).imag)) / 2 < _AREA * length**2:
            return None
        z = trace.path.z[passes.row[ring]]
        steps = np.flatnonzero(np.abs(np.diff(z)) > ROUNDING)
        # From one depth up over what stands there, and down again.
        is_hop = len(steps) > 0 and abs(z[0] - z[-1]) <= ROUNDING and bool((z >= z[0] - ROUNDING).all())
        if not len(steps) or is_hop:
            return None
        rows = np.arange(passes.row[ring[steps[0]]], passes.row[ring[steps[0] + 1]] + 1)
        moved = rows[passes.moves_z_alone[rows]]
        return int(moved[0]) if len(moved) else None

    @cached_property
    def _with_plane(self) -> Mask:
        """Blocks of a ring that move Z, too, where the others keep their depth; none at its beginning or end."""
        passes, trace = self.passes, self.trace
        moved = np.abs(trace.path.z - trace.path.z_before)[passes.row] > ROUNDING
        moved &= passes.in_ring & passes.compensated[passes.number]
        if not moved.any():
            return trace.blocks.nowhere
        count = np.add.reduceat(moved.astype(np.int64), passes.first)
        ring_first, ring_last = passes.ring
        few = (count > 0) & (count <= _MOST_CHANGES) & (ring_last - ring_first + 1 >= _LEAST_MOVES)
        first, last = ring_first[passes.closed], ring_last[passes.closed]
        at_ends = column_at(len(passes.first), passes.number[first], moved[first] | moved[last], False)
        chosen: Rows = np.flatnonzero(moved & (few & ~at_ends)[passes.number])
        return trace.blocks.mask_of(passes.row[chosen])
