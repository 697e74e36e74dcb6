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

from polarcheck.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.contour_ends import CLOSED, gaps_between_ends
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID, Geometries, Standing, Walls, standing
from polarcheck.geometry.segments import Curves, Segments, directions, first_of_its_kind, members, segments
from polarcheck.geometry.tolerances import TOUCH
from polarcheck.time_limit import keep_time

#: Corners of the circle that stands for the bar, in a quarter.
_BAR_CORNERS = 256
#: Pairs of ends and walls to compare at a time.
_PAIRS = 1_000_000
#: A contour ends beside its start where that is nearer than this share of its length, and runs on in the direction of
#: its start where it turns by no more than this [rad].
_BESIDE, _STRAIGHT = 0.025, 0.35
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
    is_first = first_of_its_kind(chosen)[parts.move]
    parts, along, total = parts[is_first].shifted(pitch * parts.loop[is_first]), along[is_first], total[is_first]
    left = contours.left[row][parts.move]
    nothing = np.zeros(len(parts), bool)
    walls = Walls(parts.start, parts.end, left, ~left, nothing, parts.loop)
    first = np.flatnonzero(np.diff(which, prepend=-1))
    last = np.append(first[1:], len(which))[: len(first)] - 1
    ends = np.append(chosen.start[first], chosen.end[last])
    more = [_joints(chosen, first, half, pitch), _square(np.unique(group), half, pitch)]
    beside = np.zeros(len(contours.radius))
    if contours.closes_beside:
        lines, length = _besides(chosen, first, last, contours.radius, pitch)
        np.maximum.at(beside, lines.group, length)
        more.append(lines)
    joined = _joined_ends(ends, np.tile(chosen.loop[first], 2), walls, pitch)
    walls, origin = _together([walls, *more, joined])
    others = np.full(len(origin) - len(parts), -1)
    others[len(others) - len(joined) :] = _JOINED
    move, along, total = (np.append(column, others)[origin] for column in (row[parts.move], along, total))
    return _Plane(walls, move, along, total, chosen, contours.left[row], first, last, half, pitch, beside)


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


def _joined_ends(point: Points, group: Rows, walls: Walls, pitch: float) -> Walls:
    """Lines from the ends of loops [mm] to the walls of their group beside them, nearer than points are rounded to."""
    ends = point + pitch * group
    end, wall = _candidates(ends, walls)
    way = walls.end[wall] - walls.start[wall]
    beside = (ends[end] - walls.start[wall]) * way.conj() / np.abs(way)
    length = np.abs(way)
    foot = walls.start[wall] + way * np.clip(beside.real, 0, length) / length
    distance = np.abs(ends[end] - foot)
    joins = (distance > TOUCH / 10) & (distance <= CLOSED)
    end, foot = end[joins], foot[joins] - pitch * group[end[joins]]
    return _lines(point[end], foot, group[end], pitch, joins=False)


def _candidates(ends: Points, walls: Walls) -> tuple[Rows, Rows]:
    """Ends of loops and walls whose boxes are no farther apart than CLOSED, as pairs of their numbers."""
    order = np.argsort(ends.real, kind="stable")
    across = ends.real[order]
    low, high = np.minimum(walls.start.real, walls.end.real), np.maximum(walls.start.real, walls.end.real)
    first, until = np.searchsorted(across, low - CLOSED), np.searchsorted(across, high + CLOSED, side="right")
    pairs: list[tuple[Rows, Rows]] = [(np.zeros(0, np.int64), np.zeros(0, np.int64))]
    begins = 0
    total = np.cumsum(until - first)
    while begins < len(total):
        keep_time()
        before = total[begins - 1] if begins else 0
        stop = max(int(np.searchsorted(total, before + _PAIRS)), begins + 1)
        count = (until - first)[begins:stop]
        wall = np.repeat(np.arange(begins, stop), count)
        place = np.arange(len(wall)) - np.repeat(np.cumsum(count) - count, count)
        end = order[first[wall] + place]
        c, a, b = ends[end].imag, walls.start[wall].imag, walls.end[wall].imag
        near = (c >= np.minimum(a, b) - CLOSED) & (c <= np.maximum(a, b) + CLOSED)
        pairs.append((end[near], wall[near]))
        begins = stop
    end, wall = (np.concatenate(column) for column in zip(*pairs, strict=True))
    return end, wall


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
    for number in np.unique(ring[is_other]).tolist():
        first, until = np.searchsorted(ring, number), np.searchsorted(ring, number, side="right")
        begins = np.flatnonzero(is_other[first:until] & ~np.roll(is_other[first:until], -1))
        if len(begins):
            order[first:until] = np.roll(order[first:until], -int(begins[-1]) - 1)
    return order


def _without_joints(faces: Standing, joined: Mask) -> tuple[Points, Points]:
    """Start and end of the edges of parts, moved to one point where a line joins an end to the wall beside it."""
    start, end, ring = faces.start.copy(), faces.end.copy(), faces.ring
    for edge in np.flatnonzero(joined).tolist():
        before, behind = edge - 1, edge + 1
        if behind < len(ring) and ring[behind] == ring[edge]:
            start[behind] = start[edge]
        elif before >= 0 and ring[before] == ring[edge]:
            end[before] = end[edge]
    return start, end


