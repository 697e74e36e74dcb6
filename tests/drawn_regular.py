"""
Contours that repeat themselves, drawn at random, with one slip in each; and contours that are meant to differ.

    contour = regular_contour(random.Random(3))
    text = program(contour.points, machine, draw)
"""

from __future__ import annotations

import cmath
import math
import random
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from programs import machine_of, report_of

#: Controls whose words differ: addresses of the virtual axis, X as a diameter or a radius, codes of the mode.
CONTROLS = (
    "fanuc-30i",
    "fanuc-16i",
    "haas-lathe",
    "okuma-osp",
    "siemens-iso",
    "citizen",
    "mitsubishi-m700",
    "mazak-eia",
)


#: Controls with incremental words of their own.
_STEPS_BY_LETTER = ("fanuc-30i", "fanuc-16i", "haas-lathe", "citizen")


class Point(NamedTuple):
    """A corner of a contour (radius values, x + 1j*c), and R of the arc that leads to it, 0 for a line."""

    place: complex
    radius: float = 0.0


class Contour(NamedTuple):
    """A closed contour counterclockwise. size: its greatest distance from the center [mm]."""

    family: str
    points: list[Point]

    @property
    def size(self) -> float:
        return max(abs(point.place) for point in self.points)


# ---- shapes ----


def regular(draw: random.Random) -> Contour:
    count = draw.randint(5, 12)
    turn = draw.choice((0.0, math.pi / count, draw.uniform(0, 1)))
    size = draw.choice((draw.uniform(12, 30), float(draw.randint(12, 30)) / math.cos(math.pi / count)))
    return Contour(f"{count} sides", [Point(cmath.rect(size, turn + 2 * math.pi * at / count)) for at in range(count)])


def cut_corners(draw: random.Random) -> Contour:
    """A polygon or a rectangle with chamfers or arcs at its corners."""
    count = draw.choice((4, 4, 5, 6, 8))
    if count == 4:
        width, height = draw.uniform(10, 25), draw.uniform(10, 25)
        corners = [complex(width, height), complex(-width, height), complex(-width, -height), complex(width, -height)]
    else:
        corners = [cmath.rect(draw.randint(14, 28), 2 * math.pi * at / count + 0.2) for at in range(count)]
        corners = [cmath.rect(abs(corners[0]), cmath.phase(corner)) for corner in corners]
    cut = draw.uniform(1.5, 4)
    is_arc = draw.random() < 0.6
    points = []
    for at, corner in enumerate(corners):
        into = corner - corners[at - 1]
        out = corners[(at + 1) % count] - corner
        turn = abs(cmath.phase(out / into))
        leg = cut * math.tan(turn / 2)
        points += [
            Point(corner - into / abs(into) * leg),
            Point(corner + out / abs(out) * leg, cut if is_arc else 0.0),
        ]
    return Contour("round corners" if is_arc else "chamfers", points)


def star(draw: random.Random) -> Contour:
    count, size, less = draw.randint(3, 8), draw.uniform(15, 30), draw.uniform(0.5, 0.8)
    return Contour(
        "star",
        [Point(cmath.rect(size * (less if at % 2 else 1), math.pi * at / count)) for at in range(2 * count)],
    )


def gear(draw: random.Random) -> Contour:
    count, size, tooth = draw.randint(3, 8), draw.uniform(20, 30), draw.uniform(2, 5)
    points = []
    for at in range(count):
        middle, half = 2 * math.pi * at / count, math.pi / count / 2
        points += [
            Point(cmath.rect(radius, middle + angle))
            for radius, angle in (
                (size - tooth, -half * 1.2),
                (size, -half * 0.7),
                (size, half * 0.7),
                (size - tooth, half * 1.2),
            )
        ]
    return Contour("gear", points)


def cross(draw: random.Random) -> Contour:
    length, width = draw.uniform(18, 28), draw.uniform(6, 12)
    arm = [complex(length, -width), complex(length, width), complex(width, width)]
    return Contour("cross", [Point(point * 1j**turn) for turn in range(4) for point in arm])


