"""The shapes of an outline."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Mask
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.outline import Outline
from polarcheck.geometry.shapes.corners import sides_of
from polarcheck.geometry.shapes.keyways import keyed_round_of
from polarcheck.geometry.shapes.open_ones import bound_one_piece, flats_of, keyway_of
from polarcheck.geometry.shapes.polygons import circle_of_chords, cross_of, polygon_of
from polarcheck.geometry.shapes.rounds import round_of, two_rounds_of
from polarcheck.geometry.shapes.shape import Shape
from polarcheck.geometry.shapes.side_rings import SHARP, Ring, directions, extents_of, rings


def shapes_of(outline: Outline, gap: float = 0.0, bar: float = np.nan) -> list[Shape]:
    """
    What an outline is, a shape for each boss and each pocket, open ones first; found once for each outline.

    gap: what of it was closed by a straight line [mm]. bar: diameter [mm], NaN if not known.
    """
    found, key = vars(outline), f"shapes {gap} {bar}"
    if key not in found:
        found[key] = shapes_of_rings(rings(outline, gap, bar), bar)
    return [*found[key]]


def shapes_of_rings(rings: Iterable[Ring], bar: float = np.nan) -> list[Shape]:
    """The shapes of rings."""
    chains: list[Ring] = []
    remaining: list[Ring] = []
    for ring in rings:
        if _is_of_flats(ring):
            chains.append(ring)
        elif len(ring):
            remaining.append(ring)
    single = [ring[side : side + 1] for ring in chains for side in range(len(ring))]
    if len(single) > len(chains) and not bound_one_piece(single, bar):
        single = [ring for ring in chains if len(ring) == 1]
        remaining = [*(ring for ring in chains if len(ring) > 1), *remaining]
    beyond = _beyond(min((ring.beyond for ring in single), default=np.inf))
    flats = [msgspec.structs.replace(shape, values=shape.values | beyond) for shape in flats_of(single)]
    return flats + [_shape_of(ring) for ring in remaining]


def _shape_of(ring: Ring) -> Shape:
    keep_time()
    shape, corners = _recognised(ring), _beyond(ring.beyond)
    sharp = _is_sharp_inside(ring)
    if sharp.any():
        corners["inside_corners"] = float(np.count_nonzero(sharp))
        fits = _fits_corners(ring, sharp)
        corners |= {"corner_reach": fits} if np.isfinite(fits) else {}
    return msgspec.structs.replace(shape, values=shape.values | corners)


def _is_of_flats(ring: Ring) -> bool:
    """An open ring of straight sides, convex: what stands is within all of them."""
    if ring.closed or not ring.is_line.all():
        return False
    into, out = directions(ring)
    turn = np.angle(out[1:] * into[:-1].conj())
    return len(ring) > 0 and bool((turn > 0).all()) and float(turn.sum()) < 2 * np.pi


def _beyond(radius: float) -> dict[str, float]:
    return {"reach_beyond": radius} if np.isfinite(radius) else {}


def _fits_corners(ring: Ring, sharp: Mask) -> float:
    """The largest R that mills each straight wall beside a sharp inside corner, if only to its far end [mm]."""
    into, out = directions(ring)
    turn = np.abs(np.angle(np.roll(out, -1) * into.conj()))
    taken = np.where(sharp, np.tan(np.minimum(turn, 3.0) / 2), 0.0)
    taken = taken + np.roll(taken, 1)
    adjacent = ring.is_line & (taken > 0)
    return float(np.min(ring.length[adjacent] / taken[adjacent], initial=np.inf))


def _recognised(ring: Ring) -> Shape:
    sides = sides_of(ring)
    of_sides = sides and (circle_of_chords(ring, sides) or polygon_of(ring, sides) or cross_of(ring, sides))
    of_circle = round_of(ring) or two_rounds_of(ring) or keyed_round_of(ring)
    return of_circle or of_sides or keyway_of(ring) or contour_of(ring)


def contour_of(ring: Ring) -> Shape:
    """Anything else, by its extents."""
    values = extents_of(ring)
    if ring.closed:
        values["area"] = ring.area
    values |= _inside_radius(ring)
    return Shape("contour", ring.inside, values, row=int(ring.row[0]), is_open=not ring.closed)


def _inside_radius(ring: Ring) -> dict[str, float]:
    """The smallest radius into which the tool has to go [mm], 0 for a sharp inside corner; none where there is none."""
    hollow = ring.radius[(ring.sweep * _air(ring)) > 0]
    if _is_sharp_inside(ring).any():
        return {"inside_radius": 0.0}
    return {"inside_radius": float(hollow.min())} if len(hollow) else {}


def _is_sharp_inside(ring: Ring) -> Mask:
    """The sides behind which the tool finds a sharp inside corner."""
    into, out = directions(ring)
    turn = np.angle(np.roll(out, -1) * into.conj()) * _air(ring)
    sharp = turn > SHARP
    sharp[-1] &= ring.closed
    return np.asarray(sharp)


def _air(ring: Ring) -> int:
    """On which side of a ring the tool is: 1 for its left."""
    return 1 if ring.inside else -1
