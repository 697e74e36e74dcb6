"""
Sound polar sections, drawn at random, and programs of them.

A section mills one closed contour with a cutter: a polygon, a polygon with rounded corners, a D, a round or a pocket.
Nothing is reported of it at or above warning, so that a slip can be planted in it.
"""

from __future__ import annotations

import cmath
import math
import random
from typing import NamedTuple

HEAD = ["O1", "G21 G40 G97 G98 G18", "T0101"]
END = ["G0 Z50.", "M30"]


class Section(NamedTuple):
    """
    A sound section.

    family: the kind of its contour. blocks: as written, from the approach to G13.1. radius: of the cutter [mm].
    stock: the diameter of a bar that holds the contour and ends within the approach [mm].
    """

    family: str
    blocks: tuple[str, ...]
    radius: float
    stock: float

    def changed(self, old: str, new: str) -> Section | None:
        """The section with `new` in place of the first `old`; None where it has none."""
        text = "/".join(self.blocks)
        return self._replace(blocks=tuple(text.replace(old, new, 1).split("/"))) if old in text else None


class Corner(NamedTuple):
    """A point of a contour, and where an arc leads to it, its center (radius values, x + 1j*c)."""

    point: complex
    center: complex | None = None


def number(value: float) -> str:
    """As programs write it, with a decimal point."""
    text = f"{value:.3f}".rstrip("0")
    return "0" if text in ("-0.", "0.") else text


def sections(count: int, seed: int) -> list[Section]:
    """Sections of all families in turn."""
    draw = random.Random(seed)  # noqa: S311 - programs that can be written again
    families = (polygon, rounded, d_shape, round_part, pocket)
    return [families[index % len(families)](draw) for index in range(count)]


def polygon(draw: random.Random) -> Section:
    count = draw.choice((3, 4, 4, 5, 6, 6, 8))
    corners = _polygon(count, draw.uniform(16, 30))
    return _outside(f"{count} corners", [Corner(point) for point in corners], draw)


def rounded(draw: random.Random) -> Section:
    width, height, corner = draw.uniform(15, 28), draw.uniform(12, 28), draw.uniform(2, 8)
    signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    path = [Corner(complex(width, 0))]
    for x, c in signs:
        middle = complex(x * (width - corner), c * (height - corner))
        turn = (complex(x * corner, 0), complex(0, c * corner))
        first, last = turn if x == c else turn[::-1]
        path += [Corner(middle + first), Corner(middle + last, middle)]
    return _outside("rounded", [*path[1:], path[0]], draw)


def d_shape(draw: random.Random) -> Section:
    radius = draw.uniform(16, 28)
    flat = radius * draw.uniform(0.4, 0.8)
    half = math.sqrt(radius * radius - flat * flat)
    path = [Corner(complex(flat, half)), Corner(complex(-radius, 0), 0j), Corner(complex(flat, -half), 0j)]
    return _outside("D", [*path, Corner(complex(flat, 0))], draw)


def round_part(draw: random.Random) -> Section:
    """A round boss with two flats at its sides, so that a line follows each arc."""
    radius, length = draw.uniform(9, 16), draw.uniform(3, 10)
    path = [
        Corner(complex(radius, length)),
        Corner(complex(-radius, length), 1j * length),
        Corner(complex(-radius, -length)),
        Corner(complex(radius, -length), -1j * length),
        Corner(complex(radius, 0)),
    ]
    return _outside("round", path, draw)


def pocket(draw: random.Random) -> Section:
    cutter = draw.choice((2.0, 3.0, 4.0))
    width, height = draw.uniform(18, 28), draw.uniform(15, 28)
    corner = cutter + draw.uniform(0.5, 3)
    path = []
    for x, c in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        middle = complex(x * (width - corner), c * (height - corner))
        turn = (complex(x * corner, 0), complex(0, c * corner))
        first, last = turn if x == c else turn[::-1]
        path += [Corner(middle + first), Corner(middle + last, middle)]
    path.append(Corner(complex(width, 0)))
    start = complex(draw.uniform(3, width - cutter - 3), 0)
    return _section("pocket", path, start, "G41", cutter, 2.2 * abs(complex(width, height)), draw)


def _polygon(count: int, size: float) -> list[complex]:
    """The corners of a regular polygon around the center, begun and ended in the middle of the side towards +X."""
    corners = [cmath.rect(size, math.pi * (2 * index + 1) / count) for index in range(count)]
    return [*corners, complex(corners[0].real, 0)]


def _outside(family: str, path: list[Corner], draw: random.Random) -> Section:
    cutter = draw.choice((2.0, 3.0, 4.0, 5.0))
    widest = max(abs(corner.point) for corner in path)
    start = complex(widest + cutter + draw.uniform(6, 12), 0)
    return _section(family, path, start, "G42", cutter, 2 * widest + draw.uniform(1, 3), draw)


def _section(
    family: str, path: list[Corner], start: complex, side: str, cutter: float, stock: float, draw: random.Random
) -> Section:
    """The path that is drawn, or its mirror image, in one or two passes from the outside or the middle of a pocket."""
    if draw.random() < 0.5:
        path = [Corner(corner.point.conjugate(), corner.center and corner.center.conjugate()) for corner in path]
        side = {"G41": "G42", "G42": "G41"}[side]
    first, far = path[-1].point, f"X{number(2 * start.real)}"
    aside = draw.choice((0.0, 0.0, 1.0, 3.0)) * (1 if path[0].point.imag <= 0 else -1)
    is_mirrored = path[0].point.imag < 0
    depth, feed = draw.randint(3, 8), draw.choice((80, 120, 200))
    passes = draw.choice((1, 1, 1, 2))
    blocks = [f"G0 {far} Z2. C0", "G12.1"]
    if aside:
        blocks.append(f"G1 C{number(aside)} F300")
    for level in range(passes):
        blocks.append(f"G1 Z-{depth * (level + 1)}." + " F300" * (level == 0))
        blocks.append(
            f"{side} X{number(2 * first.real)}" + f" C{number(first.imag)}" * bool(aside) + f" F{feed}" * (level == 0)
        )
        blocks += _contour(path, "G2" if is_mirrored else "G3")
        blocks.append(f"G40 {far}" + f" C{number(aside)}" * bool(aside))
    return Section(family, (*blocks, "Z2.", "G13.1"), cutter, stock)


def _contour(path: list[Corner], arc_code: str) -> list[str]:
    """The blocks of a closed contour, behind a G1 to its last point; G1 is in force at their end."""
    blocks, motion, at = [], "G1", path[-1].point
    for corner in path:
        x, c = number(2 * corner.point.real), number(corner.point.imag)
        if corner.center is None:
            code, words = "G1", [f"X{x}"] * (number(2 * at.real) != x) + [f"C{c}"] * (number(at.imag) != c)
        else:
            arc = corner.center - at
            code, words = arc_code, [f"X{x}", f"C{c}", f"I{number(arc.real)}", f"J{number(arc.imag)}"]
        blocks.append(" ".join([code] * (code != motion) + words))
        motion, at = code, corner.point
    return blocks


def program(*written: Section) -> str:
    """One program of these sections."""
    blocks = [block for section in written for block in ("G0 Z20.", *section.blocks)]
    return "\n".join([*HEAD, *blocks, *END]) + "\n"