REGULAR = (regular, regular, cut_corners, cut_corners, star, gear, cross)


def regular_contour(draw: random.Random) -> Contour:
    return draw.choice(REGULAR)(draw)


# ---- shapes that are meant to differ ----


def keyed(draw: random.Random) -> Contour:
    """A regular polygon with one flat nearer to the center, or farther out."""
    count = draw.choice((5, 6, 6, 8, 10))
    out = [draw.randint(14, 25) + draw.choice((0.0, 0.5))] * count
    out[draw.randrange(count)] *= draw.uniform(0.82, 0.98)
    if draw.random() < 0.5:
        out = [round(each, 1) for each in out]
    turn = draw.choice((0.0, math.pi / count, draw.uniform(0, 1)))
    points = []
    for at in range(count):
        first, second = out[at - 1], out[at]
        angle = 2 * math.pi / count
        # Where two lines at these distances from the center meet.
        along = (second - first * math.cos(angle)) / math.sin(angle)
        points.append(Point(complex(first, along) * cmath.exp(1j * (turn + angle * (at - 1)))))
    return Contour("keyed", points)


def free(draw: random.Random) -> Contour:
    count = draw.randint(5, 12)
    whole = draw.random() < 0.5
    angles = sorted(draw.uniform(0, 2 * math.pi) for _ in range(count))
    points = [cmath.rect(draw.uniform(10, 28), angle) for angle in angles]
    if whole:
        points = [complex(round(point.real), round(point.imag)) for point in points]
    return Contour("free", [Point(point) for point in points])


def stepped(draw: random.Random) -> Contour:
    """Sides along the axes, as a plate with steps."""
    xs = sorted(draw.sample(range(-25, 26), 4))
    cs = [draw.randint(5, 25) for _ in range(3)]
    low = -draw.randint(5, 20)
    points = [complex(xs[3], low), complex(xs[3], cs[2])]
    points += [complex(xs[2], cs[2]), complex(xs[2], cs[1]), complex(xs[1], cs[1]), complex(xs[1], cs[0])]
    points += [complex(xs[0], cs[0]), complex(xs[0], low)]
    return Contour("stepped", [Point(point) for point in points])


def house(draw: random.Random) -> Contour:
    width, low, wall = draw.randint(10, 25), -draw.randint(5, 20), draw.randint(2, 10)
    other = draw.choice((wall, wall + draw.randint(1, 5)))
    ridge = draw.choice((0, 0, draw.randint(-5, 5)))
    points = [complex(width, low), complex(width, wall), complex(ridge, wall + draw.randint(8, 12))]
    points += [complex(-width, other), complex(-width, low)]
    return Contour("house", [Point(point) for point in points])


def one_corner(draw: random.Random) -> Contour:
    """A rectangle with chamfers at its corners, one of them larger, or none there."""
    width, height, cut = draw.randint(12, 25), draw.randint(12, 25), draw.randint(1, 4)
    corners = [complex(width, height), complex(-width, height), complex(-width, -height), complex(width, -height)]
    odd, larger = draw.randrange(4), draw.choice((0, cut + draw.randint(1, 4), 2 * cut))
    points = []
    for at, corner in enumerate(corners):
        size = larger if at == odd else cut
        into, out = corner - corners[at - 1], corners[(at + 1) % 4] - corner
        if size == 0:
            points.append(Point(corner))
            continue
        points += [Point(corner - into / abs(into) * size), Point(corner + out / abs(out) * size)]
    return Contour("one corner", points)


def unlike_arms(draw: random.Random) -> Contour:
    """A cross with one arm longer, or wider."""
    length, width = draw.randint(18, 28), draw.randint(6, 12)
    lengths = [length] * 4
    lengths[draw.randrange(4)] += draw.choice((-3, -2, 2, 3, 5))
    points = []
    for turn in range(4):
        arm = [complex(lengths[turn], -width), complex(lengths[turn], width), complex(width, width)]
        points += [Point(point * 1j**turn) for point in arm]
    return Contour("unlike arms", points)


