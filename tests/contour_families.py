"""
Whole programs of contours, with the part that they should leave: for each seed one program of one family.

    program = program_of(7)
    program.text, program.radius, program.part

The part is known by construction, not from the program. Some programs get a fault (a large cutter, a ramp from the
wrong side, a notch, a wrong coordinate, the wrong side of compensation); none is marked as good or bad, part_reference
judges. `program_of(seed, Twin(...))` is the same program turned, mirrored, in inch or incremental.
"""

from __future__ import annotations

import cmath
import itertools
import math
import random
from collections.abc import Callable
from typing import Any, NamedTuple

import shapely  # type: ignore[import-untyped]
from contour_loops import (
    Outline,
    Shape,
    begun_anywhere,
    circle,
    closed_loop,
    corners_of,
    cutter,
    cutter_within,
    direct_loop,
    heights,
    open_loop,
    placed,
    point_of,
    room_in,
    rounded,
)
from contour_pieces import (
    Depths,
    Piece,
    Step,
    Style,
    Way,
    polygon,
    polygon_of,
    text_of,
    turned,
)

PLATE = 5000.0  # [mm] half the side of what is taken as endless


class Twin(NamedTuple):
    """The same program in another form; None leaves it as it is drawn."""

    turn: float = 0.0
    mirror: bool = False
    inch: bool | None = None
    incremental: bool | None = None


class Program(NamedTuple):
    """A program and what it should leave."""

    seed: int
    family: str
    text: str
    radius: float
    part: Any
    wide: Any  # the part if the bar were much larger, for checks that do not know the bar
    bar: float | None


def program_of(seed: int, twin: Twin = Twin(), family: str = "") -> Program:  # noqa: B008
    """The program of a seed."""
    rng = random.Random(f"{seed} {family}")  # noqa: S311
    family = family or list(FAMILIES)[seed % len(FAMILIES)]
    shape = FAMILIES[family](rng)
    style = Style(rng.random() < 0.2, rng.random() < 0.2, shape.may_stay and rng.random() < 0.3)
    if rng.random() < 0.5:
        shape = _changed(shape, lambda point: point.conjugate(), mirrored=True)
    if rng.random() < 0.04:
        swap = {"G41": "G42", "G42": "G41"}
        shape = shape._replace(steps=[step._replace(code=swap.get(step.code, step.code)) for step in shape.steps])
    if twin.turn:
        direction = cmath.exp(1j * twin.turn)
        shape = _changed(shape, lambda point: point * direction)
    if twin.mirror:
        shape = _changed(shape, lambda point: -point.conjugate(), mirrored=True)
    style = style._replace(
        inch=style.inch if twin.inch is None else twin.inch,
        incremental=style.incremental if twin.incremental is None else twin.incremental,
    )
    text = text_of(shape.steps, style, shape.safe)
    part, wide = _part(shape, style, shape.bar), _part(shape, style, shape.bar and 4 * shape.bar)
    return Program(seed, family, text, shape.radius, part, wide, shape.bar)


def _changed(shape: Shape, change: Callable[[complex], complex], mirrored: bool = False) -> Shape:
    kinds = {"cw": "ccw", "ccw": "cw", "G41": "G42", "G42": "G41"} if mirrored else {}
    steps = [
        step
        if step.kind == "z"
        else Step(
            kinds.get(step.kind, step.kind),
            change(step.end),
            None if step.center is None else change(step.center),
            kinds.get(step.code, step.code),
        )
        for step in shape.steps
    ]
    outlines = [Outline([piece.mapped(change, mirrored) for piece in way], is_part) for way, is_part in shape.outlines]
    return shape._replace(steps=steps, outlines=outlines)


def _part(shape: Shape, style: Style, bar: float | None) -> Any:
    """What the program should leave, from the coordinates that are written."""
    if bar is not None:
        left = shapely.Point(0, 0).buffer(bar / 2, quad_segs=360)
    elif shape.endless:
        left = shapely.box(-PLATE, -PLATE, PLATE, PLATE)
    else:
        left = shapely.Polygon()
    for way, is_part in shape.outlines:
        area = polygon_of([piece.mapped(style.rounded) for piece in way])
        left = left.union(area) if is_part else left.difference(area)
    return left


