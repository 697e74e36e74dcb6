"""Depths of one section that make different shapes of one contour: by how much, and where."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import numpy as np

from polarcheck.foundation.finding import MadeShape
from polarcheck.geometry.shapes.shape import SAME
from polarcheck.rules.wording.part import Sizes

if TYPE_CHECKING:
    from polarcheck.columns.metal.finished import Level

#: Passes of one contour have at least this share of their outline in common.
_IN_COMMON = 0.25
#: Pairs of points and edges up to which all points are compared; beyond, some of them.
_PAIRS = 10_000_000
#: Points along an outline, besides its corners.
_POINTS = 1000


class Area(NamedTuple):
    """What stands at one depth, or what is cleared there: its Z [mm], and the polygon (shapely, mm)."""

    z: float
    polygon: Any
    is_cleared: bool = False


def with_differences(entries: Sequence[MadeShape], areas: Sequence[Area], sizes: Sizes) -> Iterator[MadeShape]:
    """
    The entries of a section; where passes of one contour differ, the first entry of a depth says by how much.

    They are compared with what most depths make, or else the deepest one.
    """
    by_z = {round(area.z, 6): area for area in areas if not np.isnan(area.z)}
    groups = dict.fromkeys(tuple(entry.depths) for entry in entries if entry.depths and min(entry.depths) in by_z)
    usual = max(groups, key=lambda depths: (len(depths), -min(depths)), default=())
    names = {depths: {entry.shape for entry in entries if tuple(entry.depths) == depths} for depths in groups}
    seen = {usual}
    for entry in entries:
        depths = tuple(entry.depths)
        text = ""
        if depths in groups and depths not in seen:
            seen.add(depths)
            one, other = by_z[min(depths)], by_z[min(usual)]
            is_pass = names[depths] == names[usual] or _in_common(one.polygon, other.polygon) >= _IN_COMMON
            if one.is_cleared == other.is_cleared and is_pass:
                text = _in_words(one, other, sizes)
        yield msgspec.structs.replace(entry, text=f"{entry.text}; {text}") if text else entry


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
    return max(_farthest(one, other)[0], _farthest(other, one)[0]) <= 2 * SAME


def _in_words(one: Area, other: Area, sizes: Sizes) -> str:
    """`cuts up to 8.660 deeper than at Z-6.000, at x 0.000 c -17.321`."""
    text = []
    more, less = (one, other) if one.is_cleared else (other, one)
    for said, (size, place) in (
        ("cuts up to {} deeper", _farthest(more.polygon, less.polygon)),
        ("leaves up to {} more", _farthest(less.polygon, more.polygon)),
    ):
        if size > 2 * SAME:
            where = f"at x {sizes(place.real)} c {sizes(place.imag)}"
            text.append(f"{said.format(sizes(size))} than at Z{sizes(other.z)}, {where}")
    return " and ".join(text)


def _in_common(one: Any, other: Any) -> float:
    """The share of the outline of a polygon that is outline of the other, too."""
    import shapely

    from polarcheck.geometry.polygons import areas

    outline = shapely.boundary(one)
    common = areas.intersection(outline, areas.buffer(shapely.boundary(other), 2 * SAME, quad_segs=1))
    return float(shapely.length(common) / max(shapely.length(outline), SAME))


def _farthest(one: Any, other: Any) -> tuple[float, complex]:
    """How far a polygon reaches beyond the other [mm], and the plane point there."""
    import shapely

    if shapely.is_empty(one) or shapely.is_empty(other):
        return 0.0, 0j
    points = shapely.get_coordinates(shapely.segmentize(one, max(shapely.length(one) / _POINTS, SAME)))
    points = points[:: 1 + len(points) * int(shapely.get_num_coordinates(other)) // _PAIRS]
    distance = shapely.distance(shapely.points(points), other)
    best = int(np.argmax(distance))
    return float(distance[best]), complex(*points[best])
