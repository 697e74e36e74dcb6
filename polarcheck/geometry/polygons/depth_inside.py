"""How deep straight ways run in the finished part."""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import coordinates
from polarcheck.geometry.polygons.finished_part import Contours, FinishedParts, finished_parts
from polarcheck.geometry.segments import Curves, first_of_its_kind, members, segments

#: How near its ends must come to the farthest point of a contour that ends outside the bar [share].
_OUTSIDE = 0.95
#: A circle has 1, a square 0.8, a blade ten times as long as it is wide 0.26, a sliver less than this.
_SLIVER = 0.1
#: How much of the extent of its contour an outline has at least [share]; leads and passes have the rest.
_LEAST = 0.4
#: How much of the length of an outline a contour may run back over itself [share].
_RETRACED = 0.15
#: Points of a way that are looked at.
_POINTS = 17


def depth_inside(
    contour: Curves, left: Mask, ways: tuple[Points, Points], loop: Rows, tolerance: float, gap: float
) -> Floats:
    """
    How deep each way, from start to end, runs in the finished part of its loop [mm]; 0 where that is not known.

    contour, left: as for contour.overcuts. loop: of each way. gap: what is closed [mm]. Of a contour that does not
    close the part is known only if it ends outside the bar, so that none of its points is farther out than its ends;
    of one that encloses a sliver or a corner of itself, as a wrong sign makes it run the other way, it is not.
    """
    loops, group = np.unique(loop, return_inverse=True)
    half = np.full(len(loops), gap / 2)
    part = finished_parts(Contours(contour, left, loops, np.arange(len(loops)), half, np.nan, tolerance))
    known = np.where(part.open, _ends_outside(contour, loops), _is_whole(part, contour, loops, tolerance))
    start, end = ways
    place = start[:, None] + (end - start)[:, None] * np.linspace(0, 1, _POINTS) + (part.pitch * group)[:, None]
    points = shapely.points(coordinates(place))
    shapely.prepare(part.polygon)
    inside = shapely.contains(part.polygon[group][:, None], points)
    with np.errstate(invalid="ignore"):  # from what has no outline there is no distance
        depth = shapely.distance(shapely.boundary(part.polygon)[group][:, None], points)
    return np.asarray(np.where(inside & known[group][:, None], depth, 0.0).max(axis=1, initial=0.0))


def _ends_outside(contour: Curves, loops: Rows) -> Mask:
    """The loops whose contour is nowhere farther from the center than at its ends."""
    first, last = np.searchsorted(contour.loop, loops), np.searchsorted(contour.loop, loops, side="right") - 1
    here, group = members(contour.loop, loops)
    out = np.maximum(np.abs(contour.start), np.abs(contour.end))
    farthest = np.zeros(len(loops))
    np.maximum.at(farthest, group, out[here])
    nearer = np.minimum(np.abs(contour.start[first]), np.abs(contour.end[last]))
    return np.asarray(nearer >= _OUTSIDE * farthest)


def _is_whole(part: FinishedParts, contour: Curves, loops: Rows, tolerance: float) -> Mask:
    """
    The parts whose outline encloses an area that its length is worth, and reaches as far as the contour does.

    What runs back over itself is at best a lead: no part has a wall whose both sides the tool passes.
    """
    count = len(loops)
    area = np.bincount(part.group, (part.start.conj() * part.end).imag / 2, count)
    length = np.bincount(part.group, np.abs(part.end - part.start), count)
    here, group = members(contour.loop, loops)
    reach = _reach(np.concatenate([contour.start[here], contour.end[here]]), np.tile(group, 2), count)
    whole = _reach(part.start, part.group, count) >= _LEAST * reach
    # Of walls that cross again and again there is no part, and what they have in common grows with their square.
    asked = np.flatnonzero(whole & ~part.open & ~shapely.is_empty(part.polygon))
    whole[asked] &= _retraced(contour, loops[asked], tolerance) <= _RETRACED * length[asked]
    return np.asarray((4 * np.pi * np.abs(area) >= _SLIVER * length**2) & whole)


def _retraced(contour: Curves, loops: Rows, tolerance: float) -> Floats:
    """How long each loop runs where it has run before, by other blocks [mm]."""
    here, group = members(contour.loop, loops)
    chosen = msgspec.structs.replace(contour[here], loop=group)
    walls = segments(chosen[first_of_its_kind(chosen)], tolerance)
    lines = shapely.linestrings(coordinates(np.stack([walls.start, walls.end], axis=1)))
    every = shapely.multilinestrings(lines, indices=walls.loop)
    return np.asarray(shapely.length(every) - shapely.length(areas.with_itself(every)))


def _reach(points: Points, group: Rows, count: int) -> Floats:
    """The larger of width and height of the points of each group [mm]."""
    result = np.zeros(count)
    for along in (points.real, points.imag):
        low, high = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(low, group, along)
        np.maximum.at(high, group, along)
        result = np.maximum(result, high - low)
    return result
