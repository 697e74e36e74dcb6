"""
Contours of lines and arcs, drawn at random and written as setters of many controls write them, and single slips.

    drawn = contour(7)
    drawn.text(), drawn.machine, drawn.tools

A contour is sound. A slip changes one word or one block of it.
"""

from __future__ import annotations

import cmath
import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Control:
    """How a control is written: codes, addresses, and whether X is a diameter in the mode."""

    machine: str
    head: tuple[str, ...]
    on: str
    off: str
    end: tuple[str, ...]
    virtual: str = "C"
    step: str = "H"
    radius_word: str = "R"
    diameter: bool = True
    code: dict[str, str] = field(default_factory=dict)
    unit: float = 1.0


_FANUC_HEAD = ("O1", "G21 G40 G97 G98", "T0101", "G28 H0", "M13 S3000")
_END = ("G0 X100. Z50.", "M30")
CONTROLS = (
    Control("fanuc", _FANUC_HEAD, "G12.1", "G13.1", _END),
    Control("fanuc-30i", _FANUC_HEAD, "G12.1", "G13.1", _END),
    Control("doosan", _FANUC_HEAD, "G12.1", "G13.1", _END),
    Control("siemens-iso", _FANUC_HEAD, "G12.1", "G13.1", _END),
    Control("mazak-eia", (*_FANUC_HEAD, "M200"), "G12.1", "G13.1", _END),
    Control("fanuc", ("O1", "G20 G40 G97 G98", "T0101", "G28 H0", "M13 S3000"), "G12.1", "G13.1", _END, unit=25.4),
    Control(
        "haas-lathe",
        ("O1", "G21 G40 G97 G98", "M154", "G28 H0", "T0101", "G17", "M133 P2000"),
        "G112",
        "G113",
        ("G18", "M135", "M155", *_END),
        "Y",
        "V",
        diameter=False,
    ),
    Control("mitsubishi-m700", ("O1", "G21 G17 G90 G94 G40 G97", "T0101"), "G12.1", "G13.1", _END, diameter=False),
    Control(
        "okuma-osp",
        ("O1", "G97 G40 G94", "M110", "T0101", "SB=1500 M13"),
        "G137 C0",
        "G136",
        ("M12", "M109", *_END),
        "Y",
        "",
        "L",
        diameter=False,
        code={"G1": "G101", "G2": "G102", "G3": "G103"},
    ),
)


@dataclass(frozen=True)
class Element:
    """A line or an arc to a point; center None for lines, left: counterclockwise. Radius values, x + 1j*c [mm]."""

    end: complex
    center: complex | None = None
    left: bool = True


