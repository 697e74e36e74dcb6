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

from polarcheck.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.overcuts.cuts import Cuts, cuts_into, with_facing_walls
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import ends_of, gathered, lines_of, polylines
from polarcheck.geometry.polygons.finished_part import Contours, FinishedParts, finished_parts
from polarcheck.geometry.segments import Curves, Segments, first_of_its_kind, members, segments
from polarcheck.geometry.tolerances import ZERO
from polarcheck.time_limit import keep_time

#: Depth [mm] up to which nothing is said; two roundings to the least increment.
TOLERANCE = 0.002
#: Moves of a loop, or pieces of them, from which on it is worth while to look for passes that are written once more.
_MANY = 2000
#: Straight pieces of a loop that are compared as one line, and pieces between two looks at the clock.
_LONG_RUN, _PIECES = 1024, 2048


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
) -> tuple[Cuts, Rows]:
    """
    Where the tool center comes nearer than R to the finished part of its loop; the worst place of each of its moves.
    And the loops whose walls cross too often to tell.

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
        return Cuts.none(), np.zeros(0, np.int64)
    loops, group = np.unique(ways.loop, return_inverse=True)
    smallest = np.full(len(loops), np.inf)
    np.minimum.at(smallest, group, radius[ways.move])
    part = finished_parts(Contours(contour, left, loops, np.arange(len(loops)), smallest, bar, tolerance))
    in_open = part.open[group] & is_ramp[ways.move]
    ramps = _Ramps.of(contour, air, path, ways[in_open].shifted((part.pitch * group)[in_open]), group[in_open])
    own_loop = Cuts.concatenated(
        [
            cuts_into(part, part.open, ways[~in_open], group[~in_open], smallest, tolerance, may_be_far=False),
            _cuts_in_the_open(part, ramps, smallest, tolerance),
        ]
    ).worst()
    loop, first = np.unique(contour.loop, return_index=True)
    of_cut = level[first][np.searchsorted(loop, loops[own_loop.group])]
    shared = np.bincount(level[first])[of_cut] > 1
    levels = _levels(contour, left, level, np.unique(of_cut[shared]), smallest.max(), bar, tolerance)
    decided, again = _left_at_level(levels, path, own_loop, np.where(shared, of_cut, -1), radius, tolerance)
    cuts = Cuts.concatenated([with_facing_walls(part, own_loop[decided]), with_facing_walls(levels, again)])
    return cuts.worst(), loops[part.tangled]


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
    levels: FinishedParts, path: Curves, cuts: Cuts, level: Rows, radius: Floats, tolerance: float
) -> tuple[Mask, Cuts]:
    """
    Cuts into the part of their own loop compared with the part of all loops of their level; level: -1 for none.

    Gives the cuts that stay as they are, a boolean each, and what remains of the others.
    """
    wanted, group = np.unique(level, return_inverse=True)
    group = group - np.count_nonzero(wanted < 0)
    compared = ~np.append(levels.tangled | shapely.is_empty(levels.polygon), True)[group]
    moves = cuts.move[compared]
    ways = segments(path[moves], tolerance)
    group = group[compared][ways.move]
    smallest = np.full(len(levels.polygon), np.inf)
    np.minimum.at(smallest, group, radius[moves[ways.move]])
    ways = Segments(ways.start, ways.end, moves[ways.move], ways.loop)
    again = cuts_into(levels, levels.open, ways, group, smallest, tolerance, may_be_far=False).worst()
    before = cuts.depth[np.searchsorted(cuts.move, again.move)]
    return ~compared, msgspec.structs.replace(again, depth=np.minimum(again.depth, before))


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
    contours = polylines(walls.start, walls.end, walls.loop)
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
        lines, of = polylines(path.start, path.end, run), number[np.diff(run, prepend=0) != 0]
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


def _cuts_in_the_open(part: FinishedParts, ramps: _Ramps, radius: Floats, tolerance: float) -> Cuts:
    """Where ramps cut walls of which one ends where they touch it."""
    ways, group, begins = ramps.ways, ramps.group, ramps.begins
    if not len(ways):
        return Cuts.none()
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
    cuts = [Cuts.none()]
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
        place, tool = ends_of(shapely.shortest_line(walls[cut], path[cut]))
        aside, unknown = (radius - depth)[cut], np.full(len(cut), -1)
        cuts.append(Cuts(cut, ways.move[cut], group[cut], unknown, depth[cut], aside, place, tool))
    return Cuts.concatenated(cuts)


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
