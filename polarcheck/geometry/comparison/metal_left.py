"""
What mills leave standing beside what is asked for, as areas; lengths in mm. Import late: shapely takes its time.

Metal is compared near the walls of a shape only: farther away other tools may have been, or other parts begin.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Points
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import coordinates
from polarcheck.geometry.polygons.widened import widened
from polarcheck.geometry.segments import Curves, segments
from polarcheck.geometry.tolerances import ZERO

#: Four times by how much the chords of a round may leave it [mm].
_CHORDS = 0.008
#: Corners of a quarter of a circle round a corner.
_CORNERS = 64
#: Slivers thinner than this are rounding [mm].
_SLIVER = 0.004
#: More chords than these are not compared.
_MOST_CHORDS = 60_000
#: An area lies within another one where no larger share of it lies outside.
_OUTSIDE = 0.01
#: The area of chords of a circle is smaller by no more than this share.
_ROUND = 1e-3
#: Dimensions of an area.
_AREA = 2
#: A pocket as wide as its cutter is cut by it, though its walls are rounded [mm].
_SPARE = 0.01


class Extreme(NamedTuple):
    """A difference on one side: how far from the wall that is asked for, and where [mm]; 0 for none; its area [mm2]."""

    size: float
    place: complex
    area: float


NOTHING = Extreme(0.0, complex(np.nan), 0.0)


def cleared_by(curves: Curves, radius: Floats) -> Any:
    """The area that cutters clear along paths of their centers; radius: R of each curve."""
    covered: list[Any] = []
    is_place = (np.abs(curves.end - curves.start) <= ZERO) & np.isnan(curves.center)
    for size in np.unique(radius).tolist():
        path = curves[(radius == size) & ~is_place]
        if not len(path):
            continue
        chords = segments(path, _CHORDS)
        if len(chords) > _MOST_CHORDS:
            raise TooHardError(f"{len(chords)} chords of paths are too many to compare as areas")
        if len(chords):
            covered.append(widened(path, chords, size, _CHORDS))
    return areas.union_all(np.array(covered, object)) if covered else empty()


def empty() -> Any:
    """No area."""
    return shapely.from_wkt("POLYGON EMPTY")


def polygon_of(points: Points) -> Any:
    """The area within a closed curve."""
    area = shapely.polygons(coordinates(points))
    return area if shapely.is_valid(area) else polygons_of(areas.make_valid(area))


def polygons_of(area: Any) -> Any:
    """An area without lines and points that belong to it."""
    parts = shapely.get_parts(area, return_index=False)
    parts = shapely.get_parts(parts[shapely.get_dimensions(parts) == _AREA])
    return joined([*parts])


def within_lines(area: Any, lines: Sequence[Points]) -> Any:
    """The part of an area on the left of each of these lines, which reach beyond it."""
    for start, end in lines:
        out = -1j * (end - start)
        area = areas.difference(area, polygon_of(np.array([start, start + out, end + out, end, start])))
    return area


def sides_of(curves: Sequence[Points], far: float) -> Any:
    """
    What lies on the one side of curves that end in the air, within a circle about the axis: each curve goes straight on
    from its ends, and from one side of a curve to the other what stands and what is milled take turns.
    """
    area = empty()
    for curve in curves:
        first, last = curve[0] - curve[1], curve[-1] - curve[-2]
        line = np.concatenate(
            [[curve[0] + 3 * far * first / abs(first)], curve, [curve[-1] + 3 * far * last / abs(last)]]
        )
        begin, end = np.angle(line[[0, -1]])
        sweep = (begin - end) % (2 * np.pi)
        back = 3 * far * np.exp(1j * (end + np.linspace(0, sweep, 64)))
        side = polygon_of(np.concatenate([line, back, line[:1]]))
        area = areas.symmetric_difference(area, side)
    return areas.intersection(area, disc(far))


def is_inside(inner: Any, outer: Any, by: float = 0.0) -> bool:
    """True if one area lies within another, enlarged by `by` [mm], except for a small share."""
    return bool(shapely.area(areas.difference(inner, grown(outer, by))) <= _OUTSIDE * shapely.area(inner))


def is_circle(area: Any) -> bool:
    """An area is that of a circle with the same length of its edge."""
    return bool(abs(4 * np.pi * shapely.area(area) / shapely.length(area) ** 2 - 1) < _ROUND)


def disc(radius: float) -> Any:
    """The area within a circle about the axis."""
    return shapely.buffer(shapely.points(0.0, 0.0), radius, quad_segs=4 * _CORNERS)


def grown(area: Any, by: float) -> Any:
    """The area offset outward by this distance [mm], or inward if it is negative."""
    return areas.buffer(area, by, quad_segs=_CORNERS) if by else area


def reachable(area: Any, radius: float, is_pocket: bool) -> Any:
    """The area that a cutter can leave of a part, or clear of a pocket: its inside corners are round."""
    size = max(radius - _SPARE, _SPARE)
    return grown(grown(area, -size), size) if is_pocket else grown(grown(area, size), -size)


def area_to_clear(area: Any, radius: float, tolerance: float, is_pocket: bool) -> Any:
    """The area that a cutter must clear: outside the walls of a part or inside those of a pocket, R wide."""
    limit = reachable(area, radius, is_pocket)
    if is_pocket:
        return areas.difference(grown(limit, -tolerance), grown(limit, -radius))
    return areas.difference(grown(limit, radius), grown(limit, tolerance))


def area_to_keep(area: Any, radius: float, tolerance: float, is_pocket: bool) -> Any:
    """The area to keep: the part, or the surroundings of a pocket as far as a cutter on its wrong side clears."""
    if is_pocket:
        return areas.difference(grown(area, 2 * radius), grown(area, tolerance))
    return grown(area, -tolerance)


def joined(several: Sequence[Any]) -> Any:
    """Several areas as one."""
    return areas.union_all(np.array(several, object)) if several else empty()


def farthest(difference: Any, whole: Any, area: Any) -> Extreme:
    """
    The greatest distance of a difference from the wall.

    difference: the difference within the area of the search. whole: all of it. area: of the part or pocket.
    """
    keep_time()
    difference = grown(grown(difference, -_SLIVER), _SLIVER)
    if shapely.is_empty(difference) or shapely.area(difference) < _SLIVER**2:
        return NOTHING
    pieces = shapely.get_parts(whole)
    touching = pieces[shapely.intersects(pieces, difference)]
    # A pocket that is not milled at all has its corners on the wall, and its middle far from it.
    middles = [polygon for polygon in touching if shapely.get_dimensions(polygon) == _AREA]
    lines = areas.maximum_inscribed_circle(np.array(middles, object)) if middles else np.zeros(0, object)
    points = np.concatenate(
        [shapely.get_coordinates(geometry) for geometry in (touching, difference, shapely.get_point(lines, 0))]
    )
    wall = shapely.boundary(area)
    shapely.prepare(wall)
    far = shapely.distance(shapely.points(points), wall)
    most = int(np.argmax(far))
    return Extreme(float(far[most]), complex(*points[most]), float(shapely.area(difference)))


def off_wall(cleared: Any, area: Any, radius: float, certain: float, is_pocket: bool) -> Floats:
    """The distances from points of the wall that is asked for to the edge of what is cleared [mm]; none in the air."""
    wall = shapely.segmentize(shapely.boundary(reachable(area, radius, is_pocket)), radius / 4)
    points = shapely.get_coordinates(wall)
    points = points[np.hypot(points[:, 0], points[:, 1]) <= certain]
    edge = shapely.boundary(cleared)
    if shapely.is_empty(edge):
        return np.full(len(points), np.inf)
    shapely.prepare(edge)
    return np.asarray(shapely.distance(shapely.points(points), edge))
