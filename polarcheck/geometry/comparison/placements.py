"""
Other placements of a drawing, with which a part would agree: other units, mirrored, X as a diameter, turned, shifted.

Lengths are in mm, plane points complex, x + 1j*c.
"""

from __future__ import annotations

import cmath
import itertools
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from polarcheck.foundation.arrays import Floats, Points
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.comparison.alignment import best_turn
from polarcheck.geometry.comparison.deviation import Difference, Made, difference
from polarcheck.geometry.comparison.measured_path import Way, way_of

#: Another placement is named if it reduces the difference at least to this share.
_FAR_LESS = 0.05
#: A placement that is off the center may halve the difference of one side; it is named below this share.
_SHIFTED_LESS = 0.2
#: A smaller shift [mm] or turn [rad] is none.
_NO_SHIFT, _NO_TURN = 1e-3, 1e-5
#: Points of a contour for the quick comparison and for the refinement; steps of the latter.
_FEW, _STEPS = 400, 12
#: Differences below this count alike in the refinement [mm].
_LEAST = 1e-3
#: Curves of the drawing that are tried for each change.
_MOST_CURVES = 4
#: Centers of arcs that may be meant for the axis.
_CENTERS = 2
#: From one chord of an arc to the next the direction changes by less than this [rad].
_LARGEST_TURN = 0.5
#: Most chords from which the centers of arcs are found; beyond it only every second, third, ... chord counts.
_MOST_ARCS = 1000
#: Arcs whose centers are nearer to each other than this share of their radius have the same center.
_SAME_CENTER = 0.01


class Placement(NamedTuple):
    """
    A change of a drawing, its steps in this order.

    scale: all lengths are multiplied by this.
    mirrored: C has the other sign.
    x_factor: X is multiplied by this.
    turned: angle about the center [rad].
    shift: the drawing is shifted by this [mm].
    """

    scale: float = 1.0
    mirrored: bool = False
    x_factor: float = 1.0
    turned: float = 0.0
    shift: complex = 0j

    def of(self, way: Way, center: complex) -> Way:
        """The path after this change."""
        return way_of(self.points(way.start, center), self.points(way.end, center), way.of)

    def points(self, points: Points, center: complex) -> Points:
        """The points after this change."""
        points = self.scale * (points.conj() if self.mirrored else points)
        points = self.x_factor * points.real + 1j * points.imag
        center *= self.scale
        return np.asarray(center + (points - center) * cmath.exp(1j * self.turned) + self.shift)


class Freedom(NamedTuple):
    """
    The changes that are tried.

    stretches: a drawing, which may be mirrored or have X as a diameter; else a shape with its numbers.
    turns: its angle is given, so that another one is a change.
    is_round: it looks the same at any angle.
    """

    stretches: bool
    turns: bool
    is_round: bool


def better_placement(
    made: Made, ways: Sequence[Way], center: complex, now: Difference, tolerance: float, freedom: Freedom
) -> tuple[Placement, float] | None:
    """
    The simplest change of a drawing with which a contour agrees, or else the best one with which it nearly agrees, and
    the difference that remains [mm]; None if there is none.

    ways: the curves of the drawing that the contour may be meant for, the one that it was compared with first.
    center: the point about which the drawing is turned, and the axis in a drawing that is shifted [mm].
    now: the difference without a change.
    """
    best: tuple[Placement, float] | None = None
    enough = max(tolerance, _FAR_LESS * now.largest)
    for way, placement in _candidates(made, ways, center, enough, freedom):
        keep_time()
        limit = min(enough, _SHIFTED_LESS * now.largest) if placement.shift else enough
        placed = placement.of(way, center)
        remaining = _difference_within(made, placed, limit)
        if remaining is None:
            continue
        if remaining <= tolerance:
            return placement, remaining
        # The simplest come first: one that is better by less than a shift that counts is no better.
        if best is None or remaining < best[1] - _NO_SHIFT:
            best = placement, remaining
    return best


