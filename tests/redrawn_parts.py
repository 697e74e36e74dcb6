"""
A part drawn again from what `polarcheck part` says of it, and laid over what the cutters sweep.

    for mismatch in mismatches(tables, made_by(tables)):
        print(mismatch)

A shape is drawn from its name and its values alone, without polarcheck.geometry.shapes. At each of its depths the
cutters must come within TOLERANCE of its whole outline, and must not enter it by more. Where the words leave a size
open, as in `hexagon, not quite regular, 29.900 to 30.100 across flats`, the least and the largest part that they allow
are drawn.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.columns.path.moves import z_along
from polarcheck.foundation.finding import MadeInSection, MadeShape
from polarcheck.foundation.states import Motion
from polarcheck.geometry.cutter_compensation.offset_path import Phase
from polarcheck.geometry.plane import arc_sweep
from polarcheck.rules.tables import Tables

#: How far a drawn outline may be from what the cutters leave, and the sagitta of chords [mm].
TOLERANCE, SAGITTA = 0.01, 0.001
#: How deep behind the wall of a pocket a cut is looked for [mm].
BAND = 0.06
#: How far the Z of moves at one depth may differ, and what is taken as no length or no area [mm, mm2].
SAME_DEPTH, NOTHING = 1e-3, 1e-3
#: Half the side of what stands for the plane [mm].
FAR = 1e4

Values = Mapping[str, float]


class Mismatch(NamedTuple):
    """A shape that is not what the cutters leave: what differs, and by how much [mm, or mm2 of an area]."""

    line: int
    z: float | None
    text: str
    what: str
    size: float


class Drawn(NamedTuple):
    """
    The least and the largest area that the words allow: of a boss, or of a pocket.

    open: it is known only along its walls. middle: where these are to be looked for, of a shape that is open.
    """

    least: Any
    most: Any
    open: bool = False


class NotDrawnError(Exception):
    """The words are too few to draw the shape."""


# ---- what is drawn ----


def drawn_of(shape: MadeShape, values: Values) -> Drawn | None:
    """The shape from its words; None for one that is told by its extents alone."""
    name = shape.shape or ""
    if "x_least" in values:
        return None
    draw = _DRAWN_BY.get(name)
    if draw is None:
        if "across_flats" not in values:
            raise NotDrawnError(f"{name} with {sorted(values)}")
        draw = _regular
    found = draw(values)
    return Drawn(*(_at(area, values) for area in (found.least, found.most)), found.open)


def _at(area: Any, values: Values) -> Any:
    """An area about the axis, turned and moved to where the words say that it is."""
    turned = shapely.affinity.rotate(area, values.get("turned", 0.0), origin=(0, 0))
    return shapely.affinity.translate(turned, values.get("center_x", 0.0), values.get("center_c", 0.0))


def _disc(radius: float, center: complex = 0j) -> Any:
    """A circle, as a polygon whose chords leave it by SAGITTA at most."""
    return shapely.Point(center.real, center.imag).buffer(radius, quad_segs=_in_quarter(radius))


def _in_quarter(radius: float) -> int:
    return max(4, math.ceil(math.pi / 4 / math.acos(max(1 - SAGITTA / max(radius, SAGITTA), 0.5))))


def _half_plane(direction: complex, distance: float) -> Any:
    """The plane up to a line; direction: of its normal."""
    box = shapely.box(-FAR, -FAR, distance, FAR)
    return shapely.affinity.rotate(box, math.degrees(cmath.phase(direction)), origin=(0, 0))


def _within(directions: Sequence[complex], distances: Sequence[float]) -> Any:
    area = shapely.box(-FAR, -FAR, FAR, FAR)
    for direction, distance in zip(directions, distances, strict=True):
        area = area.intersection(_half_plane(direction, distance))
    return area


def _round_about(count: int) -> list[complex]:
    return [cmath.rect(1, math.tau * number / count) for number in range(count)]


def _with_corners(area: Any, values: Values) -> Drawn:
    """A polygon whose first corner is behind the side of direction 0, with its corners: sharp, round or chamfered."""
    name = "corner_chamfer" if "corner_chamfer" in values else "corner_radius"
    if name not in values:
        return Drawn(area, area)
    points = [complex(*point) for point in shapely.get_coordinates(area.exterior)[:-1]]
    points.sort(key=lambda point: cmath.phase(point) % math.tau)
    sizes = [values.get(f"corner_{number}", values[name]) for number in range(1, len(points) + 1)]
    if "corner_least" in values and "corner_1" not in values:
        raise NotDrawnError("which corner is how large is not said")
    for number, (corner, size) in enumerate(zip(points, sizes, strict=True)):
        beside = points[number - 1], points[(number + 1) % len(points)]
        area = _without_corner(area, corner, beside, size, is_round=name == "corner_radius")
    return Drawn(area, area)


def _without_corner(area: Any, corner: complex, beside: tuple[complex, complex], size: float, *, is_round: bool) -> Any:
    """The area without what a round or a chamfer takes off at a corner."""
    if not size:
        return area
    ways = [(other - corner) / abs(other - corner) for other in beside]
    half = abs(cmath.phase(ways[1] / ways[0])) / 2
    leg = size / math.tan(half) if is_round else size
    ends = [corner + way * leg for way in ways]
    taken = shapely.Polygon([(point.real, point.imag) for point in (corner, *ends)])
    if is_round:
        middle = (ways[0] + ways[1]) / abs(ways[0] + ways[1])
        taken = taken.difference(_disc(size, corner + middle * size / math.sin(half)))
    return area.difference(taken)


def _rounded(area: Any, radius: float) -> Any:
    if not radius:
        return area
    return area.buffer(-radius, join_style="mitre", mitre_limit=50).buffer(radius, quad_segs=_in_quarter(radius))


def _regular(values: Values) -> Drawn:
    count = round(values["sides"])
    size = values["across_flats"] / 2
    least, most = values.get("least", 2 * size) / 2, values.get("most", 2 * size) / 2
    areas = [_within(_round_about(count), [distance] * count) for distance in (least, most)]
    if "corner_diameter" in values:
        areas = [area.intersection(_disc(values["corner_diameter"] / 2)) for area in areas]
    found = [_with_corners(area, values) for area in areas]
    return Drawn(found[0].least, found[1].most)


def _circle(values: Values) -> Drawn:
    radius = values["diameter"] / 2
    if "chords" not in values:
        return Drawn(_disc(radius), _disc(radius))
    return Drawn(_disc(radius * math.cos(math.pi / values["chords"])), _disc(radius))


def _rectangle(values: Values) -> Drawn:
    half = values["length"] / 2, values["width"] / 2
    return _with_corners(shapely.box(-half[0], -half[1], *half), values)


def _round_with_flats(values: Values) -> Drawn:
    area = _disc(values["diameter"] / 2).intersection(_between_flats(values))
    return Drawn(area, area)


def _flats(values: Values) -> Drawn:
    area = _between_flats(values)
    return Drawn(area, area, open=True)


def _between_flats(values: Values) -> Any:
    """What flats leave: each where the words say that it is, else all alike; the first has the direction 0."""
    count = round(values["flats"])
    if "turned_1" not in values:
        return _within(_round_about(count), [values["distance"]] * count)
    numbers = range(1, count + 1)
    directions = [cmath.rect(1, math.radians(values[f"turned_{number}"] - values["turned"])) for number in numbers]
    return _within(directions, [values[f"distance_{number}"] for number in numbers])


def _slot(values: Values) -> Drawn:
    half = values["width"] / 2
    if "length" not in values:
        area = shapely.box(-FAR, -half, FAR, half)
        return Drawn(area, area, open=True)
    ends = values["length"] / 2 - values["radius"]
    area = shapely.box(-ends, -half, ends, half)
    area = area.union(_disc(values["radius"], complex(ends))).union(_disc(values["radius"], complex(-ends)))
    return Drawn(area, area)


def _keyway(values: Values) -> Drawn:
    half, bottom = values["width"] / 2, values["distance"]
    # The bottom is measured from the axis, and the middle line lies beside it.
    area = shapely.box(bottom + values.get("radius", 0.0), -half, FAR, half)
    if "radius" in values:
        area = area.union(_disc(values["radius"], complex(bottom + values["radius"])))
    return Drawn(area, area, open=True)


def _round_with_keyway(values: Values) -> Drawn:
    half, bottom, radius = values["width"] / 2, values["distance"], values["diameter"] / 2
    disc = _disc(radius)
    outward = bottom > radius
    end = values.get("radius", 0.0)
    box = shapely.box(0.0, -half, bottom - end, half) if outward else shapely.box(bottom + end, -half, FAR, half)
    if end:
        box = box.union(_disc(end, complex(bottom - end if outward else bottom + end)))
    box = _rounded(box, values.get("corner_radius", 0.0))
    for direction in _round_about(round(values["keyways"])):
        keyway = shapely.affinity.rotate(box, math.degrees(cmath.phase(direction)), origin=(0, 0))
        disc = disc.union(keyway) if outward else disc.difference(keyway)
    return Drawn(disc, disc)


def _cam(values: Values) -> Drawn:
    discs = [_disc(values["radius"]), _disc(values["radius_small"], complex(values["apart"]))]
    area = shapely.union_all(discs).convex_hull
    return Drawn(area, area)


def _cross(values: Values) -> Drawn:
    half = [values[name] / 2 for name in ("length", "width", "other_length", "other_width")]
    area = shapely.box(-half[0], -half[1], half[0], half[1]).union(shapely.box(-half[3], -half[2], half[3], half[2]))
    return Drawn(area, area)


_DRAWN_BY: Mapping[str, Callable[[Values], Drawn]] = {
    "circle": _circle,
    "rectangle": _rectangle,
    "round with flats": _round_with_flats,
    "flats": _flats,
    "slot": _slot,
    "keyway": _keyway,
    "round with keyway": _round_with_keyway,
    "cam": _cam,
    "cross": _cross,
}


# ---- what the cutters sweep ----


class Sweep(NamedTuple):
    """What the cutters sweep in some sections at one depth, and there or deeper; the largest R [mm]."""

    area: Any
    deeper: Any
    radius: float


def sweep_at(
    tables: Tables, sections: Sequence[int], z: float | None, turned: Sequence[float] = (), all_moves: bool = True
) -> Sweep:
    """
    What the cutters sweep in these sections with the tip at a depth, and at this depth or below.

    turned: for each of the sections, by what angle it is turned to be in the frame of the part [deg]. all_moves: also
    those before G41 and behind G40, in a section that has these.
    """
    trace, moves = tables["trace"], tables["tool_center"].moves
    before, after = z_along(trace, moves)
    if z is None:
        at_depth = deeper = np.isnan(after)
    else:
        at_depth = (np.abs(before - z) <= SAME_DEPTH) & (np.abs(after - z) <= SAME_DEPTH)
        deeper = np.fmax(before, after) <= z + SAME_DEPTH
    deeper &= moves.is_of_tool & (trace.axes.motion[moves.row] != Motion.RAPID)
    offset, radius = trace.offsets, trace.compensation.radius_of_move
    cutter = np.fmax(np.fmax(np.abs(offset.radius_of_offset), np.abs(radius)), offset.cutter_diameter / 2)[moves.row]
    deeper &= ~np.isnan(moves.start + moves.end) & (cutter > 0)
    if not all_moves:
        compensates = trace.mode.anywhere_in_section(trace.compensation.compensates)[moves.row]
        deeper &= ~compensates | (moves.phase != Phase.CANCELLED)
    areas: list[list[Any]] = [[], []]
    largest = 0.0
    for place, section in enumerate(sections):
        chosen = np.flatnonzero(deeper & (moves.section == section))
        swept = np.array(
            [
                _swept(moves.start[at], moves.end[at], moves.center[at], int(moves.kind[at]), float(cutter[at]))
                for at in chosen
            ],
            object,
        )
        for found, counts in zip(areas, (at_depth[chosen], np.ones(len(chosen), bool)), strict=True):
            area = shapely.union_all(swept[counts])
            found.append(shapely.affinity.rotate(area, turned[place], origin=(0, 0)) if turned else area)
        largest = max(largest, float(cutter[chosen].max(initial=0.0)))
    return Sweep(*(shapely.union_all(found) for found in areas), largest)


def _swept(start: complex, end: complex, center: complex, kind: int, radius: float) -> Any:
    points = [start, end]
    if kind in (Motion.CW, Motion.CCW) and not cmath.isnan(center):
        turn = float(arc_sweep(np.array([start]), np.array([end]), np.array([center]), np.array([kind]))[0])
        size = abs(start - center)
        count = max(8, math.ceil(abs(turn) / math.acos(max(1 - SAGITTA / max(size, SAGITTA), 0.5)) / 2))
        shares = np.linspace(0, 1, count + 1)
        grown = size + (abs(end - center) - size) * shares
        spoke = (start - center) / size
        points = list(center + spoke * grown * np.exp(1j * turn * shares))
    way = shapely.LineString([(point.real, point.imag) for point in points])
    return way.buffer(radius, quad_segs=_in_quarter(radius))


# ---- one laid over the other ----


def mismatches(
    tables: Tables, made: Sequence[MadeShape], bar: float = math.nan, all_moves: bool = True
) -> Iterator[Mismatch]:
    """
    Where shapes are not what the cutters leave at one of their depths.

    bar: diameter [mm]. all_moves: as in sweep_at.
    """
    for shape in made:
        if shape.shape is None or shape.needs is not None:
            continue
        if any(left.kind == "strip" for one in made if one.line == shape.line for left in one.left_standing):
            continue  # what stands beside the part is no part, and the words do not say where it ends
        for z in dict.fromkeys(shape.depths) or (None,):
            beside = [
                one for one in made if one is not shape and _share_sections(one, shape) and z in (one.depths or [None])
            ]
            best: list[Mismatch] | None = None
            for sections, turned in _sections_of(tables, shape):
                sweep = sweep_at(tables, sections, z, turned, all_moves)
                if sweep.area.is_empty:
                    continue
                found = list(_compared(shape, z, sweep, beside, bar))
                best = found if best is None or len(found) < len(best) else best
            yield from [Mismatch(shape.line, z, shape.text, "nothing is swept", 0.0)] if best is None else best


def _share_sections(one: MadeShape, other: MadeShape) -> bool:
    return not {part.line for part in one.sections}.isdisjoint(part.line for part in other.sections)


def _sections_of(tables: Tables, shape: MadeShape) -> list[tuple[list[int], list[float]]]:
    """The sections that make a shape, with their angles; a list for each way to take them."""
    trace = tables["trace"]
    lines = trace.blocks.line_in_file[trace.mode.sections.enter].tolist()
    entry = np.where(trace.path.knows_section_entry, trace.path.section_entry, np.nan)

    def of(one: MadeInSection) -> list[int]:
        return [
            number
            for number, line in enumerate(lines)
            if line == one.line
            and (
                math.isnan(entry[number])
                if one.angle is None
                else abs(math.sin((math.radians(entry[number] - one.angle)) / 2)) < 1e-6
            )
        ]

    angles = [one.angle or 0.0 for one in shape.sections]
    if len(shape.sections) == 1:
        return [([number], angles) for number in of(shape.sections[0])]
    numbers: list[int] = []
    for one in shape.sections:
        numbers.append(next(number for number in of(one) if number not in numbers))
    return [(numbers, angles)]


def _compared(
    shape: MadeShape, z: float | None, sweep: Sweep, beside: Sequence[MadeShape], bar: float
) -> Iterator[Mismatch]:
    def told(what: str, size: float) -> Mismatch:
        return Mismatch(shape.line, z, shape.text, what, round(size, 4))

    try:
        drawn = drawn_of(shape, shape.values)
    except NotDrawnError as error:
        yield told(f"cannot be drawn: {error}", 0.0)
        return
    if drawn is None:
        if any(left.kind != "corner" for one in (shape, *beside) for left in one.left_standing):
            return  # a rib joins what stands beside it
        yield from (told(what, size) for what, size in _measured(shape, sweep, bar))
        return
    limit = _disc(bar / 2) if not math.isnan(bar) else shapely.box(-FAR, -FAR, FAR, FAR)
    if drawn.open and math.isnan(bar):
        limit = _known_within(shape, drawn, sweep)
        if limit is None:
            yield told("its walls are not reached", 0.0)
            return
    if "joined" in shape.values:
        limit = limit.intersection(_disc(shape.values["joined"]))
    other, clear = _others(beside), limit.buffer(-TOLERANCE)
    if shape.inside:
        behind = drawn.most.buffer(BAND).difference(drawn.most.buffer(TOLERANCE))
        entered = sweep.area.intersection(behind).intersection(clear).difference(other)
        for boss in _bosses(beside):
            entered = entered.intersection(boss.buffer(-TOLERANCE))
    else:
        entered = sweep.area.intersection(drawn.least.buffer(-TOLERANCE)).intersection(clear).difference(other)
    if entered.area > NOTHING:
        wall = drawn.most.boundary if shape.inside else drawn.least.intersection(limit).boundary
        yield told("is cut into", max(wall.distance(shapely.Point(one)) for one in shapely.get_coordinates(entered)))
    line = _outline(shape, drawn, sweep)
    rounding = max(0.0, sweep.radius - shape.values.get("reach_beyond", sweep.radius))
    if sweep.radius > shape.values.get("corner_reach", sweep.radius):
        return  # more stands than can be drawn, and the words say so
    missed = line.intersection(clear.buffer(-rounding)).difference(sweep.deeper)
    for left in (left for one in (shape, *beside) for left in one.left_standing):
        if left.place is not None:
            missed = missed.difference(shapely.Point(left.place).buffer(2 * sweep.radius + 2 * left.size))
    far = max((sweep.deeper.distance(shapely.Point(one)) for one in shapely.get_coordinates(missed)), default=0.0)
    if far > 3 * SAGITTA:
        yield told("is not reached", TOLERANCE + far)


def _others(beside: Sequence[MadeShape]) -> Any:
    """What other shapes of this depth allow to be swept: pockets, and what is cleared round bosses is not looked at."""
    areas = []
    for one in beside:
        if one.inside and one.shape is not None:
            try:
                drawn = drawn_of(one, one.values)
            except NotDrawnError:
                drawn = None
            if drawn is None:
                values = one.values
                box = shapely.box(values["x_least"], values["c_least"], values["x_most"], values["c_most"])
                areas.append(box.buffer(2 * TOLERANCE))
            else:
                areas.append(drawn.most.buffer(2 * TOLERANCE))
    return shapely.union_all(areas)


def _reachable(shape: MadeShape, drawn: Drawn, radius: float) -> Any:
    """The largest part, with R of the cutter in its inside corners where the words speak of such."""
    if not shape.values.get("inside_corners"):
        return drawn.least if shape.inside else drawn.most
    size, segments = radius - SAGITTA, _in_quarter(radius)
    if shape.inside:
        return drawn.least.buffer(-size, quad_segs=segments).buffer(size, quad_segs=segments)
    return drawn.most.buffer(size, quad_segs=segments).buffer(-size, quad_segs=segments)


def _bosses(beside: Sequence[MadeShape]) -> Iterator[Any]:
    """What flats of this depth leave, in which a slot is cut."""
    for one in beside:
        if one.shape == "flats":
            yield drawn_of(one, one.values).least  # type: ignore[union-attr]


def _outline(shape: MadeShape, drawn: Drawn, sweep: Sweep) -> Any:
    """The line that must be swept: the outline, TOLERANCE within the air, R of the cutter in corners left apart."""
    reach = _reachable(shape, drawn, sweep.radius)
    return reach.buffer(-TOLERANCE).boundary if shape.inside else reach.buffer(TOLERANCE).boundary


def _known_within(shape: MadeShape, drawn: Drawn, sweep: Sweep) -> Any:
    """
    The circle about the axis within which the walls of an open shape are milled.

    The words do not say how large the bar is: each wall must be reached for some way, and counts as far as it is.
    """
    line = _outline(shape, drawn, sweep)
    near = line.intersection(_disc(sweep.area.hausdorff_distance(shapely.Point(0, 0)) + 1))
    reached = near.intersection(sweep.area)
    if reached.is_empty:
        return None
    missed = near.difference(sweep.area)
    parts = [part for part in shapely.get_parts(missed) if part.length > TOLERANCE]
    least = max(0.0, reached.distance(shapely.Point(0, 0)))
    ends = [part.distance(shapely.Point(0, 0)) for part in parts]
    limit = min([end for end in ends if end > least + 1e-6], default=FAR)
    return _disc(limit - TOLERANCE) if limit > least + 0.1 else None


def _measured(shape: MadeShape, sweep: Sweep, bar: float) -> Iterator[tuple[str, float]]:
    """What of extents and area differs from what the cutters leave; nothing of open shapes: their ends are unknown."""
    values = shape.values
    if "area" not in values:
        return
    told = np.array([values[name] for name in ("x_least", "c_least", "x_most", "c_most")])
    candidates = _areas_left(shape, sweep, bar)
    if not candidates:
        yield "there is no such area", 0.0
        return
    off = [float(np.abs(np.array(area.bounds) - told).max()) for area in candidates]
    best = int(np.argmin(off))
    area = candidates[best]
    corners = values.get("inside_corners", 0.0)
    if off[best] > TOLERANCE and not corners:
        yield "other extents", off[best]
    wrong = abs(area.area - values["area"]) / max(area.length, NOTHING)
    if wrong > TOLERANCE and not corners:
        yield "another area", wrong
    hollow = values.get("inside_radius", 0.0)
    if hollow > sweep.radius and not corners:
        size = hollow - 2 * TOLERANCE
        out, back = (-size, size) if shape.inside else (size, -size)
        opened = area.buffer(out, quad_segs=_in_quarter(size)).buffer(back, quad_segs=_in_quarter(size))
        left = opened.symmetric_difference(area).buffer(-TOLERANCE / 2)
        if left.area > NOTHING:
            yield "a smaller inside radius", left.area


def _areas_left(shape: MadeShape, sweep: Sweep, bar: float) -> list[Any]:
    """What the shape may be: of a groove what is swept, of a pocket with what stands in it, of a boss the rest."""
    swept = [part for part in shapely.get_parts(sweep.area) if part.area > NOTHING]
    if shape.shape == "groove":
        return swept
    if shape.inside:
        return [shapely.Polygon(part.exterior) for part in swept]
    if not math.isnan(bar):
        rest = _disc(bar / 2).difference(sweep.area)
        return [shapely.Polygon(part.exterior) for part in shapely.get_parts(rest) if part.area > NOTHING]
    return [shapely.Polygon(hole) for part in swept for hole in part.interiors]
