"""What a cutter leaves whose center runs along a path: what stands, and what is cleared round it; lengths in mm."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.geometry.outline import Outline
from polarcheck.geometry.shapes.shape import Shape
from polarcheck.geometry.shapes.shapes import contour_of, shapes_of_rings
from polarcheck.geometry.shapes.side_rings import Ring, rings

#: A path with material on both sides along this share of it makes a groove; at corners and crossings there is less.
GROOVE = 0.5
#: Pockets that have a name of their own, whichever way they are cut.
_NAMED = ("circle", "slot")


def shapes_of_cleared(outline: Outline, across: float, radius: float, bar: float = np.nan) -> list[Shape]:
    """
    What stands and what is cleared, in this order.

    outline: of the cleared area, that on the right. across: share of the path beside which there is material on both
    sides. radius: R of the cutter [mm]. bar: diameter [mm], NaN if not known.
    """
    all_rings = list(rings(outline, 0.0, bar))
    around = [ring for ring in all_rings if ring.inside]
    stands = shapes_of_rings((ring for ring in all_rings if not ring.inside), bar)
    inside = sum(ring.closed and not ring.inside for ring in all_rings)
    if across < GROOVE:
        return [*stands, *(_around(shape, inside, len(around)) for shape in shapes_of_rings(around))]
    inner = sum(ring.area for ring in all_rings if ring.closed and not ring.inside)
    return [*stands, *(_groove(ring, radius, inner if len(around) == 1 or not inner else np.nan) for ring in around)]


def _around(shape: Shape, inside: int, count: int) -> Shape:
    """A shape without a name, with the number of pieces that stand within it, if no other area may hold them."""
    if shape.name != "contour" or not inside or count > 1:
        return shape
    return msgspec.structs.replace(shape, values={**shape.values, "stands_inside": float(inside)})


def _groove(ring: Ring, radius: float, inner: float) -> Shape:
    """A groove as wide as the cutter. inner: what stands within it [mm2], NaN where several may hold it."""
    (shape,) = shapes_of_rings([ring])
    if shape.name in _NAMED and not inner:
        return shape
    values = contour_of(ring).values
    values = {name: value for name, value in values.items() if name not in ("inside_radius", "area")}
    area = {} if np.isnan(inner) else {"area": ring.area - inner}
    return Shape("groove", True, {"width": 2 * radius, **values, **area}, row=shape.row)
