"""
The geometry of one corner of a compensated path, for many corners at once.

Plane points are complex, x + 1j*c [mm, X as radius]. In formulas P is the corner, d a unit tangent, n the unit normal
towards the tool, R the tool radius; 1 the move before, 2 the one after.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Table
from polarcheck.geometry.tolerances import ROUNDING

#: A turn below this [rad] is no corner; rounding in the arithmetic only, a program's last digit turns by 1e-4 and more.
STRAIGHT = 1e-6


class Corners(Table, frozen=True):
    """
    Ends of a move at which another begins, one per row; all arrays of one length.

    point: programmed corner. arriving, leaving: unit tangents there. center_before, center_after: of arcs, else NaN.
    turning_before, turning_after: 1 CCW, -1 CW, 0 line. fits: both moves have a circle or line of the tool center.
    side: 1 tool on the left, -1 on the right. radius: R [mm], not negative.
    """

    point: Points
    arriving: Points
    leaving: Points
    center_before: Points
    center_after: Points
    turning_before: Floats
    turning_after: Floats
    fits: Mask
    side: Floats
    radius: Floats

    @property
    def vector_before(self) -> Points:
        """Offset vector perpendicular to the move that ends here: R*n1."""
        return 1j * (self.side * self.radius) * self.arriving

    @property
    def vector_after(self) -> Points:
        """Offset vector perpendicular to the move that begins here: R*n2."""
        return 1j * (self.side * self.radius) * self.leaving


def turn(corners: Corners) -> Points:
    """The turn from one tangent to the other as a unit vector: cosine + 1j * sine, left positive."""
    result: Points = corners.leaving * corners.arriving.conj()
    return result


def is_straight(turned: Points) -> Mask:
    """Which turns are no corner: the angle on the workpiece's side is 180 degrees."""
    return np.asarray((np.abs(turned.imag) < STRAIGHT) & (turned.real > 0))


def is_inner(corners: Corners, turned: Points) -> Mask:
    """
    Which corners the tool passes on the inner side, the angle on the workpiece's side being above 180 degrees.

    A full reversal has two readings: 360 degrees if the two curves open towards the tool like a valley, else 0
    (a ridge, as for two lines). Mitsubishi M700V programming manual p. 177 has the classes; the reversal is derived.
    """
    reversal = (np.abs(turned.imag) < STRAIGHT) & (turned.real < 0)
    inner = corners.side * turned.imag > 0
    if reversal.any():
        inner[reversal] = _is_valley(corners[reversal])
    return np.asarray(inner)


def _is_valley(corners: Corners) -> Mask:
    before = _curvature(corners.turning_before, corners.center_before, corners.point)
    after = _curvature(corners.turning_after, corners.center_after, corners.point)
    noise = 1e-6 * (np.abs(before) + np.abs(after))
    return np.asarray(corners.side * (before + after) < -noise)


def _curvature(turning: Floats, center: Points, point: Points) -> Floats:
    """Signed curvature [1/mm], left positive, 0 for lines."""
    is_arc = turning != 0
    return np.where(is_arc, turning / np.where(is_arc, np.abs(center - point), 1.0), 0.0)


def mitre(corners: Corners, turned: Points) -> Points:
    """Where the tangents, shifted by R, meet: P + R * (n1 + n2) / (1 + n1.n2); not finite after a full reversal."""
    bisector = 1j * (corners.arriving + corners.leaving)
    square = 1 + turned.real
    square[square < 1e-12] = np.nan
    shifted: Points = bisector * (corners.side * corners.radius / square)
    return corners.point + shifted


def squared_off(corners: Corners) -> tuple[Points, Points]:
    """The two ends of the line across an acute outside corner: P + R*n1 + R*d1 and P + R*n2 - R*d2."""
    before = corners.point + corners.vector_before + corners.radius * corners.arriving
    after = corners.point + corners.vector_after - corners.radius * corners.leaving
    return before, after


def meeting(corners: Corners, turned: Points, inner: Mask) -> Points:
    """
    Where the paths of the tool center meet: the tangents shifted by R; at inner corners the curves themselves, at the
    point nearest to the corner, not finite where they do not meet.

    An arc whose end is off its circle counts as a circle about the same center through that end
    (FANUC 16/18-C lathe manual p. 232).
    """
    result = mitre(corners, turned)
    before, after = corners.turning_before != 0, corners.turning_after != 0
    for pairs, find in (
        (~before & after, _line_and_arc),
        (before & ~after, _arc_and_line),
        (before & after, _arc_and_arc),
    ):
        rows = np.flatnonzero(pairs & inner)
        if len(rows):
            result[rows] = find(corners[rows])
    result[inner & ~corners.fits] = complex(np.nan, np.nan)
    return result


def _line_and_arc(corners: Corners) -> Points:
    radius = _tool_circle(corners, corners.center_after, corners.turning_after)
    on_line = corners.point + corners.vector_before
    return _nearest(corners, *_cut_line(on_line, corners.arriving, corners.center_after, radius))


def _arc_and_line(corners: Corners) -> Points:
    radius = _tool_circle(corners, corners.center_before, corners.turning_before)
    on_line = corners.point + corners.vector_after
    return _nearest(corners, *_cut_line(on_line, corners.leaving, corners.center_before, radius))


def _arc_and_arc(corners: Corners) -> Points:
    before = _tool_circle(corners, corners.center_before, corners.turning_before)
    after = _tool_circle(corners, corners.center_after, corners.turning_after)
    apart = corners.center_after - corners.center_before
    distance = np.abs(apart)
    distance[distance < ROUNDING] = np.nan
    direction = apart / distance
    reach = (distance**2 + before**2 - after**2) / (2 * distance)
    half = _half_chord(before**2 - reach**2, before)
    return _nearest(corners, corners.center_before + direction * reach, 1j * direction, half)


def _tool_circle(corners: Corners, center: Points, turning: Floats) -> Floats:
    """Radius [mm] of the tool center's circle: arc radius less R inside the arc, plus R outside."""
    return np.abs(center - corners.point) - corners.side * turning * corners.radius


def _cut_line(on_line: Points, direction: Points, center: Points, radius: Floats) -> tuple[Points, Points, Floats]:
    """Foot of the center on the line, direction of the line, half of the chord that the circle cuts out of it."""
    foot = on_line + direction * ((center - on_line) * direction.conj()).real
    return foot, direction, _half_chord(radius**2 - np.abs(center - foot) ** 2, radius)


def _half_chord(squared: Floats, radius: Floats) -> Floats:
    """Root of the square; NaN where the curves miss each other, 0 where they touch but for rounding."""
    misses = squared < -1e-12 * radius**2
    return np.sqrt(np.where(misses, np.nan, np.maximum(squared, 0.0)))


def _nearest(corners: Corners, foot: Points, direction: Points, half: Floats) -> Points:
    """The nearer of two common points; at the same distance the one that shortens the two moves."""
    back, forth = foot - direction * half, foot + direction * half
    retreat = (corners.leaving - corners.arriving).conj()
    return np.where(_detour(corners, back, retreat) <= _detour(corners, forth, retreat), back, forth)


def _detour(corners: Corners, candidate: Points, retreat: Points) -> Floats:
    away = candidate - corners.point
    result: Floats = np.abs(away) - 1e-6 * (away * retreat).real
    return result
