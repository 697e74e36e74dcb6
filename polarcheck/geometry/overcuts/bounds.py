"""
What of a program is looked at: the loops that would take out of all proportion are given up one by one, before the rest
is looked at. They are found by counting alone, so that the same program gives the same answer everywhere.
"""

from __future__ import annotations

import numpy as np

from polarcheck.arrays import Rows, different
from polarcheck.geometry.segments import Curves, chord_counts, first_of_its_kind
from polarcheck.geometry.tolerances import CHORDS, CHORDS_OF_FILE, FARTHEST, FARTHEST_CENTER


def far_loops(*curves: Curves) -> Rows:
    """
    Loops with a point farther from the center than any lathe reaches, or an arc round one so far away that nothing is
    left of its digits.
    """
    found = [np.zeros(0, np.int64)]
    for some in curves:
        far = np.zeros(len(some), bool)
        for points, limit in ((some.start, FARTHEST), (some.end, FARTHEST), (some.center, FARTHEST_CENTER)):
            far |= (np.abs(points.real) > limit) | (np.abs(points.imag) > limit)
        found.append(some.loop[far])
    return different(np.concatenate(found))


def long_loops(curves: Curves, tolerance: float) -> Rows:
    """
    Loops whose arcs are of too many chords, each arc once; of all those of a file the longest are left out until the
    rest is few enough.
    """
    count = chord_counts(curves, tolerance)
    if count.sum() <= CHORDS:
        return np.zeros(0, np.int64)
    arcs = np.flatnonzero(count)
    arcs = arcs[first_of_its_kind(curves[arcs])]
    loops, number = np.unique(curves.loop[arcs], return_inverse=True)
    total = np.bincount(number, count[arcs])
    order = np.argsort(total, kind="stable")
    kept = (total[order] <= CHORDS) & (np.cumsum(total[order]) <= CHORDS_OF_FILE)
    return np.sort(loops[order[~kept]])
