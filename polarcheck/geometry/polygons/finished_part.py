"""
The finished part, as the walls that are programmed in offset mode leave it.

All walls of a group are cut into faces; the part fills those that see nothing but backs. So leads, passes inside each
other, spirals and overlaps need no order of their own: a lead shows its tool side to the air that it runs through, and
a pass to the material that the next one takes. What surrounds a pocket is a face as well.

A contour that does not close bounds no face. Where it comes back to its start but for a gap, the gap is closed. Else
its first and its last wall go on straight ahead, as a flat does beyond the bar; what the part is like there is not
known, but where the bar is, beyond which there is nothing.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.contour_ends import gaps_between_ends
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID, Geometries, Standing, Walls, standing
from polarcheck.geometry.segments import Curves, Segments, directions, first_of_its_kind, members, segments
from polarcheck.geometry.tolerances import TOUCH

#: Corners of the circle that stands for the bar, in a quarter.
_BAR_CORNERS = 256


class Contours(msgspec.Struct, frozen=True):
    """
    Programmed walls with the groups that are looked at together.

    curves: those of offset mode, loop after loop. left: bool[curves], the tool runs left of it. loop, group: int[m],
    the loops of each group, groups from 0 and rising. radius: float64[groups] [mm]. bar: diameter [mm], NaN if unknown.
    """

    curves: Curves
    left: Mask
    loop: Rows
    group: Rows
    radius: Floats
    bar: float
    tolerance: float


class FinishedParts(msgspec.Struct, frozen=True):
    """
    The finished part of each group, groups side by side: everything of group k is shifted by pitch * k along X.

    polygon: shapely geometry[groups] [mm], empty where there is none. open: bool[groups], its outline is known along
    the walls only. gap: float64[groups], what was closed [mm], 0 for none. tangled: bool[groups], no contour at all.
    start, end: complex128[k] [mm], the walls that bound the part, with it on their left; move: int[k], of the curves;
    group: int[k]; along: float64[k, 2], how far along the contour of its loop each starts and ends, and ahead:
    float64[k, 2], how far that goes on from there [mm].
    """

    polygon: Geometries
    open: Mask
    gap: Floats
    tangled: Mask
    start: Points
    end: Points
    move: Rows
    group: Rows
    along: Floats
    ahead: Floats
    pitch: float


def finished_parts(contours: Contours) -> FinishedParts:
    """What the walls of each group leave standing."""
    plane = _plane(contours)
    groups = len(contours.radius)
    found, outline = _standing(plane, None, np.ones(groups, bool), contours.tolerance)
    polygon, tangled, outlines = found.polygon, found.tangled, [outline]
    gap, is_open = np.zeros(groups), np.zeros(groups, bool)
    for closing in (_bridges, _rays):
        asked = shapely.is_empty(polygon) & ~tangled
        if not asked.any():
            break
        lines, length = closing(plane, contours)
        asked &= length > 0
        if not asked.any():
            continue
        found, outline = _standing(plane, lines, asked, contours.tolerance)
        closed = asked & ~shapely.is_empty(found.polygon)
        polygon[closed] = found.polygon[closed]
        tangled |= found.tangled
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
    return FinishedParts(polygon, is_open, gap, tangled, start, end, move, group, along, ahead, plane.pitch)


class _Plane(msgspec.Struct, frozen=True):
    """
    All groups side by side.

    walls; move: the curve that each is part of, -1 for other lines; along, total: how far along its loop it begins, and
    how long that is [mm]. chosen: the curves, `loop` their group; left: bool of each, the tool runs left of it; first,
    last: of each loop of a group. half: half the side of the square round each group [mm].
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


#: Start, end and wall of what bounds a part.
_Outline = tuple[Points, Points, Rows]


