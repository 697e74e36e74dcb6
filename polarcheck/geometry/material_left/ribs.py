"""
Ribs: material that remains on the outline of a finished part where no tool touches it.

Floats in mm, plane points complex, x + 1j*c. Import late: shapely takes its time.

A tool that turns from a lead into a contour, or out of it, stops short of the corner between them. The material there
is removed only if the contour goes on far enough beyond its start. At an inside corner of the part itself, no tool of
that R reaches farther, so the material there is no rib.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, ranges
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.contour_ends import WITNESS, Corners
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID, Geometries, coordinates, gathered
from polarcheck.geometry.polygons.finished_part import FinishedParts
from polarcheck.geometry.segments import Segments
from polarcheck.geometry.tolerances import CORNER, ROUNDING, ZERO

#: Distance [mm] that counts as a touch; larger than the error of chords and of two roundings.
_CONTACT = 0.003
#: A corner of the outline is the corner between two blocks if it turns by at least this share of it.
_SAME_TURN = 0.8
#: Farther than any lathe reaches [mm].
_FAR = 1e6
#: A ray that is shorter by more than this share of R with tools enlarged by a touch has passed through a slit.
_SLIT = 0.25
#: Unit directions of an outline without a corner differ by less than this.
_STRAIGHT_ON = 0.1
#: Pairs of points and pieces compared at a time, to limit memory, and in total, to limit time.
_PAIRS_AT_A_TIME, _PAIRS = 500_000, 50_000_000
#: Samples along the smallest rib that is searched for; points compared round the top of a rib.
_SAMPLES, _POINTS = 8, 33


class Swept(Table, frozen=True):
    """
    Straight pieces of tool paths, n of them.

    start, end: complex128[n] [mm].
    row: int[n], the programmed row of each.
    radius: float64[n] [mm], R of the cutter.
    z: float64[n] [mm], the deepest Z of each, NaN unknown.
    program: int[n], the program of each.
    """

    start: Points
    end: Points
    row: Rows
    radius: Floats
    z: Floats
    program: Rows

    def at_depth(self, z: Floats, program: Rows) -> Mask:
        """True for pieces of that program at that Z or deeper; an unknown Z counts as deep enough."""
        return np.asarray((self.program == program) & ~(self.z > z + ROUNDING))


class Ribs(msgspec.Struct, frozen=True):
    """
    Ribs, k of them.

    group: int[k], the group of the part.
    place: complex128[k] [mm], the place on the outline.
    height: float64[k] [mm].
    width: float64[k] [mm], at the foot.
    row: int[k], the programmed row that leaves the rib.
    given_up: int[m], groups that were not checked completely, since too many tools come near too many corners.
    """

    group: Rows
    place: Points
    height: Floats
    width: Floats
    row: Rows
    given_up: Rows


class _Samples(Table, frozen=True):
    """
    Sample points of an outline, n of them.

    point: complex128[n] [mm].
    along: complex128[n], unit direction of the outline, with the part on its left.
    corner: int[n], the corner that the point is near.
    group: int[n], the group of the part.
    """

    point: Points
    along: Points
    corner: Rows
    group: Rows


def ribs(
    part: FinishedParts, corners: Corners, radius: Floats, path: Segments, z: Floats, program: Rows, swept: Swept
) -> Ribs:
    """
    Ribs on the outlines of these parts near their corners.

    corners: their loop is the group of the part.
    radius, z: float64[groups] [mm]. program: int[groups].
    path: the tool center path of each group.
    swept: the paths of all tools.
    """
    part = _without_fins(part, radius)
    shift = np.asarray(part.pitch * corners.loop, np.float64)
    samples = _along_outline(part, corners, shift, radius)
    samples = samples[_reachable(part, samples, radius)]
    samples = samples[~_touched(path.shifted(part.pitch * path.loop), samples, radius)]
    samples = _Samples(samples.point - part.pitch * samples.group, samples.along, samples.corner, samples.group)
    if not len(samples):
        return _none()
    tree = shapely.STRtree(_lines(swept.start, swept.end))
    touched, compared_samples = _touched_by_any(swept, tree, samples, z, program)
    given_up = [samples.group[compared_samples:]]
    samples = samples[:compared_samples][~touched]
    samples = samples[np.argsort(samples.corner, kind="stable")]
    candidates, pairs = [], 0
    for at_corner in (
        np.split(np.arange(len(samples)), np.flatnonzero(np.diff(samples.corner)) + 1) if len(samples) else []
    ):
        keep_time()
        if pairs > _PAIRS:
            given_up.append(samples.group[at_corner])
            continue
        group = int(samples.group[at_corner[0]])
        rib, pair_count = _measured(swept, tree, samples[at_corner], radius[group], z[group], program[group])
        pairs += pair_count
        if rib is not None:
            candidates.append((group, *rib))
    return msgspec.structs.replace(_distinct_ribs(candidates, radius), given_up=np.unique(np.concatenate(given_up)))


def _without_fins(part: FinishedParts, radius: Floats) -> FinishedParts:
    """
    The parts without pieces that touch the main piece only at a point and are thinner than R.

    Leads and passes that cross may enclose such a piece with their backs alone. It is not intended as a part.
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
    """Samples of the outline within reach of the corners; corners of the part itself are left out."""
    tree = shapely.STRtree(_lines(part.start, part.end))
    points = corners.point + shift
    # If the path before or after meets the contour at a slant, more remains than at the corner itself.
    reach = np.maximum(corners.reach, 2 * radius[corners.loop])
    corner, wall = tree.query(shapely.points(coordinates(points)), "dwithin", reach)
    same_group = part.group[wall] == corners.loop[corner]
    corner, wall = corner[same_group], wall[same_group]
    is_lead = ~_of_part(part, corners, points, corner, wall)[corner]
    corner, wall = corner[is_lead], wall[is_lead]

    start, vector = part.start[wall], part.end[wall] - part.start[wall]
    length = np.maximum(np.abs(vector), ZERO)
    along = vector / length
    foot = ((points[corner] - start) * along.conj()).real
    low, high = (np.clip(foot + sign * reach[corner], 0, length) for sign in (-1, 1))
    step = np.sqrt(8 * WITNESS * radius[corners.loop[corner]]) / _SAMPLES
    count = np.ceil((high - low) / step).astype(np.int64)
    pair, index = ranges(count)
    position = low[pair] + (index + 0.5) * ((high - low) / np.maximum(count, 1))[pair]
    return _Samples(start[pair] + position * along[pair], along[pair], corner[pair], corners.loop[corner[pair]])


