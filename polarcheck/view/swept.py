"""
What the cutter leaves standing in sections without compensation, where it runs along the programmed path.

Import late: shapely is slow to import.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.columns.trace import Trace
from polarcheck.foundation.finding import MadeShape
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID
from polarcheck.geometry.polygons.standing_metal import turned
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.parts.made_depths import Depth
from polarcheck.view.drawn_moves import LENGTH
from polarcheck.view.extent import bar_rings
from polarcheck.view.part_rings import Ring, polygons_of, rings
from polarcheck.view.picture_data import PartPicture

#: How far metal is shown beyond what is cleared, as a share of its extent.
_AROUND = 0.1


def swept_parts(
    trace: Trace,
    depths: Sequence[Depth],
    section: int,
    bar: tuple[float, float],
    tolerance: float,
    makes: Sequence[MadeShape],
) -> Iterator[PartPicture]:
    """
    Yield what stands at each depth of a section, in the order of the program.

    depths: what is made at each Z, in the frame of the part.
    bar: the diameters of the bar and of its bore; NaN if unknown [mm].
    tolerance: of the outline [mm].
    makes: the shapes of the section in words.
    """
    depth_by_z: dict[float, Depth] = {}
    for depth in depths:
        if section in depth.sections and depth.swept is not None:
            depth_by_z.setdefault(depth.z, depth)
    entry = trace.path.section_entry[section] if trace.path.knows_section_entry[section] else 0.0
    gone: Any = None
    before: Any = None
    polygons: list[list[Ring]] = []
    is_known = True
    pictures: dict[float, PartPicture] = {}
    # What is cleared at one depth is cleared above it, too.
    for z in sorted(depth_by_z, key=lambda z: (np.isnan(z), z)):
        depth = depth_by_z[z]
        # Most passes clear the same as the pass below them.
        if before is None or np.isnan(z) or not shapely.equals_exact(before, depth.swept, ROUNDING):
            swept = shapely.simplify(depth.swept, tolerance)
            above = gone is not None and not np.isnan(z)
            gone = areas.union_all([gone, swept], grid_size=GRID) if above else swept
            standing, is_known = _standing(gone, depth, bar)
            turn = -float(np.radians(entry))
            polygons = [rings(polygon) for polygon in polygons_of(turned(standing, turn))]
        before = depth.swept
        if polygons:
            pictures[z] = PartPicture(
                z=None if np.isnan(z) else round(z, LENGTH),
                polygons=polygons,
                text=_text(z, makes),
                known_outside=is_known,
            )
    yield from (pictures[z] for z in depth_by_z if z in pictures)


def _standing(gone: Any, depth: Depth, bar: tuple[float, float]) -> tuple[Any, bool]:
    """Return what is not cleared, and whether its outside is known; without a bar it is cut off a little beyond."""
    outside, *bore = [shapely.Polygon(ring) for ring in bar_rings(*bar)] or [None]
    if outside is not None:
        metal = areas.difference(outside, bore[0], grid_size=GRID) if bore else outside
        return areas.difference(metal, gone, grid_size=GRID), True
    x0, c0, x1, c1 = gone.bounds
    around = max(2 * depth.radius, _AROUND * max(x1 - x0, c1 - c0))
    window = shapely.box(x0 - around, c0 - around, x1 + around, c1 + around)
    return areas.difference(window, gone, grid_size=GRID), False


def _text(z: float, makes: Sequence[MadeShape]) -> str:
    """Return the shapes at a depth in words."""
    texts = [shape.text for shape in makes if any(abs(depth - z) <= ROUNDING for depth in shape.depths)]
    return "; ".join(dict.fromkeys(texts)) or "what the cutter leaves standing"
