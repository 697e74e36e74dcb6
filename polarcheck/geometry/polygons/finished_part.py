"""
The finished part, as the walls that are programmed in offset mode leave it.

The walls of a group cut the plane into faces. The part consists of the faces that are bounded by backs of walls alone.
Leads, nested passes, spirals and overlaps need no special treatment: a lead turns its tool side to the air it crosses,
and a pass to the material that the next pass removes. The surroundings of a pocket are a face as well.

Where a contour runs on past its start, rounding moves its end to one side of the wall that it follows: both ends are
joined to the walls beside them. A contour that does not close bounds no face. If only a gap separates its end from its
start, the gap is closed. Else its first and last walls are extended straight ahead, as a flat continues beyond the
bar. The part is unknown there unless the bar is known.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, different, first_in_run
from polarcheck.geometry.contour_ends import gaps_between_ends
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID, Geometries, Standing, Walls, standing
from polarcheck.geometry.polygons.loop_ends import LoopEnds, closed_beside, joined_to_walls
from polarcheck.geometry.segments import Curves, Segments, first_of_its_kind, members, segments
from polarcheck.geometry.tolerances import TOUCH

#: Corners of the circle that stands for the bar, in a quarter.
_BAR_CORNERS = 256
#: Instead of a curve: a line from the end of a loop to the wall beside it.
_JOINED = -2


class Contours(msgspec.Struct, frozen=True):
    """
    Programmed walls, and the groups of loops that bound a part together.

    curves: the curves in offset mode, loop after loop.
    left: bool[curves], the tool runs left of the curve.
    loop: int[m], the loops of the groups.
    group: int[m], the group of each loop, from 0, rising.
    radius: float64[groups] [mm].
    bar: diameter [mm], NaN if unknown.
    tolerance: of the chords of arcs [mm].
    closes_beside: contours that end a little beside their start are closed, too: what they make is told, though the
        ramps may cut into that.
    """

    curves: Curves
    left: Mask
    loop: Rows
    group: Rows
    radius: Floats
    bar: float
    tolerance: float
    closes_beside: bool = False


class FinishedParts(msgspec.Struct, frozen=True):
    """
    The finished part of each group, groups side by side: everything of group k is shifted by pitch * k along X.

    polygon: shapely geometry[groups] [mm], empty where there is no part.
    open: bool[groups], the outline is known only along the walls.
    gap: float64[groups] [mm], length of the gap that was closed, 0 for none.
    beside: float64[groups] [mm], how far a contour ends beside its start, 0 where none does or nothing was closed.
    tangled: bool[groups], the walls cross too often.
    start, end: complex128[k] [mm], the walls that bound the part, with the part on their left.
    move: int[k], the curve that each wall is part of.
    group: int[k], the group of each wall.
    along: float64[k, 2] [mm], distance of the start and the end of each wall from the start of its loop.
    ahead: float64[k, 2] [mm], distance of the start and the end of each wall from the end of its loop.
    pitch: distance between neighbouring groups [mm].
    """

    polygon: Geometries
    open: Mask
    gap: Floats
    beside: Floats
    tangled: Mask
    start: Points
    end: Points
    move: Rows
    group: Rows
    along: Floats
    ahead: Floats
    pitch: float


class PartsOfLoops(msgspec.Struct, frozen=True):
    """The finished part of each of these loops, rising; its group is the number of the loop among them."""

    loop: Rows
    part: FinishedParts

    def closes(self, loops: Rows) -> bool:
        """True if these loops are all among them, each closed without a line across a gap: R is not in their part."""
        part = self.part
        is_closed = ~part.open & (part.gap == 0) & ~shapely.is_empty(part.polygon)
        return bool(np.isin(loops, self.loop[is_closed]).all())


def finished_parts(contours: Contours) -> FinishedParts:
    """The finished part of each group."""
    plane = _plane(contours)
    groups = len(contours.radius)
    result, outline = _standing(plane, None, np.ones(groups, bool), contours.tolerance)
    polygon, tangled, outlines = result.polygon, result.tangled, [outline]
    gap, is_open = np.zeros(groups), np.zeros(groups, bool)
    for closing in (_bridges, _rays):
        searched = shapely.is_empty(polygon) & ~tangled
        if not searched.any():
            break
        lines, length = closing(plane, contours)
        searched &= length > 0
        if not searched.any():
            continue
        result, outline = _standing(plane, lines, searched, contours.tolerance)
        closed = searched & ~shapely.is_empty(result.polygon)
        polygon[closed] = result.polygon[closed]
        tangled |= result.tangled
        outlines.append(outline)
        if closing is _bridges:
            gap[closed & (length > contours.tolerance)] = length[closed & (length > contours.tolerance)]
        else:
            is_open |= closed
    if not np.isnan(contours.bar):
        polygon = _within_bar(polygon, contours.bar, plane.pitch)
        is_open[:] = False
    start, end, wall = (np.concatenate(columns) for columns in zip(*outlines, strict=True))
    order = np.argsort(plane.walls.group[wall], kind="stable")
    start, end, wall = start[order], end[order], wall[order]
    along = np.abs(np.stack([start, end], axis=1) - plane.walls.start[wall][:, None]) + plane.along[wall][:, None]
    ahead = plane.total[wall][:, None] - along
    move, group = plane.move[wall], plane.walls.group[wall]
    return FinishedParts(
        polygon, is_open, gap, plane.beside, tangled, start, end, move, group, along, ahead, plane.pitch
    )


class _Plane(msgspec.Struct, frozen=True):
    """
    All groups side by side.

    walls: the walls, n of them, and other lines.
    move: int[n], the curve that each wall is part of, -1 for other lines, _JOINED for those that join ends to walls.
    along: float64[n] [mm], distance of the start of each wall from the start of its loop.
    total: float64[n] [mm], length of that loop.
    chosen: the curves of all groups, m of them, with the group as their loop.
    left: bool[m], the tool runs left of the curve.
    first, last: int[loops], the first and the last curve of each loop of a group.
    half: half the side of the square round each group [mm].
    pitch: distance between neighbouring groups [mm].
    beside: float64[groups] [mm], see FinishedParts.
    """

    walls: Walls
    move: Rows
    along: Floats
    total: Floats
    chosen: Curves
    left: Mask
    first: Rows
    last: Rows
    half: float
    pitch: float
    beside: Floats


#: The outline of parts: start and end of each edge, and its wall.
_Outline = tuple[Points, Points, Rows]


def _plane(contours: Contours) -> _Plane:
    curves = contours.curves
    order = np.argsort(curves.loop, kind="stable")
    row, which = members(curves.loop[order], contours.loop)
    row = order[row]
    is_known = ~np.isnan(curves.start[row] + curves.end[row])
    row, which = row[is_known], which[is_known]
    group = contours.group[which]
    chosen = msgspec.structs.replace(curves[row], loop=group)

    parts = segments(chosen, contours.tolerance)
    reach = float(np.abs([parts.start.real, parts.start.imag, parts.end.real, parts.end.imag]).max(initial=1.0))
    half = 2 * reach + 4 * float(contours.radius.max(initial=0.0))
    pitch = 3 * half
    along, total = _lengths(parts, which)
    first = np.flatnonzero(first_in_run(which))
    number = np.searchsorted(which[first], which[parts.move])
    length = np.bincount(number, np.abs(parts.end - parts.start), len(first)).astype(np.float64)
    loops = _ends(chosen, first, length, contours, pitch)
    is_first = first_of_its_kind(chosen)[parts.move]
    parts, along, total = parts[is_first].shifted(pitch * parts.loop[is_first]), along[is_first], total[is_first]
    number = number[is_first]
    left = contours.left[row][parts.move]
    nothing = np.zeros(len(parts), bool)
    walls = Walls(parts.start, parts.end, left, ~left, nothing, parts.loop)
    more = [_joints(chosen, first, half, pitch), _square(different(group), half, pitch)]
    beside = np.zeros(len(contours.radius))
    if contours.closes_beside:
        lines, length = closed_beside(loops, walls, number, along)
        np.maximum.at(beside, lines.group, length)
        more.append(lines)
    joined = joined_to_walls(loops, walls)
    walls, origin = _together([walls, *more, joined])
    filler = np.full(len(origin) - len(parts), -1)
    filler[len(filler) - len(joined) :] = _JOINED
    move, along, total = (np.append(column, filler)[origin] for column in (row[parts.move], along, total))
    last = _last_of(first, len(which))
    return _Plane(walls, move, along, total, chosen, contours.left[row], first, last, half, pitch, beside)


def _last_of(first: Rows, count: int) -> Rows:
    """The last curve of each loop; count: of all curves."""
    return np.append(first[1:], count)[: len(first)] - 1


def _ends(chosen: Curves, first: Rows, total: Floats, contours: Contours, pitch: float) -> LoopEnds:
    """The ends of loops, at the place of their group; total: their length [mm]."""
    last, group = _last_of(first, len(chosen)), chosen.loop[first]
    start, end = chosen[first], chosen[last]
    return LoopEnds(
        start.start + pitch * group,
        end.end + pitch * group,
        start.leaving,
        end.arriving,
        np.isnan(start.center) & np.isnan(end.center),
        total,
        contours.radius[group],
        group,
    )


def _lengths(parts: Segments, which: Rows) -> tuple[Floats, Floats]:
    """The distance of each part from the start of its loop, and the length of the loop [mm]; which: loop per move."""
    loop = which[parts.move]
    until = np.cumsum(np.abs(parts.end - parts.start))
    first, last = (np.searchsorted(loop, loop, side) for side in ("left", "right"))
    begin = np.append(0, until)[first]
    return np.append(0, until)[: len(loop)] - begin, until[last - 1] - begin


def _lines(start: Points, end: Points, group: Rows, pitch: float, joins: bool) -> Walls:
    """Lines that are no walls, each moved to the place of its group."""
    neither = np.zeros(len(start), bool)
    shift = (pitch * group).astype(np.complex128)
    return Walls(start + shift, end + shift, neither, neither, np.full(len(start), joins), group)


def _together(lines: list[Walls]) -> tuple[Walls, Rows]:
    """These walls sorted by group, and the original number of each."""
    walls = Walls.concatenated(lines)
    order = np.argsort(walls.group, kind="stable")
    return walls[order], order


def _joints(curves: Curves, first: Rows, half: float, pitch: float) -> Walls:
    """Lines that connect a group: across gaps between curves, and from each loop to the square round the group."""
    torn = np.flatnonzero(np.abs(curves.start[1:] - curves.end[:-1]) > TOUCH / 10)
    torn = torn[curves.loop[torn] == curves.loop[torn + 1]]
    group, begin = curves.loop[first], curves.start[first]
    out = half + 1j * begin.imag
    # Starts in one row are joined each to the next: lines all the way to the square would overlap.
    order = np.lexsort((begin.real, begin.imag, group))
    here, after = order[:-1], order[1:]
    in_row = (group[here] == group[after]) & (begin.imag[here] == begin.imag[after])
    out[here[in_row]] = begin[after[in_row]]
    start, end = np.concatenate([curves.end[torn], begin]), np.concatenate([curves.start[torn + 1], out])
    return _lines(start, end, np.concatenate([curves.loop[torn], group]), pitch, joins=True)


def _square(group: Rows, half: float, pitch: float) -> Walls:
    """The squares round these groups."""
    corner = np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j]) * complex(half)
    of = np.repeat(group, 4)
    start, end = np.tile(corner, len(group)), np.tile(np.roll(corner, -1), len(group))
    return _lines(start, end, of, pitch, joins=False)


def _standing(plane: _Plane, lines: Walls | None, chosen: Mask, thinnest: float) -> tuple[Standing, _Outline]:
    """The standing faces of the chosen groups with these added lines, and the outline along programmed curves."""
    walls, origin, move = plane.walls, np.arange(len(plane.move)), plane.move
    if lines is not None:
        move = np.append(move, np.full(len(lines.group), -1))
        walls, origin = _together([walls, lines])
        in_chosen = chosen[walls.group]
        walls, origin = walls[in_chosen], origin[in_chosen]
    faces = standing(walls, len(chosen), thinnest)
    wall = origin[faces.wall]
    start, end = _without_joints(faces, move[wall] == _JOINED)
    edge = _begun_behind(faces.ring, move[wall] == -1)
    edge = edge[move[wall[edge]] >= 0]
    return faces, (start[edge], end[edge], wall[edge])


def _begun_behind(ring: Rows, is_other: Mask) -> Rows:
    """The edges of rings, in the order of the rings; those with lines that are no walls begin behind one of these."""
    order = np.arange(len(ring))
    for number in different(ring[is_other]).tolist():
        first, until = np.searchsorted(ring, number), np.searchsorted(ring, number, side="right")
        begins = np.flatnonzero(is_other[first:until] & ~np.roll(is_other[first:until], -1))
        if len(begins):
            order[first:until] = np.roll(order[first:until], -int(begins[-1]) - 1)
    return order


def _without_joints(faces: Standing, joined: Mask) -> tuple[Points, Points]:
    """Start and end of the edges of parts, moved to one point where a line joins an end to the wall beside it."""
    start, end, ring = faces.start.copy(), faces.end.copy(), faces.ring
    for edge in np.flatnonzero(joined).tolist():
        before, after = edge - 1, edge + 1
        if after < len(ring) and ring[after] == ring[edge]:
            start[after] = start[edge]
        elif before >= 0 and ring[before] == ring[edge]:
            end[before] = end[edge]
    return start, end


# ---- contours that do not close ----


def _bridges(plane: _Plane, contours: Contours) -> tuple[Walls, Floats]:
    """
    Lines across the gaps of loops, and the length of the longest gap of each group [mm], 0 for none.

    A gap is shorter than 2R, so that no tool passes through it, and continues the direction of the contour. The walls
    of a blade that is machined round its end are as near to each other, but lie side by side. The leads beside a gap
    have the tool on their far side, else they are the walls of a slot.
    """
    curves, first, last = plane.chosen, plane.first, plane.last
    gaps = gaps_between_ends(curves, first, last)
    fits = (gaps.length < 2 * contours.radius[curves.loop[first]][:, None]) & (gaps.length > TOUCH)
    fits &= gaps.lead_on | (gaps.length <= contours.tolerance)
    aside = np.where(plane.left, 1j, -1j)
    leads = (gaps.after - 1, curves.arriving, -gaps.vector), (gaps.before + 1, curves.leaving, gaps.vector)
    for lead, direction, across in leads:
        lead = np.clip(lead, first[:, None], last[:, None])
        is_lead = (lead != gaps.after) & (lead != gaps.before)
        fits &= ~is_lead | ((across * (aside * direction)[lead].conj()).real <= contours.tolerance)
    length = np.where(fits, gaps.length, np.inf)
    best = np.argmin(length, axis=1)
    row = np.arange(len(first))
    has_gap = np.isfinite(length[row, best])
    row, best = row[has_gap], best[has_gap]
    after, before = gaps.after[row, best], gaps.before[row, best]
    group = curves.loop[after]
    longest = np.zeros(len(contours.radius))
    np.maximum.at(longest, group, length[row, best])
    return _lines(curves.end[before], curves.start[after], group, plane.pitch, joins=False), longest


def _rays(plane: _Plane, contours: Contours) -> tuple[Walls, Floats]:
    """Lines straight on from both ends of each loop to the square, and the longest of each group [mm], 0 for none."""
    curves = plane.chosen
    point = np.concatenate([curves.start[plane.first], curves.end[plane.last]])
    direction = np.concatenate([-curves.leaving[plane.first], curves.arriving[plane.last]])
    group = np.concatenate([curves.loop[plane.first], curves.loop[plane.last]])
    length = np.full(len(point), np.inf)
    for begin, along in ((point.real, direction.real), (point.imag, direction.imag)):
        with np.errstate(divide="ignore", invalid="ignore"):
            length = np.fmin(length, np.where(along == 0, np.inf, (np.copysign(plane.half, along) - begin) / along))
    length = np.where(np.isfinite(length), length, 0)
    longest = np.zeros(len(contours.radius))
    np.maximum.at(longest, group, length)
    return _lines(point, point + length * direction, group, plane.pitch, joins=False), longest


def _within_bar(polygon: Geometries, diameter: float, pitch: float) -> Geometries:
    """The polygons cut off at the bar."""
    middle = shapely.points(pitch * np.arange(len(polygon)), 0.0)
    bar = areas.buffer(middle, diameter / 2, quad_segs=_BAR_CORNERS)
    return np.asarray(areas.intersection(polygon, bar, grid_size=GRID))
