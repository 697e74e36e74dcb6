"""
The workpiece through a program: what the mills have taken off the bar, and what they touch on their way to a place.

Followed are mills along Z whose R is known. Other tools are not: a turning tool or a drill may go where metal seems to
stand. All places are on the plane that turns with the part: X as a radius, at the angle of C.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.finished import Finished, Level
from polarcheck.columns.metal.milled import Milled
from polarcheck.columns.path.moves import z_along
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, Table, cached_property, is_among, mask_at
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.states import Motion
from polarcheck.geometry import polar
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import ROUNDING

if TYPE_CHECKING:
    from polarcheck.geometry.polygons.standing_metal import Sweeps

#: A tip less far below the face than this touches nothing [mm].
_CLEARANCE = 0.01
#: How far away a reference point is, at least [mm]. The slowest X beside Z in rapid traverse, as a share of Z: where
#: both go at once, X does so by this share of Z, or on the straight line.
_FAR, _SLOWEST_X = 200.0, 0.4
#: The share of the way up to the face at which such a move is looked at.
_SHARE = 0.75
#: Largest move of an axis by rounding alone [mm, deg].
_STILL = 1e-4
#: Most moves to points within the bar that are followed, and most moves that cut.
_MOST_WAYS, _MOST_MOVES = 200, 20_000


class ToolMoves(PlanePath, frozen=True):
    """
    Moves that take a mill to a place: the part of each that is known whatever the order of the axes, the whole way of X
    or of C alone, a place on a way up and aside, else its end.

    row: int[n]. tip: float64[n], Z of the tip [mm]. radius: float64[n], R [mm]. is_rapid: bool[n]. plunges: bool[n], it
    goes down. is_sure: bool[n], False for a way that is taken if the axes move in one order, and not in the other.
    """

    row: Rows
    tip: Floats
    radius: Floats
    is_rapid: Mask
    plunges: Mask
    is_sure: Mask

    @property
    def farthest(self) -> Floats:
        """Largest distance of the center of the cutter from X0 [mm]."""
        return polar.farthest(*self.shape)


class Hits(Table, frozen=True):
    """
    Hits of moves on the bar or the part, n of them.

    row: int[n]. place: complex128[n] [mm], on the plane of the part. is_sure: bool[n], as in ToolMoves.
    """

    row: Rows
    place: Points
    is_sure: Mask

    @classmethod
    def none(cls) -> Hits:
        return cls(np.zeros(0, np.int64), np.zeros(0, np.complex128), np.zeros(0, bool))


class Workpiece(Columns, frozen=True):
    """Hits of mills on their way to a point, by rows of one trace."""

    trace: Trace
    tool_center: ToolCenter
    overcuts: Overcuts
    finished: Finished
    bar: Bar
    milled: Milled

    # ---- the tools ----

    @cached_property
    def is_mill(self) -> Mask:
        """Rows of tool calls that enter the mode, along Z of the main spindle."""
        trace = self.trace
        call = self.bar.tools.tool_call
        has_section = mask_at(int(call.max(initial=0)) + 1, call[trace.mode.sections.enter])
        return np.asarray(has_section[call] & self.milled.is_along_z & ~trace.modal.on_sub_spindle)

    @cached_property
    def radius(self) -> Floats:
        """R of the mill in force [mm], NaN where it is not known or only adjusts a path."""
        return np.where(self.is_mill, self.milled.radius, np.nan)

    # ---- where they go ----

    @cached_property
    def _outside(self) -> ToolMoves:
        """All moves of mills outside of sections of which the end or the way is known."""
        trace = self.trace
        path, axes = trace.path, trace.axes
        returns = trace.blocks.listed("reference_return") & trace.blocks.has("X", "U") & (trace.mode.section < 0)
        moves = axes.moves & is_among(axes.motion, (Motion.RAPID, Motion.LINE)) & (trace.mode.section < 0)
        moves &= ~trace.modal.in_cycle
        row = np.flatnonzero((moves | returns) & ~np.isnan(self.radius))
        returns = returns[row]
        x_from, c_from, z_from = path.x_before[row], path.c_angle_before[row], path.z_before[row]
        x_to = np.where(returns, x_from + _FAR, path.x[row])
        z_to = np.where(returns & trace.blocks.has("Z", "W")[row], z_from + _FAR, path.z[row])
        z_to = np.where(returns & ~trace.blocks.has("Z", "W")[row], z_from, z_to)
        # Controls show the angle of C from 0 to 360 deg, however far a section has turned it.
        c_from = np.where((c_from < 0) | (c_from > 360), np.mod(c_from, 360), c_from)
        c_to = c_from + np.where(returns | ~path.moves_c[row], 0.0, path.c_turn_from(c_from, row))
        # The way of the first C word is not known, its end is.
        c_to = np.where(np.isnan(c_to), path.c_angle[row], c_to)
        c_from, c_to = (path.c_axis.sense * c for c in (c_from, c_to))
        with np.errstate(invalid="ignore"):
            begin, end = (x * np.exp(1j * np.radians(c)) for x, c in ((x_from, c_from), (x_to, c_to)))
        moves_x, moves_c, moves_z = (
            ~(np.abs(to - start) <= _STILL) for start, to in ((x_from, x_to), (c_from, c_to), (z_from, z_to))
        )
        arc, line = moves_c & ~moves_x & ~moves_z, moves_x & ~moves_c & ~moves_z
        arc &= ~np.isnan(begin) & (x_to > ROUNDING)
        line &= ~np.isnan(begin)
        # Up from below the face and along X at once: a place on the way to the face.
        rise = (self.top - z_from) * _SHARE
        slope = moves_x & ~moves_c & (rise > 0) & (z_to > self.top) & ~np.isnan(begin + x_to)
        with np.errstate(invalid="ignore", divide="ignore"):
            linear = (x_to - x_from) * rise / (z_to - z_from)
        aside = np.sign(linear) * np.minimum(np.abs(linear), _SLOWEST_X * np.abs(rise))
        turn = c_to - c_from
        full = arc & (np.abs(turn) >= 360)
        kind = np.where(arc, np.where(turn > 0, Motion.CCW, Motion.CW), Motion.LINE).astype(np.int16)
        with np.errstate(invalid="ignore"):
            on_slope = (x_from + aside) * np.exp(1j * np.radians(c_from))
        end = np.where(slope, on_slope, np.where(full, begin, end))
        rapids = ToolMoves(
            row=row,
            start=np.asarray(np.where(arc | line, begin, end), np.complex128),
            end=np.asarray(end, np.complex128),
            center=np.where(arc, 0j, np.nan + 0j),
            kind=kind,
            tip=np.where(slope, z_from + rise, z_to),
            radius=self.radius[row],
            is_rapid=(axes.motion[row] == Motion.RAPID) | returns,
            plunges=moves_z & ~(z_to > z_from),
            is_sure=np.ones(len(row), bool),
        )
        several = [rapids[~np.isnan(rapids.end + rapids.tip) & (moves_x | moves_c | moves_z)]]
        # X and Z, or X and C, below the face at once: their order is unknown.
        with np.errstate(invalid="ignore"):
            turned_x = x_to * np.exp(1j * np.radians(c_from))
        low = moves_x & (z_from < self.top - _CLEARANCE) & ~np.isnan(begin + turned_x)
        upward, sideways = low & moves_z & (z_to > z_from), low & moves_c & ~moves_z & ~np.isnan(end)
        for chosen in (upward, sideways):
            several.append(
                msgspec.structs.replace(
                    rapids,
                    start=begin,
                    end=turned_x,
                    center=np.full(len(row), np.nan + 0j),
                    kind=np.full(len(row), Motion.LINE, np.int16),
                    tip=z_from,
                    is_sure=np.zeros(len(row), bool),
                )[chosen]
            )
        rapids = ToolMoves.concatenated(several)
        return rapids[np.argsort(rapids.row, kind="stable")]

    @property
    def _z_alone(self) -> Mask:
        """Rows in sections that move Z and nothing on the plane."""
        path = self.trace.path
        return np.asarray(self.trace.mode.in_polar & path.moves_z & ~path.travels)

    @cached_property
    def _inside(self) -> ToolMoves:
        """All moves of the tool center in sections, those of Z alone as places."""
        from polarcheck.columns.path.standing_moves import with_standing

        trace = self.trace
        moves, number = with_standing(trace, self.tool_center.moves, self._z_alone & ~trace.modal.in_cycle)
        low = np.minimum(*z_along(trace, moves))
        usable = moves.is_of_tool & ~np.isnan(self.radius[moves.row] + low) & ~np.isnan(moves.start + moves.end)
        moves = moves[usable]
        row = moves.row
        return ToolMoves(
            *moves.turned_by(trace.path.section_turn[moves.section]).shape,
            row=row,
            tip=low[usable],
            radius=self.radius[row],
            is_rapid=trace.axes.motion[row] == Motion.RAPID,
            plunges=(number[usable] < 0) & ~(trace.path.z[row] >= trace.path.z_before[row]),
            is_sure=np.ones(len(row), bool),
        )

    @cached_property
    def _all(self) -> ToolMoves:
        """Both, in the order of the program."""
        moves = ToolMoves.concatenated([self._outside, self._inside])
        return moves[np.argsort(moves.row, kind="stable")]

    @cached_property
    def _with_all_rapids(self) -> ToolMoves:
        """
        The moves outside of sections, and those in sections, too, where one of these is in rapid traverse.

        In most programs none is, and to compute them takes long.
        """
        rapid_on_plane = self.is_rapid[self.tool_center.moves.row].any()
        return self._all if rapid_on_plane or (self.is_rapid & self._z_alone).any() else self._outside

    def _sweeps(self, moves: ToolMoves) -> Sweeps:
        from polarcheck.geometry.polygons.standing_metal import Sweeps
        from polarcheck.geometry.segments import Curves

        return Sweeps(Curves(*moves.shape, np.zeros(len(moves), np.int64), moves.row), moves.radius, moves.tip)

    # ---- the bar ----

    @cached_property
    def top(self) -> float:
        """Z of the face of the bar [mm]; at Z0, as is usual on lathes, where nothing says another."""
        face = self.bar.known.face
        return 0.0 if np.isnan(face) else face

    @cached_property
    def _into_bar(self) -> ToolMoves:
        """Moves in rapid traverse with the tip below the face and the cutter within the circle of the bar."""
        moves = self._with_all_rapids
        moves = moves[moves.is_rapid & (moves.tip < self.top - _CLEARANCE)]
        within = moves.nearest - moves.radius < self.bar.inner(moves.row, moves.tip) - ROUNDING
        within &= moves.farthest + moves.radius > self.bar.bore(moves.row) / 2 + ROUNDING
        return moves[within]

    @cached_property
    def through_bar(self) -> Hits:
        """Rapid moves through the remaining bar."""
        if self.bar.known.source == "none":
            return Hits.none()
        moves = self._into_bar
        moves = moves[moves.row < self._unknown_from]
        if not len(moves):
            return Hits.none()
        self._bound(moves)
        hit, point = self.hits_on_bar(moves)
        return Hits(moves.row[hit], point[hit], moves.is_sure[hit])

    def stands_at(self, rows: Rows, share: float) -> Mask:
        """Per row of a Z move in a section: it goes down into what stands of the bar, with this share of R already."""
        if self.bar.known.source == "none":
            return np.zeros(len(rows), bool)
        moves = self._inside
        moves = moves[np.isin(moves.row, rows) & (moves.row < self._unknown_from)]
        if not len(moves):
            return np.zeros(len(rows), bool)
        self._bound(moves)
        hit, _ = self.hits_on_bar(msgspec.structs.replace(moves, radius=moves.radius * share))
        return np.isin(rows, moves.row[hit])

    def hits_on_bar(self, moves: ToolMoves) -> tuple[Mask, Points]:
        """A mask of the moves that lead through what stands of the bar, and where; rising in rows."""
        from polarcheck.geometry.polygons.standing_metal import disc, hits_on_bar

        bores = self.bar.bore(moves.row).tolist()
        stands = [
            [(disc(step.diameter, bore), step.height) for step in self.bar.standing(row, tip) if step.diameter > bore]
            for row, tip, bore in zip(moves.row.tolist(), moves.tip.tolist(), bores, strict=True)
        ]
        lower = self._all[(self._all.tip < self.top) & self._all.is_sure]
        return hits_on_bar(self._sweeps(moves), stands, self._sweeps(lower), *self._holes)

    def _bound(self, mills: ToolMoves) -> None:
        if len(mills) > _MOST_WAYS or len(self._all) > _MOST_MOVES:
            raise TooHardError(
                f"{len(mills)} ways of mills at depth and {len(self._all)} moves are too many to follow the metal: "
                "check its sections in separate files"
            )

    @cached_property
    def _drills(self) -> Mask:
        """Moves of other tools that drill along Z at a place of C."""
        trace = self.trace
        down = (trace.axes.motion == Motion.LINE) & trace.path.moves_z & (trace.path.z < trace.path.z_before - ROUNDING)
        drilled = (trace.modal.drilling != 0) & trace.axes.moves
        return np.asarray((down | drilled) & (trace.mode.section < 0) & ~self.is_mill & ~self.bar.tools.turns)

    @cached_property
    def _drilled(self) -> tuple[Rows, Points]:
        """Rows that drill, and where [mm]; NaN where that is not known. On X0 every angle of C is one place."""
        path, row = self.trace.path, np.flatnonzero(self._drills)
        angle = np.where(np.abs(path.x[row]) <= ROUNDING, 0.0, path.c_axis.sense * path.c_angle[row])
        return row, np.asarray(path.x[row] * np.exp(1j * np.radians(angle)), np.complex128)

    @property
    def _holes(self) -> tuple[Rows, Points]:
        """Rows that drill, and where [mm]; places that are not known are left out."""
        row, place = self._drilled
        return row[~np.isnan(place)], place[~np.isnan(place)]

    @cached_property
    def _unknown_from(self) -> int:
        """The first row that cuts the bar and is not followed: a mill of unknown R, a drill, a tool across."""
        trace = self.trace
        mills = trace.mode.in_polar & trace.path.cuts
        unknown = mills & np.isnan(self.radius) & ~np.isnan(trace.path.z)
        row, place = self._drilled
        drills = trace.blocks.mask_of(row[np.isnan(place)])
        rows = np.flatnonzero(unknown | drills | trace.mode.on_cylinder)
        return int(rows[0]) if len(rows) else len(trace)

    def not_followed(self) -> Iterator[tuple[int, int, str]]:
        """Rapid moves below the face that are not compared with the bar: the first row, their number, and why."""
        trace, bar = self.trace, self.bar.known
        if not len(trace.mode.sections) or np.isnan(bar.smallest):
            return
        down = self.is_rapid & (trace.mode.section < 0) & (trace.path.z < self.top - _CLEARANCE)
        down &= (np.abs(trace.path.x) < bar.smallest / 2) & trace.axes.moves
        calls = mask_at(
            int(self.bar.tools.tool_call.max(initial=0)) + 1, self.bar.tools.tool_call[trace.mode.sections.enter]
        )
        mills = calls[self.bar.tools.tool_call]
        why_not = [
            (mills & trace.modal.on_sub_spindle, "the sub-spindle has a Z of its own"),
            (mills & ~self.is_mill & ~trace.modal.on_sub_spindle, "the tool is not a mill along Z"),
        ]
        if np.isnan(bar.bore):
            why_not.append((self.is_mill, "the program drills on X0, and how large that hole is nobody knows"))
        else:
            rest = self.is_mill & (np.arange(len(trace)) >= self._unknown_from)
            line = int(trace.blocks.line[min(self._unknown_from, len(trace) - 1)])
            why_not.append((rest, f"what line {line} takes off the bar is not known"))
        for mask, reason in why_not:
            rows = np.flatnonzero(down & mask)
            if len(rows):
                yield int(rows[0]), len(rows), reason

    # ---- the finished part ----

    @cached_property
    def _over_contour(self) -> ToolMoves:
        """
        Moves outside of sections to a place within the reach of a contour and of the bar, no higher than the contour.

        Rapid traverse, and the first move behind a section at feed: a retract is missing there.
        """
        trace, moves, walls = self.trace, self._outside, self.overcuts.walls[0]
        if not len(walls) or not len(moves):
            return moves[np.zeros(len(moves), bool)]
        top = self._highest_wall
        moving = np.flatnonzero(trace.axes.moves | trace.mode.enters)
        after = np.searchsorted(moving, np.flatnonzero(trace.mode.leaves), side="right")
        first = trace.blocks.mask_of(moving[after[after < len(moving)]])
        low = (moves.is_rapid | first[moves.row]) & (moves.tip <= top + _CLEARANCE)
        if not low.any():
            return moves[low]
        farthest = polar.farthest(*walls.shape)
        reach = float(np.max(farthest + np.where(self._walls_of_pockets, 2 * self.overcuts.radius[walls.row], 0)))
        near = moves.nearest - moves.radius
        return moves[low & (near < reach) & ~(near >= self.bar.outer(moves.row, moves.tip))]

    @property
    def _highest_wall(self) -> float:
        """The highest Z at which a contour is milled, or the face if it is known [mm]."""
        walls, _ = self.overcuts.walls
        highest = float(np.nanmax(np.append(self.trace.path.z[walls.row], -np.inf)))
        if self._comes_from_above.any():
            highest = max(highest, 0.0)
        face = self.bar.known.face
        return highest if np.isnan(face) else max(face - 2 * _CLEARANCE, highest)

    @property
    def _walls_of_pockets(self) -> Mask:
        """Walls of loops that close with the tool inside."""
        walls, left = self.overcuts.walls
        first = np.flatnonzero(np.diff(walls.loop, prepend=-1))
        last = np.append(first[1:], len(walls)) - 1
        area = np.add.reduceat(walls.twice_swept, first)
        closed = np.abs(walls.end[last] - walls.start[first]) <= 2 * np.abs(self.overcuts.radius[walls.row[first]])
        inside = closed & ((area > 0) == left[first])
        return np.asarray(np.repeat(inside, last - first + 1))

    @cached_property
    def through_part(self) -> Hits:
        """Rapid moves through the finished part."""
        rapids = self._over_contour
        if not len(rapids):
            return Hits.none()
        self._bound(rapids)
        from polarcheck.geometry.polygons.standing_metal import hits_on_part, turned, within

        moves = self._inside
        moves = moves[~moves.is_rapid]
        arrives, leads_in = self.arrives[rapids.row], self._leads_in[moves.row]
        hit, point = np.zeros(len(rapids), bool), np.full(len(rapids), np.nan + 0j)
        # What a section cuts on its way from where it arrives to its contour is part all the same.
        for chosen, cleared in ((~arrives, moves), (arrives, moves[~leads_in])):
            rows = np.flatnonzero(chosen)
            if not len(rows):
                continue
            sweeps, taken = self._sweeps(rapids[rows]), self._sweeps(cleared)
            for level, top in self._levels:
                angle = float(np.radians(self.trace.path.section_entry[level.section]))
                solid = turned(within(level.walls, 2 * level.radius, level.polygon), angle)
                more, where = hits_on_part(sweeps, solid, top, level.z, taken)
                new = rows[more & ~hit[rows]]
                point[new] = where[more & ~hit[rows]]
                hit[new] = True
        return Hits(rapids.row[hit], point[hit], rapids.is_sure[hit])

    @cached_property
    def arrives(self) -> Mask:
        """Rows of the last move before each section: where it ends the section begins."""
        trace = self.trace
        moving = np.append(-1, np.flatnonzero(trace.axes.moves & (trace.mode.section < 0)))
        last = moving[np.searchsorted(moving, trace.mode.sections.enter) - 1]
        return self.trace.blocks.mask_of(last[last >= 0])

    @cached_property
    def _leads_in(self) -> Mask:
        """Rows of each section before its first start-up, where it has one."""
        trace = self.trace
        return np.asarray(
            trace.mode.in_polar
            & ~trace.mode.given_in_section(trace.compensation.starts_up)
            & trace.mode.anywhere_in_section(trace.compensation.starts_up)
        )

    @property
    def _levels(self) -> list[tuple[Level, float]]:
        """Levels of known Z, of mills that are followed, and the highest Z at which their part stands for certain."""
        face = self.bar.known.face
        levels = [
            level
            for level in self.finished.levels
            if not level.tangled and not np.isnan(level.z) and self.is_mill[level.walls.row[0]]
        ]
        tops: dict[int, float] = {}
        for level in levels:
            tops[level.section] = max(tops.get(level.section, -np.inf), level.z)
        if not np.isnan(face):
            return [(level, max(face - 2 * _CLEARANCE, level.z)) for level in levels]
        above = self._comes_from_above
        return [(level, 0.0 if above[level.section] and level.z < 0 else tops[level.section]) for level in levels]

    @cached_property
    def _comes_from_above(self) -> Mask:
        """
        Sections that the tool enters from above Z0, or leaves for a place above it: there is the face, as is usual on
        lathes; bool[sections].
        """
        z, sections = self.trace.path.z, self.trace.mode.sections
        return np.asarray((z[sections.enter] > 0) | (z[np.minimum(sections.last, len(z) - 1)] > 0))

    # ---- columns ----

    @cached_property
    def hits_part(self) -> Mask:
        """Rows whose way leads through the finished part, or may, if the axes move in that order."""
        return self.trace.blocks.mask_of(self.through_part.row)

    @cached_property
    def hits_bar(self) -> Mask:
        """Rapid moves that pass through the remaining bar, or may."""
        return self.trace.blocks.mask_of(self.through_bar.row)

    @cached_property
    def may_miss_part(self) -> Mask:
        """Of those, the rows that may not."""
        hits = self.through_part
        return self.hits_part & ~self.trace.blocks.mask_of(hits.row[hits.is_sure])

    @cached_property
    def may_miss_bar(self) -> Mask:
        """Of those, the rows that may not."""
        hits = self.through_bar
        return self.hits_bar & ~self.trace.blocks.mask_of(hits.row[hits.is_sure])

    @cached_property
    def precedes_idle_plunge(self) -> Mask:
        """
        Moves in rapid traverse down below the face, to where a section mills a pocket and its own plunge at feed, a Z
        word alone before anything moves on the plane, then moves nowhere.
        """
        trace, mask = self.trace, np.zeros(len(self.trace), bool)
        walls, _ = self.overcuts.walls
        if not len(walls):
            return mask
        first = trace.mode.first_in_section(trace.blocks.mask_of(walls.row))
        rows = walls.row[self._walls_of_pockets & first[walls.row]]
        pockets = mask_at(len(trace.mode.sections) + 1, trace.mode.section[rows])
        moving = trace.mode.first_in_section(trace.mode.in_polar & trace.axes.moves)
        idle = moving & trace.axes.commands_z & ~trace.path.moves_z & ~trace.path.travels
        idle &= (trace.axes.motion == Motion.LINE) & (trace.path.z < -_CLEARANCE) & pockets[trace.mode.section]
        down = np.flatnonzero(self.is_rapid & trace.path.moves_z & ~(trace.path.z >= trace.path.z_before))
        down = np.append(-1, down)[np.searchsorted(down, np.flatnonzero(idle), side="right")]
        down = down[down >= 0]
        mask[down[trace.mode.section[down] < 0]] = True
        return mask

    @property
    def bar_is_certain(self) -> bool:
        """The bar is that of the job, or the program turns it; what a comment says may be another one."""
        return self.bar.known.source in ("job", "turning")

    @cached_property
    def plunges(self) -> Mask:
        """Rows that go down to their place, of those with all moves in rapid traverse."""
        moves = self._with_all_rapids
        return self.trace.blocks.mask_of(moves.row[moves.plunges])

    @cached_property
    def is_rapid(self) -> Mask:
        """Rows in rapid traverse."""
        return np.asarray(self.trace.axes.motion == Motion.RAPID)
