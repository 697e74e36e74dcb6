"""
What families of contours have in common: cutters, depths, corners, and loops round a contour with their leads.

Random choices are drawn here as in contour_families.py, from the generator of numbers that is handed in.
"""

from __future__ import annotations

import cmath
import math
import random
from typing import Any, NamedTuple

import shapely  # type: ignore[import-untyped]
from contour_pieces import (
    LEADS,
    Depths,
    Lead,
    Piece,
    Step,
    Way,
    begun_at,
    first_of,
    lead_in,
    lead_out,
    log_uniform,
    loop_of,
    polygon,
    polygon_of,
    reversed_way,
    turned,
)


class Outline(NamedTuple):
    """A closed way; what is within is part, or is not; later ones override."""

    way: Way
    is_part: bool


class Shape(NamedTuple):
    """A program before it is written. bar: diameter of the stock, where the part is cut out of it and not closed."""

    steps: list[Step]
    outlines: list[Outline]
    radius: float
    bar: float | None = None
    endless: bool = False  # all that no outline names is part: pockets
    safe: float = 2.0
    may_stay: bool = True  # at one depth from before G12.1 on


def cutter(rng: random.Random, size: float) -> float:
    """A cutter, from very small to twice the part."""
    return round(log_uniform(rng, 0.02, 0.6 * size) if rng.random() < 0.7 else rng.uniform(0.1, 2) * size, 3)


def cutter_within(rng: random.Random, room: float) -> float:
    """A cutter that fits into a room, mostly."""
    share = rng.uniform(0.05, 0.6) if rng.random() < 0.8 else rng.uniform(0.6, 1.5)
    return round(max(share * room, 0.02), 3)


def heights(rng: random.Random, safe: float, several: bool = False) -> Depths:
    deep = -round(rng.uniform(0.5, 8), 2)
    kind = rng.random()
    contour = tuple(round(deep * number / 3, 2) for number in (1, 2, 3)) if several else (deep,)
    if kind < (0.4 if several else 0.7):
        return Depths(safe, contour[0], contour)
    if kind < 0.9:
        return Depths(safe, safe, contour)
    return Depths(safe, round(contour[0] / 2, 2), contour)


def begun_anywhere(rng: random.Random, way: Way) -> Way:
    """A closed way from a corner or from anywhere."""
    number = rng.randrange(len(way))
    return begun_at(way, number, 0 if rng.random() < 0.35 else rng.uniform(0.1, 0.9))


def closed_loop(
    rng: random.Random,
    way: Way,
    inside: bool,
    radius: float,
    depths: Depths,
    passes: list[Way] | None = None,
    repeat: bool = False,
) -> list[Step]:
    """
    A loop round a closed way that runs counterclockwise, with leads; inside: the tool is within it.

    passes: ways before it, in one loop with it. repeat: the way at each depth, so that it ends where it starts.
    """
    left = inside
    before = [piece for one in passes or [] for piece in one]
    style_in, style_out = rng.choice(LEADS), rng.choice(LEADS)
    if rng.random() < 0.6:
        style_out = style_in
    overlap = 0.0
    if not repeat and rng.random() < 0.35:
        overlap = rng.uniform(0.1, 4) * radius
        overlap = min(overlap, 0.9 * sum(piece.length for piece in way))
    whole = [*way, *first_of(way, overlap)]
    if before:
        whole = [*joined(before, whole[0].start), *whole]
    room = polygon_of(passes[0] if passes else way).buffer(-radius) if inside else None
    careless = rng.random() < 0.1
    ins = out = Lead(0j, [])
    for _ in range(40):
        ins = lead_in(rng, style_in, whole[0].start, whole[0].tangent(0), left, radius)
        out = lead_out(rng, style_out, whole[-1].end, whole[-1].tangent(1), left, radius)
        ends = [ins.ramp, out.ramp] + [piece.start for piece in ins.way] + [piece.end for piece in out.way]
        if careless or room is None or all(room.contains(point_of(end)) for end in ends):
            break
        style_in, style_out = rng.choice(LEADS), rng.choice(LEADS)
    if rng.random() < 0.05:  # from the other side of the part
        size = max(abs(piece.at(0.5) - whole[0].start) for piece in way)
        ins = ins._replace(ramp=whole[0].start + (whole[0].start - ins.ramp) / radius * size)
    return loop_of(ins, whole, out, left, depths)


