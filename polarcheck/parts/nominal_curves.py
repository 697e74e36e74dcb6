"""The shape that a part should have, as the curves of a drawing; lengths in mm, plane points complex, x + 1j*c."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np

from polarcheck.foundation.arrays import Points
from polarcheck.program.machines.chains import chord_count
from polarcheck.program.machines.part_keys import Part

#: Greatest distance of a chord from its arc [mm].
_SAGITTA = 2e-4
#: Half the length of a line without ends, such as a flat on an unknown bar [mm].
_ENDLESS = 1e5


def curves_of(part: Part, scale: float) -> list[Points]:
    """
    The curves of a shape, those that are closed counterclockwise and with their first point once more at the end.

    scale: mm per unit of its lengths. Where it may be turned in any way, its first flat looks to C0.
    """
    turn = cmath.exp(1j * math.radians(0.0 if math.isnan(part.turned) else part.turned))
    center = complex(*part.center)
    return [np.array([scale * (center + turn * point) for point in curve]) for curve in _curves(part, scale)]


def _curves(part: Part, scale: float) -> list[list[complex]]:
    """About the origin, in the units of the part."""
    sagitta, endless = _SAGITTA / scale, _ENDLESS / scale
    if part.shape == "circle":
        return [_closed(_arc(0j, part.diameter / 2 + 0j, math.tau, sagitta))]
    if part.shape in ("flat", "flats"):
        return _flats(part, sagitta, endless)
    if part.count_of_sides:
        half = math.pi / part.count_of_sides
        corner = part.apothem / math.cos(half)
        corners = [cmath.rect(corner, (2 * number - 1) * half) for number in range(1, part.count_of_sides + 1)]
        return [_closed(_cornered(corners, part, sagitta))]
    x, c = part.length / 2, part.width / 2
    if math.isnan(x):
        return [[complex(endless, side), complex(-endless, side)] for side in (c, -c)]
    round_ = c if part.shape == "slot" and math.isnan(part.corner_radius) else math.nan
    corners = [complex(x, -c), complex(x, c), complex(-x, c), complex(-x, -c)]
    return [_closed(_cornered(corners, part, sagitta, round_))]


def _flats(part: Part, sagitta: float, endless: float) -> list[list[complex]]:
    """Flats on a round, or each by itself where the round is not known."""
    count, apart = part.count_of_sides, part.apothem
    normals = [cmath.rect(1, math.tau * number / count) for number in range(count)]
    if math.isnan(part.diameter):
        return [[normal * complex(apart, side * endless) for side in (-1, 1)] for normal in normals]
    radius, share = part.diameter / 2, math.pi / count
    half = min(math.acos(apart / radius), share)
    corner, points = cmath.rect(apart / math.cos(half), half), []
    for normal in normals:
        points += [normal * corner.conjugate(), normal * corner]
        if half < share:
            points += _arc(0j, normal * corner, 2 * (share - half), sagitta)[1:-1]
    return [_closed(points)]


def _cornered(corners: Sequence[complex], part: Part, sagitta: float, radius: float = math.nan) -> list[complex]:
    """A convex polygon, counterclockwise, with the corners of the part, or with others that are round."""
    radius = part.corner_radius if math.isnan(radius) else radius
    points: list[complex] = []
    for number, corner in enumerate(corners):
        before, after = (corners[(number + step) % len(corners)] - corner for step in (-1, 1))
        before, after = before / abs(before), after / abs(after)
        turned = math.pi - abs(cmath.phase(after / before))
        if not math.isnan(part.chamfer):
            points += [corner + before * part.chamfer, corner + after * part.chamfer]
        elif not math.isnan(radius):
            start = corner + before * radius * math.tan(turned / 2)
            points += _arc(start - 1j * before * radius, start, turned, sagitta)
        else:
            points.append(corner)
    return points


def _arc(center: complex, start: complex, sweep: float, sagitta: float) -> list[complex]:
    """The points of an arc, both ends included."""
    spoke = start - center
    count = max(chord_count(sweep, abs(spoke), sagitta), 1)
    return [center + spoke * cmath.rect(1, sweep * number / count) for number in range(count + 1)]


def _closed(points: Sequence[complex]) -> list[complex]:
    return [*points, points[0]]
