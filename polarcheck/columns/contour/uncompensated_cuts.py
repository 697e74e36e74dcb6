"""Moves without compensation that cut into the part of the contours of their section, by rows."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.overcuts import CutsOfRows, Overcuts
from polarcheck.columns.contour.skipped_loops import SkippedLoops, SkipReason
from polarcheck.columns.contour.slots import Slots
from polarcheck.columns.filling import before, fill_down
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, cached_property, mask_at
from polarcheck.foundation.states import Motion
from polarcheck.geometry.cutter_compensation.offset_path import Phase
from polarcheck.geometry.overcuts.uncompensated_moves import Bare, flat_loops, may_reach
from polarcheck.geometry.segments import Curves
from polarcheck.geometry.tolerances import ADJUSTMENT, ROUNDING


class UncompensatedCuts(Columns, frozen=True):
    """Columns of one trace, one value per row: the depth of cuts by moves without compensation, 0 for none."""

    trace: Trace
    tool_center: ToolCenter
    overcuts: Overcuts
    slots: Slots

    @cached_property
    def _has_contour(self) -> Mask:
        """
        Rows of sections with compensation, and the rows after them up to the next G12.1; but for cuts of a tool that is
        taken in the mode and never compensated there: a drill goes into the part.
        """
        trace = self.trace
        section = fill_down(trace.mode.section, (trace.mode.section >= 0) | trace.blocks.starts, -1)
        has = mask_at(len(trace.mode.sections) + 1, trace.mode.section[trace.compensation.compensates])
        taken = trace.tools.changes_tool & trace.mode.in_polar
        if not taken.any():
            return has[section]
        since = fill_down(np.where(taken, np.cumsum(taken), 0), taken | trace.mode.enters | trace.blocks.starts, 0)
        compensates = mask_at(int(since.max()) + 1, since[trace.compensation.compensates])
        works_alone = (since > 0) & ~compensates[since] & (trace.axes.motion != Motion.RAPID)
        return np.asarray(has[section] & ~works_alone)

    @cached_property
    def _is_behind_contour(self) -> Mask:
        """Rows of sections after the first start-up, and all rows outside sections."""
        trace = self.trace
        return np.asarray((trace.mode.section < 0) | trace.mode.given_in_section(trace.compensation.starts_up))

    @cached_property
    def _is_beside_bad_ramp(self) -> Mask:
        """
        Rows before a start-up or after an offset cancel that is too short or cuts the part.

        Such a ramp begins or ends too near to the part: cuts beside it are consequences.
        """
        trace = self.trace
        moving = np.flatnonzero(trace.mode.in_polar & trace.path.travels)
        short = trace.path.length < np.abs(trace.compensation.radius) - ROUNDING
        bad = short | (self.slots.ramp_depth > 0) | self.overcuts.objected
        rows = np.arange(len(trace))
        after = np.append(moving, -1)[np.searchsorted(moving, rows, side="right")]
        ahead = np.append(-1, moving)[np.searchsorted(moving, rows, side="left")]
        begins = (after >= 0) & (trace.compensation.starts_up & bad)[after]
        return np.asarray(begins | ((ahead >= 0) & (trace.compensation.cancels & bad)[ahead]))

    @property
    def cuts(self) -> CutsOfRows:
        """The deepest cut of each move, with the row of the contour whose part is cut."""
        return self._all_cuts[0]

    @property
    def skipped(self) -> SkippedLoops:
        """Loops whose part is not searched for cuts."""
        return SkippedLoops.of({SkipReason.CROSSES: self._all_cuts[1]})

    @cached_property
    def _all_cuts(self) -> tuple[CutsOfRows, Rows]:
        """The cuts, and the loops that cross each other too often to be searched."""
        nothing = CutsOfRows.none(), np.zeros(0, np.int64)
        if not self.overcuts.compensates:
            return nothing
        row, start, end, center, z, section = (
            np.concatenate(column)
            for column in zip(self._on_plane, self._of_z_alone, self._after_the_mode, strict=True)
        )
        trace, (walls, left) = self.trace, self.overcuts.walls
        radius = np.abs(trace.compensation.radius[row])
        usable = (radius > ADJUSTMENT + ROUNDING) & ~np.isnan(z + np.abs(start) + np.abs(end))
        # At Z0 or above, a move to the contour is in air.
        usable = np.flatnonzero(usable & ((z < -ROUNDING) | self._is_behind_contour[row]))
        if not len(usable) or not len(walls):
            return nothing
        kind = np.where(np.isnan(center), Motion.LINE, trace.axes.motion[row]).astype(np.int16)
        plunges = np.abs(end - start) == 0
        plunges &= np.isnan(center)
        bare = Bare(Curves(start, end, center, kind, section, row), z, radius, plunges)[usable]
        loops = flat_loops(walls, trace.mode.section[walls.row], trace.path.z[walls.row])
        bare = bare[may_reach(loops, bare)]
        if not len(bare.z):
            return nothing
        from polarcheck.geometry.overcuts.without_compensation import cuts_into_part
        from polarcheck.geometry.polygons.finished_part import Contours

        no_rows, tolerance = np.zeros(0, np.int64), trace.machine.compensation.overcut_tolerance
        contours = Contours(walls, left, no_rows, no_rows, np.zeros(0), self.overcuts.bar, tolerance)
        cuts, tangled = cuts_into_part(contours, loops, bare)
        return CutsOfRows.of(cuts, bare.curves, walls), tangled

    @property
    def _is_stroke(self) -> Mask:
        """Lines to and fro, at feed, behind a move of Z down: a slot that is as wide as the tool."""
        trace, path = self.trace, self.trace.path
        rows = np.flatnonzero(trace.mode.in_polar & path.moves)
        plunge, out, back = rows[:-2], rows[1:-1], rows[2:]
        goes_down = path.moves_z & ~path.travels & (path.z < path.z_before - ROUNDING)
        is_line = (trace.axes.motion == Motion.LINE) & path.travels & ~path.moves_z
        strokes = goes_down[plunge] & is_line[out] & is_line[back] & (np.diff(trace.mode.section[rows])[1:] == 0)
        strokes &= np.abs(path.end[back] - path.start[out]) <= ROUNDING
        return trace.blocks.mask_of(np.append(out[strokes], back[strokes]))

    @property
    def _on_plane(self) -> tuple[Rows, Points, Points, Points, Floats, Rows]:
        """Moves on the plane: row, start, end, center, the highest Z, section."""
        moves = self.tool_center.moves
        moves = moves[(moves.phase == Phase.CANCELLED) & self._has_contour[moves.row] & ~self._is_stroke[moves.row]]
        z = np.maximum(self.trace.path.z, before(self.trace.path.z, self.trace.blocks.starts, np.nan))[moves.row]
        return moves.row, moves.start, moves.end, moves.center, z, moves.section

    @property
    def _of_z_alone(self) -> tuple[Rows, Points, Points, Points, Floats, Rows]:
        """Moves of Z alone down into the material, as points at the Z of their end."""
        trace = self.trace
        down = (
            trace.mode.in_polar
            & trace.path.moves_z
            & ~trace.path.travels
            & ~trace.compensation.compensates
            & ~trace.compensation.offset_mode
        )
        down &= (
            ~trace.modal.in_cycle
            & self._has_contour
            & ~(trace.path.z >= before(trace.path.z, trace.blocks.starts, np.nan))
        )
        row = np.flatnonzero(down)
        point = trace.path.end[row]
        return row, point, point, np.full(len(row), np.nan + 0j), trace.path.z[row], trace.mode.section[row]

    @property
    def _after_the_mode(self) -> tuple[Rows, Points, Points, Points, Floats, Rows]:
        """
        The first move after a G13.1, if it is a rapid move of X alone.

        C stands still: from the end of the section the tool moves on a straight line through the center of C.
        """
        trace = self.trace
        last = np.flatnonzero(trace.mode.leaves) - 1
        moves = np.flatnonzero(
            trace.path.moves | trace.mode.enters | trace.blocks.starts | trace.blocks.listed("reference_return")
        )
        row = np.append(moves, -1)[np.searchsorted(moves, last, side="right")]
        last, row = last[row >= 0], row[row >= 0]
        further = trace.path.moves_z | trace.path.moves_c | trace.blocks.has("Y", "V", "B")
        alone = (trace.axes.motion == Motion.RAPID) & trace.path.moves_x & ~further
        alone &= (
            self._has_contour & (trace.mode.section < 0) & (trace.compensation.side == trace.compensation.side_before)
        )
        last, row = last[alone[row]], row[alone[row]]
        point = trace.path.end[last]
        with np.errstate(invalid="ignore"):  # at the center the direction is not known
            direction = point / np.abs(point)
        return (
            row,
            point,
            direction * trace.path.x[row],
            np.full(len(row), np.nan + 0j),
            trace.path.z[row],
            trace.mode.section[last],
        )

    @cached_property
    def depth(self) -> Floats:
        """Depth of the deepest cut of a move without compensation into the part [mm], at most R; 0 for none."""
        column = self.cuts.depth_by_row(len(self.trace))
        if column.any():
            column[self._is_beside_bad_ramp & (column < np.abs(self.trace.compensation.radius))] = 0
        return column

    @cached_property
    def is_rapid(self) -> Mask:
        """Rows that cut in rapid traverse."""
        return np.asarray((self.depth > 0) & (self.trace.axes.motion == Motion.RAPID))

    @cached_property
    def graveness(self) -> Floats:
        """The depth, increased for rapid traverse above that of all moves at feed."""
        return np.where(self.is_rapid, self.depth + self.depth.max(initial=0.0), self.depth)
