"""
The search for cuts: where straight pieces of a tool center path come nearer than R to finished parts, and how deep.

Each piece is compared with the part of its group. The caller marks the parts whose walls alone count, since the rest of
their outline is unknown, and selects the cuts that it reports. Floats in mm, plane points complex, x + 1j*c. Import
late: shapely takes its time.
"""

from __future__ import annotations

from typing import Self

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, first_in_run
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import Geometries, coordinates, edges_of, ends_of, gathered, lines_of, polylines
from polarcheck.geometry.polygons.finished_part import FinishedParts
from polarcheck.geometry.segments import Segments
from polarcheck.geometry.tolerances import CORNER, ZERO

#: Pieces of path that are first compared as one polyline; pieces processed at a time, to limit memory.
_RUN, _BATCH = 64, 4096


class Cuts(Table, frozen=True):
    """
    Pieces of a tool center path that cut into the part of their group, n of them.

    piece: int[n], number of the piece among those that were searched.
    move: int[n], the move of the tool center that the piece is of.
    group: int[n], the group of the piece.
    wall: int[n], the programmed curve that is cut; -1 before `with_walls`.
    depth: float64[n] [mm], R less the distance from the tool center to the part.
    aside: float64[n] [mm], distance from the tool center to the outline of the part.
    place: complex128[n] [mm], the point of the outline nearest to the tool center.
    tool: complex128[n] [mm], the tool center there.

    Before `with_walls`, place and tool lie where the part of the group lies, beside the parts of the other groups.
    """

    piece: Rows
    move: Rows
    group: Rows
    wall: Rows
    depth: Floats
    aside: Floats
    place: Points
    tool: Points

    @classmethod
    def none(cls) -> Self:
        """No cuts."""
        row, length, point = np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.complex128)
        return cls(row, row, row, row, length, length, point, point)

    def worst(self) -> Self:
        """The deepest cut of each move; of equal ones the first."""
        order = np.lexsort((-self.depth, self.move))
        return self[order[first_in_run(self.move[order])]]


def cuts_into(
    part: FinishedParts,
    by_walls: Mask,
    pieces: Segments,
    group: Rows,
    radius: Floats,
    tolerance: float,
    may_be_far: bool = True,
) -> Cuts:
    """
    Pieces of path that come nearer than the R of their group [mm] to its part, by more than the tolerance [mm].

    by_walls: bool[groups], only the walls of the part count. pieces: on the plane itself, not shifted to their groups.
    radius: float64[groups] [mm]. may_be_far: a piece may run to where the part of another group lies, as it goes on far
    from its own part.
    """
    searched = np.isin(np.arange(len(radius)), group)
    whole, start, end = _outline(part, by_walls, searched)
    if may_be_far:
        number, pieces, group = _clipped(whole, pieces, group, radius, part.pitch)
    else:
        number, pieces = np.arange(len(pieces)), pieces.shifted(part.pitch * group)
    if not len(number) or not len(start):
        return Cuts.none()
    # Within R of a wall its back is certain to be solid, except at the ends of a contour in the open.
    solid = whole.copy()
    solid[searched & ~part.open] = part.polygon[searched & ~part.open]
    shapely.prepare(whole)
    shapely.prepare(solid)
    near = _run_is_near(whole, pieces, group, radius - tolerance)
    number, pieces, group = number[near], pieces[near], group[near]
    tree = shapely.STRtree(lines_of(start, end))
    cuts = [Cuts.none()]
    for first in range(0, len(number), _BATCH):
        keep_time()
        rows = np.arange(first, min(first + _BATCH, len(number)))
        line = lines_of(pieces.start[rows], pieces.end[rows])
        near = shapely.dwithin(whole[group[rows]], line, radius[group[rows]] - tolerance)
        rows, line = rows[near], line[near]
        (_, edge), aside = tree.query_nearest(line, all_matches=False, return_distance=True)
        nearest, tool = ends_of(shapely.shortest_line(tree.geometries[edge], line))
        depth = radius[group[rows]] - np.where(shapely.intersects(solid[group[rows]], line), 0, aside)
        wall = np.full(len(rows), -1)
        cuts.append(Cuts(number[rows], pieces.move[rows], group[rows], wall, depth, aside, nearest, tool))
    return Cuts.concatenated(cuts)


def assign_walls(part: FinishedParts, cuts: Cuts) -> Cuts:
    """
    The cuts with the walls that they go into, at a corner once for each wall.

    Their places are on the plane itself, not shifted to their groups.
    """
    return _into(part, cuts, *_nearest_walls(part, cuts))


def assign_facing_walls(part: FinishedParts, cuts: Cuts) -> Cuts:
    """The cuts with the wall that each goes into, at a corner the wall that faces the tool; places as `with_walls`."""
    cut, wall = _nearest_walls(part, cuts)
    along = part.end[wall] - part.start[wall]
    facing = ((cuts.tool - cuts.place)[cut] * (-1j * along).conj()).real / np.maximum(np.abs(along), ZERO)
    order = np.lexsort((part.move[wall], -np.round(facing, 6), cut))
    first = order[first_in_run(cut[order])]
    return _into(part, cuts, cut[first], wall[first])