# ---- contours that do not close ----


def _besides(curves: Curves, first: Rows, last: Rows, radius: Floats, pitch: float) -> tuple[Walls, Floats]:
    """
    Lines that close contours which end a little beside their start; for each line how far beside, or how far either
    end is from the corner [mm].

    At a corner the walls are extended to where they meet, along a wall its end is joined to what lies beside it. The
    walls of a blade lie as near to each other, but run against each other.
    """
    begins, ends = directions(curves.start, curves.end, curves.center, curves.kind)
    start, end, group = curves.start[first], curves.end[last], curves.loop[first]
    begin, way = begins[first], ends[last]
    until = np.append(0, np.cumsum(np.abs(curves.end - curves.start)))
    total = until[last + 1] - until[first]
    limit = np.minimum(_BESIDE * total, np.where(radius[group] > 0, radius[group], np.inf))
    is_line = np.isnan(curves.center[first]) & np.isnan(curves.center[last])
    turn = np.abs(np.angle(begin * way.conj()))
    gap = start - end
    length = np.abs(gap)
    is_near = (length > CLOSED) & (last - first >= 2)

    # At a corner: end + along * way is start - back * begin.
    bends = (turn > _STRAIGHT) & (turn < np.pi - _STRAIGHT)
    across = np.where(bends, (way.conj() * begin).imag, np.nan)
    along = (gap.conj() * begin).imag / across
    back = (way.conj() * gap).imag / across
    meet = end + along * way
    is_corner = is_near & is_line & (length <= limit) & bends
    is_corner &= (np.abs(along) <= 3 * length) & (np.abs(back) <= 3 * length)

    # Along a wall: over some of their length the two lie side by side.
    over = -(gap * way.conj()).real
    apart = np.abs((gap * way.conj()).imag)
    is_wall = is_near & (turn <= _STRAIGHT) & (apart <= limit) & (apart > CLOSED)
    lies_along = is_wall & is_line & (over > 0) & (length > limit)
    lies_along &= over <= np.minimum(*(np.abs(curves.end[rows] - curves.start[rows]) for rows in (first, last)))
    is_step = is_near & ~is_corner & (length <= limit) & (is_wall | (~is_line & (turn < np.pi - _STRAIGHT)))
    foot_of_end = start + begin * ((end - start) * begin.conj()).real
    foot_of_start = end + way * (gap * way.conj()).real
    lines = [
        (end, meet, is_corner),
        (meet, start, is_corner),
        (end, start, is_step),
        (end, foot_of_end, lies_along),
        (start, foot_of_start, lies_along),
    ]
    points = [np.concatenate([line[side][line[2]] for line in lines]) for side in (0, 1)]
    loop = np.concatenate([np.flatnonzero(chosen) for _, _, chosen in lines])
    size = np.where(is_corner, np.fmax(length, np.fmax(np.abs(along), np.abs(back))), np.where(is_step, length, apart))
    return _lines(points[0], points[1], group[loop], pitch, joins=False), size[loop]


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
    begins, ends = directions(curves.start, curves.end, curves.center, curves.kind)
    aside = np.where(plane.left, 1j, -1j)
    for lead, way, across in ((gaps.after - 1, ends, -gaps.vector), (gaps.before + 1, begins, gaps.vector)):
        lead = np.clip(lead, first[:, None], last[:, None])
        is_lead = (lead != gaps.after) & (lead != gaps.before)
        fits &= ~is_lead | ((across * (aside * way)[lead].conj()).real <= contours.tolerance)
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
    begins, ends = directions(curves.start, curves.end, curves.center, curves.kind)
    point = np.concatenate([curves.start[plane.first], curves.end[plane.last]])
    way = np.concatenate([-begins[plane.first], ends[plane.last]])
    group = np.concatenate([curves.loop[plane.first], curves.loop[plane.last]])
    length = np.full(len(point), np.inf)
    for at, along in ((point.real, way.real), (point.imag, way.imag)):
        with np.errstate(divide="ignore", invalid="ignore"):
            length = np.fmin(length, np.where(along == 0, np.inf, (np.copysign(plane.half, along) - at) / along))
    length = np.where(np.isfinite(length), length, 0)
    longest = np.zeros(len(contours.radius))
    np.maximum.at(longest, group, length)
    return _lines(point, point + length * way, group, plane.pitch, joins=False), longest


def _within_bar(polygon: Geometries, diameter: float, pitch: float) -> Geometries:
    """The polygons cut off at the bar."""
    middle = shapely.points(pitch * np.arange(len(polygon)), 0.0)
    bar = areas.buffer(middle, diameter / 2, quad_segs=_BAR_CORNERS)
    return np.asarray(areas.intersection(polygon, bar, grid_size=GRID))
