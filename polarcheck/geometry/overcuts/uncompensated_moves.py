"""
Moves without compensation, and which of them come anywhere near a contour of their section, by their boxes.

Floats in mm, plane points complex, x + 1j*c.
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.arrays import Floats, Mask, Rows, Table
from polarcheck.geometry.segments import Curves, boxes
from polarcheck.geometry.tolerances import ROUNDING


class Bare(Table, frozen=True):
    """
    Moves without compensation. curves: with their section as the loop. z: float64[n] [mm], the highest on the way;
    of a move of Z alone where it ends. radius: float64[n] [mm], |R|. plunges: bool[n], Z alone moves.
    """

    curves: Curves
    z: Floats
    radius: Floats
    plunges: Mask


class FlatLoops(msgspec.Struct, frozen=True):
    """Loops that stay at one Z, in their order: number, section, Z and box of each."""

    loop: Rows
    section: Rows
    z: Floats
    box: Floats


def flat_loops(curves: Curves, section: Rows, z: Floats) -> FlatLoops:
    """The loops of these curves that stay at one Z; section: int[curves], z: float64[curves], NaN unknown."""
    first = np.flatnonzero(np.diff(curves.loop, prepend=-1))
    low, high = np.minimum.reduceat(z, first), np.maximum.reduceat(z, first)
    flat = high - low <= ROUNDING
    return FlatLoops(curves.loop[first][flat], section[first][flat], low[flat], boxes(curves, first)[:, flat])


def may_reach(loops: FlatLoops, bare: Bare) -> Mask:
    """Moves whose box comes within R of that of the contours of their section, not above the highest of these."""
    result = np.zeros(len(bare), bool)
    if not len(loops.loop):
        return result
    first = np.flatnonzero(np.diff(loops.section, prepend=-1))
    known = loops.section[first]
    at = np.minimum(np.searchsorted(known, bare.curves.loop), len(known) - 1)
    top = np.maximum.reduceat(loops.z, first)[at]
    box = np.concatenate(
        [np.minimum.reduceat(loops.box[:2], first, axis=1), np.maximum.reduceat(loops.box[2:], first, axis=1)]
    )[:, at]
    own = boxes(bare.curves, np.arange(len(bare)))
    result = (known[at] == bare.curves.loop) & (bare.z <= top + ROUNDING)
    for side in (0, 1):
        result &= (own[side] <= box[side + 2] + bare.radius) & (own[side + 2] >= box[side] - bare.radius)
    return np.asarray(result)
