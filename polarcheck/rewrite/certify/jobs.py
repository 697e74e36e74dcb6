"""The small jobs with which a post is certified: each standard feature in words, as a part and as a drawing."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

#: A closed outline: its corners x + 1j*c [mm, radius], each with the bulge of the side behind it: the tangent of a
#: quarter of the angle of the arc, 0 for a line, above 0 counterclockwise.
Outline = tuple[tuple[complex, float], ...]

#: The bulge of an arc of 90 deg.
_QUARTER = math.tan(math.pi / 8)


class Job(NamedTuple):
    """
    A job for the CAM system.

    title: what is made. task: how, in sentences. part: the [[part]] that it must make, lengths in mm.
    outline: its drawing [mm]. unit: mm for each unit of the drawing.
    """

    title: str
    task: str
    part: Mapping[str, Any]
    outline: Outline
    unit: float = 1.0


def _polygon(sides: int, across_flats: float) -> Outline:
    corner = across_flats / 2 / math.cos(math.pi / sides)
    return tuple((cmath.rect(corner, math.pi * (2 * side + 1) / sides), 0.0) for side in range(sides))


def _circle(diameter: float) -> Outline:
    return ((complex(diameter / 2), 1.0), (complex(-diameter / 2), 1.0))


def _rounded(length: float, width: float, radius: float) -> Outline:
    x, c = length / 2, width / 2
    corners = ((x, c - radius), (x - radius, c), (radius - x, c), (-x, c - radius))
    upper = [(complex(*corner), bulge) for corner, bulge in zip(corners, (_QUARTER, 0.0, _QUARTER, 0.0), strict=True)]
    return (*upper, *((-corner, bulge) for corner, bulge in upper))


def _with_flat(diameter: float, distance: float) -> Outline:
    half = math.acos(2 * distance / diameter)
    corner = cmath.rect(diameter / 2, half)
    return ((corner, math.tan((2 * math.pi - 2 * half) / 4)), (corner.conjugate(), 0.0))


_HEXAGON = {"shape": "hexagon", "across_flats": 24.0, "turned": 0.0, "z": -3.0}
_RECTANGLE = {"shape": "rectangle", "length": 26.0, "width": 20.0, "corner_radius": 5.0, "turned": 0.0, "z": -3.0}
_POCKET = {"shape": "circle", "diameter": 16.0, "inside": True, "z": -3.0}

JOBS: Mapping[str, Job] = {
    "contour": Job(
        "Hexagon, 24 across flats, 3 deep",
        "Mill round the outside once, with cutter compensation. A side is square to C0.",
        _HEXAGON,
        _polygon(6, 24),
    ),
    "pocket": Job(
        "Round pocket of 16, 3 deep, in the middle of the face",
        "Mill along the wall once, with cutter compensation. Plunge beside the center, inside the pocket.",
        _POCKET,
        _circle(16),
    ),
    "arcs-by-radius": Job(
        "Rectangle 26 x 20 with corners R5, 3 deep",
        "Mill round the outside once. The post writes the corners with R. The long sides are square to C90.",
        _RECTANGLE,
        _rounded(26, 20, 5),
    ),
    "arcs-by-center": Job(
        "The same rectangle",
        "As before, but the post writes the corners with I and J.",
        _RECTANGLE,
        _rounded(26, 20, 5),
    ),
    "arc-above-180": Job(
        "Round of 28 with one flat 10 from the center at C0, 3 deep",
        "Mill round the outside once. The round is one arc of 271 deg, which the post must not turn the wrong way.",
        {"shape": "flat", "distance": 10.0, "diameter": 28.0, "turned": 0.0, "z": -3.0},
        _with_flat(28, 10),
    ),
    "helical": Job(
        "The round pocket of 16, 3 deep, with a helix",
        "Go down along the wall on a helix of 3 per turn, then once round at depth. "
        "A control that takes no Z with an arc in the mode does not offer this.",
        _POCKET,
        _circle(16),
    ),
    "compensation-left": Job(
        "The hexagon, clockwise with G41",
        "Mill round the outside once, with the cutter on the left of the contour.",
        _HEXAGON,
        _polygon(6, 24),
    ),
    "compensation-right": Job(
        "The hexagon, counterclockwise with G42",
        "Mill round the outside once, with the cutter on the right of the contour.",
        _HEXAGON,
        _polygon(6, 24),
    ),
    "several-depths": Job(
        "Square, 20 across flats, 6 deep in three passes of 2",
        "Mill round the outside at each depth, without leaving the mode in between.",
        {"shape": "square", "across_flats": 20.0, "turned": 0.0, "z": -6.0},
        _polygon(4, 20),
    ),
    "indexing": Job(
        "Triangle, 22 across flats, of three flats at C0, C120 and C240, 3 deep",
        "Mill one flat, 11 from the center, and index C for the others. The triangle is larger than the bar: its "
        "corners stay round.",
        {"shape": "flats", "count": 3, "distance": 11.0, "turned": 0.0, "z": -3.0},
        _polygon(3, 22),
    ),
    "inch": Job(
        "Hexagon, 1 inch across flats, 3 mm (0.1181 inch) deep",
        "Mill round the outside once; the program is in inch.",
        {**_HEXAGON, "across_flats": 25.4},
        _polygon(6, 25.4),
        25.4,
    ),
    "incremental": Job(
        "The hexagon in incremental words",
        "Mill round the outside once; the post writes the contour as distances from block to block.",
        _HEXAGON,
        _polygon(6, 24),
    ),
    "canned-end": Job(
        "The hexagon behind a drilling cycle",
        "Drill two holes of 5 on a diameter of 12 with a canned cycle, then mill the hexagon: the cycle ends before "
        "the mode begins, and the mode before the end of the program.",
        _HEXAGON,
        _polygon(6, 24),
    ),
}