# --- the families ------------------------------------------------------------------------------------------------


def polygons(rng: random.Random) -> Shape:
    """A boss with 3 to 12 sides."""
    size = rng.uniform(4, 60)
    way = polygon(placed(rng, corners_of(rng, size), size))
    radius = cutter(rng, size)
    steps = closed_loop(rng, begun_anywhere(rng, way), False, radius, heights(rng, 2.0))
    return Shape(steps, [Outline(way, True)], radius, may_stay=_one_height(steps))


def crosses(rng: random.Random) -> Shape:
    """A plus, with equal arms or not."""
    size = rng.uniform(8, 60)
    half, arm = size * rng.uniform(0.1, 0.7), size * rng.uniform(0.75, 1)
    quarter = [complex(size, -half), complex(size, half), complex(half, half)]
    corners = [corner * 1j**number for number in range(4) for corner in quarter]
    corners = [complex(corner.real, min(max(corner.imag, -arm), arm)) for corner in corners]
    way = polygon(placed(rng, corners, size))
    radius = cutter(rng, size - half)
    steps = closed_loop(rng, begun_anywhere(rng, way), False, radius, heights(rng, 2.0))
    return Shape(steps, [Outline(way, True)], radius, may_stay=_one_height(steps))


def d_shafts(rng: random.Random) -> Shape:
    """A round with one flat, or two."""
    size = rng.uniform(4, 50)
    direction, angle = turned(rng), rng.uniform(0.3, 1.4)
    ends = [size * cmath.exp(1j * turn) * direction for turn in (-angle, angle)]
    way = [Piece("line", *ends), Piece("ccw", ends[1], ends[0], 0j)]
    if rng.random() < 0.4:
        ends += [-end for end in ends]
        way = [Piece("line", *ends[:2]), Piece("ccw", ends[1], ends[2], 0j)]
        way += [Piece("line", *ends[2:]), Piece("ccw", ends[3], ends[0], 0j)]
    radius = cutter(rng, size)
    steps = closed_loop(rng, begun_anywhere(rng, way), False, radius, heights(rng, 2.0))
    return Shape(steps, [Outline(way, True)], radius, may_stay=_one_height(steps))


def pockets(rng: random.Random) -> Shape:
    """A pocket, square, with round corners or any polygon; the tool comes in from above."""
    size = rng.uniform(8, 60)
    if rng.random() < 0.5:
        corners = corners_of(rng, size)
        way = polygon(placed(rng, corners, size))
    else:
        count = rng.randint(3, 8)
        corners = [cmath.rect(size, math.tau * number / count) for number in range(count)]
        way = rounded(placed(rng, corners, size), size * rng.uniform(0.05, 0.4))
    if rng.random() < 0.15:
        way = circle(size * rng.uniform(0, 1) * turned(rng), size, turned(rng))
    arcs = [abs(piece.center - piece.start) for piece in way if piece.center is not None]
    radius = cutter_within(rng, min([room_in(way), *([arc / 0.65 for arc in arcs] if rng.random() < 0.9 else [])]))
    steps = closed_loop(rng, begun_anywhere(rng, way), True, radius, heights(rng, 2.0))
    return Shape(steps, [Outline(way, False)], radius, endless=True, may_stay=_one_height(steps))


