"""
Contours that setters mill on the face of a part, by construction [mm, X as a radius, x + 1j*c].

Each is travelled counterclockwise and begins where a cutter can come from +X (or from inside a pocket). `evidence`
names what tells, without a drawing, that one word of it is wrong: "regular" (equal sides, or symmetric with eight
pieces or more), "tangent" (every arc leaves its neighbours tangentially).
"""

from __future__ import annotations

import cmath
import math
import random
from collections.abc import Callable, Sequence
from typing import NamedTuple


class Piece(NamedTuple):
    """A line, or an arc where it has a center; ccw: its sense."""

    end: complex
    center: complex | None = None
    ccw: bool = True


class Contour(NamedTuple):
    """
    A contour.

    side: where the cutter is, "right" of the travel around a boss, "left" in a pocket. closed: it ends where it begins.
    size: what a comment says of it, in mm; empty where no plain word is. bar: the least bar that it fits in [mm].
    """

    name: str
    start: complex
    pieces: tuple[Piece, ...]
    side: str
    closed: bool
    evidence: frozenset[str]
    bar: float
    size: tuple[str, float] | None = None

    @property
    def is_pocket(self) -> bool:
        return "pocket" in self.name

    def points(self) -> list[complex]:
        return [self.start, *(piece.end for piece in self.pieces)]


Draw = random.Random
Grid = Callable[[float, float], float]
REGULAR, TANGENT = frozenset({"regular"}), frozenset({"tangent"})


def ring(corners: Sequence[complex], radii: Sequence[float] = (), chamfer: float = 0.0) -> tuple[complex, list[Piece]]:
    """A closed polygon from the middle of the side before its first corner, with arcs or chamfers at corners."""
    count = len(corners)
    start = (corners[-1] + corners[0]) / 2
    pieces: list[Piece] = []
    for index, corner in enumerate(corners):
        before, behind = corners[index - 1], corners[(index + 1) % count]
        back, on = (before - corner) / abs(before - corner), (behind - corner) / abs(behind - corner)
        radius = radii[index % len(radii)] if radii else 0.0
        if chamfer:
            pieces += [Piece(corner + back * chamfer), Piece(corner + on * chamfer)]
        elif radius:
            half = abs(cmath.phase(on / back)) / 2
            step = radius / math.tan(half)
            middle = (back + on) / abs(back + on) * radius / math.sin(half)
            is_left = (on / -back).imag > 0
            pieces += [Piece(corner + back * step), Piece(corner + on * step, corner + middle, is_left)]
        else:
            pieces.append(Piece(corner))
    return start, [*pieces, Piece(start)]


def polygon(count: int, across: float, turn: float = 0.0) -> list[complex]:
    """The corners of a regular polygon; the side before the first one faces +X where turn is 0."""
    size = across / 2 / math.cos(math.pi / count)
    return [cmath.rect(size, math.pi * (2 * index + 1) / count + turn) for index in range(count)]


NAMES = {5: "PENTAGON", 6: "HEX", 8: "OCTAGON", 10: "DECAGON", 12: "DODECAGON"}


def _regular(count: int, draw: Draw, grid: Grid, corner: str = "", turned: bool = False) -> Contour:
    across = grid(18, 50)
    turn = math.pi / count * draw.choice((0.5, 1, -0.5)) if turned else 0.0
    corners = polygon(count, across, turn)
    side = abs(corners[1] - corners[0])
    small = max(grid(0.08 * side, 0.25 * side), 0.5)
    start, pieces = ring(corners, (small,) if corner == "arcs" else (), small if corner == "chamfers" else 0.0)
    name = f"{count} sides" + (f" with {corner}" if corner else "") + (" turned" if turned else "")
    widest = max(abs(piece.end) for piece in pieces)
    evidence = REGULAR if count >= 5 or corner else frozenset[str]()
    word = (f"{'SQ' if count == 4 else NAMES.get(count, '')}", across) if count in (4, 6) else None
    return Contour(
        name,
        start,
        tuple(pieces),
        "right",
        True,
        evidence | (TANGENT if corner == "arcs" else frozenset()),
        2 * widest,
        word,
    )


