"""Blocks that cut into the contour: the cuts that the geometry finds in loops, by rows of the trace."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

import numpy as np

from polarcheck.columns.contour.skipped_loops import SkippedLoops, SkipReason
from polarcheck.columns.filling import before
from polarcheck.columns.path.moves import Moves, programmed_moves
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Floats,
    Mask,
    Points,
    Rows,
    Table,
    cached_property,
    column_at,
    different,
    folded,
    repeated,
)
from polarcheck.foundation.states import Side
from polarcheck.geometry.cutter_compensation.offset_path import Phase
from polarcheck.geometry.tolerances import ADJUSTMENT, ROUNDING

if TYPE_CHECKING:
    from polarcheck.geometry.overcuts.cuts import Cuts
    from polarcheck.geometry.polygons.finished_part import PartsOfLoops
    from polarcheck.geometry.segments import Curves

#: Largest distance of two points that are intended as one [tolerances].
_ROUNDINGS = 10


def loop_of_row(trace: Trace) -> Rows:
    """
    Number of the loop of each row in offset mode, -1 elsewhere.

    A loop lasts from a start-up to its offset cancel. A Z move within it begins a new loop: the same contour at
    another depth is another loop.
    """
    begins = trace.compensation.starts_up | (trace.path.moves_z & ~trace.path.travels)
    return np.where(trace.compensation.compensates, np.cumsum(begins), -1)


def level_of(trace: Trace, walls: Curves) -> Rows:
    """For each wall a number of the level of its loop: its section, and the depth at which the loop begins."""
    first = np.flatnonzero(np.diff(walls.loop, prepend=-1))
    number = level_of_rows(trace, walls.row[first])
    return np.asarray(number[np.cumsum(np.diff(walls.loop, prepend=-1) != 0) - 1])


def level_of_rows(trace: Trace, row: Rows) -> Rows:
    """For each of these rows a number of its section and depth; where Z is not known, increments alone tell depths."""
    depth, is_known = trace.path.depth[row] / ROUNDING, ~np.isnan(trace.path.z[row])
    keys = np.stack([trace.mode.section[row], np.round(depth), is_known], axis=1)
    return np.asarray(np.unique(keys, axis=0, return_inverse=True)[1].ravel())


class CutsOfRows(Table, frozen=True):
    """
    Cuts into contours by rows of the trace, n of them.

    row: int[n], the row that cuts.
    into: int[n], the row of the contour that is cut.
    depth: float64[n] [mm].
    place: complex128[n] [mm], plane point.
    """

    row: Rows
    into: Rows
    depth: Floats
    place: Points

    @classmethod
    def none(cls) -> Self:
        """No cuts."""
        return cls(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.complex128))

    @classmethod
    def of(cls, cuts: Cuts, path: Curves, walls: Curves) -> Self:
        """Cuts of moves into walls, by the rows of the moves and of the walls."""
        return cls(path.row[cuts.move], walls.row[cuts.wall].astype(np.int64), cuts.depth, cuts.place)

    def deepest(self, row: int) -> tuple[int, complex]:
        """The deepest cut of a row: the row that is cut, and the place."""
        of_row = np.flatnonzero(self.row == row)
        worst = of_row[np.argmax(self.depth[of_row])]
        return int(self.into[worst]), complex(self.place[worst])

    def depth_by_row(self, count: int) -> Floats:
        """The depth of the deepest cut of each row [mm], 0 for none; count: the number of rows."""
        if not len(self):
            return repeated(np.float64(0), count)
        return folded(np.maximum, self.row, self.depth, count, 0.0)


class Overcuts:
    """Columns of one trace, one value per row: the depth of the deepest cut, 0 for none; and all cuts."""

    def __init__(self, trace: Trace, tool_center: ToolCenter) -> None:
        self.trace = trace
        self.tool_center = tool_center

    @property
    def radius(self) -> Floats:
        """R with its sign [mm], NaN where it is not known."""
        return self.tool_center.radius

    @cached_property
    def has_walls(self) -> Mask:
        """
        Rows whose R is the radius of a cutter, so that the programmed path is the wall of the part.

        A small R may only adjust a programmed tool center path, which is no wall. A small negative R is an adjustment.
        A small positive R is one if a comment states a larger cutter.
        """
        trace = self.trace
        radius = trace.compensation.radius
        small = np.abs(radius) <= ADJUSTMENT + ROUNDING
        cutter = small & (radius > ROUNDING) & trace.mode.in_polar
        if cutter.any():
            larger = [
                number
                for number, comment in trace.offsets.radii_in_comments.items()
                if comment.radius > ADJUSTMENT + ROUNDING
            ]
            cutter &= ~np.isin(trace.tools.offset_number, larger)
        return np.asarray(~np.isnan(radius) & (~small | cutter))

    @cached_property
    def compensates(self) -> bool:
        """True if any section is compensated and has walls."""
        return bool(np.any(self.trace.compensation.compensates & self.has_walls))

    @cached_property
    def loop(self) -> Rows:
        return loop_of_row(self.trace)

    @cached_property
    def _loop_of_ramps(self) -> Rows:
        """As loop_of_row, but a ramp has the loop of the wall beside it even if Z moves."""
        trace, wall = self.trace, np.append(self._wall_beside, 0)
        loop, ramp = self.loop.copy(), np.flatnonzero(trace.compensation.starts_up | trace.compensation.cancels)
        loop[ramp] = np.where(wall[ramp] >= 0, self.loop[wall[ramp]], -1)
        return loop

    @cached_property
    def _wall_beside(self) -> Rows:
        """The row of the wall after a start-up or before an offset cancel; -1 for none and for other rows."""
        trace = self.trace
        adjacent = np.full(len(trace), -1)
        moving = np.flatnonzero(trace.mode.in_polar & trace.path.travels)
        is_wall = (trace.compensation.compensates & ~trace.compensation.starts_up)[moving]
        adjacent[moving[:-1]] = np.where(trace.compensation.starts_up[moving[:-1]] & is_wall[1:], moving[1:], -1)
        cancels = trace.compensation.cancels[moving[1:]]
        adjacent[moving[1:][cancels]] = np.where(is_wall[:-1], moving[:-1], -1)[cancels]
        return adjacent

    @cached_property
    def objected(self) -> Mask:
        return objected(self.trace, self.tool_center)

    @cached_property
    def beyond_bounds(self) -> SkippedLoops:
        """Loops that reach too far out or have too many chords: walls and path leave them out."""
        if not self.compensates:
            return SkippedLoops.of({})
        from polarcheck.geometry.overcuts import bounds

        tolerance = self.trace.machine.compensation.overcut_tolerance
        walls, path = self._all_walls, self._whole_path[0]
        far = bounds.far_loops(walls, path)
        near = [curves[~np.isin(curves.loop, far)] if len(far) else curves for curves in (walls, path)]
        long = different(np.concatenate([bounds.long_loops(curves, tolerance) for curves in near]))
        return SkippedLoops.of({SkipReason.TOO_FAR: far, SkipReason.TOO_MANY_CHORDS: long})

    @property
    def skipped(self) -> SkippedLoops:
        """Loops that are not searched for cuts."""
        crossing = SkippedLoops.of({SkipReason.CROSSES: self._all_cuts[2]})
        return SkippedLoops.concatenated([self.beyond_bounds, crossing])

    @cached_property
    def walls(self) -> tuple[Curves, Mask]:
        """
        The contour programmed in offset mode, and a mask of the walls with the tool on their left.

        Loops beyond all bounds are left out.
        """
        walls, beyond = self._all_walls, self.beyond_bounds.loop
        walls = walls[~np.isin(walls.loop, beyond)] if len(beyond) else walls
        return walls, (self.trace.compensation.side[walls.row] == Side.LEFT) ^ (self.radius[walls.row] < 0)

    @cached_property
    def _all_walls(self) -> Curves:
        return self._walls_of(self.has_walls)

    def _walls_of(self, rows_of_cutters: Mask) -> Curves:
        is_wall = (self.loop >= 0) & ~self.trace.compensation.starts_up & rows_of_cutters
        programmed = programmed_moves(self.trace, is_wall)
        return curves_of(programmed, self.loop[programmed.row], programmed.known)

    @cached_property
    def walls_of_unknown_radius(self) -> tuple[Curves, Mask]:
        """
        The same for rows of unknown R: the contour if R is the radius of a cutter.

        The part depends on the side of the tool, not on R, unless R is negative.
        """
        from polarcheck.geometry.overcuts import bounds

        walls = self._walls_of(np.isnan(self.radius) & ~self.trace.compensation.sides_are_open)
        far = bounds.far_loops(walls, walls) if len(walls) else np.zeros(0, np.int64)
        walls = walls[~np.isin(walls.loop, far)] if len(far) else walls
        return walls, self.trace.compensation.side[walls.row] == Side.LEFT

    @property
    def path(self) -> tuple[Curves, Mask]:
        """
        The moves of the tool center in offset mode, the ramps at the depth of their contour, and a mask of the ramps.

        Each move has the number of its loop. Loops beyond all bounds are left out. Not stored: it is large.
        """
        path, is_ramp = self._whole_path
        skipped = self.beyond_bounds.loop
        within = ~np.isin(path.loop, skipped)
        return (path[within], is_ramp[within]) if len(skipped) else (path, is_ramp)

    @property
    def _whole_path(self) -> tuple[Curves, Mask]:
        tool = self.tool_center.moves
        is_ramp = (tool.phase == Phase.START_UP) | (tool.phase == Phase.CANCEL)
        chosen = np.where(is_ramp, self._at_depth[tool.row], tool.phase == Phase.OFFSET)
        chosen &= tool.known & self.has_walls[tool.row]
        loop = np.where(is_ramp, self._loop_of_ramps[tool.row], self.loop[tool.row])
        return curves_of(tool, loop, chosen), is_ramp[chosen]

    @cached_property
    def _all_cuts(self) -> tuple[CutsOfRows, Mask, Rows, PartsOfLoops | None]:
        """
        The cuts of all moves of the tool center, a mask of cuts by ramps, and the loops that cross themselves.

        Further: the parts of the loops that were searched.
        """
        nothing = CutsOfRows.none(), np.zeros(0, bool), np.zeros(0, np.int64), None
        if not self.compensates:
            return nothing
        if self._keeps_away:
            return nothing
        from polarcheck.geometry.overcuts import own_loop

        walls, left = self.walls
        around = self._air_radius(walls), self.level  # before the path, which is large
        path, is_ramp = self.path
        radius = self._radius_of(path)
        tolerance = self.trace.machine.compensation.overcut_tolerance
        cuts, tangled, parts = own_loop.overcuts(walls, left, *around, path, radius, is_ramp, tolerance, self.bar)
        return CutsOfRows.of(cuts, path, walls), is_ramp[cuts.move], tangled, parts

    def _radius_of(self, path: Curves) -> Floats:
        """For each of these moves of `path` its R [mm]; with an allowance, the cutter stays away from the contour."""
        return np.abs((self.radius - self.trace.compensation.allowance)[path.row])

    @cached_property
    def _keeps_away(self) -> bool:
        """True if all moves of `path` stay away from all walls, without any polygon."""
        from polarcheck.geometry.overcuts.clearance import keeps_away

        tolerance = self.trace.machine.compensation.overcut_tolerance
        path, _ = self.path
        return bool(keeps_away(self.walls[0], path, self._radius_of(path), tolerance))

    @property
    def has_areas(self) -> bool:
        """True once polygons of loops have been computed."""
        return "_all_cuts" in vars(self) and self.compensates and not self._keeps_away

    def _air_radius(self, walls: Curves) -> Floats:
        """
        For each wall the radius about the center of C outside which there is air [mm].

        In a section with contours that do not end where they begin, the bar reaches no farther than their ends.
        """
        if not len(walls):
            return np.zeros(0)
        first = np.flatnonzero(np.diff(walls.loop, prepend=-1))
        last = np.append(first[1:], len(walls)) - 1
        start, end = walls.start[first], walls.end[last]
        apart = np.abs(end - start) > 2 * np.abs(self.trace.compensation.radius[walls.row[first]])
        ends = np.where(apart, np.minimum(np.abs(start), np.abs(end)), np.inf)
        section = self.trace.mode.section[walls.row]
        least = folded(np.fmin, section[first], ends, len(self.trace.mode.sections) + 1, np.inf)
        return least[section]

    @cached_property
    def level(self) -> Rows:
        """For each wall the number of its level, see level_of."""
        return level_of(self.trace, self.walls[0])

    @cached_property
    def cuts(self) -> CutsOfRows:
        """All cuts by moves in offset mode."""
        cuts, by_ramp, *_ = self._all_cuts
        return cuts[~by_ramp]

    @cached_property
    def sweeps(self) -> CutsOfRows:
        """All cuts by start-ups and offset cancels at the depth of their contour."""
        cuts, by_ramp, *_ = self._all_cuts
        return cuts[by_ramp]

    @cached_property
    def _at_depth(self) -> Mask:
        """
        Ramps that may cut material: they run at the Z of the contour or lower, or below the face.

        The face is at Z0, as is usual on lathes. Where Z is not known, these are ramps without a Z move beside them.
        """
        trace, wall = self.trace, self._wall_beside
        ramp = np.flatnonzero(wall >= 0)
        z_of_ramp = np.fmax(trace.path.z[ramp], before(trace.path.z, trace.blocks.starts, np.nan)[ramp])
        z_of_wall = trace.path.z[wall[ramp]]
        moves_z = np.cumsum(trace.path.moves_z & ~trace.path.travels)
        deep = np.where(
            np.isnan(z_of_ramp - z_of_wall),
            moves_z[ramp] == moves_z[wall[ramp]],
            (z_of_ramp <= z_of_wall + ROUNDING) | (z_of_ramp < -ROUNDING),
        )
        return column_at(len(trace), ramp, deep, False)

    def comes_out_of_part(self, rows: Mask) -> Mask:
        """
        Those of these start-ups and offset cancels that run through the part as programmed, if they lie at the depth of
        their contour; others, if the contour begins or ends within the part.

        The part is that for a cutter of any size: only a gap that rounding leaves is closed.
        """
        from polarcheck.geometry.polygons.depth_inside import depth_inside

        trace, tolerance = self.trace, self.trace.machine.compensation.overcut_tolerance
        starts_up = trace.compensation.starts_up
        has_walls = np.isin(self._loop_of_ramps, self.walls[0].loop)
        ramp = np.flatnonzero(has_walls & rows & (starts_up | trace.compensation.cancels) & ~trace.path.is_arc)
        contour_at = np.where(starts_up, trace.path.end, trace.path.start)[ramp]
        far = np.where(starts_up, trace.path.start, trace.path.end)[ramp]
        ramps = np.where(self._at_depth[ramp], far, contour_at), contour_at
        parts = self._all_cuts[3] if np.isnan(self.bar) else None
        depth = depth_inside(*self.walls, ramps, self._loop_of_ramps[ramp], tolerance, _ROUNDINGS * tolerance, parts)
        return trace.blocks.mask_of(ramp[depth > _ROUNDINGS * tolerance])

    @cached_property
    def bar(self) -> float:
        """Diameter of the stock [mm]; NaN if not known."""
        diameter = self.trace.lengths.stock_diameter[self.trace.compensation.compensates]
        return float(diameter[0]) if len(diameter) else np.nan

    @cached_property
    def depth(self) -> Floats:
        """Depth of the deepest cut of the row into its contour [mm]; 0 for none, and where the control objects."""
        return self._depth_of(self.cuts)

    @cached_property
    def wall(self) -> Rows:
        """
        The same number for all blocks that belong to one overcut; -1 for other rows.

        Blocks belong together if one cuts the other, as the two walls of a groove do, or if both cut or are cut and
        follow each other in a loop, as round a wrong point. The number is the first of these blocks.
        """
        first: dict[int, int] = {}

        def root(block: int) -> int:
            while (parent := first.setdefault(block, block)) != block:
                first[block] = first[parent]  # shortens the next search
                block = parent
            return block

        block, cutting, cut = self.trace.run.block, self.cuts.row, self.cuts.into
        moving = np.flatnonzero(self.trace.path.on_plane)
        involved = np.isin(moving, np.concatenate([cutting, cut])) & (self.loop[moving] >= 0)
        pairs = np.flatnonzero(involved[1:] & involved[:-1] & (np.diff(self.loop[moving]) == 0))
        cutting, cut = np.append(cutting, moving[pairs]), np.append(cut, moving[pairs + 1])
        for pair in zip(block[cutting].tolist(), block[cut].tolist(), strict=True):
            left_root, right_root = root(pair[0]), root(pair[1])
            first[max(left_root, right_root)] = min(left_root, right_root)
        label = np.full(len(self.trace.text.blocks), -1)
        for number in list(first):
            label[number] = root(number)
        return np.asarray(label[block])

    @cached_property
    def sweep_depth(self) -> Floats:
        """Depth of the deepest cut of a ramp into its contour [mm], 0 in loops with other overcuts."""
        if not len(self.sweeps.row):
            return repeated(np.float64(0), len(self.trace))
        loop = self._loop_of_ramps
        return np.where(np.isin(loop, loop[self.depth > 0]), 0.0, self._depth_of(self.sweeps))

    def _depth_of(self, cuts: CutsOfRows) -> Floats:
        """The depth of the deepest cut of each row [mm]; 0 for none, and where the control objects."""
        depth = cuts.depth_by_row(len(self.trace))
        return np.where(self.objected, 0.0, depth) if len(cuts) else depth


def curves_of(moves: Moves, loop: Rows, chosen: Mask) -> Curves:
    from polarcheck.geometry.segments import Curves

    curves = Curves(*moves.shape, loop, moves.row)
    return curves if chosen.all() else curves[chosen]


def objected(trace: Trace, tool_center: ToolCenter) -> Mask:
    """
    Rows that the control would reject while it compensates, and the moves before and after them.

    Their cuts into the contour are consequences, not mistakes of their own.
    """
    rows = tool_center.inside_arc_too_small | tool_center.interferes | tool_center.no_intersection
    rows |= tool_center.movement_missing | tool_center.arc_center_on_path
    moving = np.flatnonzero(trace.path.travels)
    on = rows[moving]
    near = on.copy()
    near[1:] |= on[:-1]
    near[:-1] |= on[1:]
    rows[moving] |= near
    return rows
