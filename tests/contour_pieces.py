"""
Contours as lists of lines and arcs, the ramps and leads that bring a cutter to them, and the blocks that say so.

What the generator of contours (contour_families.py) is made of. Plane points are complex, x + 1j*c, radius values [mm].
"""

from __future__ import annotations

import cmath
import math
import random
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]

SAGITTA = 3e-4  # [mm] by which a chord may leave its arc
NOTHING = 1e-9  # [mm]

Map = Callable[[complex], complex]


class Piece(NamedTuple):
    """A line or an arc; an arc that ends where it starts is a full circle."""

    kind: str  # "line", "cw", "ccw"
    start: complex
    end: complex
    center: complex | None = None

    @property
    def sweep(self) -> float:
        """Signed angle [rad] of an arc, 0 of a line."""
        if self.center is None:
            return 0.0
        turn = math.tau
        if abs(self.end - self.start) > NOTHING:
            turn = cmath.phase((self.end - self.center) / (self.start - self.center))
            turn = (turn if self.kind == "ccw" else -turn) % math.tau
        return turn if self.kind == "ccw" else -turn

    @property
    def length(self) -> float:
        """[mm]."""
        if self.center is None:
            return abs(self.end - self.start)
        return abs(self.start - self.center) * abs(self.sweep)

    def at(self, share: float) -> complex:
        """The point at a share, 0 to 1, of the piece."""
        if self.center is None:
            return self.start + (self.end - self.start) * share
        radius = abs(self.start - self.center) * (1 - share) + abs(self.end - self.center) * share
        spoke = (self.start - self.center) / abs(self.start - self.center)
        return self.center + radius * spoke * cmath.exp(1j * self.sweep * share)

    def tangent(self, share: float) -> complex:
        """The direction there."""
        if self.center is None:
            return (self.end - self.start) / abs(self.end - self.start)
        spoke = self.at(share) - self.center
        return spoke / abs(spoke) * (1j if self.kind == "ccw" else -1j)

    def part(self, begin: float, end: float) -> Piece:
        """The piece between two shares."""
        first = self.start if begin == 0 else self.at(begin)
        last = self.end if end == 1 else self.at(end)
        return Piece(self.kind, first, last, self.center)

    def mapped(self, change: Map, mirrored: bool = False) -> Piece:
        """The piece where `change` brings it."""
        kind = {"cw": "ccw", "ccw": "cw"}.get(self.kind, self.kind) if mirrored else self.kind
        return Piece(kind, change(self.start), change(self.end), None if self.center is None else change(self.center))


Way = list[Piece]


def points_of(way: Sequence[Piece]) -> list[complex]:
    """Points along a way, on its arcs, the last one left out."""
    found = []
    for piece in way:
        count = 1
        if piece.center is not None:
            step = math.sqrt(8 * SAGITTA / abs(piece.start - piece.center))
            count = max(math.ceil(abs(piece.sweep) / step), 8)
        found += [piece.at(number / count) for number in range(count)]
    return found


def polygon_of(way: Sequence[Piece]) -> shapely.Polygon:
    """The area within a closed way."""
    return shapely.Polygon([(point.real, point.imag) for point in points_of(way)])


def polygon(corners: Sequence[complex]) -> Way:
    """Lines round the corners, back to the first."""
    return [Piece("line", one, other) for one, other in zip(corners, [*corners[1:], corners[0]], strict=True)]


def reversed_way(way: Sequence[Piece]) -> Way:
    """The same the other way round."""
    other = {"cw": "ccw", "ccw": "cw", "line": "line"}
    return [Piece(other[piece.kind], piece.end, piece.start, piece.center) for piece in reversed(way)]


def begun_at(way: Sequence[Piece], number: int, share: float) -> Way:
    """A closed way that begins within one of its pieces; with share 0 at the corner before it."""
    turned = [*way[number:], *way[:number]]
    if share == 0:
        return turned
    return [turned[0].part(share, 1), *turned[1:], turned[0].part(0, share)]


