"""
Limits on the loops of a program that are checked.

Loops that would take too long are given up one by one before the check. Only counts decide, so a program gives the same
result on every computer.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Rows, different
from polarcheck.geometry.segments import Curves, chord_counts, first_of_its_kind
from polarcheck.geometry.tolerances import CHORDS, CHORDS_OF_FILE, FARTHEST, FARTHEST_CENTER


def far_loops(*curves: Curves) -> Rows:
    """
    Loops with a point beyond the reach of any lathe, or with an arc center so far away that the digits of the arc are
    lost.
    """
    loops = [np.zeros(0, np.int64)]
    for table in curves:
        far = np.zeros(len(table), bool)
        for points, limit in ((table.start, FARTHEST), (table.end, FARTHEST), (table.center, FARTHEST_CENTER)):
            far |= (np.abs(points.real) > limit) | (np.abs(points.imag) > limit)
        loops.append(table.loop[far])
    return different(np.concatenate(loops))


def long_loops(curves: Curves, tolerance: float) -> Rows:
    """
    Loops whose distinct arcs have too many chords, and the longest loops of a file beyond the total for one file.
    """
    count = chord_counts(curves, tolerance)
    if count.sum() <= CHORDS:
        return np.zeros(0, np.int64)
    arcs = np.flatnonzero(count)
    arcs = arcs[first_of_its_kind(curves[arcs])]
    loops, number = np.unique(curves.loop[arcs], return_inverse=True)
    total = np.bincount(number, count[arcs])
    order = np.argsort(total, kind="stable")
    fits = (total[order] <= CHORDS) & (np.cumsum(total[order]) <= CHORDS_OF_FILE)
    return np.sort(loops[order[~fits]])
