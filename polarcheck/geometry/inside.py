"""How deep straight ways run in the finished part."""

from __future__ import annotations

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.faces import coordinates
from polarcheck.geometry.finished_part import Contours, FinishedParts, finished_parts
from polarcheck.geometry.segments import Curves, members

#: How near its ends must come to the farthest point of a contour that ends outside the bar [share].
_OUTSIDE = 0.95
#: A circle has 1, a square 0.8, a blade ten times as long as it is wide 0.26, a sliver less than this.
_SLIVER = 0.1
#: Points of a way that are looked at.
_POINTS = 17


def depth_inside(
    contour: Curves, left: Mask, ways: tuple[Points, Points], loop: Rows, tolerance: float, gap: float
) -> Floats:
    """
    How deep each way, from start to end, runs in the finished part of its loop [mm]; 0 where that is not known.

    contour, left: as for contour.overcuts. loop: of each way. gap: what is closed [mm]. Of a contour that does not
    close the part is known only if it ends outside the bar, so that none of its points is farther out than its ends;
    of one that encloses a sliver, which a sign makes of a contour that runs the other way, it is not.
    """
    loops, group = np.unique(loop, return_inverse=True)
    half = np.full(len(loops), gap / 2)
    part = finished_parts(Contours(contour, left, loops, np.arange(len(loops)), half, np.nan, tolerance))
    known = np.where(part.open, _ends_outside(contour, loops), _is_broad(part))
    start, end = ways
    place = start[:, None] + (end - start)[:, None] * np.linspace(0, 1, _POINTS) + (part.pitch * group)[:, None]
    points = shapely.points(coordinates(place))
    shapely.prepare(part.polygon)
    inside = shapely.contains(part.polygon[group][:, None], points)
    depth = shapely.distance(shapely.boundary(part.polygon)[group][:, None], points)
    return np.asarray(np.where(inside & known[group][:, None], depth, 0.0).max(axis=1, initial=0.0))


def _ends_outside(contour: Curves, loops: Rows) -> Mask:
    """The loops whose contour is nowhere farther from the center than at its ends."""
    order = np.argsort(contour.loop, kind="stable")
    first = np.searchsorted(contour.loop[order], loops)
    last = np.searchsorted(contour.loop[order], loops, side="right") - 1
    here, group = members(contour.loop[order], loops)
    out = np.maximum(np.abs(contour.start), np.abs(contour.end))[order]
    farthest = np.zeros(len(loops))
    np.maximum.at(farthest, group, out[here])
    nearer = np.minimum(np.abs(contour.start[order[first]]), np.abs(contour.end[order[last]]))
    return np.asarray(nearer >= _OUTSIDE * farthest)


def _is_broad(part: FinishedParts) -> Mask:
    """The parts whose outline, which closes, encloses an area that its length is worth."""
    count = len(part.polygon)
    area = np.bincount(part.group, (part.start.conj() * part.end).imag / 2, count)
    length = np.bincount(part.group, np.abs(part.end - part.start), count)
    return np.asarray(4 * np.pi * np.abs(area) >= _SLIVER * length**2)