def first_of(way: Sequence[Piece], length: float) -> Way:
    """The beginning of a way, as long as asked [mm]."""
    found = []
    for piece in way:
        if piece.length >= length:
            return [*found, piece.part(0, max(length, 0.05) / piece.length)] if length > 0 else found
        found.append(piece)
        length -= piece.length
    return found


# --- leads -------------------------------------------------------------------------------------------------------


class Lead(NamedTuple):
    """From where the ramp starts to the contour; `way` is programmed in offset mode."""

    ramp: complex
    way: Way


LEADS = ("straight", "perpendicular", "tangent", "arc")


def lead_in(rng: random.Random, style: str, at: complex, tangent: complex, left: bool, radius: float) -> Lead:
    """
    A way to a point of the contour, which goes on along the tangent; the tool is on the side `left`.

    One ramp in eight starts where a hasty programmer might, from any side.
    """
    lead = _careful_lead(rng, style, at, tangent, left, radius)
    if rng.random() < 0.12:
        begin = lead.way[0].start if lead.way else at
        lead = lead._replace(ramp=begin + turned(rng) * (radius * rng.uniform(1.1, 3) + rng.uniform(0.2, 5)))
    return lead


def _careful_lead(rng: random.Random, style: str, at: complex, tangent: complex, left: bool, radius: float) -> Lead:
    normal = tangent * (1j if left else -1j)
    room = rng.uniform(0.2, 5)

    def far(least: float = 1.05) -> float:
        return radius * rng.uniform(least, least + 2) + room

    if style == "straight":
        back = rng.uniform(-0.3, 1.5) if rng.random() < 0.7 else rng.uniform(-3, 3)
        return Lead(at + normal * far() - tangent * back * (radius + room), [])
    if style == "perpendicular":
        begin = at + normal * far()
        way = [Piece("line", begin, at)]
        aside = rng.uniform(-1.2, 1.2)
        return Lead(begin + normal * far() * cmath.exp(1j * aside), way)
    if style == "tangent":
        begin = at - tangent * far(0.3 if rng.random() < 0.3 else 1.05)
        way = [Piece("line", begin, at)]
        return Lead(begin + (normal * rng.uniform(0, 2) - tangent * rng.uniform(0, 1.5)) * far(), way)
    curve = radius * (rng.uniform(1.05, 3) if rng.random() < 0.9 else rng.uniform(0.5, 1)) + 0.05
    center, angle = at + normal * curve, rng.uniform(0.4, 2.2)
    begin = center + (at - center) * cmath.exp(-1j * angle if left else 1j * angle)
    way = [Piece("ccw" if left else "cw", begin, at, center)]
    along = way[0].tangent(0)
    if rng.random() < 0.3:
        way.insert(0, Piece("line", begin - along * far(0.3), begin))
        begin = way[0].start
    inward = along * (1j if left else -1j)
    return Lead(begin - along * far() + inward * rng.uniform(-0.3, 1) * far(), way)


def lead_out(rng: random.Random, style: str, at: complex, tangent: complex, left: bool, radius: float) -> Lead:
    """The same away from the contour: a lead in read backwards."""
    lead = lead_in(rng, style, at, -tangent, not left, radius)
    return Lead(lead.ramp, reversed_way(lead.way))


# --- blocks ------------------------------------------------------------------------------------------------------


class Step(NamedTuple):
    """One block of the polar section; kind "z" goes to a height."""

    kind: str
    end: complex = 0j
    center: complex | None = None
    code: str = ""  # "G40", "G41", "G42"
    z: float = 0.0


def steps_of(way: Sequence[Piece]) -> list[Step]:
    """The blocks of a way."""
    return [Step(piece.kind, piece.end, piece.center) for piece in way]


class Depths(NamedTuple):
    """How a loop comes to its depth: before the ramp, between ramp and contour, or both; several depths in one loop."""

    safe: float
    ramp: float
    contour: tuple[float, ...]


