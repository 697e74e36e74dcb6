"""Blocks of a loop that cut into another loop of the same section at the same depth, as in a slot."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.overcuts import CutsOfRows, Overcuts
from polarcheck.columns.contour.skipped_loops import SkippedLoops, SkipReason
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, computed
from polarcheck.geometry.tolerances import ROUNDING


class Slots(Columns, frozen=True):
    """Columns of one trace, one value per row: the depth of cuts into the part of another loop, 0 for none."""

    trace: Trace
    overcuts: Overcuts

    @cached_property
    def _all_cuts(self) -> tuple[CutsOfRows, Mask, Rows]:
        """
        All cuts of moves of the tool center into other loops.

        Further: a mask of the cuts by ramps, and the loops that cross each other too often to be searched.
        """
        nothing = CutsOfRows.none(), np.zeros(0, bool), np.zeros(0, np.int64)
        if not self.overcuts.compensates:
            return nothing
        level, several = self._levels
        if not several.any():
            return nothing
        from polarcheck.geometry.overcuts import other_loops
        from polarcheck.geometry.polygons.finished_part import Contours

        walls, material_left = self.overcuts.walls
        chosen = several[walls.row]
        walls, material_left = walls[chosen], material_left[chosen]
        path, is_ramp = self.overcuts.path
        of_walls = np.isin(path.loop, walls.loop) & ~self.overcuts.objected[path.row]
        path, is_ramp = path[of_walls], is_ramp[of_walls]
        radius = np.abs(self.trace.compensation.radius[path.row])
        no_rows = np.zeros(0, np.int64)
        tolerance = self.trace.machine.compensation.overcut_tolerance
        contours = Contours(walls, material_left, no_rows, no_rows, np.zeros(0), self.overcuts.bar, tolerance)
        cuts, tangled = other_loops.cuts_into_others(contours, level[walls.row], path, radius, is_ramp)
        return CutsOfRows.of(cuts, path, walls), is_ramp[cuts.move], tangled

    @property
    def has_areas(self) -> bool:
        """True once polygons of loops have been computed: a level has several loops."""
        return "_all_cuts" in vars(self) and bool(self._levels[1].any())

    @cached_property
    def _levels(self) -> tuple[Rows, Mask]:
        """
        For rows in offset mode a number of the level of their loop; and a mask of levels with several loops.

        Loops of one section at one depth have the same level. Where Z is not known, loops without a Z move between
        them have the same depth. A loop that changes its depth has a level of its own.
        """
        trace = self.trace
        level, several = np.full(len(trace), -1), np.zeros(len(trace), bool)
        rows = np.flatnonzero(trace.compensation.compensates & trace.path.travels & ~trace.compensation.starts_up)
        loop = self.overcuts.loop[rows]
        begins = np.diff(loop, prepend=-1) != 0
        first, number = np.flatnonzero(begins), np.cumsum(begins) - 1
        if len(first) < 2:
            return level, several
        z = np.rint(trace.path.z[rows] / ROUNDING)
        low, high = np.minimum.reduceat(z, first), np.maximum.reduceat(z, first)
        parted = np.cumsum(trace.path.moves_z)[rows][first]
        unknown, slopes = np.isnan(low), low != high
        depth = np.where(unknown, parted, np.where(slopes, np.arange(len(first)), low))
        kind = np.where(unknown, 0, np.where(slopes, 1, 2))
        key = np.stack([trace.mode.section[rows][first], kind, depth], axis=1)
        _, of_loop, count = np.unique(key, axis=0, return_inverse=True, return_counts=True)
        of_loop = of_loop.ravel()
        level[rows], several[rows] = of_loop[number], (count[of_loop] > 1)[number]
        return level, several

    @property
    def compared(self) -> Mask:
        """Rows in offset mode of loops that have another loop at the same level."""
        return self._levels[1]

    @property
    def skipped(self) -> SkippedLoops:
        """Loops that are not searched for cuts into each other."""
        return SkippedLoops.of({SkipReason.CROSSES: self._all_cuts[2]})

    @cached_property
    def cuts(self) -> CutsOfRows:
        """All cuts by moves in offset mode."""
        cuts, by_ramp, _ = self._all_cuts
        return cuts[~by_ramp]

    @cached_property
    def sweeps(self) -> CutsOfRows:
        """All cuts by ramps at the depth of their contour."""
        cuts, by_ramp, _ = self._all_cuts
        return cuts[by_ramp]

    @cached_property
    def depth(self) -> Floats:
        """Depth of the deepest cut of a row in offset mode into a wall of another loop [mm], 0 for none."""
        return self.cuts.depth_by_row(len(self.trace))

    @property
    def diameter(self) -> Floats:
        """Twice R [mm]."""
        return np.asarray(2 * np.abs(self.trace.compensation.radius))

    @cached_property
    def sweep_depth(self) -> Floats:
        """Depth of the deepest cut of a ramp into a wall of another loop [mm], 0 for none."""
        return self.sweeps.depth_by_row(len(self.trace))

    @cached_property
    def ramp_depth(self) -> Floats:
        """Depth of the deepest cut of a ramp into its contour or another loop [mm], 0 for none."""
        return computed(np.maximum, self.overcuts.sweep_depth, self.sweep_depth)

    @cached_property
    def slot(self) -> Rows:
        """
        The same number for all blocks of one slot: those of two loops that cut into each other; -1 for other rows.

        The same walls written again at another depth have the same number.
        """
        cuts, trace = self.cuts, self.trace
        label = np.full(len(trace), -1)
        if not len(cuts):
            return label
        loop = self.overcuts.loop
        cutting_loop, cut_loop = loop[cuts.row], loop[cuts.into]
        from polarcheck.geometry.polygons.noding import merged

        first = merged(int(loop.max()) + 1, cutting_loop, cut_loop)
        group, number = np.unique(first[cutting_loop], return_inverse=True)
        # The same walls written again at another depth have the same bounding box.
        ends = np.stack(
            [
                trace.path.start[cuts.row],
                trace.path.end[cuts.row],
                trace.path.start[cuts.into],
                trace.path.end[cuts.into],
            ]
        )
        key = np.full((len(group), 5), np.inf)
        key[number, 4] = trace.mode.section[cuts.row]
        for side, values in enumerate((ends.real, ends.imag, -ends.real, -ends.imag)):
            np.minimum.at(key[:, side], number, np.rint(values.min(axis=0) / ROUNDING))
        _, box = np.unique(key, axis=0, return_inverse=True)
        label[cuts.row] = box.ravel()[number]
        return label

    def width(self, row: int) -> float:
        """Distance of the deepest cut of a row from the contour of the same loop [mm]."""
        import shapely  # type: ignore[import-untyped]

        from polarcheck.geometry.polygons.faces import coordinates, lines_of
        from polarcheck.geometry.segments import segments

        walls, _ = self.overcuts.walls
        chords = segments(
            walls[walls.loop == self.overcuts.loop[row]], self.trace.machine.compensation.overcut_tolerance
        )
        _, point = self.cuts.deepest(row)
        return float(
            shapely.distance(lines_of(chords.start, chords.end), shapely.points(coordinates(np.array(point)))).min()
        )