def d_shape(draw: random.Random) -> Contour:
    radius, flat = draw.uniform(12, 25), draw.uniform(4, 10)
    half = math.sqrt(radius**2 - flat**2)
    ends = [complex(flat, half), complex(-radius, 0), complex(flat, -half)]
    return Contour("D", [Point(ends[0]), Point(ends[1], radius), Point(ends[2], radius)])


def other_sides(draw: random.Random) -> Contour:
    """A hexagon or octagon that is longer in one direction."""
    count = draw.choice((6, 8))
    size, stretch = draw.uniform(12, 20), draw.choice((1.2, 1.5, 1.3, 0.8))
    corners = [cmath.rect(size, 2 * math.pi * (at + 0.5) / count) for at in range(count)]
    return Contour("stretched", [Point(complex(point.real * stretch, point.imag)) for point in corners])


MEANT = (keyed, keyed, free, stepped, house, one_corner, unlike_arms, d_shape, other_sides, *REGULAR)


# ---- programs ----


class Style(NamedTuple):
    """How a contour is written."""

    machine: str
    compensated: bool
    within_side: bool
    repeats_words: bool
    clockwise: bool
    incremental: bool
    by_center: bool
    inch: bool


def style(draw: random.Random) -> Style:
    machine = draw.choice(CONTROLS)
    return Style(
        machine,
        draw.random() < 0.7,
        draw.random() < 0.6,
        draw.random() < 0.3,
        draw.random() < 0.3,
        machine in _STEPS_BY_LETTER and draw.random() < 0.1,
        draw.random() < 0.4,
        draw.random() < 0.15,
    )


def number(value: float, places: int = 3) -> str:
    text = f"{value:.{places}f}".rstrip("0")
    return "0" if text in ("-0.", "0.") else text


def blocks_of(contour: Contour, how: Style) -> list[str]:
    """The blocks of a closed contour; the first one goes to where it begins."""
    points = contour.points
    if how.clockwise:
        points = [Point(point.place.conjugate(), point.radius) for point in points]
    count = len(points)
    # Begin where a line leads on.
    out = [
        at
        for at in range(count)
        if points[(at + 1) % count].radius == 0 and abs(points[at].place) > 0.98 * contour.size
    ]
    first = next(iter(out), next(at for at in range(count) if points[(at + 1) % count].radius == 0))
    order = [points[(first + 1 + at) % count] for at in range(count)]
    begin = points[first].place
    if how.within_side:
        begin = (begin + order[0].place) / 2
        order = [*order[:-1], Point(points[first].place, points[first].radius), Point(begin)]
    polar = machine_of(how.machine).polar
    virtual = polar.virtual_axis
    steps = {"X": "U", "C": "H", "Y": "V"}
    unit = 25.4 if how.inch else 1.0
    places = 4 if how.inch else 3
    factor = (2.0 if polar.x == "diameter" else 1.0) / unit

    def rounded(point: complex) -> tuple[float, float]:
        return round(point.real * factor, places), round(point.imag / unit, places)

    at = rounded(begin)
    blocks = [f"X{number(at[0], places)} {virtual}{number(at[1], places)}"]
    motion = ""
    for point in order:
        to = rounded(point.place)
        code = "" if point.radius == 0 else "G2" if how.clockwise else "G3"
        words = []
        for axis, old, new in (("X", at[0], to[0]), (virtual, at[1], to[1])):
            if how.incremental:
                if old != new:
                    words.append(f"{steps[axis]}{number(new - old, places)}")
            elif how.repeats_words or old != new:
                words.append(f"{axis}{number(new, places)}")
        if code:
            begin_place = complex(at[0] / factor, at[1] * unit)
            if how.by_center:
                center = _center(begin_place, point.place, point.radius, how.clockwise) - begin_place
                words += [f"I{number(center.real / unit, places)}", f"J{number(center.imag / unit, places)}"]
            else:
                words.append(f"{machine_of(how.machine).arcs.radius_word}{number(point.radius / unit, places)}")
        else:
            code = "G1"
        if words:
            blocks.append(" ".join(([code] if code != motion else []) + words))
            motion = code
        at = to
    return blocks


