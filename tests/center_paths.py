"""
Parts by their corners and arcs, and paths of the tool center round them, by plain geometry without polarcheck.

Points are x + 1j*c [mm, X as a radius]. A contour is a list of Lines that join, the last with the first.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import shapely  # type: ignore[import-untyped]


class Line(NamedTuple):
    """A line, or an arc about a center, counterclockwise or not."""

    start: complex
    end: complex
    center: complex | None = None
    ccw: bool = True

    def along(self, point: complex) -> complex:
        """Unit tangent at a point."""
        if self.center is None:
            return (self.end - self.start) / abs(self.end - self.start)
        spoke = point - self.center
        return (1j if self.ccw else -1j) * spoke / abs(spoke)

    def points(self) -> list[complex]:
        """Points along it; of an arc with chords that leave it by no more than 0.0005 mm."""
        if self.center is None:
            return [self.start, self.end]
        sense = 1 if self.ccw else -1
        spoke = self.start - self.center
        sweep = (sense * cmath.phase((self.end - self.center) / spoke)) % math.tau
        sweep = sweep if abs(self.end - self.start) > 1e-6 else math.tau
        count = math.ceil(sweep / (2 * math.acos(1 - 5e-4 / abs(spoke))))
        between = [self.center + spoke * cmath.exp(1j * sense * sweep * k / count) for k in range(count)]
        return [*between, self.end]


def polygon(corners: Sequence[complex]) -> list[Line]:
    """Straight sides, from the middle of the last one on."""
    middle = (corners[0] + corners[-1]) / 2
    points = [middle, *corners, middle]
    return [Line(*pair) for pair in pairwise(points)]


def beside(contour: Sequence[Line], distance: float, round_corners: bool) -> list[Line]:
    """
    The path at a distance to the left of a contour; below 0 to the right.

    Outer corners are rounded by arcs about the corner of the part, or, between lines, extended until they meet.
    """
    moved = [
        line._replace(
            start=line.start + 1j * distance * line.along(line.start),
            end=line.end + 1j * distance * line.along(line.end),
        )
        for line in contour
    ]
    path: list[Line] = []
    for index, line in enumerate(contour):
        following = contour[(index + 1) % len(contour)]
        turn = cmath.phase(following.along(line.end) / line.along(line.end))
        after = (index + 1) % len(contour)
        if abs(turn) < 1e-9:
            path.append(moved[index])
            continue
        is_outer = turn * distance < 0
        if is_outer and (round_corners or line.center is not None or following.center is not None):
            path += [moved[index], Line(moved[index].end, moved[after].start, line.end, turn > 0)]
            continue
        corner = _meet(moved[index], moved[after], line.end)
        moved[index] = moved[index]._replace(end=corner)
        moved[after] = moved[after]._replace(start=corner)
        if after == 0 and path:
            path[0] = path[0]._replace(start=corner)
        path.append(moved[index])
    return path


def _meet(one: Line, other: Line, near: complex) -> complex:
    """Where two lines meet, or a line and a circle nearest to a point."""
    if one.center is not None:
        one, other = other, one
    along = one.along(one.start)
    if other.center is None:
        across = other.along(other.start)
        return one.start + along * _cross(other.start - one.start, across) / _cross(along, across)
    foot = one.start + along * ((other.center - one.start) * along.conjugate()).real
    half = along * math.sqrt(abs(other.start - other.center) ** 2 - abs(foot - other.center) ** 2)
    return min(foot - half, foot + half, key=lambda point: abs(point - near))


def _cross(one: complex, other: complex) -> float:
    return (one.conjugate() * other).imag


# ---- programs ----


def number(value: float, digits: int = 3) -> str:
    """A number as programs have it, with a point."""
    text = f"{round(value, digits) + 0.0:.{digits}f}".rstrip("0")
    return "0." if text in ("-0.", "") else text


def words(path: Sequence[Line], by_radius: bool = False, unit: float = 1.0) -> list[str]:
    """The blocks of a path: X as a diameter, arcs by I and J, or by R up to half a turn."""
    digits = 3 if unit == 1.0 else 4
    blocks = []
    for line in path:
        block = f"X{number(2 * line.end.real / unit, digits)} C{number(line.end.imag / unit, digits)}"
        if line.center is None:
            blocks.append(f"G1 {block}")
            continue
        spoke = line.center - line.start
        turn = (cmath.phase((line.end - line.center) / -spoke) * (1 if line.ccw else -1)) % math.tau
        arc = f"I{number(spoke.real / unit, digits)} J{number(spoke.imag / unit, digits)}"
        if by_radius and 0 < turn < 3.1:
            arc = f"R{number(abs(spoke) / unit, digits)}"
        blocks.append(f"{'G3' if line.ccw else 'G2'} {block} {arc}")
    return blocks


_WORD = re.compile(r"([A-Z])(-?[\d.]+)")


def read_section(text: str) -> tuple[list[Line], list[Line]]:
    """The moves of the first section as its words say, from its first contour on: those up to G40, and all of them."""
    at, motion, inside, in_contour = 0j, 1, False, False
    contour: list[Line] = []
    every: list[Line] = []
    for block in text.split("\n"):
        values = dict(_WORD.findall(block.partition("(")[0]))
        codes = [int(float(code)) for address, code in _WORD.findall(block) if address == "G"]
        inside = (inside or "G12.1" in block) and "G13.1" not in block
        in_contour = (in_contour or bool({41, 42} & set(codes))) and 40 not in codes
        motion = next((code for code in codes if code in (0, 1, 2, 3)), motion)
        if "X" not in values and "C" not in values:
            continue
        end = complex(
            float(values["X"]) / 2 if "X" in values else at.real, float(values["C"]) if "C" in values else at.imag
        )
        if inside:
            line = Line(at, end, _center(at, end, motion, values), motion == 3)
            every.append(line)
            contour += [line] if in_contour and not {41, 42} & set(codes) else []
        at = end
    return contour, every


def _center(start: complex, end: complex, motion: int, values: dict[str, str]) -> complex | None:
    if motion < 2:
        return None
    if "R" in values:
        half = (end - start) / 2
        height = math.sqrt(max(float(values["R"]) ** 2 - abs(half) ** 2, 0.0))
        return start + half + (1j if motion == 3 else -1j) * height * half / abs(half)
    return start + complex(float(values.get("I", 0)), float(values.get("J", 0)))


# ---- what is cut, by shapely ----


def cleared(path: Sequence[Line], radius: float) -> shapely.Geometry:
    """What a cutter clears along a path."""
    points = [point for line in path for point in line.points()]
    return shapely.LineString([(point.real, point.imag) for point in points]).buffer(radius, quad_segs=256)


def left_standing(area: shapely.Geometry) -> shapely.Geometry:
    """What stands within the cleared area."""
    return shapely.unary_union([shapely.Polygon(ring) for ring in area.interiors])


def thickest_difference(one: shapely.Geometry, other: shapely.Geometry) -> float:
    """How thick the thickest piece is that only one of two areas has [mm]."""
    difference = shapely.get_parts(shapely.symmetric_difference(one, other))
    pieces = [piece for piece in difference if piece.area > 1e-6]
    return max((2 * shapely.maximum_inscribed_circle(piece).length for piece in pieces), default=0.0)