@dataclass(frozen=True)
class Drawn:
    """A contour and how it is written."""

    family: str
    start: complex
    elements: tuple[Element, ...]
    control: Control
    side: str
    away: complex
    radius: float
    by_radius: bool
    incremental: bool
    depths: tuple[float, ...]
    has_arcs: bool = True

    @property
    def machine(self) -> str:
        return self.control.machine

    @property
    def tools(self) -> tuple[str, ...]:
        return tuple(f"{number}:radius={self.radius / self.control.unit:.6g},nose=0" for number in (1, 8))

    def number(self, value: float) -> str:
        text = f"{value / self.control.unit:.{4 if self.control.unit > 1 else 3}f}".rstrip("0")
        return "0." if text in ("-0.", "0.") else text

    def x(self, value: float) -> str:
        return self.number(value * (2 if self.control.diameter else 1))

    def blocks(self) -> list[str]:
        """The program block by block."""
        control = self.control
        code = {"G1": "G1", "G2": "G2", "G3": "G3", **control.code}
        far = self.number(2 * abs(self.away))
        blocks = [*control.head, f"G0 X{far} Z{self.number(2)} C0", control.on]
        blocks.append(f"{code['G1']} X{self.x(self.away.real)} {control.virtual}{self.number(self.away.imag)} F200.")
        for depth in self.depths:
            blocks.append(f"Z{self.number(-depth)}")
            blocks += self.loop()
        return [*blocks, f"Z{self.number(2)}", control.off, *control.end]

    def loop(self) -> list[str]:
        """The blocks of one pass, from G41 or G42 to G40; G1 is in force before and behind them."""
        control = self.control
        code = {"G1": "G1", "G2": "G2", "G3": "G3", **control.code}
        start = self.start
        blocks = [f"{self.side} X{self.x(start.real)} {control.virtual}{self.number(start.imag)}"]
        motion, at = "G1", self._rounded(start)
        for element in self.elements:
            end = self._rounded(element.end)
            new = "G1" if element.center is None else "G3" if element.left else "G2"
            words = [code[new]] * (new != motion)
            moved = end - at
            if self.incremental:
                words += [f"U{self.x(moved.real)}"] * (abs(moved.real) > 1e-9)
                words += [f"{control.step}{self.number(moved.imag)}"] * (abs(moved.imag) > 1e-9)
            else:
                words += [f"X{self.x(end.real)}"] * (abs(moved.real) > 1e-9 or new != "G1")
                words += [f"{control.virtual}{self.number(end.imag)}"] * (abs(moved.imag) > 1e-9 or new != "G1")
            if element.center is not None:
                spoke, last = at - element.center, end - element.center
                sweep = (cmath.phase(last / spoke) * (1 if element.left else -1)) % (2 * math.pi)
                if self.by_radius and sweep <= math.pi + 1e-3:
                    words.append(control.radius_word + self.number(abs(element.end - element.center)))
                else:
                    words += [f"I{self.number(-spoke.real)}", f"J{self.number(-spoke.imag)}"]
            if len(words) > (new != motion):
                blocks.append(" ".join(words))
            motion, at = new, end
        back = [code["G1"]] * (motion != "G1")
        return [
            *blocks,
            " ".join([*back, "G40", f"X{self.x(self.away.real)}", f"{control.virtual}{self.number(self.away.imag)}"]),
        ]

    def _rounded(self, point: complex) -> complex:
        step = self.control.unit * (1e-4 if self.control.unit > 1 else 1e-3)
        x = round(point.real * (2 if self.control.diameter else 1) / step) * step / (2 if self.control.diameter else 1)
        return complex(x, round(point.imag / step) * step)

    def text(self, blocks: list[str] | None = None) -> str:
        return "%\n" + "\n".join(self.blocks() if blocks is None else blocks) + "\n%\n"


# ---- shapes: a start and elements, counterclockwise ----

Path = tuple[complex, list[Element]]


def fillets(corners: list[complex], radii: list[float]) -> Path:
    """A polygon with rounded corners, begun in the middle of the side from the last corner to the first."""
    count = len(corners)
    start = (corners[-1] + corners[0]) / 2
    path: list[Element] = []
    for index, (corner, radius) in enumerate(zip(corners, radii, strict=True)):
        before, after = corners[index - 1], corners[(index + 1) % count]
        into, out = (corner - before) / abs(corner - before), (after - corner) / abs(after - corner)
        turn = cmath.phase(out / into)
        if radius == 0:
            path.append(Element(corner))
            continue
        back = radius * math.tan(abs(turn) / 2)
        first, last = corner - into * back, corner + out * back
        center = first + into * (1j if turn > 0 else -1j) * radius
        path += [Element(first), Element(last, center, turn > 0)]
    return start, [*path, Element(start)]


def rectangle(draw: random.Random) -> Path:
    width, height = draw.randint(10, 24), draw.randint(9, 22)
    corners = [complex(width, height), complex(-width, height), complex(-width, -height), complex(width, -height)]
    return fillets(corners, [draw.choice((2, 2.5, 3, 4, 5, 6))] * 4)