def _center(start: complex, end: complex, radius: float, clockwise: bool) -> complex:
    half = abs(end - start) / 2
    away = math.sqrt(max(radius**2 - half**2, 0.0))
    side = -1j if clockwise else 1j
    return (start + end) / 2 + side * (end - start) / abs(end - start) * away


#: What stands before G12.1, or behind it, beside what all controls take.
_PLANE = {"haas-lathe": "G17", "mazak-eia": "G17"}
_LIVE_TOOL = {"haas-lathe": ["M154", "M133 P2000"], "okuma-osp": ["M110", "SB=2000 M13"]}
_BESIDE = {"okuma-osp": " C0"}


def program(blocks: Sequence[str], contour: Contour, how: Style) -> str:
    """A program that goes to the side at which the contour begins, round it, and back."""
    polar = machine_of(how.machine).polar
    unit = 25.4 if how.inch else 1.0
    factor = (2.0 if polar.x == "diameter" else 1.0) / unit
    path = sound_path(contour, how)
    first, second = path[0], next(point for point in path if point != path[0])
    outward = (second - first) / abs(second - first) * (1j if how.clockwise else -1j)
    away = first + outward * 12
    far = f"X{number(away.real * factor)} {polar.virtual_axis}{number(away.imag / unit)}"
    side = ("G41 " if how.clockwise else "G42 ") if how.compensated else ""
    head = [
        *("O1", "G20" if how.inch else "G21", f"G40 G97 G98 {_PLANE.get(how.machine, 'G18')}", "T0101"),
        *_LIVE_TOOL.get(how.machine, []),
        *(f"G0 X{number(140 / unit, 1)} Z1. C0", polar.on[0] + _BESIDE.get(how.machine, "")),
    ]
    feed = "F5." if how.inch else "F200"
    body = [
        f"G1 {far} {feed}",
        f"{side}{blocks[0]}",
        *blocks[1:],
        f"G1 {'G40 ' * how.compensated}{far}",
        f"X{number(140 / unit, 1)}",
    ]
    return "\n".join([*head, *body, polar.off[0], "G0 Z20.", "M30"]) + "\n"


def sound_path(contour: Contour, how: Style) -> list[complex]:
    """The ends of the blocks of the contour without a slip."""
    return corners(blocks_of(contour, how), contour, how)


def findings(blocks: Sequence[str], contour: Contour, how: Style) -> list[tuple[str, str]]:
    """The rules and messages of all findings at or above warning."""
    report = report_of(program(blocks, contour, how), how.machine, "1:radius=1", "1:nose=0")
    return [(found.rule, found.message) for found in report.findings if found.severity != "note"]


# ---- slips ----

_WORD = re.compile(r"([XCYUHV])(-?)(\d*)\.(\d*)")


def _changed(change: Callable[[str, str, str, random.Random], str | None]) -> Callable[..., list[str] | None]:
    """A slip in one word of the contour."""

    def plant(blocks: list[str], draw: random.Random) -> list[str] | None:
        places = [(at, match) for at, block in enumerate(blocks) for match in _WORD.finditer(block)]
        at, match = draw.choice(places)
        new = change(match[2], match[3], match[4], draw)
        if new is None or float(new) == float(f"{match[2]}{match[3] or 0}.{match[4]}"):
            return None
        block = blocks[at]
        return [*blocks[:at], f"{block[: match.start()]}{match[1]}{new}{block[match.end() :]}", *blocks[at + 1 :]]

    return plant


def _swapped(sign: str, whole: str, rest: str, draw: random.Random) -> str | None:
    digits = whole + rest
    at = [at for at in range(len(digits) - 1) if digits[at] != digits[at + 1]]
    if not at:
        return None
    one = draw.choice(at)
    digits = digits[:one] + digits[one + 1] + digits[one] + digits[one + 2 :]
    return f"{sign}{digits[: len(whole)]}.{digits[len(whole) :]}"


