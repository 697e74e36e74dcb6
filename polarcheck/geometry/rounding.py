"""End points of a contour that only show the rounding of the last written digit."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows

#: How wide a strip passes for straight, in roundings to either side: so wide that, where the contour bends, its chords
#: turn clearly more than the rounding of their ends turns them.
_STRIP = 8
#: Looks at a contour, each of which halves it at least where it is even; what is open then stays as it is written.
_LOOKS = 100


def kept_ends(start: Points, end: Points, joins: Mask, half: Points) -> Mask:
    """
    The straight blocks whose end points tell more than rounding, bool[n]; between them the contour is straight.

    start, end: complex128[n] [mm]. joins: the block goes on from the one before it. half: half of the last digit, along
    both axes [mm].

    As Douglas and Peucker do, each stretch is halved at the point farthest from its chord until its points lie in a
    strip that is wide beside their rounding. So nobody needs to know over how many blocks rounding shows.
    """
    kept = np.append(~joins[1:], True)
    rows = np.arange(len(end))
    for _ in range(_LOOKS):
        rows = _halved(start, end, half, kept, rows)
        if not len(rows):
            return kept
    kept[rows] = True
    return kept


def may_turn_back(start: Points, end: Points, half: Points, radius: Floats) -> Mask:
    """
    Which straight blocks rounding may shorten to less than nothing along the path of a tool center with R [mm].

    The ends of two blocks of length l turn the corner between them by up to 4 half / l, which takes R times that off
    the way of the tool center. start, end, half: as above.
    """
    return np.asarray(np.abs(end - start) ** 2 < 4 * np.abs(half) * np.abs(radius))


def _halved(start: Points, end: Points, half: Points, kept: Mask, rows: Rows) -> Rows:
    """Halve the stretches of these rows that do not lie in their strip; return the rows that remain to be halved."""
    last = np.flatnonzero(kept[rows])
    first = np.append(0, last[:-1] + 1)
    count = np.diff(np.append(first, len(rows)))
    begin = start[rows[first]]
    chord = end[rows[last]] - begin
    length = np.abs(chord)
    along = np.where(length > 0, chord, 1) / np.where(length > 0, length, 1)
    reach = np.abs(along.imag) * half[rows[first]].real + np.abs(along.real) * half[rows[first]].imag

    spread = np.repeat(along.conj(), count)
    local = (end[rows] - np.repeat(begin, count)) * spread
    beyond = np.maximum(np.maximum(-local.real, local.real - np.repeat(length, count)), 0.0)
    beyond[last], local[last] = 0.0, 0.0
    aside = np.maximum.reduceat(local.imag, first) - np.minimum.reduceat(local.imag, first)
    wide = 2 * _STRIP * reach
    widest = np.abs(half[rows[first]]) * 2 * _STRIP
    is_open = (aside > wide) | (np.maximum.reduceat(beyond, first) > widest)

    # A block that leads back along the stretch is no rounding, though its ends lie in the strip.
    step = ((end[rows] - start[rows]) * spread).real
    back = (step < -np.repeat(widest, count)) & (np.repeat(length, count) > 0)
    turns = back.copy()
    turns[:-1] |= back[1:]
    kept[rows[turns]] = True
    is_open |= np.logical_or.reduceat(turns, first)

    far = np.maximum(np.abs(local.imag), beyond)
    at_most = np.repeat(np.maximum.reduceat(far, first), count)
    farthest = np.flatnonzero((far == at_most) & (far > 0))
    number = np.repeat(np.arange(len(first)), count)[farthest]
    number, index = np.unique(number, return_index=True)
    chosen = farthest[index]
    kept[rows[chosen[is_open[number]]]] = True
    return np.asarray(rows[np.repeat(is_open & (count > 1), count)])
