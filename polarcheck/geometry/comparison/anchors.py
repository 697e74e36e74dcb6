"""Corners that two polylines have in common, in the order of both: between them each part is compared by itself."""

from __future__ import annotations

from bisect import bisect_left

import numpy as np

from polarcheck.foundation.arrays import Floats, Points, Rows, first_in_run
from polarcheck.foundation.time_limit import keep_time

_MIX = np.uint64(0x9E3779B97F4A7C15)


def anchors(old: tuple[Points, Floats], new: tuple[Points, Floats], cell: float) -> tuple[Rows, Rows]:
    """
    Return the corners that are paired: their numbers in the old and in the new line, both strictly rising.

    old, new: plane points and Z of the corners [mm]. cell: corners are paired if they lie in one cell of a grid of this
    width [mm], each with the one that comes to that cell for the same time.
    """
    pairs = np.concatenate([_pairs(old, new, cell, shift) for shift in (0.0, 0.5)], axis=1)
    first, second = pairs[:, np.lexsort((-pairs[1], pairs[0]))]
    is_other = first_in_run(first, second)
    first, second = first[is_other], second[is_other]
    chosen = longest_rise(second)
    return first[chosen], second[chosen]


def _pairs(old: tuple[Points, Floats], new: tuple[Points, Floats], cell: float, shift: float) -> Rows:
    keys = np.concatenate([_cells(*old, cell, shift), _cells(*new, cell, shift)])
    count = len(old[0])
    _, group = np.unique(keys, return_inverse=True)
    visits = np.concatenate([_visit(group[:count]), _visit(group[count:])])
    # A cell and how often it was visited before are one number.
    name = group.astype(np.int64) * (len(keys) + 1) + visits
    _, first, second = np.intersect1d(name[:count], name[count:], assume_unique=True, return_indices=True)
    return np.stack([first, second]).astype(np.int64)


def _cells(point: Points, z: Floats, cell: float, shift: float) -> np.ndarray[tuple[int], np.dtype[np.uint64]]:
    """A number per corner: equal in one cell, and in different ones but for a chance of 2 ** -64 different."""
    key = np.zeros(len(point), np.uint64)
    for part in (point.real, point.imag, z):
        key = (key + np.floor(part / cell + shift).astype(np.int64).view(np.uint64)) * _MIX
        key ^= key >> np.uint64(29)
    return key


def _visit(group: Rows) -> Rows:
    """The number of earlier values in the same group, for each value."""
    order = np.argsort(group, kind="stable")
    begins = first_in_run(group[order])
    first = np.maximum.accumulate(np.where(begins, np.arange(len(group)), 0))
    visits = np.empty(len(group), np.int64)
    visits[order] = np.arange(len(group)) - first
    return visits


def longest_rise(values: Rows) -> Rows:
    """Return the indices of a longest strictly rising subsequence."""
    # A value above all before it and below all behind it belongs to every one.
    is_chosen = np.ones(len(values), bool)
    is_chosen[1:] = values[1:] > np.maximum.accumulate(values)[:-1]
    is_chosen[:-1] &= values[:-1] < np.minimum.accumulate(values[::-1])[::-1][1:]
    remaining = np.flatnonzero(~is_chosen)
    for group in np.split(remaining, 1 + np.flatnonzero(np.diff(remaining) > 1)) if len(remaining) else ():
        keep_time()
        is_chosen[group[_longest_rise(values[group])]] = True
    return np.flatnonzero(is_chosen)


def _longest_rise(values: Rows) -> list[int]:
    tops: list[int] = []
    ends: list[int] = []
    previous: list[int] = []
    for index, value in enumerate(values.tolist()):
        position = bisect_left(tops, value)
        previous.append(ends[position - 1] if position else -1)
        if position == len(tops):
            tops.append(value)
            ends.append(index)
        else:
            tops[position], ends[position] = value, index
    chosen = []
    index = ends[-1]
    while index >= 0:
        chosen.append(index)
        index = previous[index]
    return chosen