def _plane(contours: Contours) -> _Plane:
    curves = contours.curves
    order = np.argsort(curves.loop, kind="stable")
    here, which = members(curves.loop[order], contours.loop)
    here = order[here]
    known = ~np.isnan(curves.start[here] + curves.end[here])
    here, which = here[known], which[known]
    group = contours.group[which]
    chosen = msgspec.structs.replace(curves[here], loop=group)

    parts = segments(chosen, contours.tolerance)
    reach = float(np.abs([parts.start.real, parts.start.imag, parts.end.real, parts.end.imag]).max(initial=1.0))
    half = 2 * reach + 4 * float(contours.radius.max(initial=0.0))
    pitch = 3 * half
    along, total = _lengths(parts, which)
    kept = first_of_its_kind(chosen)[parts.move]
    parts, along, total = parts[kept].shifted(pitch * parts.loop[kept]), along[kept], total[kept]
    left = contours.left[here][parts.move]
    nothing = np.zeros(len(parts), bool)
    walls = Walls(parts.start, parts.end, left, ~left, nothing, parts.loop)
    first = np.flatnonzero(np.diff(which, prepend=-1))
    more = [_joints(chosen, first, half, pitch), _square(np.unique(group), half, pitch)]
    walls, origin = _together([walls, *more])
    others = np.full(len(origin) - len(parts), -1)
    move, along, total = (np.append(column, others)[origin] for column in (here[parts.move], along, total))
    last = np.append(first[1:], len(which))[: len(first)] - 1
    return _Plane(walls, move, along, total, chosen, contours.left[here], first, last, half, pitch)


def _lengths(parts: Segments, which: Rows) -> tuple[Floats, Floats]:
    """How far along its loop each part begins, and how long that loop is [mm]; which: the loop of each move."""
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
    """All these walls, those of one group together; and which each was when counted through."""
    walls = Walls.concatenated(lines)
    order = np.argsort(walls.group, kind="stable")
    return walls[order], order


def _joints(curves: Curves, first: Rows, half: float, pitch: float) -> Walls:
    """What holds a group together: across gaps between curves, and from each loop to the square round the group."""
    torn = np.flatnonzero(np.abs(curves.start[1:] - curves.end[:-1]) > TOUCH / 10)
    torn = torn[curves.loop[torn] == curves.loop[torn + 1]]
    group, begin = curves.loop[first], curves.start[first]
    out = half + 1j * begin.imag
    # Of starts in a row each leads to the next: all the way to the square, they would run over each other.
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


def _standing(plane: _Plane, lines: Walls | None, asked: Mask, thinnest: float) -> tuple[Standing, _Outline]:
    """What stands of the groups asked for, with these lines; and its outline, as far as it is of curves."""
    walls, origin, is_curve = plane.walls, np.arange(len(plane.move)), plane.move >= 0
    if lines is not None:
        is_curve = np.append(is_curve, np.zeros(len(lines.group), bool))
        walls, origin = _together([walls, lines])
        kept = asked[walls.group]
        walls, origin = walls[kept], origin[kept]
    found = standing(walls, len(asked), thinnest)
    wall = origin[found.wall]
    of_curve = is_curve[wall]
    return found, (found.start[of_curve], found.end[of_curve], wall[of_curve])


# ---- contours that do not close ----


def _bridges(plane: _Plane, contours: Contours) -> tuple[Walls, Floats]:
    """
    Over the gap of each group whose last walls lead back to its first ones, and how long it is, 0 for none [mm].

    A gap is below 2R, so that no tool goes through it, and lies on the way of the contour: the tool would have to go on
    straight ahead. The walls of a blade that is machined round its end are as near to each other, side by side. And the
    leads beside a gap have the tool on their other side, else they are the walls of a slot.
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
    """Straight on from both ends of each loop to the square round its group, and how long by group, 0 for none."""
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
    """What of these lies within the bar."""
    middle = shapely.points(pitch * np.arange(len(polygon)), 0.0)
    bar = areas.buffer(middle, diameter / 2, quad_segs=_BAR_CORNERS)
    return np.asarray(areas.intersection(polygon, bar, grid_size=GRID))
