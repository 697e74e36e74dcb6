"""
What bounds a finished part, as the lines and arcs that a drawing has; lengths in mm, plane points complex, x + 1j*c.

The faces of the contour check have chords in the place of arcs. Here the chords of one block are one element again,
with the center that is programmed, so that a size is as exact as the program.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, column_at, runs, side_by_side
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.segments import Curves
from polarcheck.geometry.tolerances import CORNER

#: More open chains than these are not linked to each other.
_MOST_OPEN = 100


class Outline(PlanePath, frozen=True, dict=True):
    """
    Lines and arcs with the part on their left: an arc that runs counterclockwise bulges outward.

    row: int[n], the row of the block. chain: int[n], from 0; elements of a chain are in the order in which they run.
    closed: bool[chains], the chain comes back to where it begins; else it ends where nobody knows what the part is
    like.
    """

    _shared = ("closed",)

    row: Rows
    chain: Rows
    closed: Mask

    @property
    def radius(self) -> Floats:
        """Of arcs [mm], NaN for lines."""
        return np.asarray(np.abs(self.start - self.center))


def outline_of(start: Points, end: Points, move: Rows, curves: Curves) -> Outline:
    """
    The outline that these chords make. start, end: of chords with the part on their left, those in a row one after
    another. move: the curve that each is part of.
    """
    if not len(move):
        none = np.zeros(0, np.int64)
        nowhere = np.zeros(0, complex)
        return Outline(nowhere, nowhere, nowhere, none.astype(np.int16), none, none, np.zeros(0, bool))
    order = _linked(start, end)
    start, end, move = start[order], end[order], move[order]
    first = _first_of_chains(start, end)
    count = np.diff(np.append(first, len(move)))
    closed = np.abs(end[first + count - 1] - start[first]) <= CORNER
    chain = np.repeat(np.arange(len(first)), count)
    order = _from_block(move, first, count, closed)
    start, end, move = start[order], end[order], move[order]
    begins, last = runs(move, chain)
    of = move[begins]
    center = np.where(curves.kind[of] == Motion.LINE, np.nan, curves.center[of])
    turns = ((start[begins] - center).conj() * (end[begins] - center)).imag
    kind = np.where(np.isnan(center), Motion.LINE, np.where(turns > 0, Motion.CCW, Motion.CW)).astype(np.int16)
    return Outline(start[begins], end[last], center, kind, curves.row[of], chain[begins], closed)


def _first_of_chains(start: Points, end: Points) -> Rows:
    return np.append(0, np.flatnonzero(np.abs(start[1:] - end[:-1]) > CORNER) + 1)


def _linked(start: Points, end: Points) -> Rows:
    """The order in which open chains follow that begin where another one ends: lines that join loops part a wall."""
    order = np.arange(len(start))
    first = _first_of_chains(start, end)
    last = np.append(first[1:], len(start)) - 1
    is_open = np.flatnonzero(np.abs(end[last] - start[first]) > CORNER)
    if not 1 < len(is_open) <= _MOST_OPEN:
        return order
    meets = np.abs(end[last[is_open]][:, None] - start[first[is_open]]) <= CORNER
    meets &= (meets.sum(axis=0) == 1) & (meets.sum(axis=1) == 1)[:, None]
    if not meets.any():
        return order
    before, following = np.nonzero(meets)
    after = column_at(len(first), is_open[before], is_open[following], -1)
    chains: dict[int, None] = {}
    begins = [*np.setdiff1d(np.arange(len(first)), after).tolist(), *range(len(first))]
    for chain in begins:
        while chain >= 0 and chain not in chains:
            chains[chain] = None
            chain = int(after[chain])
    return np.concatenate([order[first[chain] : last[chain] + 1] for chain in chains])


def _from_block(move: Rows, first: Rows, count: Rows, closed: Mask) -> Rows:
    """The order in which closed chains begin where a block does; a face begins them anywhere."""
    order = np.arange(len(move))
    last = first + count - 1
    for begin, end in side_by_side(first[closed], last[closed]):
        changes = np.flatnonzero(move[begin : end + 1] != move[begin])
        if move[begin] == move[end] and len(changes):
            order[begin : end + 1] = np.roll(order[begin : end + 1], -int(changes[0]))
    return order
