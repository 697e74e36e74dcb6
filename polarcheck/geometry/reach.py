"""
Ways of a tool against finished parts, each with those of a group: where it comes nearer than R, how deep, into which
wall.

Of a part whose outline is known along its walls only, and of one without an end, as what surrounds a pocket, the walls
alone count: nobody knows what is there else. Floats in mm, plane points complex, x + 1j*c. Import late.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Points, Rows, Table
from polarcheck.geometry.faces import Geometries, coordinates, edges_of, ends_of, gathered, lines_of
from polarcheck.geometry.finished_part import FinishedParts
from polarcheck.geometry.segments import Segments
from polarcheck.geometry.tolerances import CORNER, ZERO
from polarcheck.time_limit import keep_time

#: Ways worked on at a time, for the sake of memory.
_BATCH = 4096


class Reached(Table, frozen=True):
    """
    Pieces of way that cut, once for each wall that is cut at the place: k of them.

    way: int[k], number of the piece. move, group: int[k], its own. wall: int[k], the curve that is cut. depth:
    float64[k] [mm], R less the distance from the tool center to the part. aside: float64[k] [mm], how far the tool
    center stays from the outline. place: complex128[k] [mm], the point of the outline next to the tool center.
    """

    way: Rows
    move: Rows
    group: Rows
    wall: Rows
    depth: Floats
    aside: Floats
    place: Points

    def worst(self) -> Reached:
        """The deepest cut of each move."""
        order = np.lexsort((-self.depth, self.move))
        return self[order[np.diff(self.move[order], prepend=-1) != 0]]


_NOTHING = np.zeros(0, np.int64)
NOTHING = Reached(_NOTHING, _NOTHING, _NOTHING, _NOTHING, np.zeros(0), np.zeros(0), np.zeros(0, np.complex128))


def reached(part: FinishedParts, ways: Segments, group: Rows, radius: Floats, tolerance: float) -> Reached:
    """Where these ways come nearer than the R of their group [mm] to its part, by more than the tolerance."""
    whole, start, end = _outline(part)
    number, ways, group = _beside(whole, ways, group, radius, part.pitch)
    if not len(number) or not len(start):
        return NOTHING
    # Within R of a wall there is no doubt what is behind it, but at the ends of a contour in the open.
    solid = np.where(part.open, whole, part.polygon)
    shapely.prepare(whole)
    shapely.prepare(solid)
    tree = shapely.STRtree(lines_of(start, end))
    found = [NOTHING]
    for first in range(0, len(number), _BATCH):
        keep_time()
        rows = np.arange(first, min(first + _BATCH, len(number)))
        line = lines_of(ways.start[rows], ways.end[rows])
        near = shapely.dwithin(whole[group[rows]], line, radius[group[rows]] - tolerance)
        rows, line = rows[near], line[near]
        (_, edge), aside = tree.query_nearest(line, all_matches=False, return_distance=True)
        place = ends_of(shapely.shortest_line(tree.geometries[edge], line))[0]
        depth = radius[group[rows]] - np.where(shapely.intersects(solid[group[rows]], line), 0, aside)
        none = np.full(len(rows), -1)
        found.append(Reached(number[rows], ways.move[rows], group[rows], none, depth, aside, place))
    cuts = Reached.concatenated(found)
    return _with_walls(part, cuts)


def shortened(part: FinishedParts, radius: Floats) -> FinishedParts:
    """The parts without what lies within R of the ends of a contour in the open: there may be no part any more."""
    total = part.along[:, 0] + part.ahead[:, 0]
    long = part.along[:, 1] - part.along[:, 0]
    reach = np.where(part.open, radius, -np.inf)[part.group]
    with np.errstate(all="ignore"):  # an infinite length is meant
        one, other = ((limit - part.along[:, 0]) / long for limit in (reach, total - reach))
    low, high = np.clip(np.minimum(one, other), 0, 1), np.clip(np.maximum(one, other), 0, 1)
    way = part.end - part.start
    kept = (high - low) * np.abs(way) > ZERO
    kept &= reach < total - reach
    columns = {name: getattr(part, name)[kept] for name in ("move", "group", "along", "ahead")}
    return msgspec.structs.replace(
        part, start=(part.start + low * way)[kept], end=(part.start + high * way)[kept], **columns
    )


def endless(part: FinishedParts) -> Mask:
    """The parts that go on to the end of the plane."""
    right = part.pitch * (np.arange(len(part.polygon)) + 1 / 3)
    return np.asarray(shapely.bounds(part.polygon)[:, 2] > right - ZERO * part.pitch)


def _outline(part: FinishedParts) -> tuple[Geometries, Points, Points]:
    """What is not to be cut of each group, and the edges of it, all groups together."""
    by_walls = part.open | endless(part)
    whole = part.polygon.copy()
    of_wall = by_walls[part.group]
    start, end = part.start[of_wall], part.end[of_wall]
    whole[by_walls] = gathered(lines_of(start, end), part.group[of_wall], len(whole))[by_walls]
    begins, ends = edges_of(part.polygon[~by_walls])
    return whole, np.append(start, begins), np.append(end, ends)


def _beside(
    whole: Geometries, ways: Segments, group: Rows, radius: Floats, pitch: float
) -> tuple[Rows, Segments, Rows]:
    """
    Of ways what lies within R of the box round their part, at its place: which they were, they, and their groups.

    What goes on far from there could otherwise come near the part of another group.
    """
    bounds = shapely.bounds(whole)[group]
    shift = pitch * group
    way = ways.end - ways.start
    first, last = np.zeros(len(ways)), np.ones(len(ways))
    outside = np.isnan(bounds[:, 0])
    far = radius[group]
    for at, along, low, high in (
        (ways.start.real + shift, way.real, bounds[:, 0] - far, bounds[:, 2] + far),
        (ways.start.imag, way.imag, bounds[:, 1] - far, bounds[:, 3] + far),
    ):
        with np.errstate(all="ignore"):  # a way along the side never meets it
            one, other = (low - at) / along, (high - at) / along
        across = np.abs(along) > ZERO
        first = np.where(across, np.fmax(first, np.fmin(one, other)), first)
        last = np.where(across, np.fmin(last, np.fmax(one, other)), last)
        outside |= ~across & ((at < low) | (at > high))
    number = np.flatnonzero(~outside & (first <= last))
    begin = ways.start + shift
    cut = Segments(begin + way * first, begin + way * last, ways.move, ways.loop)
    return number, cut[number], group[number]


def _with_walls(part: FinishedParts, cuts: Reached) -> Reached:
    """The cuts with the walls that they go into; at a corner once for each."""
    if not len(cuts.way):
        return cuts
    tree = shapely.STRtree(lines_of(part.start, part.end))
    points = shapely.points(coordinates(cuts.place))
    (which, _), distance = tree.query_nearest(points, all_matches=False, return_distance=True)
    cut, wall = tree.query(points[which], predicate="dwithin", distance=distance + CORNER)
    kept = part.group[wall] == cuts.group[cut]
    cut, wall = cut[kept], wall[kept]
    place = cuts.place - part.pitch * cuts.group
    return msgspec.structs.replace(cuts[cut], wall=part.move[wall], place=place[cut])