def _into(part: FinishedParts, cuts: Cuts, cut: Rows, wall: Rows) -> Cuts:
    """These cuts into these walls."""
    shift = part.pitch * cuts.group[cut]
    return msgspec.structs.replace(
        cuts[cut], wall=part.move[wall], place=cuts.place[cut] - shift, tool=cuts.tool[cut] - shift
    )


def _nearest_walls(part: FinishedParts, cuts: Cuts) -> tuple[Rows, Rows]:
    """Each cut with each wall of its group next to its place, the numbers of both."""
    if not len(cuts):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    tree = shapely.STRtree(lines_of(part.start, part.end))
    points = shapely.points(coordinates(cuts.place))
    (which, _), distance = tree.query_nearest(points, all_matches=False, return_distance=True)
    cut, wall = tree.query(points[which], predicate="dwithin", distance=distance + CORNER)
    same_group = part.group[wall] == cuts.group[cut]
    return cut[same_group], wall[same_group]


def shortened(part: FinishedParts, radius: Floats) -> FinishedParts:
    """The parts without the walls within R of the ends of a contour in the open: beyond there may be no part."""
    total = part.along[:, 0] + part.ahead[:, 0]
    long = part.along[:, 1] - part.along[:, 0]
    reach = np.where(part.open, radius, -np.inf)[part.group]
    with np.errstate(all="ignore"):  # infinite lengths are intended
        first, second = ((limit - part.along[:, 0]) / long for limit in (reach, total - reach))
    low, high = np.clip(np.minimum(first, second), 0, 1), np.clip(np.maximum(first, second), 0, 1)
    vector = part.end - part.start
    remains = (high - low) * np.abs(vector) > ZERO
    remains &= reach < total - reach
    columns = {name: getattr(part, name)[remains] for name in ("move", "group", "along", "ahead")}
    return msgspec.structs.replace(
        part, start=(part.start + low * vector)[remains], end=(part.start + high * vector)[remains], **columns
    )


def endless(part: FinishedParts) -> Mask:
    """The parts that go on to the end of the plane, such as what surrounds a pocket."""
    right = part.pitch * (np.arange(len(part.polygon)) + 1 / 3)
    return np.asarray(shapely.bounds(part.polygon)[:, 2] > right - ZERO * part.pitch)


def _outline(part: FinishedParts, by_walls: Mask, searched: Mask) -> tuple[Geometries, Points, Points]:
    """The part or its walls of each group that is searched, None for the others; start and end of all their edges."""
    whole = part.polygon.copy()
    whole[~searched] = None
    by_walls = by_walls & searched
    of_wall = by_walls[part.group]
    start, end = part.start[of_wall], part.end[of_wall]
    whole[by_walls] = gathered(lines_of(start, end), part.group[of_wall], len(whole))[by_walls]
    begins, ends = edges_of(part.polygon[~by_walls & searched])
    return whole, np.append(start, begins), np.append(end, ends)


def _clipped(
    whole: Geometries, pieces: Segments, group: Rows, radius: Floats, pitch: float
) -> tuple[Rows, Segments, Rows]:
    """
    Pieces cut off at R from the box round the part of their group, and shifted to it: numbers, pieces and groups.

    A piece that goes on far from there could otherwise come near the part of another group.
    """
    bounds = shapely.bounds(whole)[group]
    shift = pitch * group
    vector = pieces.end - pieces.start
    first, last = np.zeros(len(pieces)), np.ones(len(pieces))
    outside = np.isnan(bounds[:, 0])
    far = radius[group]
    for coordinate, along, low, high in (
        (pieces.start.real + shift, vector.real, bounds[:, 0] - far, bounds[:, 2] + far),
        (pieces.start.imag, vector.imag, bounds[:, 1] - far, bounds[:, 3] + far),
    ):
        with np.errstate(all="ignore"):  # a way along the side never meets it
            to_low, to_high = (low - coordinate) / along, (high - coordinate) / along
        across = np.abs(along) > ZERO
        first = np.where(across, np.fmax(first, np.fmin(to_low, to_high)), first)
        last = np.where(across, np.fmin(last, np.fmax(to_low, to_high)), last)
        outside |= ~across & ((coordinate < low) | (coordinate > high))
    number = np.flatnonzero(~outside & (first <= last))
    begin = pieces.start + shift
    cut = Segments(begin + vector * first, begin + vector * last, pieces.move, pieces.loop)
    return number, cut[number], group[number]


def _run_is_near(whole: Geometries, pieces: Segments, group: Rows, limit: Floats) -> Mask:
    """True for pieces of a run that comes within the limit [mm] of its part; most runs of a sound program do not."""
    run = np.cumsum(first_in_run(group) | (np.arange(len(group)) % _RUN == 0)) - 1
    of_run = group[first_in_run(run)]
    lines = polylines(pieces.start, pieces.end, run)
    # GEOS finds nothing near a line of no length.
    return np.asarray(areas.dwithin(whole[of_run], lines, limit[of_run])[run] | (pieces.start == pieces.end))