def _of_part(part: FinishedParts, corners: Corners, points: Points, which: Rows, wall: Rows) -> Mask:
    """True for corners at which the outline turns as the blocks do; bool[corners]."""
    vector = part.end[wall] - part.start[wall]
    arrives = np.abs(part.end[wall] - points[which]) < CORNER
    leaves = np.abs(part.start[wall] - points[which]) < CORNER
    into, out = np.zeros((2, len(points)), np.complex128)
    into[which[arrives]], out[which[leaves]] = vector[arrives], vector[leaves]
    return np.asarray(np.angle(into * out.conj()) >= _SAME_TURN * corners.turn)


def _reachable(part: FinishedParts, samples: _Samples, radius: Floats) -> Mask:
    """True for samples on the part and within the bar that a cutter could touch without an overcut."""
    center = samples.point - 1j * samples.along * radius[samples.group]
    solid = part.polygon.copy()
    shapely.prepare(solid)
    limit = radius[samples.group] - _CONTACT
    of_sample, point = solid[samples.group], shapely.points(coordinates(samples.point))
    is_clear = ~shapely.dwithin(of_sample, shapely.points(coordinates(center)), limit)
    return np.asarray(is_clear & shapely.dwithin(of_sample, point, _CONTACT))


def _touched(path: Segments, samples: _Samples, radius: Floats) -> Mask:
    """True for samples that the path of their group touches."""
    lines = gathered(_lines(path.start, path.end), path.loop, len(radius))
    shapely.prepare(lines)
    limit = radius[samples.group] + _CONTACT
    return np.asarray(shapely.dwithin(lines[samples.group], shapely.points(coordinates(samples.point)), limit))


