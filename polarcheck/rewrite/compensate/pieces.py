"""Lines and arcs on the polar plane; plane points are complex, x + 1j*c [mm, radius]."""

from __future__ import annotations

import math

import msgspec

from polarcheck.geometry.tolerances import ZERO
from polarcheck.rewrite.writing.written_arcs import arc_between, swept

#: Lines whose directions differ by no more are parallel [rad].
_PARALLEL = 1e-12


class Piece(msgspec.Struct, frozen=True):
    """
    A line or an arc.

    start, end: plane points [mm]; an arc whose ends are one point is a full circle.
    center: center of an arc; None for a line.
    turning: 1 counterclockwise, -1 clockwise, 0 for a line.
    move: number of the move that it comes from.
    """

    start: complex
    end: complex
    center: complex | None = None
    turning: int = 0
    move: int = -1

    @property
    def radius(self) -> float:
        """R of an arc [mm]; inf for a line."""
        return math.inf if self.center is None else abs(self.start - self.center)

    @property
    def leaving(self) -> complex:
        """Unit tangent at the start."""
        return self._tangent(self.start)

    @property
    def arriving(self) -> complex:
        """Unit tangent at the end."""
        return self._tangent(self.end)

    def _tangent(self, point: complex) -> complex:
        if self.center is None:
            chord = self.end - self.start
            return chord / (abs(chord) or 1.0)
        spoke = point - self.center
        return 1j * self.turning * spoke / (abs(spoke) or 1.0)

    @property
    def sweep(self) -> float:
        """Angle of an arc [rad], above 0; 0 for a line."""
        return 0.0 if self.center is None else abs(swept(self.start, self.end, self.center, self.turning > 0))

    @property
    def length(self) -> float:
        """Its length [mm]."""
        return abs(self.end - self.start) if self.center is None else self.radius * self.sweep

    def at(self, share: float) -> complex:
        """Return the point at a share of the piece, 0 to 1; on a spiral if the end of an arc is off its circle."""
        if self.center is None:
            return self.start + share * (self.end - self.start)
        return arc_between(self.start, self.end, self.center, self.turning > 0).at(share)

    @property
    def back(self) -> Piece:
        """The same piece from its end to its start."""
        return msgspec.structs.replace(self, start=self.end, end=self.start, turning=-self.turning)

    def replaced(self, start: complex | None = None, end: complex | None = None) -> Piece:
        """Return the piece with another start or end on the same line or circle."""
        return msgspec.structs.replace(
            self, start=self.start if start is None else start, end=self.end if end is None else end
        )


def moved_aside(piece: Piece, aside: float) -> Piece | None:
    """Return the parallel of the piece, `aside` [mm] to its left; None for an arc that would vanish."""
    start, end = piece.start + 1j * aside * piece.leaving, piece.end + 1j * aside * piece.arriving
    if piece.center is not None and piece.radius - piece.turning * aside <= ZERO:
        return None
    return msgspec.structs.replace(piece, start=start, end=end)


def meeting_points(first: Piece, second: Piece) -> list[complex]:
    """Return the points where the lines or circles of two pieces, extended, meet: none, one or two."""
    if first.center is None:
        return _of_lines(first, second) if second.center is None else _of_line(first, second.center, second.radius)
    if second.center is None:
        return _of_line(second, first.center, first.radius)
    return _of_circles(first.center, first.radius, second.center, second.radius)


def _of_lines(first: Piece, second: Piece) -> list[complex]:
    direction, second_direction = first.leaving, second.leaving
    slope = _cross(direction, second_direction)
    return (
        [first.start + direction * (_cross(second.start - first.start, second_direction) / slope)]
        if abs(slope) > _PARALLEL
        else []
    )


def _cross(first: complex, second: complex) -> float:
    return (first.conjugate() * second).imag


def _of_line(line: Piece, center: complex, radius: float) -> list[complex]:
    """Return the points where a line meets a circle."""
    along = line.leaving
    foot = line.start + along * ((center - line.start) * along.conjugate()).real
    square = radius**2 - abs(foot - center) ** 2
    return [foot - math.sqrt(square) * along, foot + math.sqrt(square) * along] if square >= 0 else []


def _of_circles(center: complex, radius: float, other_center: complex, other_radius: float) -> list[complex]:
    vector = other_center - center
    apart = abs(vector)
    if apart <= ZERO:
        return []
    # Both lie on a line across that between the centers.
    foot = center + vector / apart * (apart**2 + radius**2 - other_radius**2) / (2 * apart)
    return _of_line(Piece(foot, foot + 1j * vector), center, radius)
