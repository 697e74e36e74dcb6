"""
Ribs: what stays on the outline of a finished part, since no tool touches it there.

Floats in mm, plane points complex, x + 1j*c. Import late: shapely takes its time.

A tool that turns into a contour from a lead, or out of it, stops short of the corner between them. What it leaves there
is cut as well only if the contour goes on far enough beyond its start. At an inside corner of the part no tool of that
R reaches more, so that nothing is missing there.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Points, Rows, Table
from polarcheck.geometry.contour_ends import WITNESS, Corners
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID, Geometries, coordinates, gathered
from polarcheck.geometry.polygons.finished_part import FinishedParts
from polarcheck.geometry.segments import Segments
from polarcheck.geometry.tolerances import CORNER, ROUNDING, ZERO
from polarcheck.time_limit import keep_time

#: The tool touches what it comes this near to [mm]; more than arcs in chords and two roundings shift it.
_CONTACT = 0.003
#: Corners of the outline that turn as much as this share of the corner between two blocks are that corner.
_SAME_TURN = 0.8
#: Farther than any lathe reaches [mm].
_FAR = 1e6
#: A ray that goes on farther than this share of R, if tools are larger by a touch, goes through a slit.
_SLIT = 0.25
#: Directions of an outline that goes on without a corner differ by less.
_STRAIGHT_ON = 0.1
#: Points and pieces that are compared at a time, for the sake of memory, and in all, for the sake of time.
_PAIRS_AT_A_TIME, _PAIRS = 500_000, 50_000_000
#: Samples for the least gap that is looked for; points for the top of a rib.
_SAMPLES, _POINTS = 8, 33


class Swept(Table, frozen=True):
    """
    Where tools run, as straight pieces: start, end [mm], of which row of the program, and R of the cutter there [mm].

    z: the deepest that each comes to [mm], NaN unknown. program: of each.
    """

    start: Points
    end: Points
    row: Rows
    radius: Floats
    z: Floats
    program: Rows

    def at_depth(self, z: Floats, program: Rows) -> Mask:
        """Whether each runs in that program at that Z or deeper; where one of the two is not known, it does."""
        return np.asarray((self.program == program) & ~(self.z > z + ROUNDING))


class Ribs(msgspec.Struct, frozen=True):
    """
    Ribs, k of them: the group, where it stands on the outline, how high it is, how wide at its foot [mm], and the row
    of the program with which the tool leaves it. given_up: groups that were not looked at any more, since so many tools
    come near so many corners.
    """

    group: Rows
    place: Points
    height: Floats
    width: Floats
    row: Rows
    given_up: Rows


class _Samples(Table, frozen=True):
    """Points of an outline with the direction there, the part on its left; the corner that each is near, its group."""

    point: Points
    along: Points
    corner: Rows
    group: Rows


def ribs(
    part: FinishedParts, corners: Corners, radius: Floats, own: Segments, z: Floats, program: Rows, swept: Swept
) -> Ribs:
    """
    What stands on the outline of these parts near their corners.

    corners: their loop is the group of the part. radius, z, program: of each group. own: the path of the tool center of
    each group. swept: all that tools run through.
    """
    part = _without_fins(part, radius)
    shift = np.asarray(part.pitch * corners.loop, np.float64)
    samples = _along_outline(part, corners, shift, radius)
    samples = samples[_reachable(part, samples, radius)]
    samples = samples[~_touched(own.shifted(part.pitch * own.loop), samples, radius)]
    samples = _Samples(samples.point - part.pitch * samples.group, samples.along, samples.corner, samples.group)
    if not len(samples):
        return _none()
    tree = shapely.STRtree(_lines(swept.start, swept.end))
    touched, asked = _touched_by_any(swept, tree, samples, z, program)
    given_up = [samples.group[asked:]]
    samples = samples[:asked][~touched]
    samples = samples[np.argsort(samples.corner, kind="stable")]
    found, pairs = [], 0
    for here in np.split(np.arange(len(samples)), np.flatnonzero(np.diff(samples.corner)) + 1) if len(samples) else []:
        keep_time()
        if pairs > _PAIRS:
            given_up.append(samples.group[here])
            continue
        group = int(samples.group[here[0]])
        rib, compared = _measured(swept, tree, samples[here], radius[group], z[group], program[group])
        pairs += compared
        if rib is not None:
            found.append((group, *rib))
    return msgspec.structs.replace(_one_each(found, radius), given_up=np.unique(np.concatenate(given_up)))


def _without_fins(part: FinishedParts, radius: Floats) -> FinishedParts:
    """
    The parts without what hangs on them at a point and is thinner than R.

    Leads and passes that cross may see nothing but backs between them, and nobody means that as a part.
    """
    polygon = part.polygon.copy()
    for group in np.flatnonzero(shapely.get_num_geometries(polygon) > 1):
        pieces = shapely.get_parts(polygon[group])
        main = pieces[np.argmax(shapely.area(pieces))]
        thin = 2 * shapely.length(areas.maximum_inscribed_circle(pieces)) < radius[group]
        fins = pieces[thin & (shapely.distance(pieces, main) < CORNER) & (pieces != main)]
        polygon[group] = areas.difference(polygon[group], areas.union_all(fins, grid_size=GRID), grid_size=GRID)
    return msgspec.structs.replace(part, polygon=polygon)


def _none() -> Ribs:
    none = np.zeros(0, np.int64)
    return Ribs(none, np.zeros(0, np.complex128), np.zeros(0), np.zeros(0), none, none)


def _along_outline(part: FinishedParts, corners: Corners, shift: Floats, radius: Floats) -> _Samples:
    """Samples of the outline within reach of the corners, but for those that are corners of the part itself."""
    tree = shapely.STRtree(_lines(part.start, part.end))
    points = corners.point + shift
    # Where the path before or behind comes to the contour at a slant, more is left than at the corner itself.
    reach = np.maximum(corners.reach, 2 * radius[corners.loop])
    which, wall = tree.query(shapely.points(coordinates(points)), "dwithin", reach)
    own = part.group[wall] == corners.loop[which]
    which, wall = which[own], wall[own]
    kept = ~_of_part(part, corners, points, which, wall)[which]
    which, wall = which[kept], wall[kept]

    start, way = part.start[wall], part.end[wall] - part.start[wall]
    length = np.maximum(np.abs(way), ZERO)
    along = way / length
    foot = ((points[which] - start) * along.conj()).real
    low, high = (np.clip(foot + sign * reach[which], 0, length) for sign in (-1, 1))
    step = np.sqrt(8 * WITNESS * radius[corners.loop[which]]) / _SAMPLES
    count = np.ceil((high - low) / step).astype(np.int64)
    of = np.repeat(np.arange(len(wall)), count)
    place = np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)
    at = low[of] + (place + 0.5) * ((high - low) / np.maximum(count, 1))[of]
    return _Samples(start[of] + at * along[of], along[of], which[of], corners.loop[which[of]])


def _of_part(part: FinishedParts, corners: Corners, points: Points, which: Rows, wall: Rows) -> Mask:
    """The corners at which the outline itself turns as the blocks do."""
    way = part.end[wall] - part.start[wall]
    arrives = np.abs(part.end[wall] - points[which]) < CORNER
    leaves = np.abs(part.start[wall] - points[which]) < CORNER
    into, out = np.zeros((2, len(points)), np.complex128)
    into[which[arrives]], out[which[leaves]] = way[arrives], way[leaves]
    return np.asarray(np.angle(into * out.conj()) >= _SAME_TURN * corners.turn)


def _reachable(part: FinishedParts, samples: _Samples, radius: Floats) -> Mask:
    """Whether each sample is on the part, and within the bar, and a cutter could touch it without cutting the part."""
    center = samples.point - 1j * samples.along * radius[samples.group]
    solid = part.polygon.copy()
    shapely.prepare(solid)
    limit = radius[samples.group] - _CONTACT
    of_sample, point = solid[samples.group], shapely.points(coordinates(samples.point))
    is_clear = ~shapely.dwithin(of_sample, shapely.points(coordinates(center)), limit)
    return np.asarray(is_clear & shapely.dwithin(of_sample, point, _CONTACT))


def _touched(path: Segments, samples: _Samples, radius: Floats) -> Mask:
    """Whether the path of its own group touches each sample."""
    lines = gathered(_lines(path.start, path.end), path.loop, len(radius))
    shapely.prepare(lines)
    limit = radius[samples.group] + _CONTACT
    return np.asarray(shapely.dwithin(lines[samples.group], shapely.points(coordinates(samples.point)), limit))


def _touched_by_any(
    swept: Swept, tree: shapely.STRtree, samples: _Samples, z: Floats, program: Rows
) -> tuple[Mask, int]:
    """Whether any tool touches each sample, of as many as there was time for; and how many these are."""
    limit = float(swept.radius.max(initial=0.0)) + _CONTACT
    result = np.zeros(len(samples), bool)
    begin, step, pairs = 0, 16, 0
    while begin < len(samples) and pairs <= _PAIRS:
        keep_time()
        some = samples[begin : begin + step]
        which, piece = tree.query(shapely.points(coordinates(some.point)), "dwithin", limit)
        group = some.group[which]
        near = swept[piece]
        distance = np.abs(_to_way(near, some.point[which]))
        touches = near.at_depth(z[group], program[group]) & (distance <= near.radius + _CONTACT)
        result[begin + which[touches]] = True
        begin, pairs = begin + step, pairs + len(which)
        step = int(np.clip(step * _PAIRS_AT_A_TIME // (len(which) + 1), 16, 2 * step))
    asked = min(begin, len(samples))
    return result[:asked], asked


def _to_way(pieces: Swept, point: Points) -> Points:
    """From points to the nearest point of pieces, one for each or all for all."""
    way = pieces.end - pieces.start
    share = ((point - pieces.start) * way.conj()).real / np.maximum(np.abs(way) ** 2, ZERO**2)
    nearest: Points = pieces.start + np.clip(share, 0, 1) * way - point
    return nearest


def _measured(
    swept: Swept, tree: shapely.STRtree, samples: _Samples, radius: float, z: float, program: int
) -> tuple[tuple[complex, float, float, int] | None, int]:
    """
    Place, height, width and row of the rib on these samples of one outline, None if it is no witness; and with how many
    pieces points were compared for that.
    """
    around = shapely.MultiPoint(coordinates(samples.point))
    pieces = swept[np.sort(tree.query(around, "dwithin", 3 * radius + float(swept.radius.max())))]
    pieces = pieces[pieces.at_depth(np.array(z), np.array(program))]
    order = np.argsort((samples.point * samples.along[len(samples) // 2].conj()).real, kind="stable")
    point, along = samples.point[order], samples.along[order]
    if not len(pieces):
        return None, 0
    compared = len(pieces) * (len(point) + 2 * _POINTS)
    feet, rows = zip(*(_foot(pieces, point[end], along[end]) for end in (0, -1)), strict=True)
    place, height = point[0], 0.0
    for _ in range(3):
        heights = _heights(pieces, point, along, radius)
        top = int(np.argmax(heights))
        place, height = point[top], float(heights[top])
        beside = max(top - 1, 0), min(top + 1, len(point) - 1)
        # Round a corner of the outline the straight line to the next sample would run through the part.
        ends = [end if abs(along[end] - along[top]) < _STRAIGHT_ON else top for end in beside]
        share = np.linspace(0, 1, _POINTS)
        point, along = point[ends[0]] + share * (point[ends[1]] - point[ends[0]]), np.full(_POINTS, along[top])
    if height <= WITNESS:
        return None, compared
    return (complex(place), height, float(abs(feet[1] - feet[0])), max(rows)), compared


def _foot(pieces: Swept, point: complex, along: complex) -> tuple[complex, int]:
    """Where the tool that comes nearest to the end of a rib touches the outline, and in which row it does."""
    way = _to_way(pieces, np.asarray(point))
    beyond = np.abs(way) - pieces.radius
    nearest = np.flatnonzero(beyond <= beyond.min() + _CONTACT)
    runs = np.abs(((pieces.end - pieces.start)[nearest] * np.conj(along)).real)
    best = nearest[np.argmax(runs / np.maximum(np.abs(pieces.end - pieces.start)[nearest], ZERO))]
    beside = (way[best] * np.conj(along)).real
    # Farther off than a touch is seen, the tool does not stand on this wall but on one round a corner.
    limit = 2 * np.sqrt(2 * pieces.radius[best] * _CONTACT)
    return point + np.clip(beside, -limit, limit) * along, int(pieces.row[best])


def _heights(pieces: Swept, point: Points, along: Points, radius: float) -> Floats:
    """
    How far from each point of the outline the first tool is, straight away from the part; twice R at most.

    Where a ray goes through between two tools that touch each other, the slit is rounding.
    """
    exact, wider = (first_tool(pieces, pieces.radius + more, point, -1j * along) for more in (0, _CONTACT))
    return np.asarray(np.clip(np.where(exact - wider < _SLIT * radius, exact, wider), 0, 2 * radius))


def first_tool(pieces: Swept, radius: Floats, point: Points, away: Points) -> Floats:
    """How far it is from each point to the first piece that a tool of this radius sweeps; _FAR where there is none."""
    step = max(1, _PAIRS_AT_A_TIME // max(1, len(pieces)))
    found = [np.zeros(0)]
    for begin in range(0, len(point), step):
        keep_time()
        chosen = slice(begin, begin + step)
        found.append(_first_tool(pieces, radius, point[chosen], away[chosen]))
    return np.concatenate(found)


def _first_tool(pieces: Swept, radius: Floats, point: Points, away: Points) -> Floats:
    """The same, all points with all pieces at once."""
    away = away[:, None]
    way = pieces.end - pieces.start
    length = np.maximum(np.abs(way), ZERO)
    found = []
    with np.errstate(all="ignore"):  # a ray that misses a tool meets it nowhere
        for middle in (pieces.start, pieces.end):
            to = (middle - point[:, None]) * away.conj()
            half = np.sqrt(radius**2 - to.imag**2)
            found.append(np.where(to.real + half > 0, to.real - half, np.inf))
        beside = (point[:, None] - pieces.start) * (way / length).conj()
        slope = away * (way / length).conj()
        for side in (-1, 1):
            until = (side * radius - beside.imag) / slope.imag
            share = beside.real + until * slope.real
            found.append(np.where((until > 0) & (share > 0) & (share < length), until, np.inf))
    nearest = np.nan_to_num(np.concatenate(found, axis=1), nan=np.inf).min(axis=1)
    return np.asarray(np.minimum(nearest, _FAR))


def _one_each(found: list[tuple[int, complex, float, float, int]], radius: Floats) -> Ribs:
    """Each rib once, at its highest: two corners are beside most of them, and several loops may leave the same."""
    kept: list[tuple[int, complex, float, float, int]] = []
    for one in sorted(found, key=lambda rib: (round(rib[2], 3), rib[-1]), reverse=True):
        if all(abs(one[1] - other[1]) > max(radius[one[0]], other[3]) for other in kept):
            kept.append(one)
    if not kept:
        return _none()
    group, place, height, width, row = zip(*kept, strict=True)
    none = np.zeros(0, np.int64)
    return Ribs(np.array(group), np.array(place), np.array(height), np.array(width), np.array(row), none)


def _lines(start: Points, end: Points) -> Geometries:
    return np.asarray(shapely.linestrings(coordinates(np.stack([start, end], axis=1))))