def _touched_by_any(
    swept: Swept, tree: shapely.STRtree, samples: _Samples, z: Floats, program: Rows
) -> tuple[Mask, int]:
    """True for samples that any tool touches, up to the limit of pairs; and the number of samples compared."""
    limit = float(swept.radius.max(initial=0.0)) + _CONTACT
    result = np.zeros(len(samples), bool)
    begin, step, pairs = 0, 16, 0
    while begin < len(samples) and pairs <= _PAIRS:
        keep_time()
        batch = samples[begin : begin + step]
        sample, piece = tree.query(shapely.points(coordinates(batch.point)), "dwithin", limit)
        group = batch.group[sample]
        near = swept[piece]
        distance = np.abs(_to_piece(near, batch.point[sample]))
        touches = near.at_depth(z[group], program[group]) & (distance <= near.radius + _CONTACT)
        result[begin + sample[touches]] = True
        begin, pairs = begin + step, pairs + len(sample)
        step = int(np.clip(step * _PAIRS_AT_A_TIME // (len(sample) + 1), 16, 2 * step))
    compared = min(begin, len(samples))
    return result[:compared], compared


def _to_piece(pieces: Swept, point: Points) -> Points:
    """The vector from each point to the nearest point of a piece; the shapes broadcast."""
    vector = pieces.end - pieces.start
    share = ((point - pieces.start) * vector.conj()).real / np.maximum(np.abs(vector) ** 2, ZERO**2)
    nearest: Points = pieces.start + np.clip(share, 0, 1) * vector - point
    return nearest


def _measured(
    swept: Swept, tree: shapely.STRtree, samples: _Samples, radius: float, z: float, program: int
) -> tuple[tuple[complex, float, float, int] | None, int]:
    """
    Place, height, width and row of the rib at these samples, and the number of pairs compared.

    None for the rib if it is not above WITNESS. The samples belong to one corner of one outline.
    """
    sample_points = shapely.MultiPoint(coordinates(samples.point))
    pieces = swept[np.sort(tree.query(sample_points, "dwithin", 3 * radius + float(swept.radius.max())))]
    pieces = pieces[pieces.at_depth(np.array(z), np.array(program))]
    order = np.argsort((samples.point * samples.along[len(samples) // 2].conj()).real, kind="stable")
    point, along = samples.point[order], samples.along[order]
    if not len(pieces):
        return None, 0
    pair_count = len(pieces) * (len(point) + 2 * _POINTS)
    feet, rows = zip(*(_foot(pieces, point[end], along[end]) for end in (0, -1)), strict=True)
    peak, height = point[0], 0.0
    for _ in range(3):
        heights = _heights(pieces, point, along, radius)
        top = int(np.argmax(heights))
        peak, height = point[top], float(heights[top])
        adjacent = max(top - 1, 0), min(top + 1, len(point) - 1)
        # At a corner of the outline the straight line to the next sample would cross the part.
        ends = [end if abs(along[end] - along[top]) < _STRAIGHT_ON else top for end in adjacent]
        share = np.linspace(0, 1, _POINTS)
        point, along = point[ends[0]] + share * (point[ends[1]] - point[ends[0]]), np.full(_POINTS, along[top])
    if height <= WITNESS:
        return None, pair_count
    return (complex(peak), height, float(abs(feet[1] - feet[0])), max(rows)), pair_count


def _foot(pieces: Swept, point: complex, along: complex) -> tuple[complex, int]:
    """The point where the tool nearest to the end of a rib touches the outline, and the row of that tool."""
    vector = _to_piece(pieces, np.asarray(point))
    beyond = np.abs(vector) - pieces.radius
    nearest = np.flatnonzero(beyond <= beyond.min() + _CONTACT)
    runs = np.abs(((pieces.end - pieces.start)[nearest] * np.conj(along)).real)
    best = nearest[np.argmax(runs / np.maximum(np.abs(pieces.end - pieces.start)[nearest], ZERO))]
    shift = (vector[best] * np.conj(along)).real
    # Beyond this distance the tool does not touch this wall but one round a corner.
    limit = 2 * np.sqrt(2 * pieces.radius[best] * _CONTACT)
    return point + np.clip(shift, -limit, limit) * along, int(pieces.row[best])


def _heights(pieces: Swept, point: Points, along: Points, radius: float) -> Floats:
    """
    The distance [mm] from each point of the outline to the first tool, perpendicular to the outline; at most 2R.

    If a ray passes between two tools that touch each other, that slit is a rounding error and is closed.
    """
    exact, wider = (first_tool(pieces, pieces.radius + more, point, -1j * along) for more in (0, _CONTACT))
    return np.asarray(np.clip(np.where(exact - wider < _SLIT * radius, exact, wider), 0, 2 * radius))


def first_tool(pieces: Swept, radius: Floats, point: Points, away: Points) -> Floats:
    """The distance [mm] along a ray from each point to the first swept piece; _FAR where there is none."""
    step = max(1, _PAIRS_AT_A_TIME // max(1, len(pieces)))
    distances = [np.zeros(0)]
    for begin in range(0, len(point), step):
        keep_time()
        batch = slice(begin, begin + step)
        distances.append(_first_tool(pieces, radius, point[batch], away[batch]))
    return np.concatenate(distances)


def _first_tool(pieces: Swept, radius: Floats, point: Points, away: Points) -> Floats:
    """The same for one batch: all points with all pieces at once."""
    away = away[:, None]
    vector = pieces.end - pieces.start
    length = np.maximum(np.abs(vector), ZERO)
    distances = []
    with np.errstate(all="ignore"):  # a ray that misses a tool gives NaN
        for middle in (pieces.start, pieces.end):
            local = (middle - point[:, None]) * away.conj()
            half = np.sqrt(radius**2 - local.imag**2)
            distances.append(np.where(local.real + half > 0, local.real - half, np.inf))
        relative = (point[:, None] - pieces.start) * (vector / length).conj()
        slope = away * (vector / length).conj()
        for side in (-1, 1):
            hit = (side * radius - relative.imag) / slope.imag
            share = relative.real + hit * slope.real
            distances.append(np.where((hit > 0) & (share > 0) & (share < length), hit, np.inf))
    nearest = np.nan_to_num(np.concatenate(distances, axis=1), nan=np.inf).min(axis=1)
    return np.asarray(np.minimum(nearest, _FAR))


def _distinct_ribs(candidates: list[tuple[int, complex, float, float, int]], radius: Floats) -> Ribs:
    """Each rib once, at its highest: most ribs lie between two corners, and several loops may leave the same one."""
    distinct: list[tuple[int, complex, float, float, int]] = []
    for candidate in sorted(candidates, key=lambda rib: (round(rib[2], 3), rib[-1]), reverse=True):
        if all(abs(candidate[1] - higher[1]) > max(radius[candidate[0]], higher[3]) for higher in distinct):
            distinct.append(candidate)
    if not distinct:
        return _none()
    group, point, height, width, row = zip(*distinct, strict=True)
    none = np.zeros(0, np.int64)
    return Ribs(np.array(group), np.array(point), np.array(height), np.array(width), np.array(row), none)


def _lines(start: Points, end: Points) -> Geometries:
    return np.asarray(shapely.linestrings(coordinates(np.stack([start, end], axis=1))))
