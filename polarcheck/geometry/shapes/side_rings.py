"""
Outlines as rings of sides: what several blocks make of one line or of one circle is one side again.

Plane points complex, x + 1j*c [mm].
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Self

import numpy as np
from msgspec.structs import replace

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table
from polarcheck.geometry.outline import Outline
from polarcheck.geometry.plane import passes_toward
from polarcheck.geometry.rounding import kept_ends
from polarcheck.geometry.shapes.shape import SAME

#: A side shorter than this is what rounding leaves between two others [mm].
_STUB = 1e-3
#: A side is short beside another one of which it is less than this share; and how often sides are put together.
_SHORT, _LOOKS = 0.25, 50
#: Sine of the least angle at which the ends of a chain make a corner.
_MEETING = 1 / 3
#: Half of the strip in which blocks make one straight line, as rounding.kept_ends wants it [mm].
_HALF = SAME / 8 * (1 + 1j)
#: Chords of a curve turn by less than a corner does [rad].
SHARP = 0.26


class Ring(Table, frozen=True):
    """
    Sides in the order in which they run, n of them.

    start, end: complex128[n]. center: complex128[n], NaN for lines. sweep: float64[n] [rad], 0 for lines, above 0
    counterclockwise. row: int[n], of the longest block of each. closed: the last one ends where the first one starts.
    inside: it bounds a pocket; it was turned round, so that what it encloses is on its left in either case.
    beyond: of an open ring that ends at the bar, the largest R that leaves nothing in it of an inside corner outside
    [mm].
    """

    _shared = ("closed", "inside", "beyond")

    start: Points
    end: Points
    center: Points
    sweep: Floats
    row: Rows
    closed: bool
    inside: bool = False
    beyond: float = np.inf

    @property
    def is_line(self) -> Mask:
        """The side is straight."""
        return np.asarray(self.sweep == 0)

    @property
    def radius(self) -> Floats:
        """Of arcs [mm], NaN for lines."""
        return np.asarray((np.abs(self.start - self.center) + np.abs(self.end - self.center)) / 2)

    @property
    def length(self) -> Floats:
        """Of each side [mm]."""
        chord = np.abs(self.end - self.start)
        return np.where(self.is_line, chord, np.abs(self.sweep) * np.nan_to_num(self.radius))

    @property
    def normal(self) -> Points:
        """Of each side of a line, or of the chord of an arc, away from what is on its left; length 1."""
        vector = self.end - self.start
        return np.asarray(-1j * vector / np.maximum(np.abs(vector), 1e-12))

    @property
    def area(self) -> float:
        """The area that a closed ring encloses [mm2], above 0 where it runs counterclockwise."""
        chords = (self.start.conj() * self.end).imag
        bows = np.where(self.is_line, 0.0, np.nan_to_num(self.radius) ** 2 * (self.sweep - np.sin(self.sweep)))
        return float(np.sum(chords + bows)) / 2

    def turned_round(self) -> Self:
        """The ring in the opposite direction."""
        ring = self[::-1]
        return replace(ring, start=ring.end, end=ring.start, sweep=-ring.sweep)


def rings(outline: Outline, gap: float = 0.0, bar: float = np.nan) -> Iterator[Ring]:
    """
    The rings of an outline, one of each chain, but for what lies outside the bar.

    gap: what of a chain was closed by a straight line [mm]. bar: diameter [mm], NaN if not known.
    """
    until = np.searchsorted(outline.chain, np.arange(len(outline.closed) + 1))
    for number, (begin, end) in enumerate(pairwise(until.tolist())):
        part = outline[np.arange(begin, end)]
        for ring in _within(_ring_of(part, bool(outline.closed[number]), gap), bar):
            whole = _whole(ring)
            yield replace(whole.turned_round(), inside=True) if whole.closed and whole.area < 0 else whole


def _ring_of(part: Outline, closed: bool, gap: float) -> Ring:
    start, end, center, sweep, row = part.start, part.end, part.center, part.sweep, part.row
    apart = abs(end[-1] - start[0]) if len(row) else 0.0
    if not closed and 0 < apart <= gap + SAME:
        corner = _corner(part, apart)
        if corner is None:
            start, end = np.append(start, end[-1]), np.append(end, start[0])
            center, sweep, row = np.append(center, np.nan), np.append(sweep, 0.0), np.append(row, row[-1])
        else:
            start, end = np.append(corner, start[1:]), np.append(end[:-1], corner)
        closed = True
    ring = Ring(start, end, center, sweep, row, closed)
    return ring[ring.length > _STUB]


def _corner(part: Outline, apart: float) -> complex | None:
    """Where the last and the first line of a chain meet near its ends, `apart` [mm] from each other; None for arcs."""
    if part.is_arc[0] or part.is_arc[-1]:
        return None
    begin, vector = part.end[0] - part.start[0], part.end[-1] - part.start[-1]
    across = (vector.conjugate() * begin).imag / (abs(vector) * abs(begin))
    if abs(across) < _MEETING:
        return None
    gap = part.start[0] - part.end[-1]
    along = (gap.conjugate() * begin).imag / abs(begin) / across
    meet = complex(part.end[-1] + along * vector / abs(vector))
    is_near = max(abs(meet - part.start[0]), abs(meet - part.end[-1])) <= apart / _MEETING
    return meet if is_near else None


def _within(ring: Ring, bar: float) -> Iterator[Ring]:
    """What of a ring cuts into the bar; where it runs outside, it is in pieces."""
    if np.isnan(bar) or not len(ring):
        yield ring
        return
    out = nearest_of(ring) >= bar / 2 - SAME
    if not out.any():
        yield ring
        return
    if ring.closed:
        first = int(np.argmax(out))
        order = np.roll(np.arange(len(ring)), -first)
        ring, out = ring[order], out[order]
    number = np.cumsum(np.diff(out, prepend=True) != 0)
    for piece in np.unique(number[~out]):
        chosen = np.flatnonzero((number == piece) & ~out)
        yield replace(ring[chosen], closed=False, beyond=_fits_beyond(ring, chosen, bar / 2))


def _fits_beyond(ring: Ring, chosen: Rows, radius: float) -> float:
    """The largest R whose rounding of the inside corners at both ends of these sides stays outside of the bar [mm]."""
    into, out = directions(ring)
    largest = np.inf
    for corner, wall in ((int(chosen[-1]) + 1, int(chosen[-1])), (int(chosen[0]), int(chosen[0]))):
        before, after = corner - 1, corner % len(ring)
        if not ring.is_line[wall] or (not ring.closed and not 0 < corner < len(ring)):
            continue
        turn = float(np.angle(out[after] * into[before].conjugate()))
        if turn > -SHARP:
            continue
        point, direction = ring.start[after], (-into[wall] if wall == before else out[wall])
        along = float((point * direction.conjugate()).real)
        aside = abs(point) ** 2 - along**2
        if aside < radius**2 and along < 0:
            largest = min(largest, (-along - np.sqrt(radius**2 - aside)) / np.tan(-turn / 2))
    return float(max(largest, 0.0))


def nearest_of(ring: Ring) -> Floats:
    """The least distance of each side from the axis, of arcs that of their ends and middles [mm]."""
    vector = ring.end - ring.start
    share = np.clip(-(ring.start * vector.conj()).real / np.maximum(np.abs(vector) ** 2, 1e-12), 0, 1)
    on_line = np.abs(ring.start + share * vector)
    middle = np.abs(ring.center + (ring.start - ring.center) * np.exp(0.5j * ring.sweep))
    on_arc = np.minimum(np.minimum(np.abs(ring.start), np.abs(ring.end)), middle)
    nearest: Floats = np.where(ring.is_line, on_line, on_arc)
    return nearest


def _whole(ring: Ring) -> Ring:
    """The ring with each line and each arc as one side."""
    for _ in range(_LOOKS):
        ring = _merged_arcs(_straightened(_begun_at_corner(ring)))
        taken = _taken_over(ring)
        if taken is None:
            break
        ring = taken
    return ring


def _taken_over(ring: Ring) -> Ring | None:
    """
    The ring with short sides as parts of the long ones beside them on whose curves they lie; None where there are none.

    Two passes round one contour, or a lead that touches it, cut into each other by what their points are rounded by.
    """
    if len(ring) < 2:
        return None
    center, sweep, row = ring.center.copy(), ring.sweep.copy(), ring.row.copy()
    half = np.exp(0.5j * ring.sweep)
    middle = np.where(ring.is_line, (ring.start + ring.end) / 2, ring.center + (ring.start - ring.center) * half)
    points, length = np.stack([ring.start, middle, ring.end]), ring.length
    for step in (1, -1):
        neighbour = np.roll(np.arange(len(ring)), step)
        if not ring.closed:
            neighbour[0 if step > 0 else -1] = 0 if step > 0 else len(ring) - 1
        on_circle = np.abs(np.abs(points - ring.center[neighbour]) - ring.radius[neighbour])
        on_line = np.abs(((points - ring.start[neighbour]) * ring.normal[neighbour].conj()).real)
        line = ring.is_line[neighbour]
        off = np.where(line, on_line, np.nan_to_num(on_circle, nan=np.inf)).max(axis=0)
        taken = (off <= SAME) & (length < _SHORT * length[neighbour])
        about = ring.center[neighbour]
        turn = np.angle((ring.end - about) * (ring.start - about).conj())
        center[taken], sweep[taken] = about[taken], np.where(line, 0.0, np.nan_to_num(turn))[taken]
        row[taken] = ring.row[neighbour][taken]
    if np.array_equal(sweep, ring.sweep):
        return None
    return replace(ring, center=center, sweep=sweep, row=row)


def _begun_at_corner(ring: Ring) -> Ring:
    """A closed ring begun where it turns most, so that no side is torn."""
    if not ring.closed or len(ring) < 2:
        return ring
    into, out = directions(ring)
    turn = np.abs(np.angle(out * np.roll(into, 1).conj()))
    kinds = ring.is_line != np.roll(ring.is_line, 1)
    differs = np.nan_to_num(np.abs(ring.center - np.roll(ring.center, 1))) > SAME
    best = int(np.argmax(turn + 0.1 * (kinds | differs)))
    return ring[np.roll(np.arange(len(ring)), -best)]


def directions(ring: Ring) -> tuple[Points, Points]:
    """Unit vectors in which each side ends, and in which it begins."""
    chord = ring.end - ring.start
    turning = 1j * np.sign(ring.sweep)
    into = np.where(ring.is_line, chord, turning * (ring.end - np.nan_to_num(ring.center)))
    out = np.where(ring.is_line, chord, turning * (ring.start - np.nan_to_num(ring.center)))
    unit: list[Points] = [np.asarray(ray / np.maximum(np.abs(ray), 1e-12), np.complex128) for ray in (into, out)]
    return unit[0], unit[1]


def _straightened(ring: Ring) -> Ring:
    """Lines in a row that are straight but for the rounding of their ends as one."""
    if len(ring) < 2:
        return ring
    line = ring.is_line
    chord = ring.end[1:] - ring.start[:-1]
    off = np.abs(((ring.start[1:] - ring.start[:-1]) * chord.conj()).imag) / np.maximum(np.abs(chord), 1e-12)
    # Across what is a corner for itself no stretch is looked at as a whole.
    joins = np.append(False, line[1:] & line[:-1] & (off <= SAME))
    kept = kept_ends(ring.start, ring.end, joins, np.full(len(ring), _HALF)) | ~line
    return _joined(ring, np.append(True, kept[:-1]))


def _merged_arcs(ring: Ring) -> Ring:
    """Arcs in a row of one circle as one; a whole circle is one arc."""
    if len(ring) < 2:
        return ring
    arc = ~ring.is_line
    center, radius = np.nan_to_num(ring.center), np.nan_to_num(ring.radius)
    same = (np.abs(np.diff(center)) <= 2 * SAME) & (np.abs(np.diff(radius)) <= SAME)
    turns = np.sign(ring.sweep)
    short = np.minimum(ring.length[1:], ring.length[:-1]) < 2 * SAME  # what rounding leaves may run back
    same &= arc[1:] & arc[:-1] & ((turns[1:] == turns[:-1]) | short)
    return _joined(ring, np.append(True, ~same))


def _joined(ring: Ring, begins: Mask) -> Ring:
    first = np.flatnonzero(begins)
    last = np.append(first[1:], len(ring)) - 1
    weight = np.maximum(np.abs(ring.sweep), 1e-12)
    center: Points = np.add.reduceat(np.asarray(ring.center * weight, np.complex128), first)
    center = center / np.add.reduceat(weight, first)
    sweep = np.add.reduceat(ring.sweep, first)
    # The block that says most of the side; the first of those that say as much.
    order = np.lexsort((ring.row, -np.round(ring.length, 3), np.cumsum(begins)))
    return Ring(ring.start[first], ring.end[last], center, sweep, ring.row[order[first]], ring.closed, ring.inside)


def extents_of(ring: Ring) -> dict[str, float]:
    """The extents along X and C, as values of a shape."""
    (x_least, x_most), (c_least, c_most) = _extents(ring, 1), _extents(ring, 1j)
    return {"x_least": x_least, "x_most": x_most, "c_least": c_least, "c_most": c_most}


def _extents(ring: Ring, axis: complex) -> tuple[float, float]:
    """The least and the largest coordinate along an axis, those of arcs between their ends included."""
    ends = np.concatenate([ring.start, ring.end])
    places = [(ends * np.conj(axis)).real]
    arcs = np.flatnonzero(~ring.is_line)
    for sign in (1, -1):
        toward = np.full(len(arcs), sign * axis, np.complex128)
        there = passes_toward(ring.start[arcs] - ring.center[arcs], ring.sweep[arcs], toward)
        top = ring.center[arcs] + sign * axis * ring.radius[arcs]
        places.append((top[there] * np.conj(axis)).real)
    along = np.concatenate(places)
    return float(along.min()), float(along.max())