def loop_of(ins: Lead, way: Way, out: Lead, left: bool, depths: Depths) -> list[Step]:
    """The blocks from the way to the start-up to the way up behind the offset cancel."""
    code = "G41" if left else "G42"
    first = (ins.way or way)[0].start
    found = [Step("line", ins.ramp), Step("z", z=depths.ramp), Step("line", first, code=code)]
    now = depths.ramp
    for number, depth in enumerate(depths.contour):
        if depth != now:
            found.append(Step("z", z=depth))
            now = depth
        if number == 0:
            found += steps_of(ins.way)
        found += steps_of(way)
    found += steps_of(out.way)
    if now != depths.ramp:
        found.append(Step("z", z=depths.ramp))
    return [*found, Step("line", out.ramp, code="G40"), Step("z", z=depths.safe)]


# --- text --------------------------------------------------------------------------------------------------------


class Style(NamedTuple):
    """How a program is written."""

    inch: bool = False
    incremental: bool = False
    at_depth: bool = False  # Z is there before G12.1, and is not written behind it

    @property
    def increments(self) -> tuple[float, float]:
        """Least steps of X, as a radius, and of C [mm]."""
        least = 0.00254 if self.inch else 0.001
        return least / 2, least

    def rounded(self, point: complex) -> complex:
        """The point that can be written."""
        of_x, of_c = self.increments
        return complex(round(point.real / of_x) * of_x, round(point.imag / of_c) * of_c)

    def number(self, value: float) -> str:
        """A length [mm] as it is written."""
        text = f"{value / 25.4:.4f}" if self.inch else f"{value:.3f}"
        text = text.rstrip("0")
        return "0." if text in ("-.", "-0.", "0.") else text.replace("0.", ".", 1) if text.startswith("0.") else text


def text_of(steps: Sequence[Step], style: Style, safe: float) -> str:
    """The whole program."""
    number = style.number
    reach = max(abs(step.end) for step in steps) + 10
    here = style.rounded(complex(reach))
    depth = min(step.z for step in steps if step.kind == "z")
    height = depth if style.at_depth else safe
    lines = ["O1", f"{'G20' if style.inch else 'G21'} G40 G97 G98 G18", "T0101"]
    lines += [f"G0 X{number(2 * here.real)} Z{number(height)} C0", "G12.1"]
    motion, feed = "", True
    for step in steps:
        words = []
        if step.kind == "z":
            if style.at_depth or step.z == height:
                continue
            code = "G1"
            words.append(f"W{number(step.z - height)}" if style.incremental else f"Z{number(step.z)}")
            height = step.z
        else:
            code = {"line": "G1", "cw": "G2", "ccw": "G3"}[step.kind]
            end = style.rounded(step.end)
            move = end - here
            full = step.center is not None and end == here
            if style.incremental:
                words += [f"U{number(2 * move.real)}"] if abs(move.real) > NOTHING else []
                words += [f"H{number(move.imag)}"] if abs(move.imag) > NOTHING else []
            else:
                words += [f"X{number(2 * end.real)}"] if abs(move.real) > NOTHING else []
                words += [f"C{number(end.imag)}"] if abs(move.imag) > NOTHING else []
            if not words and not full and not step.code:
                continue
            if step.center is not None:
                spoke = style.rounded(step.center) - here
                words += [f"I{number(spoke.real)}", f"J{number(spoke.imag)}"]
            here = end
        head = [code] if code != motion else []
        motion = code
        words += ["F200"] if feed and not style.inch else ["F8."] if feed else []
        feed = False
        lines.append(" ".join([*head, *([step.code] if step.code else []), *words]))
    return "\n".join([*lines, "G13.1", "M30", ""])


def turned(rng: random.Random, least: float = -math.pi, most: float = math.pi) -> complex:
    """A direction."""
    return cmath.exp(1j * rng.uniform(least, most))


def log_uniform(rng: random.Random, least: float, most: float) -> float:
    """A number that is as likely small as large."""
    return float(np.exp(rng.uniform(math.log(least), math.log(most))))
