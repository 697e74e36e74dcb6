"""
Moves without compensation, and a test by boxes for those that may reach a contour of their section.

Floats in mm, plane points complex, x + 1j*c.
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Rows, Table, first_in_run
from polarcheck.geometry.segments import Curves, boxes
from polarcheck.geometry.tolerances import ROUNDING


class Bare(Table, frozen=True):
    """
    Moves without compensation, n of them.

    curves: their paths, with the section as the loop.
    z: float64[n] [mm], the highest Z of the move; for a move of Z alone, its end.
    radius: float64[n] [mm], |R|.
    plunges: bool[n], moves of Z alone.
    """

    curves: Curves
    z: Floats
    radius: Floats
    plunges: Mask


class FlatLoops(msgspec.Struct, frozen=True):
    """
    Loops that stay at one Z, n of them in order.

    loop: int[n], the number of the loop.
    section: int[n], its section.
    z: float64[n] [mm].
    box: float64[4, n] [mm], lowest X and C, highest X and C.
    """

    loop: Rows
    section: Rows
    z: Floats
    box: Floats


def flat_loops(curves: Curves, section: Rows, z: Floats) -> FlatLoops:
    """The loops of these curves that stay at one Z; section: int[curves], z: float64[curves], NaN unknown."""
    first = np.flatnonzero(first_in_run(curves.loop))
    low, high = np.minimum.reduceat(z, first), np.maximum.reduceat(z, first)
    flat = high - low <= ROUNDING
    return FlatLoops(curves.loop[first][flat], section[first][flat], low[flat], boxes(curves, first)[:, flat])


def may_reach(loops: FlatLoops, bare: Bare) -> Mask:
    """True for moves not above the highest contour of their section whose box comes within R of the contours' box."""
    result = np.zeros(len(bare), bool)
    if not len(loops.loop):
        return result
    first = np.flatnonzero(np.diff(loops.section, prepend=-1))
    section = loops.section[first]
    section_number = np.minimum(np.searchsorted(section, bare.curves.loop), len(section) - 1)
    top = np.maximum.reduceat(loops.z, first)[section_number]
    box = np.concatenate(
        [np.minimum.reduceat(loops.box[:2], first, axis=1), np.maximum.reduceat(loops.box[2:], first, axis=1)]
    )[:, section_number]
    move_box = boxes(bare.curves, np.arange(len(bare)))
    result = (section[section_number] == bare.curves.loop) & (bare.z <= top + ROUNDING)
    for side in (0, 1):
        result &= (move_box[side] <= box[side + 2] + bare.radius) & (move_box[side + 2] >= box[side] - bare.radius)
    return np.asarray(result)
