"""Contours that end beyond the bar: flats, open slots, keyways; lengths in mm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.foundation.arrays import Floats, Points, Rows
from polarcheck.geometry.shapes.shape import SAME, SAME_DIRECTION, Shape, each_flat, off_axis, polygon_name, turned_by
from polarcheck.geometry.shapes.side_rings import Ring

#: Walls within this angle count as parallel [rad].
_PARALLEL = 5 * SAME_DIRECTION


def flats_of(rings: Sequence[Ring]) -> list[Shape]:
    """The shapes that open rings of one straight side each form together: flats, and the walls of slots."""
    if not rings:
        return []
    row = int(rings[0].row[0])
    normal, out, pairs = _walls(rings)
    slots = [_slot(complex(directions[0]), distances, row) for directions, distances in pairs]
    return [*([_flats(normal, out, row)] if len(out) else []), *slots]


def bound_one_piece(rings: Sequence[Ring], bar: float) -> bool:
    """True if no wall reaches, within the bar, beyond a flat: one piece stands. bar: diameter [mm], NaN if unknown."""
    normal, out, _ = _walls(rings)
    for ring in rings:
        points = np.array([ring.start[0], ring.end[0]])
        if not np.isnan(bar):
            # Cut the wall off where it leaves the bar.
            along = points[1] - points[0]
            along /= abs(along)
            ends = (points * along.conjugate()).real
            aside = points[0] - ends[0] * along
            half = np.sqrt(max((bar / 2) ** 2 - abs(aside) ** 2, 0.0))
            points = aside + along * np.clip(ends, -half, half)
        if ((points[:, None] * normal.conj()).real > out + 3 * SAME).any():
            return False
    return True


def _walls(rings: Sequence[Ring]) -> tuple[Points, Floats, list[tuple[Points, Floats]]]:
    """Normals of the flats, their distances from the axis, each wall once; then the same for the pair of each slot."""
    normal = np.array([ring.normal[0] for ring in rings])
    out = np.array([float(((ring.start[0] + ring.end[0]) / 2 * ring.normal[0].conjugate()).real) for ring in rings])
    # Two pieces of one interrupted wall are one flat.
    is_same = (np.abs(np.angle(normal[:, None] * normal.conj())) <= _PARALLEL) & (np.abs(out[:, None] - out) <= SAME)
    first = np.argmax(is_same, axis=1) == np.arange(len(rings))
    normal, out, slots = normal[first], out[first], []
    while (pair := _facing(normal, out)) is not None:
        slots.append((normal[pair], out[pair]))
        normal, out = np.delete(normal, pair), np.delete(out, pair)
    return normal, out, slots


def _facing(normal: Points, out: Floats) -> Rows | None:
    """The two walls that face each other across the narrowest slot; None where no two do."""
    if len(out) < 2:
        return None
    opposite = np.abs(np.angle(-normal[:, None] * normal.conj())) <= _PARALLEL
    width = np.where(opposite, -(out[:, None] + out), -1.0)
    width[width <= 0] = np.inf
    best = int(np.argmin(width))
    pair = np.sort(np.array(np.unravel_index(best, width.shape), np.int64))
    return pair if np.isfinite(width.flat[best]) else None


def _flats(normal: Points, out: Floats, row: int) -> Shape:
    """The shape of walls by their normals and distances: a polygon if they are even and equal, else flats."""
    count = len(out)
    order = np.argsort(np.angle(normal * normal[0].conjugate()) % (2 * np.pi - _PARALLEL), kind="stable")
    normal, out = normal[order], out[order]
    even = np.abs(np.angle(normal * normal[0].conjugate() * np.exp(-2j * np.pi * np.arange(count) / count)))
    even = even.max() <= _PARALLEL
    equal = bool(np.ptp(out) <= 2 * SAME)
    if count == 2 and even:
        values = {"flats": 2.0, "apart": float(out.sum()), "turned": turned_by(normal[0], 2)}
        values |= {"distance": float(out.mean())} if equal else _sizes(normal, out)
        return Shape("flats", False, values, row=row, is_open=True)
    if count > 2 and even and equal:
        values = {"across_flats": 2 * float(out.mean()), "sides": float(count), "turned": turned_by(normal[0], count)}
        return Shape(polygon_name(count), False, values, row=row, is_open=True)
    values = {"flats": float(count), "turned": turned_by(normal[0], 1)}
    values |= {"distance": float(out.mean())} if equal else {}
    values |= _sizes(normal, out) if count > 1 else {}
    return Shape("flats", False, values, row=row, is_open=True)


def _sizes(normal: Points, out: Floats) -> dict[str, float]:
    """The values of flats at uneven distances: the least and the most, and those of each flat."""
    sizes = {} if np.ptp(out) <= 2 * SAME else {"least": float(out.min()), "most": float(out.max())}
    return sizes | each_flat(normal, out)


def _slot(normal: complex, out: Floats, row: int) -> Shape:
    """A slot through the whole bar, by the normal of its first wall and the distances of both."""
    middle = normal * complex(out[0] - out[1]) / 2
    values = {"width": -float(out.sum()), "turned": turned_by(1j * normal, 2), **off_axis(middle)}
    return Shape("slot", True, values, row=row, is_open=True)


def _joined_flats(ring: Ring, normal: complex, out: Floats) -> Shape | None:
    """Two flats cut in one path, with an arc round the bar from one to the other."""
    if ring.is_line[1] or ring.sweep[1] < 0:
        return None
    values = {"flats": 2.0, "apart": float(out.sum()), "turned": turned_by(normal, 2), "joined": float(ring.radius[1])}
    values |= {"distance": float(out.mean())} if abs(out[0] - out[1]) <= 2 * SAME else _sizes(ring.normal[[0, 2]], out)
    return Shape("flats", False, values, row=int(ring.row[0]), is_open=True)


def keyway_of(ring: Ring) -> Shape | None:
    """A slot open at one end, of two parallel walls and a bottom; or two flats and the arc that joins them."""
    if ring.closed or len(ring) != 3 or not ring.is_line[[0, 2]].all():
        return None
    normal = ring.normal
    if abs(np.angle(-normal[0] * normal[2].conjugate())) > _PARALLEL:
        return None
    out = ((ring.start + ring.end) / 2 * normal.conj()).real[[0, 2]]
    width = -float(out.sum())
    # The direction into the slot, along its first wall.
    along = complex(ring.end[0] - ring.start[0])
    along /= abs(along)
    if width <= 0:
        return _joined_flats(ring, complex(normal[0]), out)
    values = {"width": width, "turned": turned_by(-along, 1)}
    if ring.is_line[1]:
        if abs(np.angle(normal[1] * -along)) > _PARALLEL and abs((normal[1] * along.conjugate()).imag) > _PARALLEL:
            return None
        bottom = (ring.start[1] + ring.end[1]) / 2
    else:
        if ring.sweep[1] > 0 or abs(ring.radius[1] - width / 2) > 3 * SAME:
            return None
        bottom = ring.center[1] + ring.radius[1] * along
        values["radius"] = float(ring.radius[1])
    values["distance"] = -float((bottom * along.conjugate()).real)
    values |= off_axis(complex(normal[0]) * complex(out[0] - out[1]) / 2)
    return Shape("keyway", True, values, row=int(ring.row[0]), is_open=True)