def cams(rng: random.Random) -> Shape:
    """Two circles and their tangents, as a boss or a pocket."""
    large = rng.uniform(5, 40)
    small, apart = large * rng.uniform(0.15, 0.95), large * rng.uniform(1.0, 2.5)
    direction, center = turned(rng), large * rng.uniform(0, 0.5) * turned(rng)
    spoke = cmath.exp(1j * math.acos((large - small) / apart))
    points = [center + direction * point for point in _tangents(large, small, apart, spoke)]
    way = [Piece("ccw", points[0], points[1], center), Piece("line", points[1], points[2])]
    way += [Piece("ccw", points[2], points[3], center + direction * apart), Piece("line", points[3], points[0])]
    inside = rng.random() < 0.3
    radius = cutter_within(rng, small) if inside else cutter(rng, large)
    steps = closed_loop(rng, begun_anywhere(rng, way), inside, radius, heights(rng, 2.0))
    return Shape(steps, [Outline(way, not inside)], radius, endless=inside, may_stay=_one_height(steps))


def _tangents(large: float, small: float, apart: float, spoke: complex) -> list[complex]:
    low = spoke.conjugate()
    return [large * spoke, large * low, apart + small * low, apart + small * spoke]


def eccentrics(rng: random.Random) -> Shape:
    """A circle off the center, as a boss or a pocket."""
    size = rng.uniform(3, 50)
    way = circle(size * rng.uniform(0, 1.5) * turned(rng), size, turned(rng))
    inside = rng.random() < 0.35
    radius = cutter_within(rng, size) if inside else cutter(rng, size)
    steps = closed_loop(rng, begun_anywhere(rng, way), inside, radius, heights(rng, 2.0))
    return Shape(steps, [Outline(way, not inside)], radius, endless=inside, may_stay=_one_height(steps))


def spirals(rng: random.Random) -> Shape:
    """A spiral of half circles or short lines to a boss or the wall of a pocket, closed by a last full turn."""
    inside = rng.random() < 0.4
    final, turns = rng.uniform(5, 40), rng.randint(1, 6)
    radius = cutter_within(rng, final * 0.5) if inside else cutter(rng, final)
    begin = final * rng.uniform(0.4, 0.8) if inside else final * rng.uniform(1.1, 3)
    direction = turned(rng)
    way: Way = []
    if rng.random() < 0.5:
        count = 2 * turns
        sizes = [begin + (final - begin) * number / count for number in range(count + 1)]
        points = [size * (-1) ** number * direction for number, size in enumerate(sizes)]
        for one, other in itertools.pairwise(points):
            way.append(Piece("ccw", one, other, (one + other) / 2))
    else:
        count = turns * 40
        sizes = [begin + (final - begin) * number / count for number in range(count + 1)]
        points = [cmath.rect(size, math.tau * number / 40) * direction for number, size in enumerate(sizes)]
        way = [Piece("line", one, other) for one, other in itertools.pairwise(points)]
    last = Piece("ccw", way[-1].end, way[-1].end, 0j)
    steps = closed_loop(rng, [last], inside, radius, heights(rng, 2.0), passes=[way])
    return Shape(steps, [Outline([last], not inside)], radius, endless=inside, may_stay=_one_height(steps))


def passes(rng: random.Random) -> Shape:
    """One contour in several sizes, all in one loop."""
    size, inside = rng.uniform(6, 40), rng.random() < 0.35
    corners = corners_of(rng, size) if rng.random() < 0.7 else []
    center = size * rng.uniform(0, 0.5) * turned(rng)
    way = polygon([center + corner for corner in corners]) if corners else circle(center, size, turned(rng))
    way = begun_anywhere(rng, way)
    radius = cutter_within(rng, room_in(way) * 0.5) if inside else cutter(rng, size)
    step = rng.uniform(0.05, 0.3)
    if (
        not polygon_of([piece.mapped(lambda p: center + (p - center) * (1 + step)) for piece in way])
        .buffer(1e-6)
        .contains(polygon_of(way))
    ):
        return passes(rng)  # of such a contour a larger pass would cut into the smaller
    sizes = [1 - step * number if inside else 1 + step * number for number in range(rng.randint(2, 4))]
    ways = [[piece.mapped(lambda p, by=by: center + (p - center) * by) for piece in way] for by in sizes]
    if rng.random() < 0.7:
        ways.reverse()
    steps = closed_loop(rng, ways[-1], inside, radius, heights(rng, 2.0), passes=ways[:-1])
    return Shape(steps, [Outline(way, not inside)], radius, endless=inside, may_stay=_one_height(steps))


