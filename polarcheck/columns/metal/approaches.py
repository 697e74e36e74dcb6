"""
Where mills go down below the face in a section that reaches the rim of the bar, and how far off X0 that has to be.

A section that goes below the face before G12.1 is judged where it stands at G12.1; so is one that has no Z.
"""

from __future__ import annotations

import numpy as np

from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.workpiece import ToolMoves, Workpiece
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, cached_property, column_at, folded
from polarcheck.foundation.states import Motion
from polarcheck.geometry import polar
from polarcheck.geometry.tolerances import ROUNDING

#: A tip less far below the face than this touches nothing [mm].
_CLEARANCE = 0.01


class Approaches(Columns, frozen=True):
    """Columns of one trace, one value per row; the row is G12.1 where the cutter goes down where it stands there."""

    trace: Trace
    tool_center: ToolCenter
    bar: Bar
    workpiece: Workpiece

    @property
    def clearance(self) -> Floats:
        """Clearance between stock and tool that the job demands at the approach, on the diameter [mm]."""
        return np.broadcast_to(self.trace.job.stock.clearance * self.trace.lengths.job_scale, len(self.trace))

    @cached_property
    def _is_below(self) -> Mask:
        """Rows of sections with the tip below the face; all rows of those of which nobody knows how deep they cut."""
        trace, z = self.trace, self.trace.path.z
        inside = trace.mode.in_polar | trace.mode.enters
        below = inside & (z < self.workpiece.top - _CLEARANCE)
        return np.asarray(below | (inside & self._has_no_depth))

    @cached_property
    def _has_no_depth(self) -> Mask:
        """Rows of sections in which no Z is known, or Z never moves, and the face is not known."""
        trace = self.trace
        knows = (trace.mode.in_polar | trace.mode.enters) & ~np.isnan(trace.path.z)
        if np.isnan(self.bar.known.face):
            knows &= trace.path.moves_z | (trace.path.z < self.workpiece.top - _CLEARANCE)
        return ~trace.mode.anywhere_in_section(knows)

    @cached_property
    def _plunges(self) -> Rows:
        """Rows in which the tip goes below the face, or deeper, and rows of G12.1 where it is below."""
        trace, below = self.trace, self._is_below
        if self.bar.known.source in ("comment", "none") or not below.any():
            return np.zeros(0, np.int64)
        deeper = below & trace.mode.in_polar & (trace.path.z < trace.path.z_before - ROUNDING)
        deeper &= ~trace.modal.in_cycle & ~(trace.compensation.compensates & np.append(False, below[:-1]))
        return np.flatnonzero(deeper | (below & trace.mode.enters))

    @cached_property
    def _stands(self) -> Mask:
        """
        Of these rows, those that stand where G12.1 did.

        Where compensation begins above the face, X of G12.1 counts as long as no other X is written before that: it is
        the approach point of the builder's guide.
        """
        trace, rows = self.trace, self._plunges
        inside, compensated = trace.mode.in_polar, trace.compensation.compensates
        moved = np.cumsum(inside & trace.path.travels)
        moved_x = np.cumsum(inside & trace.path.travels & trace.blocks.has("X", "U") & ~compensated)
        enter = trace.mode.sections.enter[trace.mode.section[rows]]
        above = np.maximum(rows - 1, 0)
        same = np.where(compensated[rows], moved_x[above] <= moved_x[enter], moved[above] <= moved[enter])
        return np.asarray(same | trace.mode.enters[rows])

    @cached_property
    def _points(self) -> Points:
        """Where the tool center stands in these rows [mm], on the plane of their section."""
        trace, rows, moves = self.trace, self._plunges, self.tool_center.moves
        point = trace.path.start[rows]
        compensated = trace.compensation.compensates[rows]
        if compensated.any():
            last = np.searchsorted(np.maximum.accumulate(moves.row), rows) - 1
            point = np.where(compensated, np.append(moves.end, np.nan)[last], point)
        enter = trace.mode.sections.enter[trace.mode.section[rows]]
        return np.asarray(np.where(self._stands, trace.path.x[enter], point), np.complex128)

    @cached_property
    def _inner(self) -> Floats:
        """The radius of the bar at the depth of these rows [mm]."""
        rows = self._plunges
        z = self.trace.path.z[rows]
        inner = self.bar.inner(rows, z)
        return np.where(self._has_no_depth[rows], self.bar.known.smallest / 2, inner)

    @cached_property
    def _reaches_rim(self) -> Mask:
        """
        Of these rows, those from which the cutter goes to the rim of the bar before it is lifted above the face.

        A pocket is within, and plunged into. What counts is the tool center: the wall of a pocket lies R farther out.
        Where a cutter stays nearer to X0 than the contour that it cuts, its ramps do not count: one that leaves the
        pocket is wrong, and not the approach.
        """
        trace, rows, below = self.trace, self._plunges, self._is_below
        rises = ~below | np.append(True, np.diff(trace.mode.section) != 0)
        stretch = np.cumsum(rises)
        walls = below & trace.compensation.compensates & trace.path.travels & ~trace.compensation.starts_up
        center = self._farthest(self.tool_center.farthest, walls, stretch)
        farthest = polar.farthest(*trace.path.moves_of(np.flatnonzero(walls)).shape)
        programmed = column_at(len(trace), walls, farthest, -np.inf)
        is_within = center < self._farthest(programmed, walls, stretch) - ROUNDING
        farthest = np.where(is_within, center, self._farthest(self.tool_center.farthest, below, stretch))
        reach = farthest[rows] + np.nan_to_num(trace.offsets.cutter_diameter[rows]) / 2
        return np.asarray(reach > self._inner + ROUNDING)

    @staticmethod
    def _farthest(distance: Floats, rows: Mask, stretch: Rows) -> Floats:
        """The largest distance [mm] in some rows of each stretch, for each row; -inf without such a row."""
        farthest = folded(np.fmax, stretch[rows], distance[rows], int(stretch[-1]) + 1, -np.inf)
        return np.asarray(farthest[stretch])

    @cached_property
    def _was_clear(self) -> Mask:
        """Of these rows, those that stood beside the bar or above it before: the others go on in their own cut."""
        trace, rows = self.trace, self._plunges
        before = np.where(self._is_below[np.maximum(rows - 1, 0)], trace.path.z_before[rows], np.inf)
        before = np.where(trace.mode.enters[rows], np.inf, before)
        inner = np.where(np.isinf(before), 0.0, self.bar.inner(rows, np.where(np.isinf(before), 0.0, before)))
        radius = np.nan_to_num(trace.offsets.cutter_diameter[rows]) / 2
        return np.asarray(np.isinf(before) | ~(np.abs(self._points) < inner + radius - ROUNDING))

    @cached_property
    def _index(self) -> tuple[Rows, Rows]:
        """The plunges that count, as numbers, and the row of each: G12.1 where the tool has stood there since."""
        trace = self.trace
        chosen = np.flatnonzero(self._reaches_rim & self._was_clear)
        rows = self._plunges[chosen]
        enter = trace.mode.sections.enter[trace.mode.section[rows]]
        return chosen, np.where(self._stands[chosen], enter, rows)

    def _column(self, values: Floats) -> Floats:
        chosen, rows = self._index
        return column_at(len(self.trace), rows[::-1], values[chosen[::-1]], np.nan)

    @cached_property
    def approaches(self) -> Mask:
        """Rows where the cutter goes down for a cut that reaches the rim of the bar."""
        return self.trace.blocks.mask_of(self._index[1])

    @cached_property
    def distance(self) -> Floats:
        """How far the tool center stands off X0 there [mm]; at G12.1 X as a radius."""
        return self._column(np.where(self._stands, self._points.real, np.abs(self._points)))

    @cached_property
    def stock_radius(self) -> Floats:
        """The radius of the bar at the depth to which the cutter goes [mm]."""
        return self._column(self._inner)

    @cached_property
    def depth(self) -> Floats:
        """Z to which the cutter goes [mm]."""
        return self._column(self.trace.path.z[self._plunges])

    @cached_property
    def x_needed(self) -> Floats:
        """How far off X0 clears the bar, as a radius [mm]: half of stock, cutter and clearance."""
        return self.stock_radius + (self.trace.offsets.cutter_diameter + self.clearance) / 2

    @cached_property
    def is_near(self) -> Mask:
        """Rows that stand nearer, and metal of the bar is left there."""
        near = self.approaches & (self.distance < self.x_needed - ROUNDING)
        return near & ~self._is_cleared(near) if near.any() else near

    def _is_cleared(self, near: Mask) -> Mask:
        """Mills have taken off all of the bar there before."""
        trace, cleared = self.trace, np.zeros(len(self.trace), bool)
        chosen, rows = self._index
        cuts = np.flatnonzero(trace.mode.in_polar & trace.path.cuts & trace.path.travels & self._is_below)
        is_later = near[rows] & (np.append(cuts, len(trace))[0] < self._plunges[chosen])
        is_later &= ~self._has_no_depth[self._plunges[chosen]]
        if not is_later.any():
            return cleared
        chosen, rows = chosen[is_later], rows[is_later]
        plunge = self._plunges[chosen]
        turn = trace.path.section_turn[trace.mode.section[plunge]]
        place = np.asarray(self._points[chosen] * turn, np.complex128)
        moves = ToolMoves(
            start=place,
            end=place,
            center=np.full(len(plunge), np.nan + 0j),
            kind=np.full(len(plunge), Motion.LINE, np.int16),
            row=plunge,
            tip=trace.path.z[plunge],
            radius=(trace.offsets.cutter_diameter[plunge] + self.clearance[plunge]) / 2,
            is_rapid=np.zeros(len(plunge), bool),
            plunges=np.ones(len(plunge), bool),
            is_sure=np.ones(len(plunge), bool),
        )
        cleared[rows[~self.workpiece.hits_on_bar(moves)[0]]] = True
        return cleared