def agrees(made: Made, way: Way, tolerance: float) -> bool:
    """Tells whether a contour agrees with a curve where that lies, within a tolerance [mm]."""
    return _difference_within(made, way, tolerance) is not None


def _difference_within(made: Made, way: Way, limit: float) -> float | None:
    """The largest difference of a contour from a curve [mm]; None where it is above a limit, or nothing is compared."""
    both_ways = _both_closed(made.way, way)
    if both_ways and _mean(made.way, way) > limit:
        return None
    found = difference(made, way, both_ways=both_ways)
    return found.largest if found.length and found.largest <= limit else None


def _candidates(
    made: Made, ways: Sequence[Way], center: complex, enough: float, freedom: Freedom
) -> Iterator[tuple[Way, Placement]]:
    """Curves and changes of them, the simplest first: nothing is shifted that fits as it lies."""
    plain: list[tuple[Way, Placement]] = []
    for placement in _plain(freedom):
        alike = (
            way for way in ways if not _both_closed(made.way, way) or _alike_in_size(made.way, way, placement, enough)
        )
        plain += [(way, placement) for way in itertools.islice(alike, _MOST_CURVES)]
    for place in (_turned, _shifted):
        for way, changed in plain:
            for placement in place(made, way, changed, center, freedom):
                is_turned = freedom.turns and placement.turned != 0
                if is_turned or placement._replace(turned=0.0) != Placement():
                    yield way, placement


def _plain(freedom: Freedom) -> Iterator[Placement]:
    """The changes that neither turn nor shift, the simplest first."""
    scales = (1.0, MM_PER_INCH, 1 / MM_PER_INCH)
    yield from map(Placement, scales)
    if freedom.stretches:
        yield Placement(mirrored=True)
        # What has X as a diameter in the drawing or in the program.
        yield from (Placement(x_factor=factor) for factor in (2.0, 0.5))
        yield from (Placement(scale, mirrored=True) for scale in scales[1:])
        yield from (Placement(scale, x_factor=factor) for scale, factor in itertools.product(scales[1:], (2.0, 0.5)))


def _turned(made: Made, way: Way, plain: Placement, center: complex, freedom: Freedom) -> Iterator[Placement]:
    """A change as it is, and turned."""
    may_turn = _may_turn(plain, freedom)
    if freedom.turns or not may_turn:
        yield plain
    if may_turn:
        yield plain._replace(turned=_rounded(best_turn(made.way, plain.of(way, center), center * plain.scale)))


def _shifted(made: Made, way: Way, plain: Placement, center: complex, freedom: Freedom) -> Iterator[Placement]:
    """A change with a shift, and turned as well."""
    changed, middle, may_turn = plain.of(way, center), center * plain.scale, _may_turn(plain, freedom)
    for here, there in _places(made, changed):
        turns = [0.0] if freedom.turns or not may_turn else []
        if may_turn:
            moved = Placement(shift=there - here).of(changed, 0j)
            turns.append(_rounded(best_turn(made.way, moved, there)))
        for turned in turns:
            shift = there - middle - (here - middle) * cmath.exp(1j * turned)
            placement = _refined(made, way, center, plain._replace(turned=turned, shift=shift))
            if abs(placement.shift) > _NO_SHIFT:
                yield placement


def _may_turn(plain: Placement, freedom: Freedom) -> bool:
    """A drawing whose X has another scale is not turned."""
    return plain.x_factor == 1 and not freedom.is_round


def _rounded(angle: float) -> float:
    return 0.0 if abs(angle) < _NO_TURN else angle


def _places(made: Made, drawn: Way) -> Iterator[tuple[complex, complex]]:
    """Points of the drawing and where they may be meant to be: the middle of a contour, or the center of arcs."""
    if _both_closed(made.way, drawn):
        yield _middle(drawn), _middle(made.way)
    elif not _is_closed(made.way):
        yield from ((center, 0j) for center in _arc_centers(drawn))