def square(draw: Draw, grid: Grid) -> Contour:
    return _regular(4, draw, grid, draw.choice(("", "arcs", "chamfers")))


def hexagon(draw: Draw, grid: Grid) -> Contour:
    return _regular(6, draw, grid, draw.choice(("", "", "arcs", "chamfers")))


def hexagon_turned(draw: Draw, grid: Grid) -> Contour:
    return _regular(6, draw, grid, draw.choice(("", "arcs")), turned=True)


def octagon(draw: Draw, grid: Grid) -> Contour:
    return _regular(8, draw, grid)


def many_sides(draw: Draw, grid: Grid) -> Contour:
    return _regular(draw.choice((5, 7, 9, 10, 12)), draw, grid, "", draw.random() < 0.3)


def rectangle(draw: Draw, grid: Grid) -> Contour:
    width, height = grid(8, 18), grid(8, 18)
    kind = draw.choice(("", "arcs", "chamfers", "arcs"))
    corners = [complex(width, height), complex(-width, height), complex(-width, -height), complex(width, -height)]
    small = grid(1.5, min(width, height) * 0.6)
    start, pieces = ring(corners, (small,) if kind == "arcs" else (), small if kind == "chamfers" else 0.0)
    evidence = {"arcs": REGULAR | TANGENT, "chamfers": REGULAR}.get(kind, frozenset[str]())
    widest = max(abs(piece.end) for piece in pieces)
    return Contour(f"rectangle {kind}".strip(), start, tuple(pieces), "right", True, evidence, 2 * widest)


def d_shape(draw: Draw, grid: Grid) -> Contour:
    radius = grid(10, 24)
    flat = round(radius * draw.uniform(0.5, 0.85), 1)
    half = math.sqrt(radius * radius - flat * flat)
    pieces = [
        Piece(complex(flat, half)),
        Piece(complex(-radius, 0), 0j),
        Piece(complex(flat, -half), 0j),
        Piece(complex(flat, 0)),
    ]
    return Contour("D", complex(flat, 0), tuple(pieces), "right", True, frozenset({"concentric"}), 2 * radius)


def double_d(draw: Draw, grid: Grid) -> Contour:
    radius = grid(10, 24)
    flat = round(radius * draw.uniform(0.6, 0.85), 1)
    half = math.sqrt(radius * radius - flat * flat)
    ends = [complex(flat, half), complex(-flat, half), complex(-flat, -half), complex(flat, -half)]
    pieces = [Piece(ends[0]), Piece(ends[1], 0j), Piece(ends[2]), Piece(ends[3], 0j), Piece(complex(flat, 0))]
    return Contour(
        "round with two flats", complex(flat, 0), tuple(pieces), "right", True, frozenset({"concentric"}), 2 * radius
    )


def round_boss(draw: Draw, grid: Grid) -> Contour:
    radius = grid(8, 24)
    return Contour(
        "round", complex(radius, 0), _circle(0j, radius, draw.choice((2, 4, 4))), "right", True, TANGENT, 2 * radius + 2
    )


def eccentric(draw: Draw, grid: Grid) -> Contour:
    radius, aside = grid(8, 18), grid(2, 6)
    pieces = _circle(complex(aside, 0), radius, 4)
    return Contour(
        "eccentric round", complex(aside + radius, 0), pieces, "right", True, TANGENT, 2 * (radius + aside) + 2
    )


def _circle(center: complex, radius: float, count: int) -> tuple[Piece, ...]:
    return tuple(Piece(center + cmath.rect(radius, math.tau * (index + 1) / count), center) for index in range(count))


def obround(draw: Draw, grid: Grid) -> Contour:
    radius, half = grid(8, 14), grid(4, 10)
    return Contour(
        "obround",
        complex(radius, 0),
        _obround(0j, radius, half),
        "right",
        True,
        REGULAR | TANGENT,
        2 * (radius + half) + 2,
    )