def depths(rng: random.Random) -> Shape:
    """One contour at several heights, in one loop or in a loop for each."""
    size, inside = rng.uniform(6, 40), rng.random() < 0.35
    corners = placed(rng, corners_of(rng, size), size)
    way = begun_anywhere(rng, polygon(corners) if rng.random() < 0.7 else circle(0j, size, turned(rng)))
    radius = cutter_within(rng, room_in(way)) if inside else cutter(rng, size)
    steps: list[Step] = []
    if rng.random() < 0.5:
        steps = closed_loop(rng, way, inside, radius, heights(rng, 2.0, several=True), repeat=True)
    else:
        for depth in (-1.0, -2.0, -3.5):
            steps += closed_loop(rng, way, inside, radius, Depths(2.0, rng.choice((depth, 2.0)), (depth,)))
    return Shape(steps, [Outline(way, not inside)], radius, endless=inside, may_stay=False)


def flats(rng: random.Random) -> Shape:
    """Flats on a bar, that end beyond it; in a loop each or in one."""
    bar = rng.uniform(10, 100)
    radius = cutter(rng, bar / 2)
    count, direction = rng.choice((1, 2, 4)), turned(rng) if rng.random() < 0.6 else 1 + 0j
    apart = bar / 2 * rng.uniform(0.4, 0.95)
    half = math.sqrt(bar**2 / 4 - apart**2)
    height = heights(rng, 2.0)
    normals = [direction * cmath.exp(math.tau * 1j * number / count) for number in range(count)]
    outlines, steps = [], []
    for normal in normals:
        corners = [normal * complex(apart, -half * 9), normal * complex(9 * bar, -half * 9)]
        corners += [normal * complex(9 * bar, half * 9), normal * complex(apart, half * 9)]
        outlines.append(Outline(polygon(corners), False))
    if count == 4 and apart * math.sqrt(2) > bar / 2 + 0.3 and rng.random() < 0.5:
        way = polygon([normal * complex(apart, -apart) for normal in normals])
        steps = closed_loop(rng, begun_anywhere(rng, way), False, radius, height)
    elif count == 2 and rng.random() < 0.4:
        beyond = half + rng.uniform(0.3, 3) + radius * rng.choice((0, 1, 2.5))
        ends = [normal * complex(apart, side * beyond) for normal in normals for side in (-1, 1)]
        steps = closed_loop(rng, polygon(ends), False, radius, height)
    else:
        for normal in normals:
            ends = [half + rng.uniform(0.3, 3) + radius * rng.choice((0, 0, 1, 2)) for _ in range(2)]
            way = [Piece("line", normal * complex(apart, -ends[0]), normal * complex(apart, ends[1]))]
            steps += open_loop(rng, way, False, radius, height)
    return Shape(steps, outlines, radius, bar, may_stay=False)


def slots(rng: random.Random) -> Shape:
    """A slot through the bar: both walls in one loop, or in two; sometimes narrower than the cutter."""
    bar = rng.uniform(15, 90)
    half = bar * rng.uniform(0.03, 0.3)
    radius = round(half * (rng.uniform(0.2, 0.97) if rng.random() < 0.75 else rng.uniform(1.03, 2)), 3)
    direction, aside = turned(rng) if rng.random() < 0.6 else 1 + 0j, bar * rng.uniform(-0.15, 0.15)
    reach = bar / 2 + rng.uniform(0.5, 3) + radius * rng.choice((0, 1, 2.5))
    height = heights(rng, 2.0)

    def at(x: float, c: float) -> complex:
        return direction * complex(x, c + aside)

    upper, lower = Piece("line", at(reach, half), at(-reach, half)), Piece("line", at(-reach, -half), at(reach, -half))
    if rng.random() < 0.5:
        steps = direct_loop([upper], True, radius, half, height) + direct_loop([lower], True, radius, half, height)
    else:
        link = Piece("line", upper.end, lower.start)
        steps = direct_loop([upper, link, lower], True, radius, half, height)
    outline = polygon([at(9 * bar, half), at(-9 * bar, half), at(-9 * bar, -half), at(9 * bar, -half)])
    return Shape(steps, [Outline(outline, False)], radius, bar, may_stay=False)


