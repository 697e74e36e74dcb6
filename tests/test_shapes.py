"""What an outline is: against parts that are known by construction, drawn again from the shape alone."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped
from contour_families import FAMILIES, Program, Twin, program_of
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import tables_of
from shapely import affinity

from polarcheck.columns.metal.finished import Level
from polarcheck.geometry.shapes.shape import POLYGONS, Shape
from polarcheck.geometry.shapes.shapes import shapes_of

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


@pytest.mark.ci
@looped("family", FAMILIES, one_in=13)
def test_what_is_drawn_from_a_shape_is_the_part(family: str) -> None:
    told = []
    for seed in range(7):
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


#: Sizes that do not hang on where the part is, or which way it is turned.
SIZES = ("across_flats", "diameter", "width", "length", "apart", "distance", "radius", "corner_radius")


TWINS = {"turned": Twin(0.7), "mirror": Twin(mirror=True), "inch": Twin(inch=True), "steps": Twin(incremental=True)}


@pytest.mark.nightly
@looped("twin", TWINS.values(), ids=list(TWINS), one_in=4)
def test_twins_have_the_same_shape(twin: Twin) -> None:
    compared = 0
    for family, seed in (
        ("polygons", 0),
        ("d_shafts", 2),
        ("cams", 1),
        ("eccentrics", 4),
        ("keyways", 3),
        ("pockets", 4),
    ):
        plain, other = program_of(seed, Twin(inch=False), family), program_of(seed, twin, family)
        (one,), (two,) = (
            shapes_of(levels_of(program)[0].outline, 0.0, program.bar or math.nan) for program in (plain, other)
        )
        assert (one.name, one.inside, one.is_regular) == (two.name, two.inside, two.is_regular)
        for name in SIZES:
            if name in one.values:
                assert one.values[name] == pytest.approx(two.values[name], abs=0.008), (family, name)
                compared += 1
    assert compared >= 6


# ---- parts that shapely makes ----


def shape_of(area: Any) -> Shape:
    """What a program round an area makes, written in mm with X as a diameter."""
    points = shapely.get_coordinates(shapely.geometry.polygon.orient(area).exterior)
    begin = (points[0] + points[1]) / 2
    way = [*points[1:], begin]
    words = "\n".join(f"X{2 * x:.3f} C{c:.3f}" for x, c in way)
    text = (
        f"G21 G98 G40 T0101\nG0 X900. C0\nG12.1\nG1 Z-2. F300\nG42 X{2 * begin[0]:.3f} C{begin[1]:.3f} F100\n{words}\n"
    )
    (level,) = tables_of(text + "G40 X900.\nG13.1\n", "fanuc", "1:radius=4")["finished"].levels
    (shape,) = shapes_of(level.outline)
    return shape


def regular(sides: int, across: float, turned: float = 0.0) -> Any:
    """A polygon whose first side lies in this direction [deg]."""
    return affinity.rotate(_cut(shapely.box(-FAR, -FAR, FAR, FAR), [across / 2] * sides), turned, origin=(0, 0))


@pytest.mark.nightly
@settings(max_examples=25, deadline=None)
@given(
    st.integers(3, 12), st.floats(8, 80), st.floats(0, 360), st.floats(-15, 15), st.floats(-15, 15)
)  # fmt: skip
def test_regular_polygons_are_told(sides: int, across: float, turned: float, x: float, c: float) -> None:
    found = shape_of(affinity.translate(regular(sides, across, turned), x, c))
    assert (found.name, found.is_regular, found.odd) == (POLYGONS.get(sides, "11-sided"), True, ())
    assert found.values["across_flats"] == pytest.approx(across, abs=0.005)
    step = 360 / sides
    assert abs((found.values["turned"] - turned + step / 2) % step - step / 2) < 0.05
    middle = complex(found.values.get("center_x", 0), found.values.get("center_c", 0))
    assert abs(middle - complex(x, c)) < 0.005


@pytest.mark.nightly
@settings(max_examples=15, deadline=None)
@given(st.floats(10, 60), st.floats(1.05, 4), st.floats(0, 180), st.floats(-9, 9))
def test_rectangles_are_told(width: float, share: float, turned: float, aside: float) -> None:
    length = width * share
    box = affinity.translate(shapely.box(-length / 2, -width / 2, length / 2, width / 2), aside, 2 * aside)
    found = shape_of(affinity.rotate(box, turned, origin=(0, 0)))
    assert found.name == "rectangle"
    assert found.values["length"] == pytest.approx(length, abs=0.005)
    assert found.values["width"] == pytest.approx(width, abs=0.005)
    assert abs((found.values["turned"] - turned + 90) % 180 - 90) < 0.05


@looped(("sides", "at"), [(6, 0), (6, 2), (4, 1), (8, 5), (5, 3)])
def test_one_side_that_is_off_is_told_with_its_size(sides: int, at: int) -> None:
    sizes = [13.5] * sides
    sizes[at] = 13.55
    found = shape_of(_cut(shapely.box(-FAR, -FAR, FAR, FAR), sizes))
    assert found.name == POLYGONS[sides]
    assert not found.is_regular
    assert found.values["across_flats"] == pytest.approx(27, abs=0.005)
    assert [round(odd.size, 2) for odd in found.odd] == [27.1]


def test_a_corner_that_is_off_makes_two_sides_uneven_each_by_its_worse_end() -> None:
    corners = [cmath.rect(13.5 / math.cos(math.pi / 6), math.radians(30 + 60 * number)) for number in range(6)]
    corners[0] += cmath.rect(0.06, math.radians(30))
    found = shape_of(shapely.Polygon([(point.real, point.imag) for point in corners]))
    assert [odd.size for odd in found.odd] == pytest.approx([27 + 2 * 0.06 * math.cos(math.pi / 6)] * 2, abs=0.003)


def test_a_sharp_inside_corner_is_reached_as_far_as_its_walls_are_long() -> None:
    """At a right angle R takes its own length of either wall: the shorter one is 10 mm long."""
    found = shape_of(shapely.box(-20, -10, 20, 10).difference(shapely.box(0, 0, 30, 20)))
    assert found.values["corner_reach"] == pytest.approx(10, abs=0.005)


def test_an_octagon_of_mixed_words_is_not_regular_and_says_so() -> None:
    found = shape_of(affinity.scale(regular(8, 40.0), 0.5, 1.0, origin=(0, 0)))
    assert (found.name, found.is_regular) == ("octagon", False)
    assert found.values["least"] == pytest.approx(20, abs=0.005)
    assert found.values["most"] == pytest.approx(40, abs=0.005)
    assert found.values["regular_by_x"] == 2
    assert found.values["across_flats"] == pytest.approx(40, abs=0.005)


def test_a_square_with_chamfers_is_a_square() -> None:
    box = shapely.box(-15, -15, 15, 15).intersection(affinity.rotate(shapely.box(-19, -19, 19, 19), 45))
    found = shape_of(box)
    assert found.name == "square"
    assert found.values["corner_chamfer"] == pytest.approx(30 - 19 * math.sqrt(2), abs=0.005)


def test_many_chords_are_a_circle() -> None:
    found = shape_of(shapely.Point(3, 4).buffer(12, quad_segs=20))
    assert found.name == "circle"
    assert found.values["diameter"] == pytest.approx(24, abs=0.005)
    assert (round(found.values["center_x"], 2), round(found.values["center_c"], 2)) == (3, 4)


def test_a_contour_has_its_extents_and_its_area() -> None:
    area = shapely.box(-20, -10, 15, 12).difference(shapely.box(-5, 2, 4, 20))
    found = shape_of(area)
    assert found.name == "contour"
    extents = [found.values[name] for name in ("x_least", "c_least", "x_most", "c_most")]
    assert extents == pytest.approx(list(area.bounds), abs=0.001)
    assert found.values["area"] == pytest.approx(area.area, abs=0.05)
    assert found.values["inside_corners"] == 2
