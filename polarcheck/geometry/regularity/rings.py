"""
Closed rings of corners in a path: leads, overlap and points within a side are left out.

Plane points complex, x + 1j*c [mm]. The bulge of an edge is the tangent of a quarter of its sweep: 0 for a line, above
0 counterclockwise.
"""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, column_at, mask_at

#: Ends that are nearer to each other are one point, and points so near to the line of a side lie on it [mm].
_SAME = 0.004
#: Blocks at either end of a path that may be leads, and rings that are tried.
_LEADS, _MOST_RINGS = 8, 3
#: The least number of edges of a ring.
_FEWEST = 3


class Ring(msgspec.Struct, frozen=True):
    """
    A closed contour of n corners.

    corner: complex128[n] [mm]. bulge: float64[n], of the edge from each corner to the next. turns_at_start: it has a
    corner where the path begins, and not a point within a side.
    """

    corner: Points
    bulge: Floats
    turns_at_start: bool

    def __len__(self) -> int:
        return len(self.corner)


def rings_in(point: Points, bulge: Floats) -> Iterator[Ring]:
    """
    The closed rings of a path, the first ones alone.

    point: complex128[n + 1] [mm], where the edges begin and end. bulge: float64[n].
    """
    moves = np.abs(np.diff(point)) > _SAME
    point, bulge = point[np.append(True, moves)], bulge[moves]
    count = 0
    for first in range(min(_LEADS, len(bulge) - _FEWEST + 1)):
        again = np.flatnonzero(np.abs(point[first + _FEWEST :] - point[first]) <= _SAME)
        if len(again):
            last = first + _FEWEST + int(again[0])
            yield _simplified(point[first:last], bulge[first:last])
            count += 1
        if count == _MOST_RINGS:
            return
    if not count:
        ring = next(_overlapping(point, bulge), None) or _crossed(point, bulge)
        if ring is not None:
            yield ring


def _crossed(point: Points, bulge: Floats) -> Ring | None:
    """
    The ring of a path whose first blocks cross its last ones; None where none do.

    A lead that begins on the extension of a side, and one that leaves on that of another, are cut off where they cross,
    as the cutter does.
    """
    count = len(bulge)
    pairs = ((first, last) for first in range(_LEADS) for last in range(count - 1, count - 1 - _LEADS, -1))
    for first, last in sorted(pairs, key=lambda pair: pair[0] + count - pair[1]):
        if last - first < _FEWEST - 1 or bulge[first] or bulge[last]:
            continue
        into, out = point[first + 1] - point[first], point[last + 1] - point[last]
        across = (into.conjugate() * out).imag
        if abs(across) <= _SAME * max(abs(into), abs(out)):
            continue
        between = point[last] - point[first]
        shares = (between.conjugate() * out).imag / across, (between.conjugate() * into).imag / across
        slack = _SAME / abs(into), _SAME / abs(out)
        if all(-least <= share <= 1 + least for share, least in zip(shares, slack, strict=True)):
            corner = np.append(point[first] + shares[0] * into, point[first + 1 : last + 1])
            kept = np.abs(corner - np.roll(corner, -1)) > _SAME
            return _simplified(corner[kept], np.append(0.0, bulge[first + 1 : last + 1])[kept])
    return None


def _overlapping(point: Points, bulge: Floats) -> Iterator[Ring]:
    """Rings of paths that begin within a side and end beyond that point of it, or come again to their first line."""
    for first in range(min(_LEADS, len(bulge) - _FEWEST)):
        line, away = point[first + 1] - point[first], point[first + _FEWEST :] - point[first]
        along, aside = (part(away * line.conjugate()) / abs(line) for part in (np.real, np.imag))
        again = (np.abs(aside) <= _SAME) & (along > 0) & (along < abs(line)) & (bulge[first] == 0)
        if again.any():
            last = first + _FEWEST + int(np.argmax(again))
            yield _simplified(np.append(point[last], point[first + 1 : last]), np.append(0.0, bulge[first + 1 : last]))
            return
        start, end = point[first + 2 : -1], point[first + 3 :]
        vector = end - start
        along = ((point[first] - start) * vector.conj()).real / np.abs(vector) ** 2
        aside = np.abs(((point[first] - start) * vector.conj()).imag) / np.abs(vector)
        onward = (vector * (point[first + 1] - point[first]).conjugate()).real > 0
        passes = (
            (aside <= _SAME) & (along > 0) & (along <= 1) & onward & (bulge[first + 2 :] == 0) & (bulge[first] == 0)
        )
        if passes.any():
            last = first + 3 + int(np.argmax(passes))
            yield _simplified(point[first:last], np.append(bulge[first : last - 1], 0.0))
            return


def _simplified(corner: Points, bulge: Floats) -> Ring:
    """The ring with each line and each arc as one edge, and without ways out and back."""
    start = corner[0]
    for _ in range(len(corner)):
        if len(corner) < _FEWEST:
            break
        order = np.arange(len(corner))
        before, after = corner[order - 1], corner[order - len(corner) + 1]
        into, out = bulge[order - 1], bulge
        is_tip = (np.abs(after - before) <= _SAME) & (into == 0) & (out == 0)
        if is_tip.any():
            tip = int(np.argmax(is_tip))
            gone = np.array([tip, (tip + 1) % len(corner)])
        else:
            gone = np.flatnonzero(_is_within(before, corner, after, into, out))
            if not len(gone):
                break
            gone = gone[np.append(True, np.diff(gone) > 1)]
            if len(gone) > 1 and gone[0] == 0 and gone[-1] == len(corner) - 1:
                gone = gone[:-1]
            joined = _joined(into[gone], out[gone])
            bulge = bulge.copy()
            bulge[gone - 1] = joined
        stays = ~mask_at(len(corner), gone)
        corner, bulge = corner[stays], bulge[stays]
    return Ring(corner, bulge, bool((corner == start).any()))


def _is_within(before: Points, corner: Points, after: Points, into: Floats, out: Floats) -> Mask:
    """Corners within one straight line, or one arc."""
    chord = after - before
    length = np.maximum(np.abs(chord), 1e-9)
    aside = np.abs(((corner - before) * chord.conj()).imag) / length
    onward = ((corner - before) * (after - corner).conj()).real > 0
    on_line = (into == 0) & (out == 0) & (aside <= _SAME) & onward
    if not (into * out > 0).any():
        return np.asarray(on_line)
    both, sweep = into * out > 0, np.abs(np.arctan(into)) + np.abs(np.arctan(out))
    first, second = (
        _center(begin[both], end[both], bulge[both])
        for begin, end, bulge in ((before, corner, into), (corner, after, out))
    )
    is_on_circle = (np.abs(first - second) <= 2 * _SAME) & (sweep[both] < 1.5)
    on_circle = column_at(len(corner), both, is_on_circle, False)
    return np.asarray(on_line | on_circle)


def _joined(into: Floats, out: Floats) -> Floats:
    """The bulge of two edges of one line or circle together."""
    return np.asarray(np.tan(np.arctan(into) + np.arctan(out)))


def _center(start: Points, end: Points, bulge: Floats) -> Points:
    return np.asarray((start + end) / 2 + 1j * (end - start) * (1 - bulge**2) / (4 * bulge))