def _obround(center: complex, radius: float, half: float) -> tuple[Piece, ...]:
    up, down = center + 1j * half, center - 1j * half
    return (
        Piece(up + radius), Piece(up + 1j * radius, up), Piece(up - radius, up), Piece(down - radius),
        Piece(down - 1j * radius, down), Piece(down + radius, down), Piece(center + radius),
    )  # fmt: skip


def cam(draw: Draw, grid: Grid) -> Contour:
    large, small = grid(9, 14), grid(4, 8)
    apart = grid(large + 2, large + 10)
    spoke = cmath.exp(1j * math.acos((large - small) / apart))
    low = spoke.conjugate()
    shift = -grid(2, 5)
    near, far = complex(shift, 0), complex(shift + apart, 0)
    pieces = (
        Piece(far + small * spoke, far), Piece(near + large * spoke), Piece(near - large, near),
        Piece(near + large * low, near), Piece(far + small * low), Piece(far + small, far),
    )  # fmt: skip
    bar = 2 * max(abs(far) + small, abs(near) + large) + 2
    return Contour("cam", far + small, pieces, "right", True, REGULAR | TANGENT, bar)


def free_contour(draw: Draw, grid: Grid) -> Contour:
    """An irregular shape with tangent arcs of several radii."""
    while True:
        count = draw.choice((5, 6, 7))
        angles = [(2 * index + 1) * math.pi / count + draw.uniform(-0.18, 0.18) for index in range(count)]
        corners = [cmath.rect(grid(16, 26), angle) for angle in angles]
        corners[-1] = complex(corners[0].real, -corners[0].imag * draw.uniform(0.7, 1.2))
        radii = [grid(1.5, 4) for _ in corners]
        turns = [((corners[(i + 1) % count] - corners[i]) / (corners[i] - corners[i - 1])) for i in range(count)]
        if all(0.25 < cmath.phase(turn) < 2 for turn in turns):
            break
    start, pieces = ring(corners, radii)
    return Contour("free contour", start, tuple(pieces), "right", True, TANGENT, 2 * max(abs(p.end) for p in pieces))


def cross(draw: Draw, grid: Grid) -> Contour:
    size, half, inner = grid(16, 24), grid(5, 8), grid(5.5, 7)
    quarter = [complex(size, half), complex(half, half), complex(half, size)]
    corners = [corner * 1j**number for number in range(4) for corner in quarter]
    start, pieces = ring(corners, (0.0, inner, 0.0))
    return Contour("cross", start, tuple(pieces), "right", True, REGULAR | TANGENT, 2 * abs(complex(size, half)))


def two_flats(draw: Draw, grid: Grid) -> Contour:
    """Two flats, and a way around the bar from one to the other."""
    bar = grid(20, 44)
    flat, beyond = round(bar / 2 * draw.uniform(0.6, 0.85), 1), bar / 2 + grid(1, 3)
    half = math.sqrt(beyond * beyond - flat * flat)
    pieces = (Piece(complex(flat, half)), Piece(complex(-flat, half), 0j), Piece(complex(-flat, -half)))
    return Contour("two flats", complex(flat, -half), pieces, "right", False, frozenset({"concentric"}), bar)


def one_flat(draw: Draw, grid: Grid) -> Contour:
    bar = grid(20, 44)
    flat = round(bar / 2 * draw.uniform(0.6, 0.85), 1)
    half = math.ceil(math.sqrt(bar * bar / 4 - flat * flat)) + draw.choice((6.0, 8.0, 10.0))
    return Contour("one flat", complex(flat, -half), (Piece(complex(flat, half)),), "right", False, frozenset(), bar)


def slot(draw: Draw, grid: Grid) -> Contour:
    bar, half = grid(24, 44), grid(5, 8)
    far = math.ceil(bar / 2) + 8.0
    pieces = (Piece(complex(-far, half)), Piece(complex(-far, -half)), Piece(complex(far, -half)))
    return Contour("slot", complex(far, half), pieces, "left", False, frozenset(), bar)


