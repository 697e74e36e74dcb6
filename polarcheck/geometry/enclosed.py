"""
Closed paths: do they go round the center of C, and on which side of them does it lie?

Moves come as in `polar`. A way whose end is not its start is closed by a straight line.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Mask, Points, Rows, States
from polarcheck.geometry.plane import angle_between, arc_sweep, quiet
from polarcheck.geometry.polar import c_sweep


@quiet
def go_round(start: Points, end: Points, center: Points, kind: States, path: Rows, count: int) -> Mask:
    """A boolean for each of `count` paths: it goes round the center. way: the path of each move, ascending."""
    first = np.flatnonzero(np.diff(path, prepend=-1))
    last = np.append(first[1:], len(path)) - 1
    turns = np.radians(c_sweep(start, end, center, kind))
    turns[last] += angle_between(end[last], start[first])
    turn = np.bincount(path, weights=turns, minlength=count)
    # A path round the center makes whole turns, any other path makes none.
    return np.asarray(np.abs(turn) > np.pi)


def goes_round(start: Points, end: Points, center: Points, kind: States) -> bool:
    """True if one path goes round the center."""
    return bool(go_round(start, end, center, kind, np.zeros(len(start), np.int64), 1)[0])


@quiet
def signed_area(start: Points, end: Points, center: Points, kind: States) -> float:
    """The area that one path encloses [mm2], above 0 where it lies on its left."""
    chords = (start.conjugate() * end).imag
    sweep = arc_sweep(start, end, center, kind)
    is_arc = sweep != 0
    bows = np.where(is_arc, np.abs(start - center) ** 2 * (sweep - np.sin(sweep)), 0.0)
    closing = (end[-1].conjugate() * start[0]).imag
    return float(np.sum(chords + bows) + closing) / 2


def is_on_left(start: Points, end: Points, center: Points, kind: States) -> bool:
    """True if the center lies on the left of one path: inside a path that encloses its left, outside any other."""
    return goes_round(start, end, center, kind) == (signed_area(start, end, center, kind) > 0)
