"""
The finished part at each depth as rings of points.

Import late: shapely is slow to import.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.columns.metal.finished import Level
from polarcheck.columns.trace import Trace
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID
from polarcheck.geometry.segments import segments
from polarcheck.reports.made_parts.part_report import level_in_words
from polarcheck.rules.quantity import in_row
from polarcheck.view.drawn_moves import LENGTH
from polarcheck.view.picture_data import PartPicture

#: How far a part of unknown outline is shown beyond its walls, as a share of their extent.
_AROUND = 0.1

Ring = list[tuple[float, float]]


def parts(trace: Trace, levels: Sequence[Level], tolerance: float) -> Iterator[PartPicture]:
    """Yield the part at each depth, its outline simplified within the tolerance [mm]."""
    for level in levels:
        bar = trace.lengths.stock_diameter[level.walls.row[0]]
        visible, is_known = within_window(level, bar, trace.machine.compensation.overcut_tolerance)
        polygons = [rings(polygon) for polygon in polygons_of(shapely.simplify(visible, tolerance))]
        if polygons:
            yield PartPicture(
                z=None if np.isnan(level.z) else round(level.z, LENGTH),
                polygons=polygons,
                text=_text(trace, level),
                known_outside=is_known,
            )


def within_window(level: Level, bar: float, tolerance: float) -> tuple[Any, bool]:
    """
    Return the part, and whether its outside is known; otherwise it is cut off a little beyond its walls.

    bar: the diameter of the stock, which is such an outside [mm]; NaN if unknown.
    """
    walls = segments(level.walls, tolerance)
    point = np.concatenate([walls.start, walls.end])
    if level.polygon.is_empty or level.tangled or not len(point):
        return shapely.Polygon(), True
    x, c = point.real, point.imag
    around = max(2 * level.radius, _AROUND * max(float(np.ptp(x)), float(np.ptp(c))))
    window = shapely.box(x.min() - around, c.min() - around, x.max() + around, c.max() + around)
    if not level.open and (not np.isnan(bar) or window.covers(level.polygon)):
        return level.polygon, True
    return areas.intersection(level.polygon, window, grid_size=GRID), False


def polygons_of(area: Any) -> list[Any]:
    """Return the polygons of an area that are not empty, the largest first."""
    polygons = [part for part in shapely.get_parts(area) if isinstance(part, shapely.Polygon) and not part.is_empty]
    return sorted(polygons, key=lambda polygon: (-polygon.area, polygon.bounds))


def rings(polygon: Any) -> list[Ring]:
    """Return the rings of a polygon, its outside first."""
    return [_points(ring) for ring in (polygon.exterior, *polygon.interiors)]


def _points(ring: Any) -> Ring:
    return [(x, c) for x, c in (np.round(shapely.get_coordinates(ring), LENGTH) + 0.0).tolist()]


def _text(trace: Trace, level: Level) -> str:
    """`Z-2 mm: hexagon, ...`"""
    words = level_in_words(trace, level) or "what its contour leaves standing"
    return words if np.isnan(level.z) else f"Z{in_row(level.z, trace.lengths, int(level.walls.row[0])):length}: {words}"
