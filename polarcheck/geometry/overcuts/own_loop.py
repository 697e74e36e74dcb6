"""
Overcuts of a loop into its finished part: where the tool cuts material that the contour should leave.

Floats in mm, plane points complex, x + 1j*c. Import late: shapely takes its time.

The depth of an overcut is R less the distance from the tool center path to the finished part. Inside the part that
distance is 0. Arcs become chords with their ends on the arc and a sagitta of a quarter of the tolerance. The chords of
part and path together change a distance by half the tolerance at most. No decision depends on areas.

Most loops need no part polygon: a tool center that stays at R from every wall also stays at R from the part.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, different, first_in_run, folded
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.overcuts.cuts import Cuts, assign_facing_walls, cuts_into
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import ends_of, gathered, lines_of, polylines
from polarcheck.geometry.polygons.finished_part import Contours, FinishedParts, PartsOfLoops, finished_parts
from polarcheck.geometry.segments import Curves, Segments, first_of_its_kind, members, segments
from polarcheck.geometry.tolerances import ZERO

#: Overcuts up to this depth [mm] are not reported: two roundings to the least increment.
TOLERANCE = 0.002
#: From this number of moves, or chords of them, a loop is searched for repeated passes.
_MANY = 2000
#: Moves of the path that are looked at together, but for the last loop of them.
_AT_ONCE = 20_000
#: Chords of a loop that are compared as one line, those of them that are compared first; points of lines between two
#: checks of the time limit.
_LONG_RUN, _SAMPLE, _PIECES = 1024, 8, 2048


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
) -> tuple[Cuts, Rows, PartsOfLoops | None]:
    """
    The deepest overcut of each move into the finished part of its loop, and the loops whose walls cross too often.

    Further: the parts of the loops that were searched; None if there are none.

    contour: the programmed blocks in offset mode.
    left: bool[moves of contour], the tool runs left of the block: G41 with R above 0, G42 with R below.
    air: float64[moves of contour] [mm], radius about the center of C beyond which no material is known.
    level: int[moves of contour], the same number for loops that remove what another one of them leaves.
    path: the tool center's moves in offset mode with corners, start-ups and offset cancels, each with its block's row.
    radius: float64[moves of path] [mm], |R|; the smallest value of a loop applies.
    is_ramp: bool[moves of path], start-ups and offset cancels.
    tolerance: depth [mm] up to which a cut is not reported.
    bar: its diameter [mm], NaN if unknown. Unknown moves are left out.

    A ramp reaches one end of the contour at a slant. If the contour is open there, the ramp nicks its corner, and the
    part beyond that end is unknown. Within R of that end along the contour, a ramp therefore cuts only what lies behind
    the contour, and only cuts deeper than the slant itself count. A ramp that comes from the air does not cut a part
    round the center beyond the air radius.
    """
    chords = _close_chords(contour, path, radius, is_ramp, tolerance)
    if not len(chords):
        return Cuts.none(), np.zeros(0, np.int64), None
    loops, group = np.unique(chords.loop, return_inverse=True)
    smallest = folded(np.minimum, group, radius[chords.move], len(loops), np.inf)
    part = finished_parts(Contours(contour, left, loops, np.arange(len(loops)), smallest, bar, tolerance))
    in_open = part.open[group] & is_ramp[chords.move]
    ramps = _Ramps.of(contour, air, path, chords[in_open].shifted((part.pitch * group)[in_open]), group[in_open])
    own_loop = Cuts.concatenated(
        [
            cuts_into(part, part.open, chords[~in_open], group[~in_open], smallest, tolerance, may_be_far=False),
            _cuts_in_the_open(part, ramps, smallest, tolerance),
        ]
    ).worst()
    loop, first = np.unique(contour.loop, return_index=True)
    level_of_cut = level[first][np.searchsorted(loop, loops[own_loop.group])]
    shared = np.bincount(level[first])[level_of_cut] > 1
    levels = _levels(contour, left, level, different(level_of_cut[shared]), smallest.max(), bar, tolerance)
    unshared, compared_with_level = _left_at_level(
        levels, path, own_loop, np.where(shared, level_of_cut, -1), radius, tolerance
    )
    cuts = Cuts.concatenated(
        [assign_facing_walls(part, own_loop[unshared]), assign_facing_walls(levels, compared_with_level)]
    )
    return cuts.worst(), loops[part.tangled], PartsOfLoops(loops, part)


def _levels(
    contour: Curves, left: Mask, level: Rows, requested: Rows, radius: float, bar: float, tolerance: float
) -> FinishedParts:
    """The finished part of each of these levels, bounded by all its loops."""
    loop, first = np.unique(contour.loop, return_index=True)
    chosen = np.flatnonzero(np.isin(level[first], requested))
    chosen = chosen[np.argsort(level[first][chosen], kind="stable")]
    group = np.searchsorted(requested, level[first][chosen])
    return finished_parts(Contours(contour, left, loop[chosen], group, np.full(len(requested), radius), bar, tolerance))


def _left_at_level(
    levels: FinishedParts, path: Curves, cuts: Cuts, level: Rows, radius: Floats, tolerance: float
) -> tuple[Mask, Cuts]:
    """
    Compares cuts into the part of one loop with the part of their whole level.

    level: int[cuts], -1 for none.
    Returns a mask of the cuts that need no comparison, and the cuts that remain of the others.
    """
    numbers, group = np.unique(level, return_inverse=True)
    group = group - np.count_nonzero(numbers < 0)
    compared = ~np.append(levels.tangled | shapely.is_empty(levels.polygon), True)[group]
    moves = cuts.move[compared]
    chords = segments(path[moves], tolerance)
    group = group[compared][chords.move]
    smallest = folded(np.minimum, group, radius[moves[chords.move]], len(levels.polygon), np.inf)
    chords = Segments(chords.start, chords.end, moves[chords.move], chords.loop)
    remaining = cuts_into(levels, levels.open, chords, group, smallest, tolerance, may_be_far=False).worst()
    before = cuts.depth[np.searchsorted(cuts.move, remaining.move)]
    return ~compared, msgspec.structs.replace(remaining, depth=np.minimum(remaining.depth, before))


# ---- which loops to look at ----


def _close_chords(contour: Curves, path: Curves, radius: Floats, is_ramp: Mask, tolerance: float) -> Segments:
    """The chords of the path that come close to a wall, loop after loop; some loops at a time, which bounds memory."""
    count = 2 + max(path.loop.max(initial=0), contour.loop.max(initial=0))
    share = np.cumsum(np.bincount(path.loop + 1, minlength=count)) // _AT_ONCE
    are_long, close = _is_long(path), []
    for number in range(int(share[-1]) + 1):
        rows, walls = (np.flatnonzero(share[curves.loop + 1] == number) for curves in (path, contour))
        one = path[rows], radius[rows], is_ramp[rows]
        chords = _close_chords_of_some(_once(contour[walls], tolerance), *one, tolerance, are_long)
        close.append(msgspec.structs.replace(chords, move=rows[chords.move]))
    return Segments.concatenated(close)


def _close_chords_of_some(
    walls: Segments, path: Curves, radius: Floats, is_ramp: Mask, tolerance: float, are_long: bool
) -> Segments:
    """The same of all these walls and moves; are_long: among all loops is one that may hold repeated passes."""
    is_first = first_of_its_kind(path) if are_long else np.ones(len(path), bool)
    rows = np.flatnonzero(is_ramp | is_first)
    chords = segments(path[rows], tolerance)
    chords = msgspec.structs.replace(chords, move=rows[chords.move])
    chords = chords[(radius[chords.move] > tolerance) & np.isin(chords.loop, walls.loop)]
    if not are_long and _is_long(chords):
        is_first = first_of_its_kind(path)
    limit = radius[chords.move] - tolerance
    return chords[_comes_close(walls, chords, ~is_first[chords.move], is_ramp[chords.move], limit)]


def _is_long(curves: Curves | Segments) -> bool:
    """True where a loop is long enough to hold repeated passes."""
    return len(curves) >= _MANY and bool(np.bincount(curves.loop - curves.loop.min()).max() >= _MANY)


def _once(curves: Curves, tolerance: float) -> Segments:
    """The chords of curves without the repeats of long loops. The `move` column of the result is not valid."""
    if _is_long(curves):
        return segments(curves[first_of_its_kind(curves)], tolerance)
    parts = segments(curves, tolerance)
    return parts[first_of_its_kind(curves)[parts.move]] if _is_long(parts) else parts


def _comes_close(walls: Segments, chords: Segments, repeated: Mask, is_ramp: Mask, limit: Floats) -> Mask:
    """
    Ramps that come nearer than the limit to a wall of their loop, and all chords of paths that do; bool[chords].

    repeated: bool[chords], chords of repeated moves; they are not compared a second time.
    is_ramp: bool[chords]. limit: float64[chords] [mm].
    """
    contours = polylines(walls.start, walls.end, walls.loop)
    shapely.prepare(contours)
    loops = different(walls.loop)
    result = np.zeros(len(chords), bool)
    ramps, path = np.flatnonzero(is_ramp), chords[~is_ramp]
    lines = lines_of(chords.start[ramps], chords.end[ramps])
    result[ramps] = shapely.dwithin(contours[np.searchsorted(loops, chords.loop[ramps])], lines, limit[ramps])
    path_loops, first, number = np.unique(path.loop, return_index=True, return_inverse=True)
    if len(path_loops):
        smallest = np.minimum.reduceat(limit[~is_ramp], first)
        near, loop_of_chord = np.zeros(len(path_loops), bool), number
        path, number = path[~repeated[~is_ramp]], number[~repeated[~is_ramp]]
        run = np.cumsum(first_in_run(number) | (np.arange(len(number)) % _LONG_RUN == 0))
        # A loop is decided by its first close line: a few chords of each decide most long loops that come close at all.
        index = np.arange(len(number))
        is_sample = (index % _LONG_RUN < _SAMPLE) & (np.bincount(number)[number] >= _LONG_RUN)
        for chosen in (np.flatnonzero(is_sample), index):
            chosen = chosen[~near[number[chosen]]]
            lines = polylines(path.start[chosen], path.end[chosen], run[chosen])
            loop_of_line = number[chosen][first_in_run(run[chosen])]
            share = np.cumsum(shapely.get_num_coordinates(lines)) // _PIECES
            for part in np.split(np.arange(len(loop_of_line)), np.flatnonzero(np.diff(share)) + 1):
                keep_time()
                undecided = part[~near[loop_of_line[part]]]
                loop_number = loop_of_line[undecided]
                close = shapely.dwithin(
                    contours[np.searchsorted(loops, path_loops[loop_number])], lines[undecided], smallest[loop_number]
                )
                near[loop_number[close]] = True
        result[~is_ramp] = near[loop_of_chord]
    return result


# ---- ramps of contours that end in the open ----


class _Ramps(msgspec.Struct, frozen=True):
    """
    Straight ramps, n of them.

    ways: the ramps, shifted to their groups.
    group: int[n], the group of each.
    begins: bool[n], start-ups.
    air: float64[n] [mm], radius about the center of C beyond which there is only air.
    in_air: bool[n], the far end of the ramp lies beyond that radius.
    """

    ways: Segments
    group: Rows
    begins: Mask
    air: Floats
    in_air: Mask

    @classmethod
    def of(cls, contour: Curves, air: Floats, path: Curves, chords: Segments, group: Rows) -> _Ramps:
        """Ramps from chords that are shifted to their groups."""
        order = np.argsort(contour.loop, kind="stable")
        first = order[np.searchsorted(contour.loop[order], chords.loop)]
        begins = path.row[chords.move] < contour.row[first]
        far = np.abs(np.where(begins, path.start[chords.move], path.end[chords.move]))
        return cls(chords, group, begins, air[first], far >= air[first])


def _cuts_in_the_open(part: FinishedParts, ramps: _Ramps, radius: Floats, tolerance: float) -> Cuts:
    """Cuts of ramps into contours that are open where the ramp touches them."""
    chords, group, begins = ramps.ways, ramps.group, ramps.begins
    if not len(chords):
        return Cuts.none()
    radius = radius[group]
    in_air = ramps.in_air & _is_round_center(part)[group]
    lines = lines_of(chords.start, chords.end)
    inside = areas.intersection(lines, part.polygon[group])
    center = shapely.points(part.pitch * group[in_air], 0.0)
    within = areas.buffer(center, ramps.air[in_air], quad_segs=64)
    inside[in_air] = areas.intersection(inside[in_air], within)
    wall, chord = members(part.group, group)
    near = _within_reach(part, wall, chords, chord, radius)
    wall, chord = wall[near], chord[near]
    length = np.where(begins[chord][:, None], part.along[wall], part.ahead[wall])
    cuts = [Cuts.none()]
    for low, high, path, allowed in (
        (np.zeros(len(chords)), radius, inside, _slant(chords.end - chords.start, radius)),
        (radius, np.full(len(chords), np.inf), lines, 0.0),
    ):
        start, end, chosen = _between(part, wall, length, low[chord], high[chord])
        walls = gathered(lines_of(start, end), chord[chosen], len(chords))
        if path is lines:
            walls[in_air] = areas.intersection(walls[in_air], within)
        depth = radius - shapely.distance(walls, path)
        cut = np.flatnonzero(depth > tolerance + allowed)  # NaN without walls, or with nothing behind them
        nearest, tool = ends_of(shapely.shortest_line(walls[cut], path[cut]))
        aside, unknown = (radius - depth)[cut], np.full(len(cut), -1)
        cuts.append(Cuts(cut, chords.move[cut], group[cut], unknown, depth[cut], aside, nearest, tool))
    return Cuts.concatenated(cuts)


def _within_reach(part: FinishedParts, wall: Rows, chords: Segments, chord: Rows, reach: Floats) -> Mask:
    """Pairs of a wall and a chord whose boxes come within reach [mm] of each other; bool[pairs]."""
    result = np.ones(len(wall), bool)
    for a, b, c, d in (
        (part.start.real, part.end.real, chords.start.real, chords.end.real),
        (part.start.imag, part.end.imag, chords.start.imag, chords.end.imag),
    ):
        low, high = np.minimum(c, d) - reach, np.maximum(c, d) + reach
        result &= (np.minimum(a, b)[wall] <= high[chord]) & (low[chord] <= np.maximum(a, b)[wall])
    return result


def _is_round_center(part: FinishedParts) -> Mask:
    """True where the center of C lies in the part; bool[groups]."""
    center = shapely.points(part.pitch * np.arange(len(part.polygon)), 0.0)
    return np.asarray(shapely.intersects(part.polygon, center))


def _between(part: FinishedParts, wall: Rows, length: Floats, low: Floats, high: Floats) -> tuple[Points, Points, Rows]:
    """
    The stretch of each wall between two distances along its contour: start, end, and the pairs that have one.

    length: float64[pairs, 2] [mm], distances at which the wall starts and ends. low, high: float64[pairs] [mm].
    """
    start, vector = part.start[wall], part.end[wall] - part.start[wall]
    long = length[:, 1] - length[:, 0]
    with np.errstate(all="ignore"):  # infinite lengths are intended
        shares = [np.clip((limit - length[:, 0]) / long, 0, 1) for limit in (low, high)]
    chosen = np.flatnonzero(np.abs(shares[1] - shares[0]) * np.abs(vector) > ZERO)
    from_, to = (start[chosen] + vector[chosen] * share[chosen] for share in shares)
    return from_, to, chosen


def _slant(vector: Points, radius: Floats) -> Floats:
    """The depth [mm] at which a ramp cuts its end point if it ends perpendicular to its programmed direction."""
    far = np.maximum(np.abs(vector), ZERO)
    return np.asarray(radius * (1 - np.sqrt(np.maximum(far**2 - radius**2, 0)) / far))