def keyways(rng: random.Random) -> Shape:
    """A slot that ends in the bar, with a square or a round end."""
    bar = rng.uniform(15, 90)
    half = bar * rng.uniform(0.04, 0.2)
    radius = round(half * (rng.uniform(0.15, 0.95) if rng.random() < 0.75 else rng.uniform(1.05, 2)), 3)
    direction = turned(rng) if rng.random() < 0.6 else 1 + 0j
    reach, bottom = bar / 2 + rng.uniform(0.5, 3) + radius * rng.choice((0, 1, 2.5)), bar * rng.uniform(0, 0.35)
    ends = [direction * point for point in (complex(reach, half), complex(bottom, half), complex(bottom, -half))]
    ends.append(direction * complex(reach, -half))
    beyond = [direction * complex(9 * bar, -half), direction * complex(9 * bar, half)]
    way = [Piece("line", ends[0], ends[1]), Piece("line", ends[1], ends[2]), Piece("line", ends[2], ends[3])]
    if rng.random() < 0.4:
        way[1] = Piece("ccw", ends[1], ends[2], direction * bottom)
    outline = [Piece("line", beyond[1], ends[1]), way[1], Piece("line", ends[2], beyond[0])]
    outline.append(Piece("line", beyond[0], beyond[1]))
    steps = direct_loop(way, True, radius, half, heights(rng, 2.0))
    return Shape(steps, [Outline(outline, False)], radius, bar, may_stay=_one_height(steps))


def islands(rng: random.Random) -> Shape:
    """A pocket and an island in it, a loop each."""
    size = rng.uniform(15, 60)
    inner, count = size * rng.uniform(0.15, 0.6), rng.randint(3, 8)
    island = polygon([cmath.rect(inner, math.tau * number / count) for number in range(count)])
    island = island if rng.random() < 0.6 else circle(0j, inner, turned(rng))
    wall = rounded([cmath.rect(size * math.sqrt(2), math.pi / 4 + math.pi / 2 * n) for n in range(4)], size * 0.3)
    wall = wall if rng.random() < 0.6 else circle(0j, size, turned(rng))
    center, direction = size * rng.uniform(0, 0.4) * turned(rng), turned(rng)
    wall = [piece.mapped(lambda point: center + point * direction) for piece in wall]
    island = [piece.mapped(lambda point: center + point * direction) for piece in island]
    radius = round((size - inner) / 2 * (rng.uniform(0.05, 0.5) if rng.random() < 0.8 else rng.uniform(0.5, 1.3)), 3)
    height = heights(rng, 2.0)
    radius = min(radius, round(size * 0.28, 3))
    steps: list[Step] = []
    ring = polygon_of(wall).difference(polygon_of(island)).buffer(-radius)
    for way, inside in rng.sample([(wall, True), (island, False)], 2):
        careless = rng.random() < 0.1
        for _ in range(60):
            loop = closed_loop(rng, begun_anywhere(rng, way), inside, radius, height)
            ends = [loop[0].end, [step for step in loop if step.kind != "z"][-1].end]
            if careless or all(ring.contains(point_of(end)) for end in ends):
                break
        steps += loop
    outlines = [Outline(wall, False), Outline(island, True)]
    return Shape(steps, outlines, radius, endless=True, may_stay=False)


def _one_height(steps: list[Step]) -> bool:
    return len({step.z for step in steps if step.kind == "z"}) == 2


FAMILIES: dict[str, Callable[[random.Random], Shape]] = {
    family.__name__: family
    for family in (
        polygons,
        flats,
        crosses,
        d_shafts,
        pockets,
        cams,
        eccentrics,
        spirals,
        passes,
        depths,
        slots,
        keyways,
        islands,
    )
}
