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

from polarcheck.foundation.arrays import Floats, Points, median
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.comparison.alignment import best_turn
from polarcheck.geometry.comparison.deviation import Difference, MachinedPart, difference
from polarcheck.geometry.comparison.measured_path import MeasuredPath, path_of

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

    def of(self, path: MeasuredPath, center: complex) -> MeasuredPath:
        """The path after this change."""
        return path_of(self.points(path.start, center), self.points(path.end, center), path.of)

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
    part: MachinedPart,
    curves: Sequence[MeasuredPath],
    center: complex,
    now: Difference,
    tolerance: float,
    freedom: Freedom,
) -> tuple[Placement, float] | None:
    """
    The simplest change of a drawing with which a contour agrees, or else the best one with which it nearly agrees, and
    the difference that remains [mm]; None if there is none.

    curves: the curves of the drawing that the contour may be meant for, the one that it was compared with first.
    center: the point about which the drawing is turned, and the axis in a drawing that is shifted [mm].
    now: the difference without a change.
    """
    best: tuple[Placement, float] | None = None
    enough = max(tolerance, _FAR_LESS * now.largest)
    for curve, placement in _candidates(part, curves, center, enough, freedom):
        keep_time()
        limit = min(enough, _SHIFTED_LESS * now.largest) if placement.shift else enough
        placed = placement.of(curve, center)
        remaining = _difference_within(part, placed, limit)
        if remaining is None:
            continue
        if remaining <= tolerance:
            return placement, remaining
        # The simplest come first: one that is better by less than a shift that counts is no better.
        if best is None or remaining < best[1] - _NO_SHIFT:
            best = placement, remaining
    return best


def agrees(part: MachinedPart, curve: MeasuredPath, tolerance: float) -> bool:
    """Tells whether a contour agrees with a curve where that lies, within a tolerance [mm]."""
    return _difference_within(part, curve, tolerance) is not None


def _difference_within(part: MachinedPart, curve: MeasuredPath, limit: float) -> float | None:
    """The largest difference of a contour from a curve [mm]; None where it is above a limit, or nothing is compared."""
    both_ways = _both_closed(part.way, curve)
    if both_ways and _mean(part.way, curve) > limit:
        return None
    deviation = difference(part, curve, limit, both_ways=both_ways)
    return deviation.largest if deviation.length and deviation.largest <= limit else None


def _candidates(
    part: MachinedPart, curves: Sequence[MeasuredPath], center: complex, enough: float, freedom: Freedom
) -> Iterator[tuple[MeasuredPath, Placement]]:
    """Curves and changes of them, the simplest first: nothing is shifted that fits as it lies."""
    plain: list[tuple[MeasuredPath, Placement]] = []
    for placement in _plain(freedom):
        alike = (
            curve
            for curve in curves
            if not _both_closed(part.way, curve) or _alike_in_size(part.way, curve, placement, enough)
        )
        plain += [(curve, placement) for curve in itertools.islice(alike, _MOST_CURVES)]
    for variants in (_turned, _shifted):
        for curve, changed in plain:
            for placement in variants(part, curve, changed, center, freedom):
                is_turned = freedom.turns and placement.turned != 0
                if is_turned or placement._replace(turned=0.0) != Placement():
                    yield curve, placement


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


def _turned(
    part: MachinedPart, curve: MeasuredPath, plain: Placement, center: complex, freedom: Freedom
) -> Iterator[Placement]:
    """A change as it is, and turned."""
    may_turn = _may_turn(plain, freedom)
    if freedom.turns or not may_turn:
        yield plain
    if may_turn:
        yield plain._replace(turned=_rounded(best_turn(part.way, plain.of(curve, center), center * plain.scale)))


def _shifted(
    part: MachinedPart, curve: MeasuredPath, plain: Placement, center: complex, freedom: Freedom
) -> Iterator[Placement]:
    """A change with a shift, and turned as well."""
    changed, middle, may_turn = plain.of(curve, center), center * plain.scale, _may_turn(plain, freedom)
    for here, there in _places(part, changed):
        turns = [0.0] if freedom.turns or not may_turn else []
        if may_turn:
            moved = Placement(shift=there - here).of(changed, 0j)
            turns.append(_rounded(best_turn(part.way, moved, there)))
        for turned in turns:
            shift = there - middle - (here - middle) * cmath.exp(1j * turned)
            placement = _refined(part, curve, center, plain._replace(turned=turned, shift=shift))
            if abs(placement.shift) > _NO_SHIFT:
                yield placement