def rectangle_of_two_radii(draw: random.Random) -> Path:
    width, height = draw.randint(14, 24), draw.randint(12, 22)
    corners = [complex(width, height), complex(-width, height), complex(-width, -height), complex(width, -height)]
    one, two = draw.sample((2.0, 3.0, 4.0, 5.0, 6.0), 2)
    return fillets(corners, [one, two, one, two])


def slot(draw: random.Random) -> Path:
    radius, length = draw.randint(6, 12), draw.randint(4, 12)
    start = complex(radius, 0)
    path = [
        Element(complex(radius, length)),
        Element(complex(-radius, length), 1j * length),
        Element(complex(-radius, -length)),
        Element(complex(radius, -length), -1j * length),
        Element(start),
    ]
    return start, path


def circle(draw: random.Random) -> Path:
    radius, parts = draw.randint(8, 24), draw.choice((2, 3, 4))
    middle = draw.choice((0j, complex(draw.randint(1, 5), 0)))
    points = [middle + cmath.rect(radius, 2 * math.pi * index / parts) for index in range(parts + 1)]
    return points[0], [Element(point, middle) for point in points[1:]]


def hexagon(draw: random.Random) -> Path:
    flats, count = draw.randint(9, 18), draw.choice((5, 6, 8))
    corners = [
        cmath.rect(flats / math.cos(math.pi / count), math.pi * (2 * index + 1) / count) for index in range(count)
    ]
    return fillets(corners, [draw.choice((1.0, 2.0, 3.0))] * count)


def free(draw: random.Random) -> Path:
    """Corners anywhere round the center, each rounded by another R; some of them turn inward."""
    count = draw.randint(5, 8)
    corners = [
        cmath.rect(draw.uniform(16, 26), 2 * math.pi * (index + draw.uniform(0.35, 0.65)) / count)
        for index in range(count)
    ]
    return fillets(corners, [draw.choice((1.0, 1.5, 2.0, 2.5, 3.0)) for _ in corners])


def keyed(draw: random.Random) -> Path:
    """A round part with a keyway of parallel walls: honest corners."""
    radius, half, depth = draw.randint(12, 22), draw.randint(4, 6), draw.randint(5, 8)
    x = math.sqrt(radius**2 - half**2)
    start = complex(0, radius)
    path = [
        Element(complex(-radius, 0), 0j),
        Element(complex(0, -radius), 0j),
        Element(complex(x, -half), 0j),
        Element(complex(x - depth, -half)),
        Element(complex(x - depth, half)),
        Element(complex(x, half)),
        Element(start, 0j),
    ]
    return start, path


def flats(draw: random.Random) -> Path:
    """A bar with two flats, or a hexagon whose corners the bar cuts off: honest corners."""
    radius, count = draw.randint(14, 22), draw.choice((2, 4, 6))
    least = math.cos(math.pi / count) + 0.02
    flat = round(radius * draw.uniform(max(least, 0.5), 0.97), 1)
    half = math.acos(flat / radius)
    path: list[Element] = []
    for index in range(count):
        middle = 2 * math.pi * index / count
        path += [
            Element(cmath.rect(radius, middle + half)),
            Element(cmath.rect(radius, middle + 2 * math.pi / count - half), 0j),
        ]
    return complex(flat, 0), [*path, Element(complex(flat, 0))]


def bullet(draw: random.Random) -> Path:
    """One end half a circle, the other one flatter, by an R that no slip explains: honest corners."""
    radius, length = draw.choice((6, 8, 10)), draw.randint(6, 12)
    large = radius * draw.choice((1.3, 1.45, 1.6, 1.75))
    middle = complex(0, -length + math.sqrt(large**2 - radius**2))
    start = complex(radius, 0)
    path = [
        Element(complex(radius, length)),
        Element(complex(-radius, length), 1j * length),
        Element(complex(-radius, -length)),
        Element(complex(radius, -length), middle),
        Element(start),
    ]
    return start, path