def keyway(draw: Draw, grid: Grid) -> Contour:
    bar, half = grid(30, 50), grid(3, 6)
    # No cutter comes to X0, where C has no angle.
    far, bottom = math.ceil(bar / 2) + 8.0, max(round(bar / 2 - half - draw.uniform(2, 6), 0), half + 0.5)
    if draw.random() < 0.6:
        middle = complex(bottom, 0)
        turn = [Piece(middle + 1j * half), Piece(middle - half, middle), Piece(middle - 1j * half, middle)]
    else:
        turn = [Piece(complex(bottom, half)), Piece(complex(bottom, -half))]
    pieces = (*turn, Piece(complex(far, -half)))
    evidence = TANGENT if len(turn) == 3 else frozenset[str]()
    return Contour("keyway", complex(far, half), pieces, "left", False, evidence, bar)


def pocket(draw: Draw, grid: Grid) -> Contour:
    width, height = grid(11, 18), grid(11, 18)
    corners = [complex(width, height), complex(-width, height), complex(-width, -height), complex(width, -height)]
    start, pieces = ring(corners, (grid(5.5, 8),))
    return Contour("pocket", start, tuple(pieces), "left", True, REGULAR | TANGENT, 2 * abs(corners[0]) + 8)


def round_pocket(draw: Draw, grid: Grid) -> Contour:
    radius = grid(9, 18)
    return Contour(
        "round pocket",
        complex(radius, 0),
        _circle(0j, radius, draw.choice((2, 4))),
        "left",
        True,
        TANGENT,
        2 * radius + 8,
    )


def pocket_aside(draw: Draw, grid: Grid) -> Contour:
    """A small pocket beside the center, round or long."""
    radius, aside = grid(5.5, 7.5), grid(13, 18)
    half = grid(3, 6) if draw.random() < 0.5 else 0.0
    center = complex(aside, 0)
    pieces = _obround(center, radius, half) if half else _circle(center, radius, 4)
    return Contour("pocket aside", center + radius, pieces, "left", True, TANGENT, 2 * (aside + radius + half) + 8)


def keyed_hexagon(draw: Draw, grid: Grid) -> Contour:
    """A hexagon of which one flat lies farther in, as it is meant."""
    across = grid(24, 46)
    corners = polygon(6, across)
    keyed = across / 2 - grid(1.5, 2.5)
    flat = -keyed if draw.random() < 0.5 else None
    if flat is None:
        return _keyed_across(across, keyed, corners)
    slope = math.tan(math.pi / 6)
    corners[2] = complex(flat, across / 2 / math.cos(math.pi / 6) + flat * slope)
    corners[3] = corners[2].conjugate()
    start, pieces = ring(corners)
    return Contour("keyed hexagon", start, tuple(pieces), "right", True, frozenset(), 2 * abs(corners[0]))


def _keyed_across(across: float, keyed: float, corners: list[complex]) -> Contour:
    """The flat with the start is the one."""
    slope = math.tan(math.pi / 6)
    corners[5] = complex(keyed, -(across / 2 / math.cos(math.pi / 6) - keyed * slope))
    corners[0] = corners[5].conjugate()
    start, pieces = ring(corners)
    return Contour("keyed hexagon", start, tuple(pieces), "right", True, frozenset(), 2 * max(abs(c) for c in corners))


def keyed_rectangle(draw: Draw, grid: Grid) -> Contour:
    """A rectangle with rounded corners, one of them larger."""
    width, height = grid(10, 18), grid(10, 18)
    corners = [complex(width, height), complex(-width, height), complex(-width, -height), complex(width, -height)]
    small = grid(1.5, 3)
    start, pieces = ring(corners, (small, small, small * draw.choice((1.5, 2.0)), small))
    widest = max(abs(piece.end) for piece in pieces)
    return Contour("keyed rectangle", start, tuple(pieces), "right", True, TANGENT, 2 * widest)


