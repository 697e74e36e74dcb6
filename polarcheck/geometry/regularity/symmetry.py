"""How regular a ring is: its turns and mirror images that leave it as it is, and what is left free by them."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Points, Rows
from polarcheck.geometry.regularity.rings import Ring

#: Axes of symmetry lie in steps of this angle where they are along an axis, or as those of a polygon on it [rad].
_STEP, _ALIGNED = np.pi / 12, 0.002
#: A ring with less area than this share of the square of its size is none.
_FLAT = 1e-3


class Symmetry(msgspec.Struct, frozen=True):
    """
    The symmetry of a ring of n corners.

    order: how many turns leave it as it is, within one full turn, 1 for none but that. mirrored: a mirror image does.
    freedom: how many numbers still say where all corners are and how arcs bulge; 2 n and one for each arc without any
    symmetry. corners: n. arcs: edges that are arcs. turns_at_start: a corner is where the path begins.
    """

    order: int
    mirrored: bool
    freedom: int
    corners: int
    arcs: int
    turns_at_start: bool

    @property
    def is_regular(self) -> bool:
        """All corners and edges are alike."""
        return self.order == self.corners

    @property
    def images(self) -> int:
        """How many turns and mirror images leave it as it is."""
        return self.order * (1 + self.mirrored)

    @property
    def fixed(self) -> int:
        """The number of coordinates and bulges that follow from the others."""
        return 2 * self.corners + self.arcs - self.freedom

    @property
    def corners_behind_start(self) -> int:
        """The number of corners but that where the path begins, which may be a point within a side."""
        return self.corners - self.turns_at_start

    @property
    def is_turned(self) -> bool:
        """A part of a turn leaves it as it is."""
        return self.order > 1


def symmetry_of(ring: Ring, tolerance: float) -> Symmetry:
    """The symmetry of a ring. tolerance: how far corners may be off [mm]."""
    count, arcs = len(ring), int(np.count_nonzero(ring.bulge))
    if np.isnan(ring.bulge).any() or _is_flat(ring):
        return Symmetry(1, False, 2 * count + arcs, count, arcs, ring.turns_at_start)
    middle = complex(ring.corner.mean())
    order, mirrors = _order(ring, middle, tolerance), _mirrors(ring, middle, tolerance)
    angle = np.angle(mirrors) / 2
    is_aligned = bool((np.abs(angle - _STEP * np.round(angle / _STEP)) <= _ALIGNED).any())
    centered, is_mirrored = abs(middle) <= tolerance, len(mirrors) > 0
    if order > 1:
        placed = 0 if centered else 2
        freedom = count // order + placed + (not is_aligned) if is_mirrored else 2 * count // order + placed
    elif is_mirrored:
        through = bool((np.abs(middle - mirrors * middle.conjugate()) <= 2 * tolerance).any())
        freedom = count + (not through) + (not is_aligned)
    else:
        freedom = 2 * count
    symmetry = Symmetry(order, is_mirrored, freedom, count, arcs, ring.turns_at_start)
    return msgspec.structs.replace(symmetry, freedom=freedom + -(-arcs // symmetry.images))


def _is_flat(ring: Ring) -> bool:
    """It encloses nothing: all of it lies on one line."""
    spoke = ring.corner - ring.corner[0]
    area = abs(float((spoke.conj() * np.roll(spoke, -1)).imag.sum())) / 2
    return not (ring.bulge != 0).any() and area <= _FLAT * float(np.abs(spoke).max()) ** 2


def _order(ring: Ring, middle: complex, tolerance: float) -> int:
    """The largest part of a turn that leaves the ring as it is, as its number in a full turn."""
    count, spoke = len(ring), ring.corner - middle
    turning = np.sign((spoke.conj() * np.roll(spoke, -1)).imag.sum())
    for order in range(count, 1, -1):
        if count % order == 0:
            step = np.exp(2j * np.pi * turning / order)
            moved = np.roll(spoke, -count // order)
            bent = np.abs(np.roll(ring.bulge, -count // order) - ring.bulge) * _half_chord(ring)
            if np.abs(moved - step * spoke).max() <= 2 * tolerance and bent.max() <= 2 * tolerance:
                return order
    return 1


def _mirrors(ring: Ring, middle: complex, tolerance: float) -> Points:
    """What the conjugates of the spokes are turned by in each mirror image that is the ring itself."""
    count, spoke = len(ring), ring.corner - middle
    number: Rows = np.arange(count)
    partner = (number[:, None] - number) % count
    product = (spoke[partner] * spoke).sum(axis=1)
    turn = product / np.maximum(np.abs(product), 1e-12)
    off = np.abs(spoke[partner] - turn[:, None] * spoke.conj()).max(axis=1)
    bent = (np.abs(ring.bulge[partner - 1] - ring.bulge) * _half_chord(ring)).max(axis=1)
    fits: Points = turn[(off <= 2 * tolerance) & (bent <= 2 * tolerance)]
    return fits


def _half_chord(ring: Ring) -> Floats:
    return np.asarray(np.abs(np.roll(ring.corner, -1) - ring.corner) / 2)