def _refined(made: Made, way: Way, center: complex, placement: Placement) -> Placement:
    """
    A placement near this one with the least mean distance from the contour to the drawing: the middle of a contour is
    off by a share of what a single side is off.
    """
    if not _both_closed(made.way, way):
        return placement
    points, _ = made.way.at(np.linspace(0, made.way.length, _FEW, endpoint=False))
    turns = placement.turned != 0
    for _ in range(_STEPS):
        placed = placement.of(way, center)
        _, closest, which = placed.nearest(points)
        along = (placed.end - placed.start)[which]
        normal = 1j * along / np.abs(along)
        off = ((points - closest) * normal.conj()).real
        weight = 1 / np.sqrt(np.maximum(np.abs(off), _LEAST))
        pivot = center * placement.scale + placement.shift
        columns = [normal.real, normal.imag, *([((1j * (closest - pivot)) * normal.conj()).real] if turns else [])]
        step = np.linalg.lstsq(np.stack(columns, axis=1) * weight[:, None], off * weight, rcond=1e-6)[0]
        by = complex(step[0], step[1])
        placement = placement._replace(
            shift=placement.shift + by, turned=placement.turned + (float(step[2]) if turns else 0.0)
        )
        if abs(by) < _NO_SHIFT / 100:
            break
    return placement


def _mean(one: Way, other: Way) -> float:
    """The mean distance from points of one path to another path [mm]."""
    points, _ = one.at(np.linspace(0, one.length, _FEW))
    return float(other.nearest(points)[0].mean())


def _is_closed(way: Way) -> bool:
    """True for one ring."""
    return bool(
        len(way.start) > 2
        and abs(way.start[0] - way.end[-1]) <= _NO_SHIFT
        and (np.abs(way.start[1:] - way.end[:-1]) <= _NO_SHIFT).all()
    )


def _both_closed(one: Way, other: Way) -> bool:
    return _is_closed(one) and _is_closed(other)


def _area(way: Way) -> float:
    """The area in a ring [mm2]."""
    return abs(float((way.start.conj() * way.end).imag.sum()) / 2)


def _alike_in_size(one: Way, other: Way, plain: Placement, enough: float) -> bool:
    """False for rings whose areas differ by more than a strip of this width along them."""
    area = _area(other) * plain.scale**2 * plain.x_factor
    return abs(_area(one) - area) <= one.length * enough + np.pi * enough**2


def _middle(way: Way) -> complex:
    """The centroid of the area in a ring."""
    base = way.start[0]
    start, end = way.start - base, way.end - base
    weight = (start.conj() * end).imag
    return complex(base + ((start + end) * weight).sum() / (3 * weight.sum()))


def _arc_centers(way: Way) -> list[complex]:
    """The centers of the longest arcs of a drawing, which is made of chords."""
    follows = np.flatnonzero(np.abs(way.start[1:] - way.end[:-1]) == 0)
    first, second, third = way.start[follows], way.end[follows], way.end[follows + 1]
    one, other = second - first, third - first
    cross = (one.conj() * other).imag
    lengths: Floats = np.abs(other)
    # Chords of an arc turn by some degrees at most, and are of one length.
    arc = np.abs(cross) > 1e-9 * lengths**2
    arc &= np.abs(np.abs(one) - np.abs(third - second)) <= _SAME_CENTER * lengths
    arc &= np.abs(np.angle((third - second) * one.conj())) < _LARGEST_TURN
    chosen = np.flatnonzero(arc)[:: len(arc) // _MOST_ARCS + 1]
    first, one, other = first[chosen], one[chosen], other[chosen]
    cross, lengths = cross[chosen], lengths[chosen]
    centers = first + 1j * (other * np.abs(one) ** 2 - one * np.abs(other) ** 2) / (-2 * cross)
    radius, lengths = np.abs(centers - first), lengths / 2
    found: list[complex] = []
    while len(centers) and len(found) < _CENTERS:
        near = np.abs(centers[:, None] - centers) <= _SAME_CENTER * radius
        longest = int((near * lengths).sum(axis=1).argmax())
        found.append(complex(np.median(centers[near[longest]].real), np.median(centers[near[longest]].imag)))
        left = ~near[longest]
        centers, radius, lengths = centers[left], radius[left], lengths[left]
    return found