def joined(before: Way, to: complex) -> Way:
    """Ways one after the other, with lines from the end of each to the start of the next."""
    found: Way = []
    for piece, follows in zip(before, [*before[1:], None], strict=True):
        found.append(piece)
        goal = to if follows is None else follows.start
        if abs(goal - piece.end) > 1e-6:
            found.append(Piece("line", piece.end, goal))
    return found


def point_of(point: complex) -> Any:
    return shapely.Point(point.real, point.imag)


def corners_of(rng: random.Random, size: float) -> list[complex]:
    """Corners of a regular, an uneven or a star-shaped polygon, counterclockwise; some with a notch or a wrong one."""
    count = rng.randint(3, 12)
    kind = rng.random()
    spread = 0 if kind < 0.45 else 0.15 if kind < 0.8 else 0.5
    angles = [math.tau * (number + rng.uniform(-0.3, 0.3) * (spread > 0)) / count for number in range(count)]
    corners = [cmath.rect(size * (1 - rng.uniform(0, spread)), angle) for angle in angles]
    fault = rng.random()
    if fault < 0.1:  # a notch, perhaps wider at its bottom
        at = rng.randrange(count)
        one, other = corners[at], corners[(at + 1) % count]
        along, inward = (other - one) / abs(other - one), (other - one) / abs(other - one) * 1j
        middle, half, deep = (one + other) / 2, abs(other - one) * rng.uniform(0.05, 0.3), size * rng.uniform(0.05, 0.4)
        bottom = half * rng.uniform(0.2, 1.6)
        notch = [middle - along * half, middle - along * bottom + inward * deep]
        notch += [middle + along * bottom + inward * deep, middle + along * half]
        corners[at + 1 : at + 1] = notch
    elif fault < 0.18:  # a wrong coordinate
        at = rng.randrange(count)
        wrong = size * rng.choice((0.02, 0.1, 0.5, 1.0)) * rng.uniform(-1, 1)
        corners[at] += wrong if rng.random() < 0.5 else 1j * wrong
    area = polygon_of(polygon(corners))
    if not area.is_valid or shapely.minimum_clearance(area) < 0.05 or not area.exterior.is_ccw:
        return corners_of(rng, size)
    return corners


def placed(rng: random.Random, corners: list[complex], size: float) -> list[complex]:
    """Turned, and perhaps off the center."""
    direction = turned(rng) if rng.random() < 0.7 else 1 + 0j
    center = size * rng.uniform(0, 0.8) * turned(rng) if rng.random() < 0.4 else 0j
    return [center + corner * direction for corner in corners]


def circle(center: complex, radius: float, begin: complex = 1 + 0j) -> Way:
    start = center + radius * begin
    return [Piece("ccw", start, start, center)]


def room_in(way: Way) -> float:
    """About the largest radius that fits into a closed way."""
    area = polygon_of(way)
    return float(shapely.maximum_inscribed_circle(area, 0.05).length)


def rounded(corners: list[complex], radius: float) -> Way:
    """A convex polygon with round corners."""
    found: Way = []
    for before, at, behind in zip([corners[-1], *corners[:-1]], corners, [*corners[1:], corners[0]], strict=True):
        one, other = (before - at) / abs(before - at), (behind - at) / abs(behind - at)
        half = abs(cmath.phase(one / other)) / 2
        cut = radius / math.tan(half)
        begin, end = at + one * cut, at + other * cut
        center = at + (one + other) / abs(one + other) * radius / math.sin(half)
        if found:
            found.append(Piece("line", found[-1].end, begin))
        found.append(Piece("ccw", begin, end, center))
    return [*found, Piece("line", found[-1].end, found[0].start)]


def open_loop(rng: random.Random, way: Way, left: bool, radius: float, height: Depths) -> list[Step]:
    """A loop along an open way, in the direction in which it is given or the other."""
    if rng.random() < 0.5:
        way, left = reversed_way(way), not left
    ins = lead_in(rng, rng.choice(LEADS), way[0].start, way[0].tangent(0), left, radius)
    out = lead_out(rng, rng.choice(LEADS), way[-1].end, way[-1].tangent(1), left, radius)
    return loop_of(ins, way, out, left, height)


def direct_loop(way: Way, left: bool, radius: float, room: float, height: Depths) -> list[Step]:
    """A loop whose ramps lie ahead of the first block and behind the last, in the middle of the room."""
    inward = 1j if left else -1j
    first, last = way[0], way[-1]
    begin = first.start - first.tangent(0) * (radius * 1.3 + 1) + inward * first.tangent(0) * room
    end = last.end + last.tangent(1) * (radius * 1.3 + 1) + inward * last.tangent(1) * room
    return loop_of(Lead(begin, []), way, Lead(end, []), left, height)
