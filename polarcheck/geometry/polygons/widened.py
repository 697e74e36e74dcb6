"""
The area that a cutter covers whose center runs along a path: all points within R of its chords; lengths in mm.

Each line is widened by itself. What lies within R of the equal chords of an arc is a part of a ring, or of a disc where
the arc is smaller than R, and a disc round either end. GEOS could widen all lines in one go, but nodes all their
parallels at once: where these all but meet, as round a circle, that takes it a thousand times as long. Import late:
shapely takes its time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Mask, Points, Rows, first_in_run, last_in_run, runs
from polarcheck.foundation.errors import NoAnswerError
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID, Geometries, coordinates, lines_of
from polarcheck.geometry.segments import Curves, Segments
from polarcheck.geometry.tolerances import TOUCH

#: Areas that are joined at a time: the time for one union grows faster than its areas.
_AT_A_TIME = 100
#: How far [rad] the ends of a part of a ring may lead past its spokes at the hole. They are at right angles to the
#: first and the last chord, not along the spokes.
_PAST_SPOKE = 0.5


def widened(path: Curves, chords: Segments, radius: float, tolerance: float) -> Any:
    """
    The area within R [mm] of the chords of a path, a shapely geometry. Its round edges have chords with a quarter of
    the tolerance [mm] as sagitta at most.

    Chords of lines that are repeated count once. Raises TooHardError for too many points, and where the time is over.
    """
    steps = int(np.ceil(np.pi / 4 / np.arccos(1 - np.clip(tolerance / 4 / radius, 1e-9, 0.25))))
    part = _halves_of_arcs(path, chords)
    is_ring, is_pie = _shapes(path, chords, part, radius, tolerance)
    is_round = is_ring | is_pie
    center = path.center[chords.move]
    polygons = _beside_arcs(chords[is_round], part[is_round], center[is_round], is_pie[is_round], radius, 4 * steps)
    lines = _distinct(chords[~is_round])
    straight = lines_of(lines.start, lines.end)
    covered = [_union(polygons[first : first + _AT_A_TIME]) for first in range(0, len(polygons), _AT_A_TIME)]
    for first in range(0, len(straight), _AT_A_TIME):
        covered.append(_union(areas.buffer(straight[first : first + _AT_A_TIME], radius, quad_segs=steps)))
    return _union(np.array(covered))


def _union(parts: Geometries) -> Any:
    """One area of several; on the grid only where GEOS finds no union without, which takes several times as long."""
    try:
        return areas.union_all(parts)
    except NoAnswerError:
        return areas.union_all(parts, grid_size=GRID)


def _distinct(chords: Segments) -> Segments:
    """Chords without repeats, whichever way they run: arcs of one circle have chords in common."""
    ends = np.round(np.stack([chords.start, chords.end], axis=1) / TOUCH)
    return chords[_first_rows(np.sort(ends, axis=1))]


def _first_rows(keys: NDArray[Any]) -> Rows:
    """The first row of each distinct one, in order."""
    return np.sort(np.unique(keys, axis=0, return_index=True)[1])


# ---- arcs ----


def _halves_of_arcs(path: Curves, chords: Segments) -> Rows:
    """
    The half of an arc that each chord is of, rising; -1 for lines and spirals, and for the first and the last chord of
    an arc, which may be shorter than the others. The ends of no half meet, as those of a circle do.
    """
    first, last = runs(chords.move)
    count = last - first + 1
    index = _places(chords.move)
    of = np.repeat(count, count)
    ends = np.abs(path.start - path.center), np.abs(path.end - path.center)
    on_circle = np.abs(ends[0] - ends[1]) <= TOUCH
    inner = on_circle[chords.move] & (index > 0) & (index < of - 1)
    return np.where(inner, 2 * chords.move + (index >= of // 2), -1)


def _shapes(path: Curves, chords: Segments, part: Rows, radius: float, tolerance: float) -> tuple[Mask, Mask]:
    """The shape within R of each half of an arc, as two masks of chords: part of a ring, part of a disc."""
    _, number, count = np.unique(part, return_inverse=True, return_counts=True)
    arc_radius = np.abs(chords.start - path.center[chords.move])
    with np.errstate(invalid="ignore", divide="ignore"):  # lines have no center
        half_angle = np.arcsin(np.abs(chords.end - chords.start) / 2 / arc_radius)
        hole = arc_radius * np.cos(half_angle) - radius
        is_ring = (part >= 0) & (_PAST_SPOKE * hole > radius * half_angle)
        # Beyond the center the discs round both ends must cover what the chords between them do.
        spare = (radius - arc_radius) * arc_radius / radius * (1 - np.cos(half_angle * count[number]))
        is_pie = (part >= 0) & (hole < 0) & (spare > tolerance)
    return is_ring, is_pie


def _beside_arcs(chords: Segments, part: Rows, center: Points, is_pie: Mask, radius: float, corners: int) -> Geometries:
    """
    What is within R of equal chords of arcs: polygons beside them, and discs round their ends.

    part: int[n], rising, which chords belong together. center: of the arc of each. is_pie: the polygon beside it
    reaches to the center, else to the inner parallels.
    """
    if not len(chords):
        return np.zeros(0, object)
    along = (chords.end - chords.start) / np.abs(chords.end - chords.start)
    # Away from the center: on the right of arcs that run counterclockwise.
    outward = radius * along * np.where(((chords.start - center).conj() * along).imag > 0, -1j, 1j)
    first, last = first_in_run(part), last_in_run(part)
    before, after = (np.where(end, outward, np.roll(outward, by)) for end, by in ((first, 1), (last, -1)))
    inner_start = np.where(is_pie, center, chords.start - _mitre(before, outward))
    inner_end = np.where(is_pie, center, chords.end - _mitre(outward, after))[last]
    # Round the corners between the outer parallels, as a disc has it.
    turn = np.abs(np.angle(after / outward))
    corner = np.repeat(np.arange(len(chords)), np.ceil(turn * corners / (2 * np.pi)).astype(np.int64))
    share = _places(corner) / np.maximum(np.bincount(corner, minlength=len(chords)), 1)[corner]
    rounded = chords.end[corner] + outward[corner] * (after / outward)[corner] ** share
    # Forward outside, backward inside.
    points = np.concatenate([chords.start + outward, rounded, chords.end[last] + outward[last], inner_start, inner_end])
    number, of = np.arange(len(chords)), np.cumsum(first) - 1
    rank = np.concatenate([2 * number, 2 * corner + 1 + share, 2 * number[last] + 1, -number, -number[last] - 1])
    polygon = np.concatenate([of, of[corner], of[last], of, of[last]])
    is_inside = np.arange(len(points)) >= len(points) - len(inner_start) - len(inner_end)
    order = np.lexsort((rank, is_inside, polygon))
    rings = shapely.linearrings(coordinates(points[order]), indices=polygon[order])
    ends, outward_at_end = np.append(chords.start[first], chords.end[last]), np.append(outward[first], outward[last])
    return np.concatenate([shapely.polygons(rings), _discs(ends, outward_at_end, corners)])


def _places(of: Rows) -> Rows:
    """The number of each element among those of the same group, which are in a row."""
    return np.arange(len(of)) - np.searchsorted(of, of)


def _mitre(first: Points, second: Points) -> Points:
    """From a corner to where the parallels on either side of it meet, which have these vectors [mm]."""
    return np.asarray((first + second) / (1 + (first.conj() * second).real / np.abs(first) ** 2))


def _discs(point: Points, outward: Points, corners: int) -> Geometries:
    """Discs round points, each once, with corners where the parallels beside it end, so that no slit remains."""
    # This power is the same for all directions in which a disc has corners.
    alike = np.round((outward / np.abs(outward)) ** corners, 6)
    chosen = _first_rows(np.stack([np.round(point / TOUCH), alike], axis=1))
    around = np.exp(2j * np.pi * np.arange(corners) / corners)
    return np.asarray(shapely.polygons(coordinates(point[chosen, None] + outward[chosen, None] * around)))
