"""Contours of lines and arcs as a CAM without the polar mode writes them: places along them, as X and C."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

#: A line to a point, or an arc to a point about a center, counterclockwise or not.
Piece = tuple[complex] | tuple[complex, complex, bool]


def places(start: complex, pieces: list[Piece], chord_error: float, longest: float = 0.6) -> NDArray[np.complex128]:
    """Points on the contour [mm]: arcs by chord error, lines in steps that X and C do not bend by much."""
    points = [start]
    for piece in pieces:
        begin, end = points[-1], piece[0]
        if len(piece) == 1:
            count = max(1, math.ceil(abs(end - begin) / longest))
            points += [begin + (end - begin) * k / count for k in range(1, count)]
        else:
            _, center, ccw = piece
            sense = 1 if ccw else -1
            sweep = sense * float(np.angle((end - center) / (begin - center))) % (2 * math.pi) or 2 * math.pi
            count = max(1, math.ceil(sweep / (2 * math.acos(1 - chord_error / abs(begin - center)))))
            points += [center + (begin - center) * np.exp(1j * sense * sweep * k / count) for k in range(1, count)]
        points.append(end)
    return np.array(points)


def as_x_and_c(
    points: NDArray[np.complex128], increment: float = 0.001
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """X as a radius [mm], written as a diameter, and C [deg], unwrapped; both rounded to the least increment."""
    diameter = np.round(2 * np.abs(points) / increment) * increment
    return diameter / 2, np.round(np.degrees(np.unwrap(np.angle(points))) / increment) * increment


def hexagon(across_flats: float = 20.0, radius: float = 3.0) -> tuple[complex, list[Piece]]:
    """A hexagon with rounded corners, from the middle of a flat: 13 lines and arcs."""
    flat, pieces = across_flats / 2, []
    half = (flat - radius) * math.tan(math.pi / 6)
    for k in range(6):
        here, there = np.exp(1j * math.pi / 3 * k), np.exp(1j * math.pi / 3 * (k + 1))
        pieces += [
            (complex(flat * here + half * 1j * here),),
            (complex(flat * there - half * 1j * there), complex((flat - radius) * here + half * 1j * here), True),
        ]
    return complex(flat), [*pieces, (complex(flat),)]


def slot(middle: complex = 20 + 0j, half: float = 10.0, radius: float = 5.0) -> tuple[complex, list[Piece]]:
    """A slot with round ends, from the middle of its lower side: 5 lines and arcs."""
    down, out = -1j * radius, complex(half)
    return middle + down, [
        (middle + out + down,),
        (middle + out - down, middle + out, True),
        (middle - out - down,),
        (middle - out + down, middle - out, True),
        (middle + down,),
    ]


def oval() -> tuple[complex, list[Piece]]:
    """Four tangent arcs, like an ellipse of 40 by 24, from a vertex: 5 arcs, of which the first and last are one."""
    # Small circles about +-c, radius r, large ones about -+d, radius R = r + hypot(c, d), c + r = 20, R - d = 12.
    center, small = 13.0, 7.0
    away = (center**2 - (12 - small) ** 2) / (2 * (12 - small))
    large = away + 12
    toward = complex(center, away) / math.hypot(center, away)
    joint = center + small * toward
    return 20 + 0j, [
        (joint, center + 0j, True),
        (complex(-joint.real, joint.imag), -1j * away, True),
        (complex(-joint.real, -joint.imag), -center + 0j, True),
        (complex(joint.real, -joint.imag), 1j * away, True),
        (20 + 0j, center + 0j, True),
    ] if math.isclose(large - math.hypot(center, away), small) else []