def free_polygon(draw: Draw, grid: Grid) -> Contour:
    """An irregular convex polygon."""
    while True:
        count = draw.choice((5, 6, 7))
        angles = [(2 * index + 1) * math.pi / count + draw.uniform(-0.2, 0.2) for index in range(count)]
        corners = [cmath.rect(grid(14, 24), angle) for angle in angles]
        corners = [complex(round(corner.real, 2), round(corner.imag, 2)) for corner in corners]
        turns = [((corners[(i + 1) % count] - corners[i]) / (corners[i] - corners[i - 1])) for i in range(count)]
        if all(0.25 < cmath.phase(turn) < 2 for turn in turns):
            break
    start, pieces = ring(corners)
    return Contour("free polygon", start, tuple(pieces), "right", True, frozenset(), 2 * max(abs(c) for c in corners))


def lobes(draw: Draw, grid: Grid) -> Contour:
    """Three or four arcs that meet in corners."""
    count, radius = draw.choice((3, 4)), grid(18, 30)
    aside = radius * draw.uniform(0.2, 0.35)
    turn = math.pi / count
    size = math.sqrt(radius**2 - (aside * math.sin(turn)) ** 2) - aside * math.cos(turn)
    ends = [cmath.rect(size, turn * (2 * index + 1)) for index in range(count)]
    centers = [cmath.rect(-aside, turn * 2 * index) for index in range(count)]
    first = complex(radius - aside, 0)
    pieces = [Piece(ends[0], centers[0])]
    pieces += [Piece(ends[index], centers[index]) for index in range(1, count)]
    pieces.append(Piece(first, centers[0]))
    return Contour("lobes", first, tuple(pieces), "right", True, frozenset({"concentric"}), 2 * size)


def zigzag(draw: Draw, grid: Grid) -> Contour:
    """Lines to and fro across the face."""
    bar, step = grid(20, 36), 5.0
    far = math.ceil(bar / 2) + 9.0
    count = 2 * math.ceil(bar / 2 / step)
    rows = [step * (count / 2 - 0.5 - index) for index in range(count)]
    pieces: list[Piece] = []
    for index, row in enumerate(rows):
        side = -1 if index % 2 == 0 else 1
        pieces += [Piece(complex(side * far, row))]
        pieces += [Piece(complex(side * far, rows[index + 1]))] if index + 1 < count else []
    return Contour("zigzag", complex(far, rows[0]), tuple(pieces), "right", False, frozenset(), bar)


SHAPES: dict[str, Callable[[Draw, Grid], Contour]] = {
    shape.__name__: shape
    for shape in (
        hexagon, square, octagon, many_sides, hexagon_turned, one_flat, two_flats, d_shape, double_d, round_boss,
        eccentric, rectangle, obround, cam, free_contour, cross, slot, keyway, pocket, round_pocket, pocket_aside,
        keyed_hexagon, keyed_rectangle, free_polygon, lobes, zigzag,
    )
}  # fmt: skip


def mirrored(contour: Contour) -> Contour:
    """Mirrored at the X axis: travelled the other way, the cutter on the other side."""
    pieces = tuple(
        Piece(piece.end.conjugate(), None if piece.center is None else piece.center.conjugate(), not piece.ccw)
        for piece in contour.pieces
    )
    side = {"left": "right", "right": "left"}[contour.side]
    return contour._replace(start=contour.start.conjugate(), pieces=pieces, side=side)


def led(contour: Contour, form: str, radius: float) -> Contour:
    """
    The contour as it is milled from another start, where the form of lead fits it.

    form: "corner": from the corner before its first side; "extension": on its sides extended beyond that corner;
    "overlap": on beyond its start. radius: of the cutter [mm].
    """
    first, last, pieces = contour.pieces[0], contour.pieces[-1], contour.pieces
    is_round = first.center is not None or last.center is not None
    if not contour.closed or is_round or len(pieces) < 4:
        return contour
    way, reach = first_direction(contour), radius + 1.5
    if form == "overlap":
        reach = min(1.5, abs(first.end - contour.start) / 2)
        return contour._replace(pieces=(*pieces[:-1], Piece(contour.start + way * reach)))
    corner = pieces[-2].end
    is_sharp = pieces[-2].center is None and not contour.is_pocket
    if form not in ("corner", "extension") or not is_sharp:
        return contour
    arriving = (corner - pieces[-3].end) / abs(corner - pieces[-3].end)
    turn = (way / arriving).imag * (1 if contour.side == "right" else -1)
    if turn <= 0.1:
        return contour
    reach = reach if form == "extension" else 0.0
    return contour._replace(start=corner - way * reach, pieces=(*pieces[:-2], Piece(corner + arriving * reach)))


