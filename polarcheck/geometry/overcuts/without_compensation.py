"""
Moves without compensation against the part that the contours of their section leave.

The material of a contour stands from its Z up to the face. At the Z of a contour all loops of the section that are at
that Z or deeper have been there, and so bound its part: a pocket that goes deeper is no part of the boss round it. A
move cuts the part of each contour at its own Z or above it. Floats in mm, plane points complex, x + 1j*c. Import late.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Rows
from polarcheck.geometry.overcuts.cuts import Cuts, cuts_into, endless, shortened, with_walls
from polarcheck.geometry.overcuts.uncompensated_moves import Bare, FlatLoops
from polarcheck.geometry.polygons.faces import coordinates, lines_of
from polarcheck.geometry.polygons.finished_part import Contours, FinishedParts, finished_parts
from polarcheck.geometry.segments import Curves, Segments, boxes, members, reach_from_start, segments
from polarcheck.geometry.tolerances import ROUNDING, ZERO
from polarcheck.time_limit import keep_time

#: Sums over a loop that differ by less [mm] are the same: their rounding grows with the square of its blocks.
_SAME_SUM = 1e-3
#: Pairs of a wall and a way up to which walls are looked through one by one, without a tree.
_PAIRS = 4_000_000
#: Ways between two looks at the clock.
_BATCH = 1024
#: Depths of the contours of a section that are looked at, the deepest ones.
_DEPTHS = 8


def cuts_into_part(contour: Contours, loops: FlatLoops, bare: Bare) -> tuple[Cuts, Rows]:
    """
    Where moves without compensation come nearer than R to the part of a contour at their Z or above it; the worst place
    of each. And the loops that cross each other too often to tell.

    contour: the programmed blocks in offset mode, its loops, groups and radius are not asked. loops: those of it that
    stay at one Z. bare: what may reach them. Of a move of Z alone within the part, away from its walls, nothing is
    said: it begins a hole; nor of what comes out of surroundings without an end, as to a pocket.
    """
    none = np.zeros(0, np.int64)
    groups = _groups(contour.curves, loops, bare)
    if not len(groups.top):
        return Cuts.none(), none
    move, group = _pairs(groups, bare)
    ways, group = _ways(bare, move, group, contour.tolerance)
    radius = np.zeros(len(groups.top))
    np.maximum.at(radius, group, bare.radius[ways.move])
    near = _comes_near(contour, groups, ways, group, radius)
    asked = np.unique(group[near])
    if not len(asked):
        return Cuts.none(), none
    kept = np.isin(groups.group, asked)
    number = np.searchsorted(asked, groups.group[kept])
    radius = radius[asked]
    part = finished_parts(msgspec.structs.replace(contour, loop=groups.loop[kept], group=number, radius=radius))
    tangled = groups.loop[kept][part.tangled[number]]
    ways, group = ways[near], np.searchsorted(asked, group[near])
    outline, is_endless = shortened(part, radius), endless(part)
    cuts = cuts_into(outline, part.open | is_endless, ways, group, radius, contour.tolerance)
    cuts = with_walls(outline, cuts)
    deep = ~bare.plunges[cuts.move] | (cuts.aside < radius[cuts.group] - contour.tolerance)
    depth = cuts.depth - radius[cuts.group] + bare.radius[cuts.move]
    deep &= (depth > contour.tolerance) & ~(is_endless[cuts.group] & _begins_in(part, cuts, ways))
    return msgspec.structs.replace(cuts, depth=depth)[deep].worst(), np.unique(tangled)


def _begins_in(part: FinishedParts, cuts: Cuts, ways: Segments) -> Mask:
    """Whether the way of each cut begins in the part: what is far round a pocket may as well be air."""
    begin = ways.start[cuts.piece]
    beyond = np.maximum(np.abs(begin.real), np.abs(begin.imag)) >= part.pitch / 3
    points = shapely.points(coordinates(begin + part.pitch * cuts.group))
    return np.asarray(beyond | shapely.intersects(part.polygon[cuts.group], points))


class _Groups(msgspec.Struct, frozen=True):
    """Groups of loops that bound one part: section and highest Z of each, the loops and their groups."""

    section: Rows
    top: Floats
    loop: Rows
    group: Rows


def _groups(curves: Curves, loops: FlatLoops, bare: Bare) -> _Groups:
    """
    For each depth of the contours that a move may cut the loops that bound the part there.

    A contour that is written once more, higher, bounds nothing else; depths with the same loops make one group.
    """
    lowest = np.full(int(max(loops.section.max(), bare.curves.loop.max())) + 1, np.inf)
    np.minimum.at(lowest, bare.curves.loop, bare.z)
    wanted = np.isfinite(lowest[loops.section])
    order = np.flatnonzero(wanted)[np.lexsort((loops.z[wanted], loops.section[wanted]))]
    is_fresh = _fresh(curves, loops.section[order], loops.loop[order])
    section, z = loops.section[order], loops.z[order]
    begin = np.searchsorted(section, section)
    bounding = np.cumsum(is_fresh)
    # The last loop of each depth, in the order of depths, and of depths with the same loops the highest.
    last = np.append((np.diff(section) != 0) | (np.diff(z) > ROUNDING), True)
    level = np.flatnonzero(last & (z >= lowest[section] - ROUNDING))
    same = (np.diff(bounding[level]) == 0) & (np.diff(section[level]) == 0)
    level = level[np.append(~same, True)]
    place = np.arange(len(level)) - np.searchsorted(section[level], section[level])
    level = level[place < _DEPTHS]
    count = level - begin[level] + 1
    group = np.repeat(np.arange(len(level)), count)
    loop = np.arange(len(group)) - np.repeat(np.cumsum(count) - count, count) + begin[level][group]
    kept = is_fresh[loop]
    return _Groups(section[level], z[level], loops.loop[order][loop[kept]], group[kept])


def _fresh(curves: Curves, section: Rows, loop: Rows) -> Mask:
    """Of these loops the first of its kind in its section; loops with the same sums are one."""
    here, _ = members(curves.loop, loop)
    start, first = curves.start[here], np.searchsorted(curves.loop, loop)
    count = np.searchsorted(curves.loop, loop, side="right") - first
    begin = np.cumsum(count) - count
    place = np.arange(1, len(here) + 1) - np.repeat(begin, count)
    sums = [np.add.reduceat(column, begin) for column in (start, start * place, np.abs(curves.end[here]))]
    key = [section, count, *(np.rint(part / _SAME_SUM) for total in sums for part in (total.real, total.imag))]
    _, first = np.unique(np.stack(key, axis=1), axis=0, return_index=True)
    fresh = np.zeros(len(loop), bool)
    fresh[first] = True
    return fresh


def _pairs(groups: _Groups, bare: Bare) -> tuple[Rows, Rows]:
    """Each move with each group whose part it may cut."""
    group, move = members(groups.section, bare.curves.loop)
    kept = bare.z[move] <= groups.top[group] + ROUNDING
    return move[kept], group[kept]


def _ways(bare: Bare, move: Rows, group: Rows, tolerance: float) -> tuple[Segments, Rows]:
    """The moves as straight ways, those of Z alone as points, and the group of each."""
    curves = msgspec.structs.replace(bare.curves[move], loop=np.arange(len(move)))
    parts = segments(curves, tolerance)
    point = np.flatnonzero(bare.plunges[move])
    number = np.concatenate([parts.move, point])
    start, end = (np.concatenate([ends, curves.end[point]]) for ends in (parts.start, parts.end))
    return Segments(start, end, move[number], bare.curves.loop[move][number]), group[number]


def _comes_near(contour: Contours, groups: _Groups, ways: Segments, group: Rows, radius: Floats) -> Mask:
    """
    Ways that come within R of a wall, or that begin behind the wall next to them.

    From a point to the wall next to it there is no other wall: where that shows its tool side there is no part. Nor is
    there any that is known outside of the box round all walls, and of the bar.
    """
    here, which = members(contour.curves.loop, groups.loop)
    curves = msgspec.structs.replace(contour.curves[here], loop=groups.group[which])
    box = boxes(curves, np.flatnonzero(np.diff(curves.loop, prepend=-1)))[:, group]
    inside = (ways.start.real >= box[0]) & (ways.start.real <= box[2])
    inside &= (ways.start.imag >= box[1]) & (ways.start.imag <= box[3])
    inside = np.flatnonzero(inside | (np.abs(ways.start) < contour.bar / 2))
    far = 4 * float(np.abs(box).max() + max(np.abs(ways.start).max(), np.abs(ways.end).max())) + 1
    begin = (ways.start + far * group)[inside]
    points, line = shapely.points(coordinates(begin)), lines_of(ways.start + far * group, ways.end + far * group)
    kept = _nearby(curves, ways, group, radius)
    curves, here = curves[kept], here[kept]
    walls = segments(curves, contour.tolerance)
    start, end = walls.start + far * walls.loop, walls.end + far * walls.loop
    near = np.zeros(len(ways), bool)
    if not len(walls):
        return near
    tree = shapely.STRtree(lines_of(start, end))
    most = max(float(radius.max(initial=0.0)), ZERO)
    for first in range(0, len(line), _BATCH):
        keep_time()
        # Whether there is any wall is known from the next one, however many there are.
        (close, _), apart = tree.query_nearest(
            line[first : first + _BATCH], max_distance=most, return_distance=True, all_matches=False
        )
        near[first + close] = apart <= radius[group[first + close]]
    (asked, _), distance = tree.query_nearest(points, all_matches=False, return_distance=True)
    way, wall = tree.query(points[asked], predicate="dwithin", distance=distance + ROUNDING)
    way = asked[way]
    aside = ((begin[way] - start[wall]) * (end - start)[wall].conj()).imag > 0
    near[inside[way[aside != contour.left[here[walls.move[wall]]]]]] = True
    return near


def _nearby(curves: Curves, ways: Segments, group: Rows, radius: Floats) -> Rows:
    """The curves that may come within R of a way of their group, or be next to where it begins; or all of them."""
    _, first = np.unique(np.stack([group, ways.start, ways.end], axis=1), axis=0, return_index=True)
    start, end, group = ways.start[first], ways.end[first], group[first]
    count = np.bincount(curves.loop, minlength=len(radius))[group]
    if count.sum() > _PAIRS:
        return np.arange(len(curves))
    curve, way = members(curves.loop, group)
    long = reach_from_start(curves)
    far = curves.start[curve] - start[way]
    apart = np.abs(far)
    nearest = np.minimum.reduceat(apart, np.cumsum(count) - count)
    along = end - start
    length = np.maximum(np.abs(along), ZERO)
    place = np.clip((far * (along / length)[way].conj()).real, 0, length[way])
    aside = np.abs(far - place * (along / length)[way])
    kept = (apart - long[curve] <= nearest[way] + ROUNDING) | (aside - long[curve] <= radius[group][way] + ROUNDING)
    chosen = np.zeros(len(curves), bool)
    chosen[curve[kept]] = True
    return np.flatnonzero(chosen)
