"""The straight sides of a ring with their corners: sharp, round, chamfered; lengths in mm."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, column_at
from polarcheck.geometry.shapes.shape import SAME
from polarcheck.geometry.shapes.side_rings import Ring

#: Greatest distance of the circle of a round corner from the adjacent lines [mm].
_TANGENT = 3 * SAME
#: A chamfer is shorter than this share of either side beside it, and turns as much at both of its ends [rad].
_CHAMFER, _EVEN = 0.6, 0.02


class Sides(Table, frozen=True):
    """
    Straight sides of a closed ring that runs counterclockwise, n of them.

    start, end: complex128[n]. row: int[n]. radius, chamfer: float64[n], of the corner behind each, 0 where there is
    none; of a chamfer how much of the side it takes.
    """

    start: Points
    end: Points
    row: Rows
    radius: Floats
    chamfer: Floats

    @property
    def normal(self) -> Points:
        """Away from what they enclose; length 1."""
        vector = self.end - self.start
        return np.asarray(-1j * vector / np.abs(vector))

    @property
    def middle(self) -> Points:
        """Of each side."""
        return np.asarray((self.start + self.end) / 2)

    @property
    def turn(self) -> Floats:
        """From each side to the next [rad], above 0 to the left."""
        return np.asarray(np.angle(np.roll(self.normal, -1) * self.normal.conj()))

    @property
    def is_convex(self) -> bool:
        """It turns to the left at each corner, and once round."""
        return len(self) > 2 and bool((self.turn > 0).all()) and abs(float(self.turn.sum()) - 2 * np.pi) < 1

    def corner_values(self, turned: float = np.nan) -> dict[str, float]:
        """
        How large the corners are, as values of a shape; nothing where all are sharp.

        turned: direction of the side behind which corner_1 lies [deg], NaN for corners without numbers.
        """
        if self.radius.any() and self.chamfer.any():
            values = {"corner_radius": float(self.radius.max()), "corner_chamfer": float(self.chamfer.max())}
            counts = {"round": int((self.radius > 0).sum()), "chamfered": int((self.chamfer > 0).sum())}
            counts["sharp"] = len(self) - sum(counts.values())
            return values | {"corner_least": 0.0} | {f"corners_{name}": float(count) for name, count in counts.items()}
        for name, size in (("corner_radius", self.radius), ("corner_chamfer", self.chamfer)):
            if not size.any():
                continue
            least, most = float(size.min()), float(size.max())
            if most - least <= 2 * SAME:
                return {name: float(size.mean())}
            values = {name: most, "corner_least": least}
            if not np.isnan(turned):
                first = int(np.argmax((self.normal * np.exp(-1j * np.radians(turned))).real))
                in_turn = np.roll(size, -first).tolist()
                values |= {f"corner_{number}": value for number, value in enumerate(in_turn, 1)}
            return values
        return {}


def sides_of(ring: Ring) -> Sides | None:
    """The sides of a closed ring of lines whose arcs round their corners alone; None where an arc does more."""
    line = ring.is_line
    if not ring.closed or np.count_nonzero(line) < 3:
        return None
    arc = np.flatnonzero(~line)
    before, after = arc - 1, (arc + 1) % len(ring)
    rounding, center, normal = ring.radius[arc], ring.center[arc], ring.normal
    fits = line[before] & line[after] & (ring.sweep[arc] > 0) & (ring.sweep[arc] < np.pi * 0.99)
    for side in (before, after):
        inside = ((ring.start[side] - center) * normal[side].conj()).real
        fits &= np.abs(inside - rounding) <= _TANGENT
    if not fits.all():
        return None
    radius = column_at(len(ring), before, rounding, 0.0)
    rows = np.flatnonzero(line)
    return Sides(ring.start[rows], ring.end[rows], ring.row[rows], radius[rows], np.zeros(len(rows)))


def without_chamfers(sides: Sides) -> Sides | None:
    """The sides without those that chamfer the corner between two longer ones; None where there are none."""
    if len(sides) < 5:
        return None
    length, turn = np.abs(sides.end - sides.start), sides.turn
    shorter = length < _CHAMFER * np.minimum(np.roll(length, 1), np.roll(length, -1))
    is_sharp = (sides.radius == 0) & (np.roll(sides.radius, 1) == 0)
    chamfers = shorter & is_sharp & (np.abs(turn - np.roll(turn, 1)) < _EVEN)
    kept = np.flatnonzero(~chamfers)
    if not chamfers.any() or len(kept) < 3 or (chamfers & np.roll(chamfers, 1)).any():
        return None
    leg: Floats = length / (2 * np.cos(np.abs(turn)))
    chamfer = np.where(np.roll(chamfers, -1), np.roll(leg, -1), 0.0)[kept]
    return Sides(sides.start[kept], sides.end[kept], sides.row[kept], sides.radius[kept], chamfer)


def is_at(values: Floats, size: float) -> Mask:
    """The values that are this size."""
    return np.asarray(np.abs(values - size) <= SAME)
