"""Pairs the polar sections of two revisions by what they do, not by their number."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.foundation.arrays import Floats, Rows, mask_at
from polarcheck.geometry.comparison.anchors import longest_rise
from polarcheck.rewrite.compare.compared_sections import Stretch

#: Sections that differ by more than this share of their size are not paired, unless no other section remains.
_LIKE = 0.25
#: The most pairs of sections that are compared; with more pairs, sections are paired by number.
_PAIRS = 1_000_000


def paired(old: Sequence[Stretch], new: Sequence[Stretch]) -> tuple[Rows, Rows]:
    """
    Return for each old section its new partner, -1 for none; and the paired old sections whose order has not changed.

    The most similar sections are paired first. Sections that remain between two pairs are paired in order if both
    revisions have the same number of them.
    """
    partner = np.full(len(old), -1)
    if len(old) == len(new) and _alike(old, new):
        return np.arange(len(old)), np.arange(len(old))
    if len(old) * len(new) > _PAIRS:
        count = min(len(old), len(new))
        partner[:count] = np.arange(count)
        return partner, np.arange(count)
    if len(old) and len(new):
        _pair_most_alike(partner, _features(old), _features(new))
    ordered = _in_order(partner)
    _pair_left_over(partner, ordered, len(new))
    return partner, _in_order(partner)


def _alike(old: Sequence[Stretch], new: Sequence[Stretch]) -> bool:
    first, second = _features(old), _features(new)
    return bool((_apart(first, second) <= _LIKE * _size(first)).all())


def _features(sections: Sequence[Stretch]) -> Floats:
    """
    Return a row of lengths per section [mm]: the box that its cuts fill on the part, its first point, its lowest Z, a
    quarter of its length; 0 without moves.
    """
    rows = []
    for section in sections:
        path = section.known.path
        if not len(path):
            rows.append([0.0] * 8)
            continue
        points = np.append(path.start[:1], path.end)
        cuts = points if path.rapid.all() else points[1:][~path.rapid]
        box = [cuts.real.min(), cuts.real.max(), cuts.imag.min(), cuts.imag.max()]
        rows.append([*box, points[0].real, points[0].imag, path.z_end.min(), np.abs(np.diff(points)).sum() / 4])
    return np.array(rows, np.float64).reshape(-1, 8)


def _apart(first: Floats, second: Floats) -> Floats:
    return np.asarray(np.abs(first - second).max(axis=-1))


def _size(features: Floats) -> Floats:
    """Return the size of each section, against which its differences are measured [mm]."""
    return np.asarray(np.maximum(np.abs(features[..., :4]).max(axis=-1), 1.0))


def _pair_most_alike(partner: Rows, old: Floats, new: Floats) -> None:
    apart = _apart(old[:, None], new[None])
    is_like = apart <= _LIKE * _size(old)[:, None]
    first, second = np.nonzero(is_like)
    # Equal ones in the order of the programs.
    order = np.lexsort((np.abs(first - second), np.round(apart[first, second], 4)))
    taken = np.zeros(len(new), bool)
    for a, b in zip(first[order].tolist(), second[order].tolist(), strict=True):
        if partner[a] < 0 and not taken[b]:
            partner[a], taken[b] = b, True


def _in_order(partner: Rows) -> Rows:
    """Return the old sections with a partner that have the same order in both revisions."""
    paired = np.flatnonzero(partner >= 0)
    return paired[longest_rise(partner[paired])]


def _pair_left_over(partner: Rows, ordered: Rows, count: int) -> None:
    """Pair the remaining sections between two pairs if both revisions have the same number of them there."""
    free = ~mask_at(count, partner[partner >= 0])
    bounds = zip(
        (-1, *ordered.tolist()), (*ordered.tolist(), len(partner)), (-1, *partner[ordered].tolist()),
        (*partner[ordered].tolist(), count), strict=True,
    )  # fmt: skip
    for low, high, new_low, new_high in list(bounds):
        old_unpaired = [index for index in range(low + 1, high) if partner[index] < 0]
        new_unpaired = [index for index in range(new_low + 1, new_high) if free[index]]
        if len(old_unpaired) == len(new_unpaired):
            partner[old_unpaired] = new_unpaired
