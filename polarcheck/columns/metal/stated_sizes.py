"""The size and shape that a comment states, compared with a shape that is made."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.columns.words.comment_reader import StatedShape, tolerance_of
from polarcheck.geometry.shapes.shape import POLYGONS, SAME, SIDES_OF, Shape


def is_uneven(size: StatedShape, shape: Shape) -> bool:
    """A boss with as many sides as the regular polygon that a comment states, and not regular."""
    return shape.name == "polygon" and not shape.inside and shape.values["sides"] == SIDES_OF.get(size.shape)


def fits(size: StatedShape, shape: Shape) -> bool:
    """A shape has this size, in whatever way it is measured, and is no other polygon."""
    if is_uneven(size, shape):
        return False
    if size.shape in POLYGONS.values() and is_regular_polygon(shape) and shape.name != size.shape:
        return False
    if size.shape == "keyway":
        return any(is_size(size, width) for _, width in comparable(size, [shape]))
    if size.shape == "square" and shape.name == "rectangle":
        return all(is_size(size, side) for side in _sides(shape))
    return any(is_size(size, value) for value in _values(shape, size.is_across_flats))


def has_side(size: StatedShape, rectangle: Shape) -> bool:
    """A side of a rectangle is as long as stated."""
    return any(is_size(size, side) for side in _sides(rectangle))


def is_size(size: StatedShape, value: float) -> bool:
    """A length [mm] is the stated size but for tolerances."""
    return abs(value - size.size) <= tolerance_of(size.size)


def are_alike(shape: Shape, other: Shape) -> bool:
    """Shapes of one name and one size."""
    sizes, others = [*_values(shape, False)], [*_values(other, False)]
    return shape.name == other.name and len(sizes) == len(others) and bool(np.allclose(sizes, others, atol=SAME))


def _values(shape: Shape, is_across_flats: bool) -> Iterator[float]:
    """Each number by which a comment may give the size of a shape: across flats, else also corners and diameters."""
    values = shape.values
    yield from (values[name] for name in ("across_flats", "apart", "width") if name in values)
    yield from (2 * values[name] for name in ("distance", "least", "most") if name in values)
    yield from (values[name] for name in ("least", "most") if name in values)
    if is_across_flats:
        return
    yield from (values[name] for name in ("diameter", "corner_diameter", "distance", "length") if name in values)
    if "across_flats" in values and "sides" in values:
        yield values["across_flats"] / float(np.cos(np.pi / values["sides"]))


def comparable(size: StatedShape, shapes: list[Shape]) -> list[tuple[Shape, float]]:
    """The shapes of which the comment can speak, with their sizes [mm]."""
    if size.shape == "boss":
        return [(shape, shape.values["diameter"]) for shape in shapes if shape.name == "circle" and not shape.inside]
    if size.shape == "keyway":
        return [
            (shape, shape.values["width"])
            for shape in shapes
            if shape.name in ("keyway", "slot", "round with keyway") and "width" in shape.values
        ]
    pairs = []
    for shape in shapes:
        value = shape.values.get("across_flats", shape.values.get("apart", np.nan))
        if shape.inside or np.isnan(value) or "regular_by_x" in shape.values:
            continue
        is_polygon = "across_flats" in shape.values
        if shape.name == size.shape or not size.shape or (size.shape == "flats" and not is_polygon):
            pairs.append((shape, value))
    # Corners that are cut off beside the flats make twice as many sides.
    with_corners = 2 * SIDES_OF.get(size.shape, 0)
    pairs += [
        (shape, shape.values["least"])
        for shape in shapes
        if shape.values.get("sides") == with_corners and "least" in shape.values and not shape.inside
    ]
    if size.shape in ("square", "flats"):
        pairs += [
            # The side of a square that is not as stated, and of two flats the nearer one.
            (shape, (max if size.shape == "square" else min)(_sides(shape), key=lambda side: abs(side - size.size)))
            for shape in shapes
            if shape.name == "rectangle" and not shape.inside
        ]
    return pairs


def _sides(shape: Shape) -> tuple[float, float]:
    """Of a rectangle."""
    return shape.values["width"], shape.values["length"]


def is_regular_polygon(shape: Shape) -> bool:
    """A boss that is a regular polygon."""
    return shape.name in POLYGONS.values() and shape.is_regular and not shape.inside and "across_flats" in shape.values
