"""
The tool center path against the finished part: where the tool cuts what the contour keeps.

Floats in mm, plane points complex, x + 1j*c. Import late: shapely takes its time.

An overcut is R less the distance from the path of the tool center to the finished part; 0 inside it. Arcs become chords
with their ends on the arc and a sagitta of a quarter of the tolerance; part and path together shift a distance by half
the tolerance at most. Nothing is decided by areas.

Most loops are let off without a part: where the tool center stays at R from every wall, it does so from the part.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Points, Rows, Table
from polarcheck.geometry import areas
from polarcheck.geometry.faces import Geometries, coordinates, edges_of, ends_of, gathered, lines_of
from polarcheck.geometry.finished_part import Contours, FinishedParts, finished_parts
from polarcheck.geometry.segments import Curves, Segments, first_of_its_kind, members, segments
from polarcheck.geometry.tolerances import ZERO
from polarcheck.time_limit import keep_time

__all__ = ["TOLERANCE", "Curves", "Overcut", "overcuts"]

#: Depth [mm] up to which nothing is said; two roundings to the least increment.
TOLERANCE = 0.002
#: Moves of a loop, or pieces of them, from which on it is worth while to look for passes that are written once more.
_MANY = 2000
#: Straight pieces of path that are looked at as one first; and worked on at a time, for the sake of memory.
_RUN, _BATCH = 64, 4096
#: The same for whole loops: pieces of a run, and of all runs between two looks at the clock.
_LONG_RUN, _PIECES = 1024, 2048


class Overcut(msgspec.Struct, frozen=True):
    """
    Cuts into contours, k of them, and the loops that nothing can be said of.

    row: int64[k], programmed row that is cut into. move: int64[k], index of the move of the tool center.
    depth: float64[k] [mm]. place: complex128[k] [mm], the point of the part that is cut deepest.
    tangled: int64[j], loops whose walls cross again and again.
    """

    row: Rows
    move: Rows
    depth: Floats
    place: Points
    tangled: Rows


def overcuts(
    contour: Curves,
    left: Mask,
    air: Floats,
    level: Rows,
    path: Curves,
    radius: Floats,
    is_ramp: Mask,
    tolerance: float = TOLERANCE,
    bar: float = np.nan,
) -> Overcut:
    """
    Where the tool center comes nearer than R to the finished part of its loop; the worst place of each of its moves.

    contour: the programmed blocks in offset mode. left: bool[moves of contour], the tool runs left of the block: G41
    with R above 0, G42 with R below. air: float64[moves of contour] [mm], radius about the center of C from which on
    there is nothing to cut for all that is known. level: int[moves of contour], the same for loops of which each takes
    away what another one leaves standing. path: the tool center's moves in offset mode, corners included, and start-ups
    and offset cancels, which is_ramp says; each with the row of its block. radius: float64[moves of path] [mm], |R|,
    the smallest of a loop is taken. bar: its diameter [mm], NaN if not known. What is unknown is left out.

    A ramp touches the contour at one end and comes there at a slant, whereby it nicks the corner of a contour that ends
    in the open, where nobody knows what the part is like. There, within R of that end along the contour, only what lies
    behind the contour counts, and only where that cuts more than the slant makes unavoidable. Of a part round the
    center a ramp from the air cuts nothing out there.
    """
    rows = np.flatnonzero(is_ramp | first_of_its_kind(path)) if _is_long(path) else np.arange(len(path))
    ways = segments(path[rows], tolerance)
    walls = _once(contour, tolerance)
    ways = Segments(ways.start, ways.end, rows[ways.move], ways.loop)
    ways = ways[(radius[ways.move] > tolerance) & np.isin(ways.loop, walls.loop)]
    repeats = ~first_of_its_kind(path)[ways.move] if _is_long(ways) else np.zeros(len(ways), bool)
    ways = ways[_comes_close(walls, ways, repeats, is_ramp[ways.move], radius[ways.move] - tolerance)]
    if not len(ways):
        none = np.zeros(0, dtype=np.int64)
        return Overcut(none, none, np.zeros(0), np.zeros(0, dtype=np.complex128), none)
    loops, group = np.unique(ways.loop, return_inverse=True)
    smallest = np.full(len(loops), np.inf)
    np.minimum.at(smallest, group, radius[ways.move])
    part = finished_parts(Contours(contour, left, loops, np.arange(len(loops)), smallest, bar, tolerance))
    ways = ways.shifted(part.pitch * group)
    in_open = part.open[group] & is_ramp[ways.move]
    ramps = _Ramps.of(contour, air, path, ways[in_open], group[in_open])
    cuts = _worst(
        _Cuts.concatenated(
            [
                _cuts(part, ways[~in_open], group[~in_open], smallest, tolerance),
                _cuts_in_the_open(part, ramps, smallest, tolerance),
            ]
        )
    )
    loop, first = np.unique(contour.loop, return_index=True)
    own = level[first][np.searchsorted(loop, loops[cuts.group])]
    shared = np.bincount(level[first])[own] > 1
    levels = _levels(contour, left, level, np.unique(own[shared]), smallest.max(), bar, tolerance)
    kept, again = _left_at_level(levels, path, cuts, np.where(shared, own, -1), radius, tolerance)
    return _overcut(contour, loops[part.tangled], (part, cuts[kept]), (levels, again))


def _levels(
    contour: Curves, left: Mask, level: Rows, wanted: Rows, radius: float, bar: float, tolerance: float
) -> FinishedParts:
    """What all loops of each of these levels together leave standing."""
    loop, first = np.unique(contour.loop, return_index=True)
    chosen = np.flatnonzero(np.isin(level[first], wanted))
    chosen = chosen[np.argsort(level[first][chosen], kind="stable")]
    group = np.searchsorted(wanted, level[first][chosen])
    return finished_parts(Contours(contour, left, loop[chosen], group, np.full(len(wanted), radius), bar, tolerance))


def _left_at_level(
    levels: FinishedParts, path: Curves, cuts: _Cuts, level: Rows, radius: Floats, tolerance: float
) -> tuple[Mask, _Cuts]:
    """
    Cuts into what their loop alone leaves standing, those of a level, -1 for none, compared with all that stands there.

    Which of them stay as they are, and the others with what is left of them.
    """
    wanted, group = np.unique(level, return_inverse=True)
    group = group - np.count_nonzero(wanted < 0)
    told = ~np.append(levels.tangled | shapely.is_empty(levels.polygon), True)[group]
    moves = cuts.move[told]
    ways = segments(path[moves], tolerance)
    group = group[told][ways.move]
    smallest = np.full(len(levels.polygon), np.inf)
    np.minimum.at(smallest, group, radius[moves[ways.move]])
    ways = Segments(ways.start, ways.end, moves[ways.move], ways.loop).shifted(levels.pitch * group)
    again = _worst(_cuts(levels, ways, group, smallest, tolerance))
    before = cuts.depth[np.searchsorted(cuts.move, again.move)]
    return ~told, msgspec.structs.replace(again, depth=np.minimum(again.depth, before))


def _overcut(contour: Curves, tangled: Rows, *found: tuple[FinishedParts, _Cuts]) -> Overcut:
    """Cuts into parts with the wall that each goes into."""
    some = [(part, cuts) for part, cuts in found if len(cuts.move)]
    if not some:
        return Overcut(_NO_CUTS.move, _NO_CUTS.move, _NO_CUTS.depth, _NO_CUTS.place, tangled)
    row = np.concatenate([contour.row[part.move[_wall(part, cuts)]] for part, cuts in some])
    place = np.concatenate([cuts.place - part.pitch * cuts.group for part, cuts in some])
    cuts = _Cuts.concatenated([cuts for _, cuts in some])
    order = np.argsort(cuts.move)
    return Overcut(row[order].astype(np.int64), cuts.move[order], cuts.depth[order], place[order], tangled)


def _wall(part: FinishedParts, cuts: _Cuts) -> Rows:
    """The nearest wall at each place; at a corner the one that faces the tool."""
    tree = shapely.STRtree(lines_of(part.start, part.end))
    which, wall = tree.query_nearest(shapely.points(coordinates(cuts.place)), all_matches=True)
    way = part.end[wall] - part.start[wall]
    facing = ((cuts.tool - cuts.place)[which] * (-1j * way).conj()).real / np.maximum(np.abs(way), ZERO)
    order = np.lexsort((part.move[wall], -np.round(facing, 6), which))
    return np.asarray(wall[order[np.diff(which[order], prepend=-1) != 0]])


# ---- which loops to look at ----


def _is_long(curves: Curves | Segments) -> bool:
    """Whether a loop is so long that it may well hold passes that are written once more."""
    return len(curves) >= _MANY and bool(np.bincount(curves.loop - curves.loop.min()).max() >= _MANY)


def _once(curves: Curves, tolerance: float) -> Segments:
    """The straight parts of curves, without what a long loop holds once more; their moves are not to be asked for."""
    if _is_long(curves):
        return segments(curves[first_of_its_kind(curves)], tolerance)
    parts = segments(curves, tolerance)
    return parts[first_of_its_kind(curves)[parts.move]] if _is_long(parts) else parts


def _comes_close(walls: Segments, ways: Segments, again: Mask, is_ramp: Mask, limit: Floats) -> Mask:
    """
    Which ways are ramps that come nearer than the limit to a wall of their loop, or of a path that does.

    again: those that are written once more, which need no second look.
    """
    contours = _polylines(walls)
    shapely.prepare(contours)
    loops = np.unique(walls.loop)
    result = np.zeros(len(ways), bool)
    ramps, path = np.flatnonzero(is_ramp), ways[~is_ramp]
    lines = lines_of(ways.start[ramps], ways.end[ramps])
    result[ramps] = shapely.dwithin(contours[np.searchsorted(loops, ways.loop[ramps])], lines, limit[ramps])
    own, first, number = np.unique(path.loop, return_index=True, return_inverse=True)
    if len(own):
        smallest = np.minimum.reduceat(limit[~is_ramp], first)
        near, of_way = np.zeros(len(own), bool), number
        path, number = path[~again[~is_ramp]], number[~again[~is_ramp]]
        run = np.cumsum((np.diff(number, prepend=-1) != 0) | (np.arange(len(number)) % _LONG_RUN == 0))
        lines, of = _polylines(msgspec.structs.replace(path, loop=run)), number[np.diff(run, prepend=0) != 0]
        # Of a loop that comes close at one place no other one is asked; a long one takes long where it does not.
        share = np.cumsum(shapely.get_num_coordinates(lines)) // _PIECES
        for part in np.split(np.arange(len(of)), np.flatnonzero(np.diff(share)) + 1):
            keep_time()
            asked = part[~near[of[part]]]
            which = of[asked]
            close = shapely.dwithin(contours[np.searchsorted(loops, own[which])], lines[asked], smallest[which])
            near[which[close]] = True
        result[~is_ramp] = near[of_way]
    return result


# ---- segments to lines ----


def _polylines(parts: Segments) -> Geometries:
    """One line for each loop; where segments do not join, several."""
    start, end = parts.start, parts.end
    if not len(start):
        return np.zeros(0, dtype=object)
    goes_on = (end[:-1] == start[1:]) & (parts.loop[1:] == parts.loop[:-1])
    ends = np.flatnonzero(np.append(~goes_on, True))
    line = np.cumsum(np.append(0, ~goes_on))
    points, of = np.insert(start, ends + 1, end[ends]), np.insert(line, ends + 1, line[ends])
    lines = shapely.linestrings(coordinates(points), indices=of)
    _, number = np.unique(parts.loop[ends], return_inverse=True)
    return np.asarray(shapely.multilinestrings(lines, indices=number))


# ---- cuts ----


class _Cuts(Table, frozen=True):
    """
    Pieces of way that cut, on the shifted parts: the move that each is of, its group, the depth, the place on the part
    and the tool center then.
    """

    move: Rows
    group: Rows
    depth: Floats
    place: Points
    tool: Points


def _worst(cuts: _Cuts) -> _Cuts:
    """The deepest cut of each move."""
    order = np.lexsort((-cuts.depth, cuts.move))
    return cuts[order[np.diff(cuts.move[order], prepend=-1) != 0]]


class _Outline(msgspec.Struct, frozen=True):
    """
    What is not to be cut. whole: shapely geometry[groups], prepared; of a part that is open its walls alone.

    start, end: its edges, all groups together.
    """

    whole: Geometries
    start: Points
    end: Points


def _outline(part: FinishedParts, asked: Mask) -> _Outline:
    """Of the groups asked for."""
    whole = part.polygon.copy()
    whole[~asked] = None
    by_walls = part.open & asked
    of_wall = by_walls[part.group]
    start, end = part.start[of_wall], part.end[of_wall]
    whole[by_walls] = gathered(lines_of(start, end), part.group[of_wall], len(whole))[by_walls]
    shapely.prepare(whole)
    begins, ends = edges_of(part.polygon[~part.open & asked])
    return _Outline(whole, np.append(start, begins), np.append(end, ends))


def _cuts(part: FinishedParts, ways: Segments, group: Rows, radius: Floats, tolerance: float) -> _Cuts:
    """Where these ways come nearer than R to the part of their group."""
    if not len(ways):
        return _NO_CUTS
    outline = _outline(part, np.isin(np.arange(len(radius)), group))
    # First of all the runs of ways that do; the ways in them are what is left of most.
    run = np.cumsum((np.diff(group, prepend=-1) != 0) | (np.arange(len(group)) % _RUN == 0))
    runs = _polylines(Segments(ways.start, ways.end, ways.move, run))
    of_run = group[np.diff(run, prepend=0) != 0]
    near = areas.dwithin(outline.whole[of_run], runs, radius[of_run] - tolerance)[run - 1]
    ways, group = ways[near], group[near]
    tree = shapely.STRtree(lines_of(outline.start, outline.end))
    found = [_NO_CUTS]
    for first in range(0, len(ways) if len(tree) else 0, _BATCH):
        keep_time()
        rows = np.arange(first, min(first + _BATCH, len(ways)))
        lines = lines_of(ways.start[rows], ways.end[rows])
        limit = radius[group[rows]] - tolerance
        near = shapely.dwithin(outline.whole[group[rows]], lines, limit)
        rows, lines = rows[near], lines[near]
        (line, edge), distance = tree.query_nearest(lines, all_matches=False, return_distance=True)
        place, tool = ends_of(shapely.shortest_line(tree.geometries[edge], lines[line]))
        distance[shapely.intersects(outline.whole[group[rows]], lines)] = 0
        found.append(_Cuts(ways.move[rows], group[rows], radius[group[rows]] - distance, place, tool))
    return _Cuts.concatenated(found)


_NOWHERE = np.zeros(0, np.complex128)
_NO_CUTS = _Cuts(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0), _NOWHERE, _NOWHERE)


# ---- ramps of contours that end in the open ----


class _Ramps(msgspec.Struct, frozen=True):
    """
    Straight ramps and their groups.

    begins: start-ups. air: radius about the center of C [mm] from which on there is nothing but air. in_air: those
    whose far end is that far out.
    """

    ways: Segments
    group: Rows
    begins: Mask
    air: Floats
    in_air: Mask

    @classmethod
    def of(cls, contour: Curves, air: Floats, path: Curves, ways: Segments, group: Rows) -> _Ramps:
        """Of shifted ways."""
        order = np.argsort(contour.loop, kind="stable")
        first = order[np.searchsorted(contour.loop[order], ways.loop)]
        begins = path.row[ways.move] < contour.row[first]
        far = np.abs(np.where(begins, path.start[ways.move], path.end[ways.move]))
        return cls(ways, group, begins, air[first], far >= air[first])


def _cuts_in_the_open(part: FinishedParts, ramps: _Ramps, radius: Floats, tolerance: float) -> _Cuts:
    """Where ramps cut walls of which one ends where they touch it."""
    ways, group, begins = ramps.ways, ramps.group, ramps.begins
    if not len(ways):
        return _NO_CUTS
    radius = radius[group]
    in_air = ramps.in_air & _is_round_center(part)[group]
    lines = lines_of(ways.start, ways.end)
    behind = areas.intersection(lines, part.polygon[group])
    center = shapely.points(part.pitch * group[in_air], 0.0)
    within = areas.buffer(center, ramps.air[in_air], quad_segs=64)
    behind[in_air] = areas.intersection(behind[in_air], within)
    wall, way = members(part.group, group)
    near = _within_reach(part, wall, ways, way, radius)
    wall, way = wall[near], way[near]
    length = np.where(begins[way][:, None], part.along[wall], part.ahead[wall])
    found = [_NO_CUTS]
    for low, high, path, allowed in (
        (np.zeros(len(ways)), radius, behind, _slant(ways.end - ways.start, radius)),
        (radius, np.full(len(ways), np.inf), lines, 0.0),
    ):
        start, end, chosen = _between(part, wall, length, low[way], high[way])
        walls = gathered(lines_of(start, end), way[chosen], len(ways))
        if path is lines:
            walls[in_air] = areas.intersection(walls[in_air], within)
        depth = radius - shapely.distance(walls, path)
        cut = np.flatnonzero(depth > tolerance + allowed)  # NaN without walls, or with nothing behind them
        found.append(
            _Cuts(ways.move[cut], group[cut], depth[cut], *ends_of(shapely.shortest_line(walls[cut], path[cut])))
        )
    return _Cuts.concatenated(found)


def _within_reach(part: FinishedParts, wall: Rows, ways: Segments, way: Rows, reach: Floats) -> Mask:
    """Which of these walls could be within reach of the ways given with them, judged from their boxes."""
    result = np.ones(len(wall), bool)
    for a, b, c, d in (
        (part.start.real, part.end.real, ways.start.real, ways.end.real),
        (part.start.imag, part.end.imag, ways.start.imag, ways.end.imag),
    ):
        low, high = np.minimum(c, d) - reach, np.maximum(c, d) + reach
        result &= (np.minimum(a, b)[wall] <= high[way]) & (low[way] <= np.maximum(a, b)[wall])
    return result


def _is_round_center(part: FinishedParts) -> Mask:
    """Whether the center of C is in the part."""
    center = shapely.points(part.pitch * np.arange(len(part.polygon)), 0.0)
    return np.asarray(shapely.intersects(part.polygon, center))


def _between(part: FinishedParts, wall: Rows, length: Floats, low: Floats, high: Floats) -> tuple[Points, Points, Rows]:
    """Of walls, given how far along they start and end, what lies between two lengths [mm]; and which have any."""
    start, way = part.start[wall], part.end[wall] - part.start[wall]
    long = length[:, 1] - length[:, 0]
    with np.errstate(all="ignore"):  # an infinite length is meant
        shares = [np.clip((limit - length[:, 0]) / long, 0, 1) for limit in (low, high)]
    chosen = np.flatnonzero(np.abs(shares[1] - shares[0]) * np.abs(way) > ZERO)
    from_, to = (start[chosen] + way[chosen] * share[chosen] for share in shares)
    return from_, to, chosen


def _slant(way: Points, radius: Floats) -> Floats:
    """How deep a ramp nicks the point that it leads to if it ends perpendicular to its own programmed direction."""
    far = np.maximum(np.abs(way), ZERO)
    return np.asarray(radius * (1 - np.sqrt(np.maximum(far**2 - radius**2, 0)) / far))
