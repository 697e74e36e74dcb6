"""Circles with keyways, as of shafts and bores with one and of splines with many; lengths in mm."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np
from msgspec.structs import replace

from polarcheck.foundation.arrays import Mask
from polarcheck.geometry.shapes.shape import SAME, SAME_DIRECTION, Shape, off_axis, turned_by
from polarcheck.geometry.shapes.side_rings import Ring

#: Greatest distance of a point from the line or the circle that it touches [mm].
_TOUCHES = 3 * SAME
#: A keyway is narrower than this share of the circle.
_WIDEST = 0.9


class _Keyway(msgspec.Struct, frozen=True):
    """
    A keyway in a circle, or a key that stands out of it.

    width: of its walls; distance: of its bottom from the center of the circle; direction: unit vector to it. radius: of
    a round bottom, else 0. corner: R of the corners at its bottom, 0 for sharp ones.
    """

    width: float
    distance: float
    direction: complex
    radius: float
    corner: float


def keyed_round_of(ring: Ring) -> Shape | None:
    """A circle with one keyway, or with several equal ones at equal angles; None for anything else."""
    arc = ~ring.is_line
    if not ring.closed or not arc.any() or arc.all():
        return None
    main = int(np.argmax(np.where(arc & (ring.sweep > 0), ring.length, -1.0)))
    center, radius = complex(ring.center[main]), float(ring.radius[main])
    off = np.abs(np.nan_to_num(ring.center - center)) + np.abs(np.nan_to_num(ring.radius - radius))
    on_circle = arc & (ring.sweep > 0) & (off <= 2 * SAME)
    keyways = []
    for piece in _between(ring, on_circle):
        keyway = _keyway_of(piece, center, radius)
        if keyway is None:
            return None
        keyways.append(keyway)
    first, count = keyways[0], len(keyways)
    for number, second in enumerate(keyways):
        turn = second.direction / first.direction * np.exp(-2j * np.pi * number / count)
        sizes, same = ((notch.width, notch.distance, notch.radius, notch.corner) for notch in (first, second))
        if abs(np.angle(turn)) > SAME_DIRECTION or np.abs(np.subtract(sizes, same)).max() > 2 * SAME:
            return None
    values = {"diameter": 2 * radius, "keyways": float(count), "width": first.width, "distance": first.distance}
    values |= {name: size for name, size in (("radius", first.radius), ("corner_radius", first.corner)) if size}
    values |= {"turned": turned_by(first.direction, count), **off_axis(center)}
    return Shape("round with keyway", ring.inside, values, row=int(ring.row[main]))


def _between(ring: Ring, on_circle: Mask) -> Iterator[Ring]:
    """The sides between the arcs of a circle, a ring for each stretch, in the order in which they run."""
    order = np.roll(np.arange(len(ring)), -int(np.argmax(on_circle)))
    number = np.cumsum(on_circle[order])
    for stretch in np.unique(number):
        chosen = order[(number == stretch) & ~on_circle[order]]
        if len(chosen):
            yield replace(ring[chosen], closed=False)


def _keyway_of(piece: Ring, center: complex, radius: float) -> _Keyway | None:
    """Two parallel walls from the circle, as far from its center as each other, and the bottom between them."""
    line, last = piece.is_line, len(piece) - 1
    if line.tolist() not in ([True] * 3, [True, False, True], [True, False, True, False, True]):
        return None
    # In the direction of the first wall, and to the left of it; walls may be too short to tell their direction.
    along = complex(piece.start[0] + piece.end[last]) / 2 - center
    if not abs(along) > _TOUCHES:  # arcs whose ends lie on no circle have no center
        return None
    along *= np.sign(((piece.end[0] - piece.start[0]) * along.conjugate()).real) / abs(along)
    if not along:
        return None
    start, end, middle = ((points - center) / along for points in (piece.start, piece.end, piece.center))
    half = float(start.imag[0])
    off = [end.imag[0] - half, start.imag[last] + half, end.imag[last] + half]
    off += [abs(start[0]) - radius, abs(end[last]) - radius]
    size, corner = abs(half), 0.0
    if last == 2 and not line[1]:
        bottom, end_radius = float(middle.real[1]) + size, size
        off += [middle.imag[1], piece.radius[1] - size, (piece.sweep[1] + np.sign(half) * np.pi) * size]
    else:
        side, end_radius = last // 2, 0.0
        bottom = float((start.real[side] + end.real[side]) / 2)
        off += [start.real[side] - bottom, end.real[side] - bottom]
        if last == 4:
            corner = float(piece.radius[[1, 3]].mean())
            off += [*(piece.radius[[1, 3]] - corner), *(middle.real[[1, 3]] + corner - bottom)]
            off += [*(np.abs(middle.imag[[1, 3]]) + corner - size)]
    if np.abs(off).max() > _TOUCHES or size > _WIDEST * radius:
        return None
    sense = 1 if start.real[0] > 0 else -1
    return _Keyway(2 * size, sense * bottom, sense * along, end_radius, corner)