def _lost(sign: str, whole: str, rest: str, draw: random.Random) -> str | None:
    digits = whole + rest
    if len(digits) < 2:
        return None
    one = draw.randrange(len(digits))
    if one < len(whole):
        return f"{sign}{whole[:one]}{whole[one + 1 :]}.{rest}"
    one -= len(whole)
    return f"{sign}{whole}.{rest[:one]}{rest[one + 1 :]}"


def _doubled(sign: str, whole: str, rest: str, draw: random.Random) -> str | None:
    if not whole:
        return None
    one = draw.randrange(len(whole))
    return f"{sign}{whole[: one + 1]}{whole[one:]}.{rest}"


def _point(sign: str, whole: str, rest: str, draw: random.Random) -> str | None:
    digits = whole + rest
    at = len(whole) + draw.choice((-1, 1))
    return f"{sign}{digits[:at]}.{digits[at:]}" if 0 <= at <= len(digits) else None


def _sign(sign: str, whole: str, rest: str, draw: random.Random) -> str | None:
    return f"{'' if sign else '-'}{whole}.{rest}"


def _factor(sign: str, whole: str, rest: str, draw: random.Random) -> str | None:
    return number(float(f"{sign}{whole or 0}.{rest}") * draw.choice((2, 0.5)))


def _neighbor(blocks: list[str], draw: random.Random) -> list[str] | None:
    at = draw.randrange(1, len(blocks))
    for match in _WORD.finditer(blocks[at]):
        other = next((one for one in _WORD.finditer(blocks[at - 1]) if one[1] == match[1]), None)
        if other is not None and other[0] != match[0]:
            new = blocks[at][: match.start()] + other[0] + blocks[at][match.end() :]
            return [*blocks[:at], new, *blocks[at + 1 :]]
    return None


def _word_lost(blocks: list[str], draw: random.Random) -> list[str] | None:
    at = draw.randrange(1, len(blocks))
    words = [*_WORD.finditer(blocks[at])]
    if len(words) < 2:
        return None
    match = draw.choice(words)
    new = (blocks[at][: match.start()] + blocks[at][match.end() :]).replace("  ", " ").strip()
    return [*blocks[:at], new, *blocks[at + 1 :]]


def _block_lost(blocks: list[str], draw: random.Random) -> list[str] | None:
    at = draw.randrange(1, len(blocks))
    code = re.match(r"G[123] ", blocks[at])
    behind = blocks[at + 1] if at + 1 < len(blocks) else ""
    if code and not behind.startswith("G"):
        return None
    return [*blocks[:at], *blocks[at + 1 :]]


def _all(letters: str, factor: float) -> Callable[..., list[str] | None]:
    def plant(blocks: list[str], draw: random.Random) -> list[str] | None:
        def other(match: re.Match[str]) -> str:
            return match[1] + number(float(match[0][1:]) * factor) if match[1] in letters else match[0]

        return [_WORD.sub(other, block) for block in blocks]

    return plant


SLIPS: dict[str, Callable[..., list[str] | None]] = {
    "digits swapped": _changed(_swapped),
    "digit lost": _changed(_lost),
    "digit doubled": _changed(_doubled),
    "point moved": _changed(_point),
    "sign": _changed(_sign),
    "factor of two": _changed(_factor),
    "neighbor's value": _neighbor,
    "word lost": _word_lost,
    "block lost": _block_lost,
    "all X halved": _all("XU", 0.5),
    "all X doubled": _all("XU", 2.0),
    "all C doubled": _all("CYHV", 2.0),
}


def corners(blocks: Sequence[str], contour: Contour, how: Style) -> list[complex]:
    """Where a contour goes, by a reading of its own: ends of lines and arcs."""
    polar = machine_of(how.machine).polar
    unit = 25.4 if how.inch else 1.0
    factor = (0.5 if polar.x == "diameter" else 1.0) * unit
    x = c = 0.0
    path = []
    for block in blocks:
        for match in _WORD.finditer(block):
            value = float(match[0][1:])
            if match[1] == "X":
                x = value * factor
            elif match[1] == "U":
                x += value * factor
            elif match[1] in "HV":
                c += value * unit
            else:
                c = value * unit
        path.append(complex(x, c))
    return path
