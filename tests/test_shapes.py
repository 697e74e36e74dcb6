"""What an outline is: against parts that are known by construction, drawn again from the shape alone."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped]
from contour_families import FAMILIES, Program, program_of
from programs import tables_of
from shapely import affinity

from polarcheck.geometry.shapes.shape import POLYGONS, Shape
from polarcheck.geometry.shapes.shapes import shapes_of
from polarcheck.table.finished import Level

#: How near what is drawn from a shape must be to the part: what the issue asks for, and the chords of both [mm].
NEAR = 0.005 + 0.003
#: Half the side of what stands for endless [mm].
FAR = 3000.0


# ---- a part drawn from a shape, in shapely alone ----


def drawn(shape: Shape, bar: float = math.nan) -> Any:
    """The area that the shape encloses; of an open one what is part."""
    value = shape.values
    middle = complex(value.get("center_x", 0.0), value.get("center_c", 0.0))
    turned = cmath.rect(1, math.radians(value.get("turned", 0.0)))
    found = _open(shape, middle, turned) if shape.is_open else _placed(_about_zero(shape), middle, turned)
    return found if math.isnan(bar) else found.intersection(_disc(0, bar / 2))


def _about_zero(shape: Shape) -> Any:
    value, name = shape.values, shape.name
    if name == "circle":
        return _disc(0, value["diameter"] / 2)
    if name == "round with flats":
        sizes = [value["distance"]] * int(value["flats"])
        return _cut(_disc(0, value["diameter"] / 2), sizes)
    if "across_flats" in value:
        found = _cut(shapely.box(-FAR, -FAR, FAR, FAR), [value["across_flats"] / 2] * int(value["sides"]))
        if "corner_diameter" in value:
            found = found.intersection(_disc(0, value["corner_diameter"] / 2))
        return _rounded(found, value.get("corner_radius", 0.0))
    if name == "rectangle":
        long, wide = value["length"] / 2, value["width"] / 2
        return _rounded(shapely.box(-long, -wide, long, wide), value.get("corner_radius", 0.0))
    if name == "cross":
        long, wide = value["length"] / 2, value["width"] / 2
        other, across = value["other_length"] / 2, value["other_width"] / 2
        return shapely.box(-long, -wide, long, wide).union(shapely.box(-across, -other, across, other))
    if name == "slot":
        reach = value["length"] / 2 - value["radius"]
        return shapely.LineString([(-reach, 0), (reach, 0)]).buffer(value["radius"], quad_segs=512)
    assert name == "cam"
    return shapely.union(_disc(0, value["radius"]), _disc(value["apart"], value["radius_small"])).convex_hull


def _open(shape: Shape, middle: complex, turned: complex) -> Any:
    value, name = shape.values, shape.name
    everywhere = shapely.box(-FAR, -FAR, FAR, FAR)
    if name in POLYGONS.values():
        return _placed(_cut(everywhere, [value["across_flats"] / 2] * int(value["sides"])), 0j, turned)
    if name == "flats":
        return _placed(_cut(everywhere, [value["distance"]] * int(value["flats"])), 0j, turned)
    begin = -FAR if name == "slot" else value["distance"]
    half = value["width"] / 2
    cut = shapely.box(begin, -half, FAR, half)
    if "radius" in value:
        cut = shapely.box(begin + half, -half, FAR, half).union(_disc(begin + half, half))
    return shapely.box(-FAR / 2, -FAR / 2, FAR / 2, FAR / 2).difference(_placed(cut, middle, turned))


def _disc(x: float, radius: float) -> Any:
    return shapely.Point(x, 0).buffer(radius, quad_segs=512)


def _cut(area: Any, sizes: list[float]) -> Any:
    for number, size in enumerate(sizes):
        beyond = affinity.rotate(shapely.box(size, -FAR, 2 * FAR, FAR), 360 * number / len(sizes), origin=(0, 0))
        area = area.difference(beyond)
    return area


def _rounded(area: Any, radius: float) -> Any:
    return area.buffer(-radius, join_style="mitre").buffer(radius, quad_segs=512) if radius else area


def _placed(area: Any, middle: complex, turned: complex) -> Any:
    matrix = [turned.real, -turned.imag, turned.imag, turned.real, middle.real, middle.imag]
    return affinity.affine_transform(area, matrix)


# ---- the families of the generator ----


def levels_of(program: Program) -> list[Level]:
    inch = 25.4 if "G20" in program.text else 1.0
    job = {"stock": {"diameter": program.bar / inch}} if program.bar else {}
    levels: list[Level] = tables_of(program.text, "fanuc", f"1:radius={program.radius / inch}", job=job)[
        "finished"
    ].levels
    return levels


def is_as_meant(level: Level, program: Program) -> bool:
    """Whether the walls leave the part that was drawn; not where the program has a fault."""
    reach = 2 * np.abs(level.outline.start).max(initial=0.0)
    near = shapely.box(-reach, -reach, reach, reach)
    one, other = (area.intersection(near).boundary for area in (level.polygon, program.part))
    return bool(shapely.hausdorff_distance(one, other) < 4 * NEAR)


def boundary(program: Program) -> Any:
    """Of the part, without the sides of what stands for endless."""
    return program.part.boundary.intersection(shapely.box(-FAR / 2, -FAR / 2, FAR / 2, FAR / 2))


@pytest.mark.parametrize("family", FAMILIES)
def test_what_is_drawn_from_a_shape_is_the_part(family: str) -> None:
    told = []
    for seed in range(10):
        program = program_of(seed, family=family)
        level = levels_of(program)[0]
        if not is_as_meant(level, program):
            continue
        shapes = shapes_of(level.outline, level.gap, program.bar or math.nan)
        known = [shape for shape in shapes if shape.name != "contour" and shape.is_regular]
        outline = boundary(program)
        for shape in known:
            area = drawn(shape, program.bar or math.nan)
            off = shapely.distance(outline, shapely.points(shapely.get_coordinates(area.boundary))).max()
            assert off < NEAR, (seed, shape)
        if len(known) == len(shapes) == 1:
            assert shapely.hausdorff_distance(outline, drawn(known[0], program.bar or math.nan).boundary) < NEAR, seed
        told += known
    assert len(told) >= 2
