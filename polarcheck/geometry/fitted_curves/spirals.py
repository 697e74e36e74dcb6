"""
The way of linear moves of X and C outside the polar mode, sampled.

In such a move X and C change at even rates, so that the tool runs along a piece of an Archimedean spiral: along an arc
about the center where X stays, along a radial line where C stays. Its end points are programmed; between them it bows
from its chord by about |p''| / 8 with p = r exp(i w), that is |2i r' w' - r w'^2| / 8.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, ranges
from polarcheck.geometry.plane import quiet
from polarcheck.geometry.tolerances import ZERO

#: Samples within a block are so close that their chords leave it by no more than this share of the tolerance.
_SHARE = 0.25
#: A block that bows by up to so many tolerances stands for the contour that its end points lie on: a CAM that divides
#: arcs of radius R by its chord error, as lines, leaves blocks that bow by R / r times that at the distance r.
MOST_BOW = 3.0


class Samples(Table, frozen=True):
    """
    Places along the way, in order.

    point: complex128[n], plane points [mm]. z: float64[n] [mm]. slack: float64[n], how much farther than the tolerance
    a contour may be, since the block itself leaves it [mm]. weight: float64[n], 0 for places that the contour is not
    fitted to. joint: bool[n], where an element may begin. block: int64[n], the block that leads to the place, from 0.
    """

    point: Points
    z: Floats
    slack: Floats
    weight: Floats
    joint: Mask
    block: Rows


@quiet
def bows(radius: Floats, angle: Floats) -> Floats:
    """
    Return how far each move leaves its chord [mm]: a bound, near to it for moves of a few degrees.

    radius: float64[n + 1], X as a radius, of either sign [mm]. angle: float64[n + 1], unwrapped [rad].
    """
    turn = np.diff(angle)
    # Along the chord it runs unevenly, aside of it that is no error: only what is across counts for short moves.
    start, end = radius[:-1] * np.exp(1j * angle[:-1]), radius[1:] * np.exp(1j * angle[1:])
    middle = (radius[1:] + radius[:-1]) / 2 * np.exp(0.5j * (angle[1:] + angle[:-1]))
    chord = end - start
    long = np.abs(chord)
    across = np.abs(((middle - start) * np.conj(chord)).imag) / np.where(long > ZERO, long, 1)
    return np.asarray(np.where((np.abs(turn) < 0.5) & (long > ZERO), across, _short_bows(radius, turn)))


def _short_bows(radius: Floats, turn: Floats) -> Floats:
    """The same of moves of few degrees. turn: float64[n] [rad]."""
    widest = np.maximum(np.abs(radius[1:]), np.abs(radius[:-1]))
    return np.asarray(np.hypot(2 * np.diff(radius) * turn, widest * turn**2) / 8)


@quiet
def counts(radius: Floats, angle: Floats, tolerance: float) -> Floats:
    """Return how many pieces each move needs (float64[n], at least 2, or 1 for a radial line) as `sampled` has them."""
    turn = np.diff(angle)
    bow = _short_bows(radius, turn)
    return np.where(turn == 0, 1.0, np.maximum(2.0, np.ceil(np.sqrt(bow / (_SHARE * tolerance)))))


def sampled(radius: Floats, angle: Floats, z: Floats, tolerance: float, reserve: float = 0.0) -> Samples:
    """
    Sample moves of X, C and Z at even rates.

    radius, angle, z: float64[n + 1], as in `bows`, z in [mm]. tolerance: [mm]; reserve: what of it the end points do
    not use, for rounding [mm]. The caller bounds `counts`.
    A block that bows by no more than MOST_BOW tolerances stands for a contour through its end points: within it the
    contour may be farther away by what the block bows. Any other is followed as it is.
    """
    bow = bows(radius, angle)
    stands = bow <= MOST_BOW * tolerance
    count = np.where(stands, np.minimum(counts(radius, angle, tolerance), 2), counts(radius, angle, tolerance))
    count = count.astype(np.int64)
    block, index = ranges(count)
    index += 1
    share = index / count[block]

    def along(values: Floats) -> Floats:
        inside = values[block] + np.diff(values)[block] * share
        return np.append(values[:1], np.where(index == count[block], values[block + 1], inside))

    is_end = np.append(True, index == count[block])
    is_free = np.append(True, stands[block]) & ~is_end
    slack = np.append(0.0, bow[block] + reserve)
    return Samples(
        point=along(radius) * np.exp(1j * along(angle)),
        z=along(z),
        slack=np.where(is_free, slack, 0.0),
        weight=np.where(is_free, 0.0, 1.0),
        joint=~is_free,
        block=np.append(0, block),
    )