def _may_turn(plain: Placement, freedom: Freedom) -> bool:
    """A drawing whose X has another scale is not turned."""
    return plain.x_factor == 1 and not freedom.is_round


def _rounded(angle: float) -> float:
    return 0.0 if abs(angle) < _NO_TURN else angle


def _places(part: MachinedPart, drawn: MeasuredPath) -> Iterator[tuple[complex, complex]]:
    """Points of the drawing and where they may be meant to be: the middle of a contour, or the center of arcs."""
    if _both_closed(part.way, drawn):
        yield _middle(drawn), _middle(part.way)
    elif not _is_closed(part.way):
        yield from ((center, 0j) for center in _arc_centers(drawn))


def _refined(part: MachinedPart, curve: MeasuredPath, center: complex, placement: Placement) -> Placement:
    """
    A placement near this one with the least mean distance from the contour to the drawing: the middle of a contour is
    off by a share of what a single side is off.
    """
    if not _both_closed(part.way, curve):
        return placement
    points, _ = part.way.at(np.linspace(0, part.way.length, _FEW, endpoint=False))
    turns = placement.turned != 0
    for _ in range(_STEPS):
        placed = placement.of(curve, center)
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


def _mean(path: MeasuredPath, drawn: MeasuredPath) -> float:
    """The mean distance from points of one path to another path [mm]."""
    points, _ = path.at(np.linspace(0, path.length, _FEW))
    return float(drawn.nearest(points)[0].mean())


def _is_closed(path: MeasuredPath) -> bool:
    """True for one ring."""
    return bool(
        len(path.start) > 2
        and abs(path.start[0] - path.end[-1]) <= _NO_SHIFT
        and (np.abs(path.start[1:] - path.end[:-1]) <= _NO_SHIFT).all()
    )


def _both_closed(path: MeasuredPath, drawn: MeasuredPath) -> bool:
    return _is_closed(path) and _is_closed(drawn)


def _area(ring: MeasuredPath) -> float:
    """The area in a ring [mm2]."""
    return abs(float((ring.start.conj() * ring.end).imag.sum()) / 2)


def _alike_in_size(path: MeasuredPath, drawn: MeasuredPath, plain: Placement, enough: float) -> bool:
    """False for rings whose areas differ by more than a strip of this width along them."""
    area = _area(drawn) * plain.scale**2 * plain.x_factor
    return abs(_area(path) - area) <= path.length * enough + np.pi * enough**2


def _middle(ring: MeasuredPath) -> complex:
    """The centroid of the area in a ring."""
    base = ring.start[0]
    start, end = ring.start - base, ring.end - base
    weight = (start.conj() * end).imag
    return complex(base + ((start + end) * weight).sum() / (3 * weight.sum()))


def _arc_centers(path: MeasuredPath) -> list[complex]:
    """The centers of the longest arcs of a drawing, which is made of chords."""
    follows = np.flatnonzero(np.abs(path.start[1:] - path.end[:-1]) == 0)
    first, second, third = path.start[follows], path.end[follows], path.end[follows + 1]
    to_second, to_third = second - first, third - first
    cross = (to_second.conj() * to_third).imag
    lengths: Floats = np.abs(to_third)
    # Chords of an arc turn by some degrees at most, and are of one length.
    arc = np.abs(cross) > 1e-9 * lengths**2
    arc &= np.abs(np.abs(to_second) - np.abs(third - second)) <= _SAME_CENTER * lengths
    arc &= np.abs(np.angle((third - second) * to_second.conj())) < _LARGEST_TURN
    chosen = np.flatnonzero(arc)[:: len(arc) // _MOST_ARCS + 1]
    first, to_second, to_third = first[chosen], to_second[chosen], to_third[chosen]
    cross, lengths = cross[chosen], lengths[chosen]
    centers = first + 1j * (to_third * np.abs(to_second) ** 2 - to_second * np.abs(to_third) ** 2) / (-2 * cross)
    radius, lengths = np.abs(centers - first), lengths / 2
    main_centers: list[complex] = []
    while len(centers) and len(main_centers) < _CENTERS:
        near = np.abs(centers[:, None] - centers) <= _SAME_CENTER * radius
        longest = int((near * lengths).sum(axis=1).argmax())
        main_centers.append(complex(median(centers[near[longest]].real), median(centers[near[longest]].imag)))
        remaining = ~near[longest]
        centers, radius, lengths = centers[remaining], radius[remaining], lengths[remaining]
    return main_centers
