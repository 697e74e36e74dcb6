"""The depth of straight lines in the finished part."""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, different, mask_at
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import coordinates, gathered, lines_of
from polarcheck.geometry.polygons.finished_part import Contours, FinishedParts, PartsOfLoops, finished_parts
from polarcheck.geometry.polygons.noding import may_share_stretches
from polarcheck.geometry.segments import Curves, first_of_its_kind, members, segments

#: How near its ends must come to the farthest point of a contour that ends outside the bar [share].
_OUTSIDE = 0.95
#: A circle has 1, a square 0.8, a blade ten times as long as it is wide 0.26, a sliver less than this.
_SLIVER = 0.1
#: How much of the extent of its contour an outline has at least [share]; leads and passes have the rest.
_LEAST = 0.4
#: How much of the length of an outline a contour may run back over itself [share].
_RETRACED = 0.15
#: Points per line at which the depth is measured.
_POINTS = 17


def depth_inside(
    contour: Curves,
    left: Mask,
    lines: tuple[Points, Points],
    loop: Rows,
    tolerance: float,
    gap: float,
    known: PartsOfLoops | None = None,
) -> Floats:
    """
    The greatest depth [mm] of each line in the finished part of its loop; 0 where the part is unknown.

    contour, left: as for overcuts.own_loop.overcuts.
    lines: complex128[n] each [mm], start and end.
    loop: int[n], the loop of each line.
    tolerance: of the chords of arcs [mm].
    gap: the largest gap that is closed [mm].
    known: parts of some loops of the contour, of any R and with no bar: they are taken if no loop has a gap.

    The part of an open contour is known only if the contour ends outside the bar, so that no point lies farther out
    than its ends. A contour that encloses only a sliver or a corner of itself has no known part: a wrong sign makes it
    run the other way.
    """
    loops = different(loop)
    if known is not None and known.closes(loops):
        loops, part = known.loop, known.part
    else:
        half = np.full(len(loops), gap / 2)
        part = finished_parts(Contours(contour, left, loops, np.arange(len(loops)), half, np.nan, tolerance))
    group = np.searchsorted(loops, loop)
    start, end = lines
    sample = start[:, None] + (end - start)[:, None] * np.linspace(0, 1, _POINTS) + (part.pitch * group)[:, None]
    points = shapely.points(coordinates(sample))
    shapely.prepare(part.polygon)
    inside = shapely.contains(part.polygon[group][:, None], points)
    reached = mask_at(len(loops), group[inside.any(axis=1)])
    is_known = np.where(part.open, _ends_outside(contour, loops), _is_whole(part, reached, contour, loops, tolerance))
    depth = np.zeros(inside.shape)
    line, _ = deep = np.nonzero(inside & is_known[group][:, None])
    depth[deep] = shapely.distance(shapely.boundary(part.polygon)[group[line]], points[deep])
    return np.asarray(depth.max(axis=1, initial=0.0))


def _ends_outside(contour: Curves, loops: Rows) -> Mask:
    """True for loops whose contour is farthest from the center at its ends."""
    first, last = np.searchsorted(contour.loop, loops), np.searchsorted(contour.loop, loops, side="right") - 1
    row, group = members(contour.loop, loops)
    out = np.maximum(np.abs(contour.start), np.abs(contour.end))
    farthest = np.zeros(len(loops))
    np.maximum.at(farthest, group, out[row])
    nearer = np.minimum(np.abs(contour.start[first]), np.abs(contour.end[last]))
    return np.asarray(nearer >= _OUTSIDE * farthest)


def _is_whole(part: FinishedParts, reached: Mask, contour: Curves, loops: Rows, tolerance: float) -> Mask:
    """
    True for parts, of those that a line reaches, that are no sliver and whose outline reaches about as far as the
    contour.

    A contour that runs back over itself is at best a lead: no part has a wall with the tool on both sides.
    """
    count = len(loops)
    area = np.bincount(part.group, (part.start.conj() * part.end).imag / 2, count)
    length = np.bincount(part.group, np.abs(part.end - part.start), count)
    row, group = members(contour.loop, loops)
    reach = _reach(np.concatenate([contour.start[row], contour.end[row]]), np.tile(group, 2), count)
    whole = reached & (_reach(part.start, part.group, count) >= _LEAST * reach)
    # Walls that cross again and again bound no part, and their common length would take quadratic time.
    compared = np.flatnonzero(whole & ~part.open)
    whole[compared] &= _retraced(contour, loops[compared], part.pitch, tolerance) <= _RETRACED * length[compared]
    return np.asarray((4 * np.pi * np.abs(area) >= _SLIVER * length**2) & whole)


def _retraced(contour: Curves, loops: Rows, pitch: float, tolerance: float) -> Floats:
    """The length [mm] over which each loop runs along earlier blocks of itself. pitch: as for finished parts."""
    row, group = members(contour.loop, loops)
    chosen = msgspec.structs.replace(contour[row], loop=group)
    walls = segments(chosen[first_of_its_kind(chosen)], tolerance)
    shifted = walls.shifted(pitch * walls.loop)
    # The common length of all walls is dear, and most run along no other one.
    walls = walls[may_share_stretches(shifted.start, shifted.end, walls.loop)]
    every = gathered(lines_of(walls.start, walls.end), walls.loop, len(loops))
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