def crowned(draw: random.Random) -> Path:
    """A rectangle with sharp corners whose sides bulge: honest corners everywhere."""
    width, height, large = draw.randint(10, 16), draw.randint(10, 16), draw.randint(40, 80)
    corners = [complex(width, -height), complex(width, height), complex(-width, height), complex(-width, -height)]
    path = []
    for index in range(4):
        first, last = corners[index], corners[(index + 1) % 4]
        way, middle = last - first, (first + last) / 2
        up = math.sqrt(large**2 - abs(way) ** 2 / 4)
        path.append(Element(last, middle + 1j * way / abs(way) * up))
    return corners[0], path


def teardrop(draw: random.Random) -> Path:
    radius = draw.choice((8.0, 10.0, 12.0))
    far = radius * draw.uniform(1.5, 2.2)
    angle = math.acos(radius / far)
    touch = cmath.rect(radius, angle)
    return complex(far, 0), [
        Element(touch),
        Element(complex(-radius, 0), 0j),
        Element(touch.conjugate(), 0j),
        Element(complex(far, 0)),
    ]


def polygon(draw: random.Random) -> Path:
    """Straight sides, a chamfer here and there."""
    count = draw.choice((5, 6, 6, 8))
    corners = [cmath.rect(draw.randint(14, 22), math.pi * (2 * index + 1) / count) for index in range(count)]
    return fillets(corners, [0.0] * count)


SHAPES: tuple[Callable[[random.Random], Path], ...] = (
    rectangle,
    rectangle_of_two_radii,
    slot,
    circle,
    hexagon,
    free,
    keyed,
    flats,
    bullet,
    crowned,
    teardrop,
    polygon,
)


def contour(seed: int) -> Drawn:
    """A drawn contour and its control."""
    draw = random.Random(seed)  # noqa: S311 - contours that can be drawn again
    shape = SHAPES[seed % len(SHAPES)]
    start, path = shape(draw)
    control = draw.choice(CONTROLS)
    inside = shape in (rectangle, slot, circle) and draw.random() < 0.3
    mirrored = draw.random() < 0.5
    side = "G41" if inside else "G42"
    if mirrored:
        start = start.conjugate()
        path = [
            Element(one.end.conjugate(), None if one.center is None else one.center.conjugate(), not one.left)
            for one in path
        ]
        side = {"G41": "G42", "G42": "G41"}[side]
    if draw.random() < 0.3 and shape not in (teardrop,):
        turn = cmath.rect(1, math.radians(draw.choice((15, 30, 45, 90, 180, 33))))
        start, path = (
            start * turn,
            [Element(one.end * turn, None if one.center is None else one.center * turn, one.left) for one in path],
        )
    least = min([6.0, *(abs(one.end - one.center) for one in path if one.center is not None)])
    radius = (
        round(max(0.8, min(4.0, least * 0.6)), 1)
        if inside or shape in (free, keyed)
        else draw.choice((2.0, 3.0, 4.0, 5.0))
    )
    first = path[0]
    leaving = first.end - start if first.center is None else (1j if first.left else -1j) * (start - first.center)
    outward = leaving / abs(leaving) * (-1j if side == "G42" else 1j)
    lead = radius * 1.5 + 3
    if shape is teardrop:
        outward = start / abs(start)
    away = start + outward * (min(lead, max(radius * 1.2, 0.6 * abs(start))) if inside else lead + 6)
    return Drawn(
        shape.__name__,
        start,
        tuple(path),
        control,
        side,
        away,
        radius,
        by_radius=draw.random() < 0.65,
        incremental=bool(control.step)
        and control.machine in ("fanuc", "fanuc-30i", "doosan", "haas-lathe")
        and draw.random() < 0.25,
        depths=(4.0,) if draw.random() < 0.5 else (3.0, 6.0),
        has_arcs=any(one.center is not None for one in path),
    )
