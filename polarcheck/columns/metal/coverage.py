"""Material that compensated contours leave: gaps in them, ribs at their ends, strips between passes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec
import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts, curves_of, loop_of_row
from polarcheck.columns.contour.skipped_loops import SkippedLoops, SkipReason
from polarcheck.columns.path.path import NOWHERE
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Points,
    Rows,
    cached_property,
    column_at,
    computed,
    different,
    folded,
    repeated,
)
from polarcheck.foundation.time_limit import keep_time

if TYPE_CHECKING:
    from polarcheck.geometry.contour_ends import Corners, Loops
    from polarcheck.geometry.material_left.ribs import Swept
    from polarcheck.geometry.material_left.strips import Strip
    from polarcheck.geometry.polygons.finished_part import FinishedParts
    from polarcheck.geometry.segments import Curves, Segments


class Left(msgspec.Struct, frozen=True):
    """
    Material left, by rows of the trace.

    height: float64[rows] [mm], height of a rib or thickness of a strip, 0 for none.
    width: float64[rows] [mm], 0 for none.
    place: complex128[rows] [mm], plane point, NaN for none.
    """

    height: Floats
    width: Floats
    place: Points


def _nothing_left(count: int) -> Left:
    nothing = repeated(np.float64(0), count)
    return Left(nothing, nothing, repeated(np.complex128(NOWHERE), count))


def _writable_columns(count: int) -> Left:
    """Empty columns that may be written to."""
    nothing = _nothing_left(count)
    return Left(nothing.height.copy(), nothing.width.copy(), nothing.place.copy())


class _CheckedLoops(msgspec.Struct, frozen=True):
    """
    Loops to check, in the order of their parts, n of them.

    loops: their curves.
    number: int[n], number of the loop in the trace.
    program: int[n], number of the program that the loop is in.
    z: float64[n] [mm], the highest Z of the loop.
    """

    loops: Loops
    number: Rows
    program: Rows
    z: Floats


class Coverage(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    tool_center: ToolCenter
    overcuts: Overcuts

    # ---- the loops ----

    @cached_property
    def _checked_loops(self) -> _CheckedLoops | None:
        """The distinct loops of cutters, without the loops that the control rejects; None if no loop is left."""
        trace = self.trace
        walls, left = self.overcuts.walls
        if not len(walls):
            return None
        from polarcheck.geometry.contour_ends import Loops, distinct

        first = np.flatnonzero(np.diff(walls.loop, prepend=-1))
        last = np.append(first[1:], len(walls)) - 1
        loops = Loops(walls, left, first, last, np.abs(trace.compensation.radius[walls.row[first]]))
        faulty = different(walls.loop[self.overcuts.objected[walls.row]])
        sound = np.flatnonzero(~np.isin(walls.loop[first], faulty))
        if not len(sound):
            return None
        loops = loops[sound]
        program = trace.blocks.program[walls.row[loops.first]]
        z = np.maximum.reduceat(trace.path.z[walls.row], first)[sound]
        unique = distinct(loops, program, z)
        return _CheckedLoops(loops[unique], walls.loop[loops.first[unique]], program[unique], z[unique])

    @cached_property
    def _parts(self) -> tuple[_CheckedLoops, FinishedParts, Corners] | None:
        """The loops that may leave material at their ends, with their parts and corners."""
        checked = self._checked_loops
        if checked is None:
            return None
        from polarcheck.geometry.contour_ends import lead_corners, may_be_open

        corners = lead_corners(checked.loops, self._winds)
        # A path that winds inwards passes its start on the way, and leaves no gap there.
        may_leave = may_be_open(checked.loops) & ~self._winds
        may_leave[corners.loop] = True
        if not may_leave.any():
            return None
        from polarcheck.geometry.contour_ends import Corners
        from polarcheck.geometry.polygons.finished_part import Contours, finished_parts

        loops, number = checked.loops[may_leave], checked.number[may_leave]
        tolerance, bar = self.trace.machine.compensation.overcut_tolerance, self.overcuts.bar
        part = finished_parts(
            Contours(loops.curves, loops.left, number, np.arange(len(loops)), loops.radius, bar, tolerance)
        )
        group = (np.cumsum(may_leave) - 1)[corners.loop]
        return (
            _CheckedLoops(loops, number, checked.program[may_leave], checked.z[may_leave]),
            part,
            Corners(corners.point, corners.reach, corners.turn, group),
        )

    @property
    def has_areas(self) -> bool:
        """True once polygons of loops have been computed: loops may leave material at their ends or between passes."""
        computed = vars(self)
        return computed.get("_parts") is not None or bool(computed.get("_levels"))

    # ---- gaps ----

    @cached_property
    def gap(self) -> Floats:
        """In the last block of a contour that does not quite return to its start: the gap [mm]; else 0."""
        return self._gaps[0]

    @cached_property
    def begins(self) -> Points:
        """In rows with a gap: the start of the contour [mm], plane point; NaN for other rows."""
        return self._gaps[1]

    @property
    def begins_in(self) -> Rows:
        """In rows with a gap: the row of the first move of the contour; -1 for other rows."""
        return self._gaps[2]

    @cached_property
    def _gaps(self) -> tuple[Floats, Points, Rows]:
        if self._parts is None:
            nothing = _nothing_left(len(self.trace))
            return nothing.height, nothing.place, np.full(len(self.trace), -1)
        from polarcheck.geometry.contour_ends import CLOSED, gaps_of

        checked, part, _ = self._parts
        is_open = np.flatnonzero(part.gap > CLOSED)
        first, last = gaps_of(checked.loops[is_open], part.gap[is_open])
        length, begins = np.zeros(len(self.trace)), np.full(len(self.trace), NOWHERE)
        row = checked.loops.curves.row[last]
        length[row], begins[row] = part.gap[is_open], checked.loops.curves.start[first]
        begins_in = column_at(len(self.trace), row, checked.loops.curves.row[first], -1)
        return length, begins, begins_in

    # ---- ribs ----

    @property
    def ribs(self) -> Left:
        """In rows where a tool leaves a contour beside material that no tool has removed: the rib."""
        return self._ribs[0]

    @cached_property
    def _ribs(self) -> tuple[Left, SkippedLoops]:
        """The ribs, and the loops that are not searched for ribs."""
        nothing, skipped_loops = _nothing_left(len(self.trace)), SkippedLoops.of({})
        if self._parts is None:
            return nothing, skipped_loops
        from polarcheck.geometry.contour_ends import CLOSED
        from polarcheck.geometry.material_left.ribs import ribs

        checked, part, corners = self._parts
        corners = corners[
            ~(part.open | part.tangled | (part.gap > CLOSED) | self._may_be_removed(checked))[corners.loop]
        ]
        if not len(corners.loop):
            return nothing, skipped_loops
        columns = _writable_columns(len(self.trace))
        hits = ribs(
            part,
            corners,
            checked.loops.radius,
            self._paths_of_loops(checked.number),
            checked.z,
            checked.program,
            self.swept,
        )
        columns.height[hits.row], columns.width[hits.row], columns.place[hits.row] = hits.height, hits.width, hits.place
        return columns, SkippedLoops.of({SkipReason.PATHS_TOO_LONG: checked.number[hits.given_up]})

    def _may_be_removed(self, checked: _CheckedLoops) -> Mask:
        """True for loops whose material a tool of unknown R or on an unknown path of the program may remove."""
        moves, trace = self.tool_center.moves, self.trace
        unknown = ~moves.is_of_tool | np.isnan(moves.start + moves.end) | np.isnan(self._radius[moves.row])
        unknown |= np.isin(self.overcuts.loop, self.overcuts.beyond_bounds.loop)[moves.row]
        return np.isin(checked.program, trace.blocks.program[moves.row[unknown]])

    def _paths_of_loops(self, number: Rows) -> Segments:
        """The tool center paths of these loops; each loop has the index of its part."""
        from polarcheck.geometry.segments import segments

        moves, loop = self.tool_center.moves, loop_of_row(self.trace)
        path = curves_of(moves, loop[moves.row], moves.known & np.isin(loop[moves.row], number))
        chords = segments(path, self.trace.machine.compensation.overcut_tolerance)
        return type(chords)(chords.start, chords.end, chords.move, np.searchsorted(number, chords.loop))

    @cached_property
    def _radius(self) -> Floats:
        """R of the cutter in each row [mm], from the offset in force; without compensation, too."""
        trace = self.trace
        return np.fmax(np.abs(trace.compensation.radius_of_move), trace.offsets.cutter_diameter / 2)

    @cached_property
    def swept(self) -> Swept:
        """All moves in the mode, including ramps and moves without compensation."""
        from polarcheck.geometry.material_left.ribs import Swept
        from polarcheck.geometry.segments import segments

        trace, moves = self.trace, self.tool_center.moves
        # Loops beyond all bounds are not checked: the material that they leave is not known.
        within = ~np.isin(self.overcuts.loop, self.overcuts.beyond_bounds.loop)[moves.row]
        path: Curves = curves_of(moves, np.zeros(len(moves), np.int64), within)
        chords = segments(path, trace.machine.compensation.overcut_tolerance)
        row = path.row[chords.move]
        z = np.fmin(trace.path.z, trace.path.z_before)
        with_radius = ~np.isnan(self._radius[row])
        row = row[with_radius]
        return Swept(
            chords.start[with_radius],
            chords.end[with_radius],
            row,
            self._radius[row],
            z[row],
            trace.blocks.program[row],
        )

    # ---- strips ----

    @cached_property
    def _winds(self) -> Mask:
        """True for checked loops that go round more than once."""
        from polarcheck.geometry.contour_ends import winds

        return winds(self._checked_loops.loops) if self._checked_loops else np.zeros(0, bool)

    @property
    def strips(self) -> Left:
        """In a row of a pass: the strip between it and the next pass; only the thickest strip of each section."""
        return self._strips[0]

    @cached_property
    def _strips(self) -> tuple[Left, SkippedLoops]:
        """The strips, and the loops that are not searched for strips."""
        thickest = _writable_columns(len(self.trace)) if self._levels else _nothing_left(len(self.trace))
        skipped = [SkippedLoops.of({})]
        for level in self._levels:
            keep_time()
            hits = self._strips_of(level)
            if isinstance(hits, SkipReason):
                skipped.append(SkippedLoops.of({hits: self._checked_numbers[level]}))
                continue
            for strip in hits:
                if strip.thickness > thickest.height[strip.row]:
                    thickest.height[strip.row], thickest.place[strip.row] = strip.thickness, strip.place
        section = self.trace.mode.whole_section
        for number in different(section[thickest.height > 0]):
            rows = np.flatnonzero((section == number) & (thickest.height > 0))
            thickest.height[rows[rows != rows[np.argmax(thickest.height[rows])]]] = 0
        return thickest, SkippedLoops.concatenated(skipped)

    @cached_property
    def _levels(self) -> list[Rows]:
        """
        Groups of checked loops at one Z of one section, between which material may stay.

        Loops of different sections need not be passes of one contour.
        """
        checked = self._checked_loops
        if checked is None:
            return []
        z = np.where(np.isnan(checked.z), np.inf, np.round(checked.z, 4))
        section = self.trace.mode.section[checked.loops.curves.row[checked.loops.first]]
        _, level, loop_count = np.unique(
            np.stack([section, z], axis=1), axis=0, return_inverse=True, return_counts=True
        )
        level = level.ravel()
        is_sure = ~self._may_be_removed(checked)
        compared = np.flatnonzero(((loop_count[level] > 1) | np.isin(level, level[self._winds])) & is_sure)
        if not len(compared):
            return []

        from polarcheck.geometry.contour_ends import chords, may_leave_strips

        moves, loop = self.tool_center.moves, loop_of_row(self.trace)
        path = curves_of(moves, loop[moves.row], moves.known & np.isin(loop[moves.row], checked.number[compared]))
        path = path[np.argsort(level[compared][np.searchsorted(checked.number[compared], path.loop)], kind="stable")]
        path = msgspec.structs.replace(path, loop=level[compared][np.searchsorted(checked.number[compared], path.loop)])
        radius = folded(np.maximum, level, checked.loops.radius, len(loop_count), 0.0)
        may_leave = may_leave_strips(*chords(path, float(checked.loops.radius.min()) / 16), radius)
        return [compared[level[compared] == number] for number in np.flatnonzero(may_leave)]

    @property
    def _checked_numbers(self) -> Rows:
        return self._checked_loops.number if self._checked_loops else np.zeros(0, np.int64)

    def _strips_of(self, level: Rows) -> list[Strip] | SkipReason:
        from polarcheck.geometry.material_left.strips import strips
        from polarcheck.geometry.polygons.finished_part import Contours, finished_parts
        from polarcheck.geometry.segments import segments

        checked = self._checked_loops
        assert checked is not None
        loops, number = checked.loops[level], checked.number[level]
        tolerance, bar = self.trace.machine.compensation.overcut_tolerance, self.overcuts.bar
        group = np.zeros(len(level), np.int64)
        radius = np.array([loops.radius.max()])
        part = finished_parts(Contours(loops.curves, loops.left, number, group, radius, bar, tolerance))
        if part.tangled[0]:
            return SkipReason.CROSSES
        if part.open[0]:
            return []
        rows, _ = loops.rows()
        curves = loops.curves[rows]
        walls = segments(msgspec.structs.replace(curves, loop=np.zeros(len(curves), np.int64)), tolerance)
        swept = self.swept[self.swept.at_depth(checked.z[level[:1]], checked.program[level[:1]])]
        row, left = curves.row[walls.move], loops.left[rows][walls.move]
        hits = strips(part.polygon[0], walls, row, left, swept, float(radius[0]), bar)
        return SkipReason.PATHS_TOO_LONG if hits is None else hits

    # ---- both ----

    @cached_property
    def skipped(self) -> SkippedLoops:
        """Loops that are not searched for ribs or strips."""
        skipped = [self._ribs[1], self._strips[1]]
        if self._parts is not None:
            checked, part, _ = self._parts
            skipped.append(SkippedLoops.of({SkipReason.CROSSES: checked.number[part.tangled]}))
        return SkippedLoops.concatenated(skipped)

    @cached_property
    def height(self) -> Floats:
        """Height of the ribs and strips [mm]; 0 for none."""
        return computed(np.maximum, self.ribs.height, self.strips.height)
