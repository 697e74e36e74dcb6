"""
Overcuts of moves without compensation into the part that the contours of their section leave.

The material of a contour reaches from its Z up to the face. All loops of the section at that Z or deeper bound the part
at that Z: a deeper pocket is not part of the boss round it. A move cuts the part of each contour whose Z is not below
the Z of the move. Floats in mm, plane points complex, x + 1j*c. Import late.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Rows, different, folded, mask_at, ranges
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.overcuts.cuts import Cuts, assign_walls, cuts_into, endless, shortened
from polarcheck.geometry.overcuts.uncompensated_moves import Bare, FlatLoops
from polarcheck.geometry.polygons.faces import coordinates, lines_of
from polarcheck.geometry.polygons.finished_part import Contours, FinishedParts, finished_parts
from polarcheck.geometry.segments import Curves, Segments, members, reach_from_start, segments
from polarcheck.geometry.tolerances import ROUNDING, ZERO

#: Sums over a loop are equal if they differ by less [mm]: their rounding grows with the square of its blocks.
_SAME_SUM = 1e-3
#: Up to this number of pairs of a wall and a chord, all pairs are compared, without a tree.
_PAIRS = 4_000_000
#: Pairs that are compared together, but for the last chord of them.
_PAIRS_AT_ONCE = 100_000
#: Ways between two checks of the time limit.
_BATCH = 1024
#: Only this number of contour depths per section is checked, from the deepest up.
_DEPTHS = 8


def cuts_into_part(contour: Contours, loops: FlatLoops, bare: Bare) -> tuple[Cuts, Rows]:
    """
    The deepest cut of each move into the part of a contour at its Z or above, and the loops that cross too often.

    contour: the programmed blocks in offset mode; its loops, groups and radius are not used.
    loops: the loops of the contour that stay at one Z.
    bare: moves without compensation that may reach these loops.

    Two kinds of cuts are not reported. A move of Z alone inside the part, away from its walls, begins a hole. A move
    that starts in the endless surroundings of a pocket may start in air.
    """
    none = np.zeros(0, np.int64)
    groups = _groups(contour.curves, loops, bare)
    if not len(groups.top):
        return Cuts.none(), none
    move, group = _pairs(groups, bare)
    chords, group = _chords(bare, move, group, contour.tolerance)
    radius = folded(np.maximum, group, bare.radius[chords.move], len(groups.top), 0.0)
    near = _comes_near(contour, loops, groups, chords, group, radius)
    near_groups = different(group[near])
    if not len(near_groups):
        return Cuts.none(), none
    is_near = np.isin(groups.group, near_groups)
    number = np.searchsorted(near_groups, groups.group[is_near])
    radius = radius[near_groups]
    part = finished_parts(msgspec.structs.replace(contour, loop=groups.loop[is_near], group=number, radius=radius))
    tangled = groups.loop[is_near][part.tangled[number]]
    chords, group = chords[near], np.searchsorted(near_groups, group[near])
    outline, is_endless = shortened(part, radius), endless(part)
    cuts = cuts_into(outline, part.open | is_endless, chords, group, radius, contour.tolerance)
    cuts = assign_walls(outline, cuts)
    deep = ~bare.plunges[cuts.move] | (cuts.aside < radius[cuts.group] - contour.tolerance)
    depth = cuts.depth - radius[cuts.group] + bare.radius[cuts.move]
    deep &= (depth > contour.tolerance) & ~(is_endless[cuts.group] & _begins_in(part, cuts, chords))
    return msgspec.structs.replace(cuts, depth=depth)[deep].worst(), different(tangled)


def _begins_in(part: FinishedParts, cuts: Cuts, chords: Segments) -> Mask:
    """True where the chord of a cut begins in the part. The surroundings far from a pocket may be air."""
    begin = chords.start[cuts.piece]
    beyond = np.maximum(np.abs(begin.real), np.abs(begin.imag)) >= part.pitch / 3
    points = shapely.points(coordinates(begin + part.pitch * cuts.group))
    return np.asarray(beyond | shapely.intersects(part.polygon[cuts.group], points))


class _Groups(msgspec.Struct, frozen=True):
    """
    Groups of loops that bound one part, n groups with m loops together.

    section: int[n], the section of each group.
    top: float64[n] [mm], the highest Z of each group.
    loop: int[m], the loops, group after group.
    group: int[m], the group of each.
    """

    section: Rows
    top: Floats
    loop: Rows
    group: Rows


def _groups(curves: Curves, loops: FlatLoops, bare: Bare) -> _Groups:
    """
    The loops that bound the part at each contour depth that a move may cut.

    A contour that is repeated higher up adds no boundary. Depths with the same loops make one group.
    """
    count = int(max(loops.section.max(), bare.curves.loop.max())) + 1
    lowest = folded(np.minimum, bare.curves.loop, bare.z, count, np.inf)
    is_reached = np.isfinite(lowest[loops.section])
    order = np.flatnonzero(is_reached)[np.lexsort((loops.z[is_reached], loops.section[is_reached]))]
    is_first = _first_of_equal(curves, loops.section[order], loops.loop[order])
    section, z = loops.section[order], loops.z[order]
    begin = np.searchsorted(section, section)
    bounding = np.cumsum(is_first)
    # The last loop of each depth, in the order of depths. Of depths with the same loops, only the highest.
    last = np.append((np.diff(section) != 0) | (np.diff(z) > ROUNDING), True)
    level = np.flatnonzero(last & (z >= lowest[section] - ROUNDING))
    same = (np.diff(bounding[level]) == 0) & (np.diff(section[level]) == 0)
    level = level[np.append(~same, True)]
    index = np.arange(len(level)) - np.searchsorted(section[level], section[level])
    level = level[index < _DEPTHS]
    count = level - begin[level] + 1
    group, loop = ranges(count)
    loop += begin[level][group]
    bounds = is_first[loop]
    return _Groups(section[level], z[level], loops.loop[order][loop[bounds]], group[bounds])


def _first_of_equal(curves: Curves, section: Rows, loop: Rows) -> Mask:
    """True for the first of equal loops in a section; loops with equal sums are equal."""
    curve, _ = members(curves.loop, loop)
    start, first = curves.start[curve], np.searchsorted(curves.loop, loop)
    count = np.searchsorted(curves.loop, loop, side="right") - first
    begin = np.cumsum(count) - count
    index = np.arange(1, len(curve) + 1) - np.repeat(begin, count)
    sums = [np.add.reduceat(column, begin) for column in (start, start * index, np.abs(curves.end[curve]))]
    key = [section, count, *(np.rint(part / _SAME_SUM) for total in sums for part in (total.real, total.imag))]
    _, first = np.unique(np.stack(key, axis=1), axis=0, return_index=True)
    return mask_at(len(loop), first)


def _pairs(groups: _Groups, bare: Bare) -> tuple[Rows, Rows]:
    """Pairs of a move and a group whose part it may cut."""
    group, move = members(groups.section, bare.curves.loop)
    is_deep = bare.z[move] <= groups.top[group] + ROUNDING
    return move[is_deep], group[is_deep]


def _chords(bare: Bare, move: Rows, group: Rows, tolerance: float) -> tuple[Segments, Rows]:
    """The chords of the moves, a point for a move of Z alone, and the group of each."""
    curves = msgspec.structs.replace(bare.curves[move], loop=np.arange(len(move)))
    parts = segments(curves, tolerance)
    point = np.flatnonzero(bare.plunges[move])
    number = np.concatenate([parts.move, point])
    start, end = (np.concatenate([ends, curves.end[point]]) for ends in (parts.start, parts.end))
    return Segments(start, end, move[number], bare.curves.loop[move][number]), group[number]


def _comes_near(
    contour: Contours, loops: FlatLoops, groups: _Groups, chords: Segments, group: Rows, radius: Floats
) -> Mask:
    """
    True for chords that come within R of a wall, or that begin behind their nearest wall.

    No other wall lies between a point and its nearest wall. If that wall turns its tool side to the point, the point is
    outside the part. Outside the box round all walls and outside the bar no part is known.
    """
    sides = loops.box[:, np.searchsorted(loops.loop, groups.loop)]
    begins = np.flatnonzero(np.diff(groups.group, prepend=-1))
    low, high = np.minimum.reduceat(sides[:2], begins, axis=1), np.maximum.reduceat(sides[2:], begins, axis=1)
    box = np.concatenate([low, high])[:, group]
    inside = (chords.start.real >= box[0]) & (chords.start.real <= box[2])
    inside &= (chords.start.imag >= box[1]) & (chords.start.imag <= box[3])
    inside = np.flatnonzero(inside | (np.abs(chords.start) < contour.bar / 2))
    far = 4 * float(np.abs(box).max() + max(np.abs(chords.start).max(), np.abs(chords.end).max())) + 1
    begin = (chords.start + far * group)[inside]
    points, line = shapely.points(coordinates(begin)), lines_of(chords.start + far * group, chords.end + far * group)
    curve, group_of_curve = _nearby(contour.curves, groups, chords, group, radius)
    curves = msgspec.structs.replace(contour.curves[curve], loop=group_of_curve)
    walls = segments(curves, contour.tolerance)
    start, end = walls.start + far * walls.loop, walls.end + far * walls.loop
    near = np.zeros(len(chords), bool)
    if not len(walls):
        return near
    tree = shapely.STRtree(lines_of(start, end))
    largest = max(float(radius.max(initial=0.0)), ZERO)
    for first in range(0, len(line), _BATCH):
        keep_time()
        # The nearest wall decides, however many walls are near.
        (close, _), apart = tree.query_nearest(
            line[first : first + _BATCH], max_distance=largest, return_distance=True, all_matches=False
        )
        near[first + close] = apart <= radius[group[first + close]]
    (begins_at, _), distance = tree.query_nearest(points, all_matches=False, return_distance=True)
    chord, wall = tree.query(points[begins_at], predicate="dwithin", distance=distance + ROUNDING)
    chord = begins_at[chord]
    aside = ((begin[chord] - start[wall]) * (end - start)[wall].conj()).imag > 0
    near[inside[chord[aside != contour.left[curve[walls.move[wall]]]]]] = True
    return near


def _nearby(curves: Curves, groups: _Groups, chords: Segments, group: Rows, radius: Floats) -> tuple[Rows, Rows]:
    """
    Curves that may be within R of a chord of their group or nearest to its start; all if pairs are too many.

    Returns the index of each among `curves` and its group, group after group.
    """
    of_group, entry = members(curves.loop, groups.loop)
    group_of = groups.group[entry]
    _, first = np.unique(np.stack([group, chords.start, chords.end], axis=1), axis=0, return_index=True)
    start, end, group = chords.start[first], chords.end[first], group[first]
    count = np.bincount(group_of, minlength=len(radius))[group]
    if count.sum() > _PAIRS:
        return of_group, group_of
    chosen, long = np.zeros(len(of_group), bool), reach_from_start(curves)
    for some in np.split(np.arange(len(group)), np.flatnonzero(np.diff(np.cumsum(count) // _PAIRS_AT_ONCE)) + 1):
        candidate, chord = members(group_of, group[some])
        curve = of_group[candidate]
        from_, along = start[some], (end - start)[some]
        far = curves.start[curve] - from_[chord]
        apart = np.abs(far)
        nearest = np.minimum.reduceat(apart, np.cumsum(count[some]) - count[some])
        length = np.maximum(np.abs(along), ZERO)
        foot = np.clip((far * (along / length)[chord].conj()).real, 0, length[chord])
        aside = np.abs(far - foot * (along / length)[chord])
        is_close = apart - long[curve] <= nearest[chord] + ROUNDING
        is_close |= aside - long[curve] <= radius[group[some]][chord] + ROUNDING
        chosen[candidate[is_close]] = True
    return of_group[chosen], group_of[chosen]
