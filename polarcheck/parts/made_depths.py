"""What is made at each Z, as shapes in the frame of the part: sections with C between them are put together."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import msgspec

from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.shapes.shape import SAME, Shape
from polarcheck.parts.depth_areas import are_same

#: Names of what is none of the shapes of a drawing.
_WITHOUT_NAME = ("contour", "groove")


class Depth(msgspec.Struct, frozen=True):
    """
    What sections make at one Z.

    sections: their numbers. z: [mm], NaN where it is not known. bottom: the deepest Z of a floor that slopes [mm], NaN
    of one that does not. radius: R of the cutter [mm], NaN if not known. shapes:
    in the frame of the part; where C is not known at the beginning of the section, as it writes them. needs: as in
    MadeShape. polygon: what is left there, within what is known of it (shapely, mm), or, where is_cleared, what is
    cleared; None where depths are not compared by it. swept: what the cutter clears, where the path is that of the
    tool; None elsewhere.
    """

    sections: tuple[int, ...]
    z: float
    radius: float
    shapes: list[Shape]
    needs: str | None = None
    polygon: Any = None
    is_cleared: bool = False
    swept: Any = None
    bottom: float = math.nan


def put_together(joined: Depth, single: Sequence[Depth]) -> Iterator[Depth]:
    """
    What several sections make together, each shape with the sections that make it.

    single: what each of them makes. They are told apart where they have names alone and together they have none.
    """
    shapes = [shape for depth in single for shape in depth.shapes]
    if not joined.shapes or _nameless(joined.shapes) > _nameless(shapes):
        yield from single
        return
    makers: list[tuple[int, ...]] = []
    for shape in joined.shapes:
        keep_time()
        alike = [depth for depth in single if any(are_alike(shape, other) for other in depth.shapes)]
        makers.append(tuple(number for depth in alike for number in depth.sections))
    alone = {number for sections in makers for number in sections}
    rest = tuple(number for number in joined.sections if number not in alone) or joined.sections
    by_sections: dict[tuple[int, ...], list[Shape]] = {}
    for shape, sections in zip(joined.shapes, makers, strict=True):
        by_sections.setdefault(sections or rest, []).append(shape)
    for sections, made in sorted(by_sections.items()):
        yield msgspec.structs.replace(joined, sections=sections, shapes=made)
    # Of roughing, for instance, nothing is left.
    used = {number for sections in by_sections for number in sections}
    yield from (depth for depth in single if used.isdisjoint(depth.sections))


def _nameless(shapes: Sequence[Shape]) -> int:
    """How many of the shapes are none of a drawing, be it that their sides are uneven."""
    uneven = ("sides" in shape.values and "across_flats" not in shape.values for shape in shapes)
    return sum(is_uneven or shape.name in _WITHOUT_NAME for is_uneven, shape in zip(uneven, shapes, strict=True))


def merged(depths: Sequence[Depth]) -> list[list[Depth]]:
    """The depths at which the same sections make the same shapes are one group; in their order."""
    groups: list[list[Depth]] = []
    for depth in depths:
        keep_time()
        same = next((group for group in groups if _are_same(group[0], depth)), None)
        if same is None:
            groups.append([depth])
        else:
            same.append(depth)
    return groups


def _are_same(one: Depth, other: Depth) -> bool:
    return (
        one.sections == other.sections
        and len(one.shapes) == len(other.shapes)
        and one.needs == other.needs
        and all(map(are_alike, one.shapes, other.shapes))
        and (one.is_cleared != other.is_cleared or are_same(one.polygon, other.polygon))
    )


def are_alike(one: Shape, other: Shape) -> bool:
    """They have the same name, sizes and place."""
    if (one.name, one.inside, len(one.odd)) != (other.name, other.inside, len(other.odd)):
        return False
    if one.values.keys() != other.values.keys():
        return False
    return all(abs(value - other.values[name]) <= 2 * SAME for name, value in one.values.items() if name != "area")
