"""What compensated contours leave undone: gaps in them, ribs where they begin and end, strips between passes."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import msgspec
import numpy as np

from polarcheck.arrays import Columns, Floats, Mask, Points, Rows, computed, different, repeated
from polarcheck.columns.filling import before
from polarcheck.columns.path import NOWHERE
from polarcheck.columns.trace import Trace
from polarcheck.table.overcuts import Overcuts, curves_of, loop_of_row
from polarcheck.table.skipped_loops import SkippedLoops, SkipReason
from polarcheck.table.tool_center import ToolCenter
from polarcheck.time_limit import keep_time

if TYPE_CHECKING:
    from polarcheck.geometry.contour_ends import Corners, Loops
    from polarcheck.geometry.material_left.ribs import Swept
    from polarcheck.geometry.material_left.strips import Strip
    from polarcheck.geometry.polygons.finished_part import FinishedParts
    from polarcheck.geometry.segments import Curves, Segments


class Left(NamedTuple):
    """Columns, one value per row, 0 or NaN where nothing is left: how high or thick, how wide it is, and where."""

    height: Floats
    width: Floats
    place: Points


def _nothing_left(count: int) -> Left:
    nothing = repeated(np.float64(0), count)
    return Left(nothing, nothing, repeated(np.complex128(NOWHERE), count))


def _to_fill(count: int) -> Left:
    """Columns in which nothing is left so far."""
    nothing = _nothing_left(count)
    return Left(nothing.height.copy(), nothing.width.copy(), nothing.place.copy())


class _Judged(NamedTuple):
    """Loops that are looked at, in the order of their parts: their numbers, the program and the Z of each."""

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
    def _judged(self) -> _Judged | None:
        """The loops of cutters, those that are the same once; but not those to which the control objects."""
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
        loops = loops.some(sound)
        program = trace.blocks.program[walls.row[loops.first]]
        z = np.maximum.reduceat(trace.path.z[walls.row], first)[sound]
        kept = distinct(loops, program, z)
        return _Judged(loops.some(kept), walls.loop[loops.first[kept]], program[kept], z[kept])

    @cached_property
    def _parts(self) -> tuple[_Judged, FinishedParts, Corners] | None:
        """The loops that may leave something where they begin and end, with their parts and corners."""
        judged = self._judged
        if judged is None:
            return None
        from polarcheck.geometry.contour_ends import lead_corners, may_be_open

        corners = lead_corners(judged.loops, self._winds)
        # A path that winds inwards passes its start on the way, and leaves no gap there.
        asked = may_be_open(judged.loops) & ~self._winds
        asked[corners.loop] = True
        if not asked.any():
            return None
        from polarcheck.geometry.contour_ends import Corners
        from polarcheck.geometry.polygons.finished_part import Contours, finished_parts

        loops, number = judged.loops.some(asked), judged.number[asked]
        tolerance, bar = self.trace.machine.compensation.overcut_tolerance, self.overcuts.bar
        part = finished_parts(
            Contours(loops.curves, loops.left, number, np.arange(len(loops)), loops.radius, bar, tolerance)
        )
        group = (np.cumsum(asked) - 1)[corners.loop]
        return (
            _Judged(loops, number, judged.program[asked], judged.z[asked]),
            part,
            Corners(corners.point, corners.reach, corners.turn, group),
        )

    # ---- gaps ----

    @cached_property
    def gap(self) -> Floats:
        """Of contours that come back to their start but for a gap, behind the last block of them [mm]; else 0."""
        return self._gaps[0]

    @cached_property
    def begins(self) -> Points:
        """Where the contour began that is open behind the row; NaN for other rows."""
        return self._gaps[1]

    @cached_property
    def _gaps(self) -> tuple[Floats, Points]:
        if self._parts is None:
            nothing = _nothing_left(len(self.trace))
            return nothing.height, nothing.place
        from polarcheck.geometry.contour_ends import CLOSED, gaps_of

        judged, part, _ = self._parts
        is_open = np.flatnonzero(part.gap > CLOSED)
        to, of = gaps_of(judged.loops.some(is_open), part.gap[is_open])
        length, begins = np.zeros(len(self.trace)), np.full(len(self.trace), NOWHERE)
        row = judged.loops.curves.row[of]
        length[row], begins[row] = part.gap[is_open], judged.loops.curves.start[to]
        return length, begins

    # ---- ribs ----

    @property
    def ribs(self) -> Left:
        """Where a tool leaves a contour and no tool has touched what lies beside: the rib that stands there."""
        return self._ribs[0]

    @cached_property
    def _ribs(self) -> tuple[Left, SkippedLoops]:
        """The ribs, and the loops beside which none is searched for."""
        nothing, none = _nothing_left(len(self.trace)), SkippedLoops.of({})
        if self._parts is None:
            return nothing, none
        from polarcheck.geometry.contour_ends import CLOSED
        from polarcheck.geometry.material_left.ribs import ribs

        judged, part, corners = self._parts
        corners = corners[~(part.open | part.tangled | (part.gap > CLOSED) | self._unsure(judged))[corners.loop]]
        if not len(corners.loop):
            return nothing, none
        left = _to_fill(len(self.trace))
        found = ribs(part, corners, judged.loops.radius, self._own(judged.number), judged.z, judged.program, self.swept)
        left.height[found.row], left.width[found.row], left.place[found.row] = found.height, found.width, found.place
        return left, SkippedLoops.of({SkipReason.PATHS_TOO_LONG: judged.number[found.given_up]})

    def _unsure(self, judged: _Judged) -> Mask:
        """Loops in whose program a tool of unknown R, or on an unknown way, may take off what they leave."""
        moves, trace = self.tool_center.moves, self.trace
        unknown = ~moves.is_of_tool | np.isnan(moves.start + moves.end) | np.isnan(self._radius[moves.row])
        unknown |= np.isin(self.overcuts.loop, self.overcuts.beyond_bounds.loop)[moves.row]
        return np.isin(judged.program, trace.blocks.program[moves.row[unknown]])

    def _own(self, number: Rows) -> Segments:
        """The path of the tool center of these loops, which have a part of that index each."""
        from polarcheck.geometry.segments import segments

        moves, loop = self.tool_center.moves, loop_of_row(self.trace)
        path = curves_of(moves, loop[moves.row], moves.known & np.isin(loop[moves.row], number))
        parts = segments(path, self.trace.machine.compensation.overcut_tolerance)
        return type(parts)(parts.start, parts.end, parts.move, np.searchsorted(number, parts.loop))

    @cached_property
    def _radius(self) -> Floats:
        """R of the cutter in each row [mm]; of the offset in force also where nothing is compensated."""
        trace = self.trace
        return np.fmax(np.abs(trace.compensation.radius_of_move), trace.offsets.cutter_diameter / 2)

    @cached_property
    def swept(self) -> Swept:
        """All moves in the mode, ramps and those without compensation included."""
        from polarcheck.geometry.material_left.ribs import Swept
        from polarcheck.geometry.segments import segments

        trace, moves = self.trace, self.tool_center.moves
        # Where loops that are beyond all bounds come, nobody looks: what is left there is not known either.
        within = ~np.isin(self.overcuts.loop, self.overcuts.beyond_bounds.loop)[moves.row]
        path: Curves = curves_of(moves, np.zeros(len(moves), np.int64), within)
        parts = segments(path, trace.machine.compensation.overcut_tolerance)
        row = path.row[parts.move]
        z = np.fmin(trace.path.z, before(trace.path.z, trace.blocks.starts, np.nan))
        known = ~np.isnan(self._radius[row])
        row = row[known]
        return Swept(parts.start[known], parts.end[known], row, self._radius[row], z[row], trace.blocks.program[row])

    # ---- strips ----

    @cached_property
    def _winds(self) -> Mask:
        """Of the judged loops those that go round more than once."""
        from polarcheck.geometry.contour_ends import winds

        return winds(self._judged.loops) if self._judged else np.zeros(0, bool)

    @property
    def strips(self) -> Left:
        """Behind a block of a pass, what stays between it and the next one: of each section the thickest strip."""
        return self._strips[0]

    @cached_property
    def _strips(self) -> tuple[Left, SkippedLoops]:
        """The strips, and the loops between which none is searched for."""
        left = _to_fill(len(self.trace)) if self._levels else _nothing_left(len(self.trace))
        skipped = [SkippedLoops.of({})]
        for level in self._levels:
            keep_time()
            found = self._strips_of(level)
            if isinstance(found, SkipReason):
                skipped.append(SkippedLoops.of({found: self._judged_numbers[level]}))
                continue
            for strip in found:
                if strip.thickness > left.height[strip.row]:
                    left.height[strip.row], left.place[strip.row] = strip.thickness, strip.place
        section = self.trace.mode.whole_section
        for number in different(section[left.height > 0]):
            rows = np.flatnonzero((section == number) & (left.height > 0))
            left.height[rows[rows != rows[np.argmax(left.height[rows])]]] = 0
        return left, SkippedLoops.concatenated(skipped)

    @cached_property
    def _levels(self) -> list[Rows]:
        """
        Which of the judged loops are of one section and Z, where passes may be too far apart.

        Those of two sections need not be passes of one contour.
        """
        judged = self._judged
        if judged is None:
            return []
        z = np.where(np.isnan(judged.z), np.inf, np.round(judged.z, 4))
        section = self.trace.mode.section[judged.loops.curves.row[judged.loops.first]]
        _, level, members = np.unique(np.stack([section, z], axis=1), axis=0, return_inverse=True, return_counts=True)
        level = level.ravel()
        sure = ~self._unsure(judged)
        asked = np.flatnonzero(((members[level] > 1) | np.isin(level, level[self._winds])) & sure)
        if not len(asked):
            return []

        from polarcheck.geometry.contour_ends import chords, may_leave_strips

        moves, loop = self.tool_center.moves, loop_of_row(self.trace)
        path = curves_of(moves, loop[moves.row], moves.known & np.isin(loop[moves.row], judged.number[asked]))
        path = path[np.argsort(level[asked][np.searchsorted(judged.number[asked], path.loop)], kind="stable")]
        path = msgspec.structs.replace(path, loop=level[asked][np.searchsorted(judged.number[asked], path.loop)])
        radius = np.zeros(len(members))
        np.maximum.at(radius, level, judged.loops.radius)
        found = may_leave_strips(*chords(path, float(judged.loops.radius.min()) / 16), radius)
        return [asked[level[asked] == number] for number in np.flatnonzero(found)]

    @property
    def _judged_numbers(self) -> Rows:
        return self._judged.number if self._judged else np.zeros(0, np.int64)

    def _strips_of(self, level: Rows) -> list[Strip] | SkipReason:
        from polarcheck.geometry.material_left.strips import strips
        from polarcheck.geometry.polygons.finished_part import Contours, finished_parts
        from polarcheck.geometry.segments import segments

        judged = self._judged
        assert judged is not None
        loops, number = judged.loops.some(level), judged.number[level]
        tolerance, bar = self.trace.machine.compensation.overcut_tolerance, self.overcuts.bar
        together = np.zeros(len(level), np.int64)
        radius = np.array([loops.radius.max()])
        part = finished_parts(Contours(loops.curves, loops.left, number, together, radius, bar, tolerance))
        if part.tangled[0]:
            return SkipReason.CROSSES
        if part.open[0]:
            return []
        rows, _ = loops.rows()
        curves = loops.curves[rows]
        walls = segments(msgspec.structs.replace(curves, loop=np.zeros(len(curves), np.int64)), tolerance)
        swept = self.swept[self.swept.at_depth(judged.z[level[:1]], judged.program[level[:1]])]
        row, left = curves.row[walls.move], loops.left[rows][walls.move]
        found = strips(part.polygon[0], walls, row, left, swept, float(radius[0]), bar)
        return SkipReason.PATHS_TOO_LONG if found is None else found

    # ---- both ----

    @cached_property
    def skipped(self) -> SkippedLoops:
        """Loops beside which no rib, or no strip, is searched for."""
        skipped = [self._ribs[1], self._strips[1]]
        if self._parts is not None:
            judged, part, _ = self._parts
            skipped.append(SkippedLoops.of({SkipReason.CROSSES: judged.number[part.tangled]}))
        return SkippedLoops.concatenated(skipped)

    @cached_property
    def height(self) -> Floats:
        """Of what is left [mm], ribs and strips; 0 where nothing is."""
        return computed(np.maximum, self.ribs.height, self.strips.height)
