"""What a control makes of an arc whose words are rounded, and the words that come nearest to the arc that is meant."""

from __future__ import annotations

import cmath
import itertools
import math

import msgspec

#: Largest error of the end of an arc along it, in least increments: both ends are rounded across and along.
_ALONG = 4.0


class Arc(msgspec.Struct, frozen=True):
    """
    An arc on the polar plane, as controls take it whose radius at the end is not quite that at the start.

    start, center: [mm]. sweep: [rad], above 0 counterclockwise, at most a full turn. growth: of the radius [mm].
    """

    start: complex
    center: complex
    sweep: float
    growth: float = 0.0

    @property
    def radius(self) -> float:
        """Its radius at the start [mm]."""
        return abs(self.start - self.center)

    @property
    def end(self) -> complex:
        """Where it ends [mm]."""
        return self.at(1.0)

    def at(self, share: float) -> complex:
        """The point behind a share of the sweep [mm]."""
        size = 1 + self.growth * share / self.radius if self.growth else 1.0
        return self.center + (self.start - self.center) * size * cmath.exp(1j * self.sweep * share)

    def parts(self, count: int) -> list[Arc]:
        """The arc in equal parts."""
        return [Arc(self.at(n / count), self.center, self.sweep / count, self.growth / count) for n in range(count)]


def arc_between(start: complex, end: complex, center: complex, ccw: bool) -> Arc:
    """The arc about a center from start to end [mm]; a full circle where they are the same point."""
    return Arc(start, center, swept(start, end, center, ccw), abs(end - center) - abs(start - center))


def swept(start: complex, end: complex, center: complex, ccw: bool) -> float:
    """The signed angle [rad] from start to end about a center; a full turn where they are the same point."""
    sense = 1 if ccw else -1
    spoke, last = start - center, end - center
    if abs(end - start) <= 1e-9 * max(1.0, abs(spoke)) or not spoke * last:
        return sense * math.tau
    return sense * (sense * cmath.phase(spoke.conjugate() * last) % math.tau)


def nearest_center(arc: Arc, start: complex, end: complex, step: float) -> tuple[int, int, float]:
    """
    Return I and J from a rounded start, in least increments of `step` [mm], and the largest deviation of the arc that
    they make with the rounded end [mm].
    """
    spoke = (arc.center - start) / step
    grid = [(math.floor(part) + n) for part in (spoke.real, spoke.imag) for n in (0, 1)]
    best = (0, 0, math.inf)
    for i, j in itertools.product(grid[:2], grid[2:]):
        center = start + complex(i, j) * step
        # The control compares the radii at both ends.
        growth = abs(end - center) - abs(start - center)
        deviation = _deviation(arc, start, end, center, step) + abs(growth - arc.growth)
        if deviation < best[2]:
            best = (i, j, deviation)
    return best


def nearest_radius(arc: Arc, start: complex, end: complex, step: float) -> tuple[int, float]:
    """
    Return the radius in least increments, and the deviation [mm] of the arc of 180 deg or less that it makes.

    The control computes the center from the radius and both ends. So the written arc has one radius, also where the
    arc that is meant grows by g; between two ends it leaves that by less than 0.03 g per 90 deg.
    """
    count = round(arc.radius / step)
    best = (count, math.inf)
    chord = end - start
    if not chord or abs(arc.sweep) > math.pi + 1e-6:
        return best
    half = abs(chord) / 2
    least = math.ceil(half / step * (1 - 1e-12))
    for radius in sorted({max(count + n, least, 1) for n in (-1, 0, 1)}):
        height = math.sqrt(max((radius * step) ** 2 - half**2, 0.0))
        center = start + chord / 2 + 1j * chord / abs(chord) * math.copysign(height, arc.sweep)
        deviation = _deviation(arc, start, end, center, step)
        if deviation < best[1]:
            best = (radius, deviation)
    return best


def _deviation(arc: Arc, start: complex, end: complex, center: complex, step: float) -> float:
    """How far an arc of rounded words is from the arc that is meant [mm], between its ends; inf if not there."""
    if start == center or end == center:
        return math.inf
    sweep = swept(start, end, center, arc.sweep > 0)
    if abs(sweep - arc.sweep) * arc.radius > _ALONG * step:
        return math.inf
    spoke, radius = start - center, arc.radius
    length = abs(spoke)
    growth = abs(end - center) - length
    points = (
        (share, center + spoke * (1 + growth * share / length) * cmath.exp(1j * sweep * share))
        for share in (0.25, 0.5, 0.75)
    )
    return max(abs(abs(point - arc.center) - (radius + arc.growth * share)) for share, point in points)
