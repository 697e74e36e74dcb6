"""What stands at one depth, or what is cleared there, as polygons: how far one reaches beyond another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polarcheck.geometry.shapes.shape import SAME
from polarcheck.geometry.tolerances import ZERO

if TYPE_CHECKING:
    from polarcheck.columns.metal.finished import Level

#: Pairs of points and edges up to which all points are compared; beyond, some of them.
_PAIRS = 10_000_000
#: Points along an outline, besides its corners.
_POINTS = 1000
#: One of so many points is measured first.
_FEW = 32


def known_of(level: Level) -> Any:
    """What stands at a level, within the ends of its contour where nobody knows what is beyond them."""
    if not level.open or not len(level.outline):
        return level.polygon
    import shapely  # type: ignore[import-untyped]

    from polarcheck.geometry.polygons import areas
    from polarcheck.geometry.polygons.faces import GRID

    reach = float(np.abs(np.append(level.outline.start, level.outline.end)).max())
    return areas.intersection(level.polygon, areas.buffer(shapely.Point(0, 0), reach), grid_size=GRID)


def within(cleared: Any) -> Any:
    """What stands within the areas that a path clears."""
    import shapely

    holes = [hole for part in shapely.get_parts(cleared) for hole in part.interiors]
    return shapely.MultiPolygon([shapely.Polygon(hole) for hole in holes])


def are_same(one: Any, other: Any) -> bool:
    """Two polygons are the same but for rounding."""
    import shapely

    if one is None or other is None or shapely.equals_exact(one, other, SAME):
        return True
    return max(farthest(one, other)[0], farthest(other, one)[0]) <= 2 * SAME


def in_common(one: Any, other: Any) -> float:
    """The share of the outline of a polygon that is outline of the other, too."""
    import shapely

    from polarcheck.geometry.polygons import areas

    outline = shapely.boundary(one)
    common = areas.intersection(outline, areas.buffer(shapely.boundary(other), 2 * SAME, quad_segs=1))
    return float(shapely.length(common) / max(shapely.length(outline), SAME))


def farthest(one: Any, other: Any) -> tuple[float, complex]:
    """How far a polygon reaches beyond the other [mm], and the plane point there."""
    import shapely

    if shapely.is_empty(one) or shapely.is_empty(other):
        return 0.0, 0j
    coordinates = shapely.get_coordinates(shapely.segmentize(one, max(shapely.length(one) / _POINTS, SAME)))
    coordinates = coordinates[:: 1 + len(coordinates) * int(shapely.get_num_coordinates(other)) // _PAIRS]
    points = shapely.points(coordinates)
    # Whether a point is as far away as the farthest of a few is told sooner than how far away it is.
    least = shapely.distance(points[::_FEW], other).max()
    shapely.prepare(other)
    is_far = ~(shapely.dwithin(other, points, least - ZERO) if least > ZERO else shapely.intersects(other, points))
    is_far[0] = True  # the first of equal ones
    far = np.flatnonzero(is_far)
    distance = shapely.distance(points[far], other)
    best = int(np.argmax(distance))
    return float(distance[best]), complex(*coordinates[far[best]])