def shifted(contour: Contour, by: float) -> Contour:
    """The contour at a distance on the cutter's side: of a roughing pass, or the path of the cutter's center."""
    sign = -1j if contour.side == "right" else 1j
    starts = contour.points()
    directions = [_directions(start, piece) for start, piece in zip(starts, contour.pieces, strict=False)]
    count = len(contour.pieces)
    joints = []
    for index in range(count + 1):
        before = directions[index - 1][1] if index or contour.closed else None
        behind = directions[index % count][0] if index < count or contour.closed else None
        joints.append(_joint(contour, index, before, behind, by, sign))
    pieces = tuple(piece._replace(end=joint) for piece, joint in zip(contour.pieces, joints[1:], strict=True))
    return contour._replace(start=joints[0], pieces=pieces)


def _joint(
    contour: Contour, index: int, before: complex | None, behind: complex | None, by: float, sign: complex
) -> complex:
    point = contour.points()[index]
    if before is None or behind is None:
        return point + sign * (behind or before or 1) * by
    first, last = sign * before, sign * behind
    if abs(first - last) < 1e-6:
        return point + first * by
    one, other = contour.pieces[index - 1], contour.pieces[index % len(contour.pieces)]
    if one.center is None and other.center is None:
        return point + (first + last) / (1 + (first * last.conjugate()).real) * by
    if one.center is not None and other.center is not None:
        return _joint_of_arcs(point, (one.center, first), (other.center, last), by)
    arc, line = (one, behind) if one.center is not None else (other, before)
    assert arc.center is not None
    normal = sign * line
    size = abs(point - arc.center)
    outward = ((point - arc.center) / size * (sign * (behind if arc is other else before)).conjugate()).real
    size += by * (1 if outward > 0 else -1)
    base = point + normal * by - arc.center
    along = (base * line.conjugate()).real
    away = abs(base - along * line)
    step = math.sqrt(max(size * size - away * away, 0.0))
    places = [arc.center + base - along * line + line * way for way in (step, -step)]
    return min(places, key=lambda place: abs(place - point))


def _joint_of_arcs(
    point: complex, before: tuple[complex, complex], behind: tuple[complex, complex], by: float
) -> complex:
    """Where two arcs meet at a distance; of each its center and the normal at the point where they meet as drawn."""
    sizes = [
        abs(point - center) + (by if ((point - center) * normal.conjugate()).real > 0 else -by)
        for center, normal in (before, behind)
    ]
    way = behind[0] - before[0]
    along = (abs(way) ** 2 + sizes[0] ** 2 - sizes[1] ** 2) / (2 * abs(way))
    aside = math.sqrt(max(sizes[0] ** 2 - along**2, 0.0))
    places = [before[0] + way / abs(way) * complex(along, side) for side in (aside, -aside)]
    return min(places, key=lambda place: abs(place - point))


def _directions(start: complex, piece: Piece) -> tuple[complex, complex]:
    if piece.center is None:
        way = (piece.end - start) / abs(piece.end - start)
        return way, way
    turn = 1j if piece.ccw else -1j
    return (
        turn * (start - piece.center) / abs(start - piece.center),
        turn * (piece.end - piece.center) / abs(piece.end - piece.center),
    )


def first_direction(contour: Contour) -> complex:
    return _directions(contour.start, contour.pieces[0])[0]


def last_direction(contour: Contour) -> complex:
    starts = contour.points()
    return _directions(starts[-2], contour.pieces[-1])[1]
