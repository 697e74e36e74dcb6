"""
The faces into which walls cut the plane, and the selection of the faces that are left standing.

A wall has a tool side and a back. A face stands if every wall round it turns its back to it. A wall with the same face
on both sides bounds nothing and is ignored: the end of a lead that another one crosses, or a wall that ends inside the
part.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, first_in_run, first_of_each, ranges
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.noding import Edges, merged, noded
from polarcheck.geometry.tolerances import ROUNDING

Geometries = NDArray[Any]
#: Points are rounded to this grid [mm] where areas are cut out of each other; without, GEOS may find no answer.
GRID = ROUNDING


class Walls(Table, frozen=True):
    """
    Straight walls, n of them, group after group, in the order in which they run.

    start, end: complex128[n] [mm].
    left, right: bool[n], the tool is on that side; neither for a line that only bounds faces.
    joins: bool[n], a line that bounds nothing and only connects its group.
    group: int[n], from 0, rising. Each group must be connected, and away from all others.
    """

    start: Points
    end: Points
    left: Mask
    right: Mask
    joins: Mask
    group: Rows


class Standing(msgspec.Struct, frozen=True):
    """
    The standing faces of each group.

    polygon: shapely geometry[groups] [mm], empty where no face stands.
    start, end: complex128[k] [mm], the edges of the polygons, with the polygon on the left.
    wall: int[k], the wall that each edge is part of.
    ring: int[k], the ring that each edge is part of; its edges follow one another.
    tangled: bool[groups], the walls cross too often.
    """

    polygon: Geometries
    start: Points
    end: Points
    wall: Rows
    ring: Rows
    tangled: Mask


def standing(walls: Walls, groups: int, thinnest: float) -> Standing:
    """The standing faces of each group; faces with a mean thickness below `thinnest` [mm] are left out."""
    keep_time()
    edges = noded(walls.start, walls.end, walls.group)
    keep_time()
    tangled = np.zeros(groups, bool)
    tangled[: len(edges.tangled)] = edges.tangled
    if not len(edges.wall):
        nowhere = np.zeros(0, complex)
        none = np.zeros(0, np.int64)
        return Standing(np.full(groups, shapely.Polygon(), object), nowhere, nowhere, none, none, tangled)
    edges, sides = _distinct(edges, walls)
    lines = _lines(edges, sides, walls)
    face = _faces(lines)
    stands = _stands(lines, face, thinnest)[face]
    bounds = stands[0] != stands[1]
    lines, inside = lines[bounds], stands[:, bounds].T.ravel()
    ring, line, forward = _rings(lines, inside)
    edge, forward, of = _along(lines, line, forward)
    start = edges.nodes[np.where(forward, edges.start[edge], edges.end[edge])]
    end = edges.nodes[np.where(forward, edges.end[edge], edges.start[edge])]
    polygon = _polygons(start, end, ring[of], lines.group[line[of]], groups)
    return Standing(polygon, start, end, edges.wall[edge], ring[of], tangled)


class _Sides(msgspec.Struct, frozen=True):
    """Masks of edges: the tool is left of the edge, right of it; the edge only connects its group."""

    left: Mask
    right: Mask
    joins: Mask


class _Lines(Table, frozen=True):
    """
    Edges in a row between branchings, from `first` on, `count` of them.

    start, end: their nodes. out, back: the directions in which they leave their start and, backwards, their end.
    area: the signed area between them and a point of their group [mm2]. length [mm]. The rest as for walls.
    """

    first: Rows
    count: Rows
    start: Rows
    end: Rows
    out: Points
    back: Points
    area: Floats
    length: Floats
    left: Mask
    right: Mask
    joins: Mask
    group: Rows


# ---- edges to lines ----


def _distinct(edges: Edges, walls: Walls) -> tuple[Edges, _Sides]:
    """Each distinct edge, with the tool sides of all its walls."""
    low, high = np.minimum(edges.start, edges.end), np.maximum(edges.start, edges.end)
    first, which = first_of_each(low * len(edges.nodes) + high)
    turned = edges.start > edges.end
    left, right = walls.left[edges.wall], walls.right[edges.wall]
    low_side = np.bincount(which, np.where(turned, right, left)) > 0
    high_side = np.bincount(which, np.where(turned, left, right)) > 0
    joins = np.bincount(which, ~walls.joins[edges.wall]) == 0
    order = np.argsort(first)
    first = first[order]
    low_side, high_side, joins, turned = low_side[order], high_side[order], joins[order], turned[first]
    sides = _Sides(np.where(turned, high_side, low_side), np.where(turned, low_side, high_side), joins)
    return msgspec.structs.replace(edges, start=edges.start[first], end=edges.end[first], wall=edges.wall[first]), sides


def _lines(edges: Edges, sides: _Sides, walls: Walls) -> _Lines:
    start, end = edges.start, edges.end
    degree = np.bincount(start, minlength=len(edges.nodes)) + np.bincount(end, minlength=len(edges.nodes))
    begins = first_in_run(sides.left, sides.right, sides.joins)
    begins[1:] |= (end[:-1] != start[1:]) | (degree[start[1:]] != 2)
    first = np.flatnonzero(begins)
    count = np.diff(np.append(first, len(start)))
    last = first + count - 1

    group = walls.group[edges.wall]
    origin = edges.nodes[start[np.searchsorted(group, np.arange(group[-1] + 1))]][group]
    a, b = edges.nodes[start] - origin, edges.nodes[end] - origin
    return _Lines(
        first,
        count,
        start[first],
        end[last],
        (b - a)[first],
        (a - b)[last],
        np.add.reduceat((a.conj() * b).imag / 2, first),
        np.add.reduceat(np.abs(b - a), first),
        sides.left[first],
        sides.right[first],
        sides.joins[first],
        group[first],
    )


# ---- lines to faces ----
# Half lines: 2 k is line k as it runs, 2 k + 1 the same backwards; the face of a half line is the one on its left.


def _next(lines: _Lines) -> Rows:
    """The next half line along the same face, for each half line."""
    origin = np.stack([lines.start, lines.end], axis=1).ravel()
    angle = np.angle(np.stack([lines.out, lines.back], axis=1).ravel())
    order = np.lexsort((angle, origin))
    position = np.empty(len(order), np.int64)
    position[order] = np.arange(len(order))
    first = np.searchsorted(origin[order], origin)
    last = np.searchsorted(origin[order], origin, side="right") - 1
    clockwise = order[np.where(position == first, last, position - 1)]
    return np.asarray(clockwise[np.arange(len(order)) ^ 1])


def _cycles(following: Rows) -> tuple[Rows, Rows]:
    """The least half line of the cycle of each half line, and the number of steps to it."""
    least, jump = np.arange(len(following)), following
    reach = 1
    while reach < len(following):
        least = np.minimum(least, least[jump])
        jump = jump[jump]
        reach *= 2
    # Steps to the least one, counted by doubling as well; from there on none.
    steps = (least != np.arange(len(following))).astype(np.int64)
    jump = np.where(steps > 0, following, np.arange(len(following)))
    reach = 1
    while reach < len(following):
        steps = steps + steps[jump]
        jump = jump[jump]
        reach *= 2
    return least, steps


def _faces(lines: _Lines) -> Rows:
    """The face to the left and to the right of each line: int[2, lines], from 0."""
    cycle, _ = _cycles(_next(lines))
    face = cycle.reshape(-1, 2).T
    joined = merged(len(cycle), *face[:, lines.joins])
    _, number = np.unique(joined[face], return_inverse=True)
    return number.reshape(face.shape)


def _stands(lines: _Lines, face: Rows, thinnest: float) -> Mask:
    """True for faces that stand."""
    count = int(face.max()) + 1
    bounds = face[0] != face[1]
    tool = np.zeros(count, bool)
    back = np.zeros(count, bool)
    for side, here, there in ((face[0], lines.left, lines.right), (face[1], lines.right, lines.left)):
        tool[side[bounds & here]] = True
        back[side[bounds & there & ~here]] = True
    area = np.bincount(face[0], lines.area, count) - np.bincount(face[1], lines.area, count)
    around = sum(np.bincount(side[bounds], lines.length[bounds], count) for side in face)
    return np.asarray(back & ~tool & (2 * area > thinnest * around))


# ---- faces to polygons ----


def _rings(lines: _Lines, inside: Mask) -> tuple[Rows, Rows, Mask]:
    """
    The rings that lines make round what stands, of which these half lines have it on the left.

    Per half line, in the order of the rings: its ring, its line, and whether it runs as that does.
    """
    cycle, steps = _cycles(_next(lines))
    chosen = np.flatnonzero(inside)
    order = chosen[np.lexsort((-steps[chosen], cycle[chosen]))]
    _, ring = np.unique(cycle[order], return_inverse=True)
    return ring, order // 2, order % 2 == 0


def _along(lines: _Lines, line: Rows, forward: Mask) -> tuple[Rows, Mask, Rows]:
    """The edges of these lines in order, a mask of those that keep their direction, and the line of each by index."""
    count = lines.count[line]
    of, index = ranges(count)
    index = np.where(forward[of], index, count[of] - 1 - index)
    return lines.first[line[of]] + index, forward[of], of


def _polygons(start: Points, end: Points, ring: Rows, group: Rows, groups: int) -> Geometries:
    """The polygon of each group: the counterclockwise rings less the clockwise ones."""
    result = np.full(groups, shapely.Polygon(), dtype=object)
    if not len(ring):
        return result
    first = np.searchsorted(ring, np.arange(ring[-1] + 1))
    origin = start[first][ring]
    area = np.bincount(ring, ((start - origin).conj() * (end - origin)).imag)
    solid = shapely.polygons(shapely.linearrings(coordinates(start), indices=ring))
    broken = ~shapely.is_valid(solid)
    solid[broken] = areas.make_valid(solid[broken])
    of, hole = group[first], area < 0
    result[of[~hole][::-1]] = solid[~hole][::-1]
    # A ring within another one bounds a hole, and a ring in that what stands in the hole.
    order = np.argsort(of, kind="stable")
    begins = np.append(np.flatnonzero(np.diff(of[order], prepend=-1)), len(of))
    for low, high in pairwise(begins.tolist()):
        if high - low > 1:
            whole = areas.build_area(shapely.geometrycollections(solid[order[low:high]]))
            result[of[order[low]]] = whole if shapely.is_valid(whole) else areas.make_valid(whole)
    return result


def coordinates(points: Points) -> Floats:
    """Plane points as coordinates for shapely: float64[..., 2]."""
    return np.ascontiguousarray(points).view(np.float64).reshape(*points.shape, 2)


def lines_of(start: Points, end: Points) -> Geometries:
    """Straight lines of shapely; a point for a line without a length, since GEOS finds nothing near such a line."""
    lines = np.asarray(shapely.linestrings(coordinates(np.stack([start, end], axis=-1))))
    still = start == end
    if still.any():
        lines[still] = shapely.points(coordinates(start[still]))
    return lines


def polylines(start: Points, end: Points, of: Rows) -> Geometries:
    """
    Straight pieces as one polyline for each number in `of`: int[n], rising; several lines
    where pieces do not join.
    """
    if not len(start):
        return np.zeros(0, dtype=object)
    joined = (end[:-1] == start[1:]) & (of[1:] == of[:-1])
    lines, last = lines_through(start, end, joined)
    _, number = np.unique(of[last], return_inverse=True)
    return np.asarray(shapely.multilinestrings(lines, indices=number))


def lines_through(start: Points, end: Points, joined: Mask) -> tuple[Geometries, Rows]:
    """
    A line through each run of straight pieces, and the last piece of each run.

    joined: bool[n - 1], the next piece goes on from where this one ends, in the same line.
    """
    last = np.flatnonzero(np.append(~joined, True))
    line = np.cumsum(np.append(0, ~joined))
    points, of = np.insert(start, last + 1, end[last]), np.insert(line, last + 1, line[last])
    return np.asarray(shapely.linestrings(coordinates(points), indices=of)), last


def gathered(lines: Geometries, group: Rows, count: int) -> Geometries:
    """The lines of each group as one geometry, empty for a group without lines. group: int[lines]."""
    result = np.full(count, shapely.MultiLineString(), dtype=object)
    has, number = np.unique(group, return_inverse=True)
    if len(has):
        result[has] = shapely.multilinestrings(lines, indices=number)
    return result


def edges_of(polygons: Geometries) -> tuple[Points, Points]:
    """Where the edges round these polygons and their holes begin and end, all together."""
    rings = shapely.get_rings(shapely.get_parts(polygons))
    points, ring = shapely.get_coordinates(rings, return_index=True)
    corner = points.view(np.complex128).ravel()
    inner = ring[1:] == ring[:-1]
    return corner[:-1][inner], corner[1:][inner]


def ends_of(lines: Geometries) -> tuple[Points, Points]:
    """Where these lines of two points begin and end."""
    points = shapely.get_coordinates(lines).view(np.complex128).reshape(-1, 2)
    return points[:, 0], points[:, 1]
