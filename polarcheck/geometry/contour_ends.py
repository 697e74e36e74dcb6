"""
Where contours begin and end: which may leave something there, by comparing a few blocks of each; and their gaps.

Lengths in mm, plane points complex, x + 1j*c.
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.arrays import Floats, Mask, Points, Rows, States, Table
from polarcheck.geometry.segments import Curves, directions, first_of_its_kind, segments
from polarcheck.geometry.tolerances import TOUCH

#: Height [mm] from which on a rib is one: below it no hand feels it, and the wear of a cutter leaves as much.
WITNESS = 0.02
#: What may be missing of a contour that is closed [mm]: its points are rounded.
CLOSED = 0.005
#: How many blocks from either end of a contour may be leads.
_LEADS = 4
#: How far a gap may turn off the way of the contour [cosine].
_AHEAD = 0.87
#: Arcs from which on it is worth while to look for those that are written once more.
_MANY = 2000
#: How much longer than straight across the way over a strip may be.
_SLANT = 1.6
#: A corner turns by this much at most [rad]; beyond, the contour runs back over itself.
_SHARPEST = 2.65


class Loops(msgspec.Struct, frozen=True):
    """
    The loops of a contour: their first and last curves, int[loops] each, and R of each [mm].

    curves: those of offset mode, loop after loop. left: bool[curves], the tool runs left of it.
    """

    curves: Curves
    left: Mask
    first: Rows
    last: Rows
    radius: Floats

    def __len__(self) -> int:
        return len(self.first)

    def some(self, chosen: Rows | Mask) -> Loops:
        """Some of the loops, of the same curves."""
        return Loops(self.curves, self.left, self.first[chosen], self.last[chosen], self.radius[chosen])

    def rows(self) -> tuple[Rows, Rows]:
        """All their curves, loop after loop, and which of the loops each is of."""
        count = self.last - self.first + 1
        of = np.repeat(np.arange(len(self)), count)
        return np.arange(len(of)) + (self.first - np.cumsum(count) + count)[of], of


def distinct(loops: Loops, program: Rows, z: Floats) -> Rows:
    """
    Of loops that are the same on the plane in one program the deepest, the last of these; z: of each loop [mm].

    What that one leaves standing stands in all of them, since the tool does not come there any deeper.
    """
    if len(loops) < 2:
        return np.arange(len(loops))
    curves = loops.curves
    center = np.where(np.isnan(curves.center), 0, curves.center)
    sums = [
        np.add.reduceat(column, loops.first)
        for column in (curves.start, curves.start * curves.end.conj(), center, center * curves.kind)
    ]
    columns = [np.round(part, 5) for one in sums for part in (one.real, one.imag)]
    columns += [program, loops.last - loops.first, np.round(loops.radius, 5), loops.left[loops.first]]
    _, shape = np.unique(np.stack(columns, axis=1), axis=0, return_inverse=True)
    order = np.lexsort((np.arange(len(loops)), -np.nan_to_num(z, nan=np.inf), shape.ravel()))
    return np.sort(order[np.append(np.diff(shape.ravel()[order]) != 0, True)])


class Corners(Table, frozen=True):
    """Inside corners that keep the tool off what lies beside them: point, how far [mm], its turn [rad], its loop."""

    point: Points
    reach: Floats
    turn: Floats
    loop: Rows


def lead_corners(loops: Loops, winds: Mask) -> Corners:
    """
    Inside corners where a lead may meet its contour: near the ends of a loop, anywhere in one that winds round twice.

    At such a corner the tool stops R * tan(turn / 2) before the point that is programmed.
    """
    near = np.arange(_LEADS + 1)
    head, tail = loops.first[:, None] + near, loops.last[:, None] - 1 - near
    of = np.repeat(np.arange(len(loops)), len(near))
    curve, of = np.append(head, tail), np.append(of, of)
    if winds.any():
        rows, winding = loops.some(winds).rows()
        curve, of = np.append(curve, rows), np.append(of, np.flatnonzero(winds)[winding])
    inside = (curve >= loops.first[of]) & (curve < loops.last[of])
    curve, at = np.unique(curve[inside], return_index=True)
    of = of[inside][at]

    curves, after = loops.curves, curve + 1
    joined = np.abs(curves.end[curve] - curves.start[after]) < TOUCH
    curve, after, of = curve[joined], after[joined], of[joined]
    _, arriving = directions(*_shape(curves, curve))
    leaving, _ = directions(*_shape(curves, after))
    turn = np.angle(leaving * arriving.conj()) * np.where(loops.left[curve], 1, -1)
    reach = loops.radius[of] * np.tan(np.clip(turn, 0, _SHARPEST) / 2)
    # The same corner on both sides leaves a rib of R - sqrt(R**2 - reach**2), a little more than this.
    sharp = reach**2 / (2 * loops.radius[of]) > WITNESS / 2
    return Corners(curves.end[curve[sharp]], reach[sharp], turn[sharp], of[sharp])


def _shape(curves: Curves, rows: Rows) -> tuple[Points, Points, Points, States]:
    return curves.start[rows], curves.end[rows], curves.center[rows], curves.kind[rows]


class Gaps(msgspec.Struct, frozen=True):
    """
    Where loops may be open: from the end of a curve near the last one to the start of a curve near the first one.

    before: int[loops, pairs], the curve at whose end the gap begins.
    after: int[loops, pairs], the curve at whose start it ends.
    vector: complex128[loops, pairs] [mm], from that end to that start.
    length: float64[loops, pairs] [mm], inf where the loop has no such pair of curves.
    ahead: float64[loops, pairs] [mm], how far the gap leads straight on from one of the two curves.
    """

    before: Rows
    after: Rows
    vector: Points
    length: Floats
    ahead: Floats

    @property
    def lead_on(self) -> Mask:
        """The gap lies on the way of the contour: the tool would have to go on straight ahead."""
        return np.asarray(self.ahead >= _AHEAD * self.length)


def gaps_between_ends(curves: Curves, first: Rows, last: Rows) -> Gaps:
    """All pairs of a curve near the end of a loop and one near its start; first, last: the curves of each loop."""
    i, j = (index.ravel() for index in np.mgrid[:_LEADS, :_LEADS])
    after, before = first[:, None] + i, last[:, None] - j
    is_pair = before - after >= 2
    after, before = np.minimum(after, last[:, None]), np.maximum(before, first[:, None])
    vector = curves.start[after] - curves.end[before]
    begins, ends = directions(*_shape(curves, after))[0], directions(*_shape(curves, before))[1]
    ahead = np.maximum((vector * ends.conj()).real, (vector * begins.conj()).real)
    return Gaps(before, after, vector, np.where(is_pair, np.abs(vector), np.inf), ahead)


def may_be_open(loops: Loops) -> Mask:
    """Loops that come back to their start but for a gap below 2R that lies ahead, and nowhere without a gap."""
    gaps = gaps_between_ends(loops.curves, loops.first, loops.last)
    fits = gaps.lead_on & (gaps.length < 2 * loops.radius[:, None])
    return np.asarray(fits.any(axis=1) & (gaps.length > CLOSED).all(axis=1))


def gaps_of(loops: Loops, length: Floats) -> tuple[Rows, Rows]:
    """
    For each loop the curves after and before its gap of this length [mm].

    Leads side by side are as far apart as the ends of the contour, but it does not lead from one to the other.
    """
    gaps = gaps_between_ends(loops.curves, loops.first, loops.last)
    best = np.argmax(np.where(np.abs(gaps.length - length[:, None]) < TOUCH, gaps.ahead, -np.inf), axis=1)
    row = np.arange(len(loops))
    return gaps.after[row, best], gaps.before[row, best]


# ---- how often a path goes round ----


def winds(loops: Loops) -> Mask:
    """Whether a loop goes round its middle more than once; the same arcs again do not count."""
    rows, of = loops.rows()
    curves = loops.curves if len(rows) == len(loops.curves) else loops.curves[rows]
    start, end, of = chords(msgspec.structs.replace(curves, loop=of), float(loops.radius.min(initial=1.0)) / 4)
    axis, at, _ = crossings(start, end, of, middles(start, of))
    count = np.bincount(4 * at + axis, minlength=4 * len(loops)).reshape(-1, 4)
    return np.asarray(count.min(axis=1) > 1)


def chords(curves: Curves, sagitta: float) -> tuple[Points, Points, Rows]:
    """Start, end and loop of curves, loop after loop; arcs in coarse chords, each arc once."""
    is_arc = ~np.isnan(curves.center)
    if not is_arc.any():
        return curves.start, curves.end, curves.loop
    arcs = curves[is_arc]
    parts = segments(arcs[first_of_its_kind(arcs)] if len(arcs) > _MANY else arcs, 4 * sagitta)
    start, end, of = (
        np.concatenate([getattr(curves, name)[~is_arc], getattr(parts, name)]) for name in ("start", "end", "loop")
    )
    order = np.argsort(of, kind="stable")
    return start[order], end[order], of[order]


def middles(points: Points, of: Rows) -> Points:
    """For each of these points the middle of the box round all that belong together; of: rising."""
    begins = np.diff(of, prepend=-1) != 0
    first = np.flatnonzero(begins)
    x, c = points.real, points.imag
    low, high = (side.reduceat(x, first) + 1j * side.reduceat(c, first) for side in (np.minimum, np.maximum))
    middle: Points = ((low + high) / 2)[np.cumsum(begins) - 1]
    return middle


def crossings(start: Points, end: Points, of: Rows, middle: Points) -> tuple[Rows, Rows, Floats]:
    """
    Where straight lines cross the half axes from their middle, one point for each.

    Per crossing: the half axis (0 to 3), what the line is of, how far from the middle it is [mm].
    """
    a, b = start - middle, end - middle
    axes, found, apart = [], [], []
    for number, (a_along, a_across, b_along, b_across) in enumerate(
        ((a.real, a.imag, b.real, b.imag), (a.imag, a.real, b.imag, b.real))
    ):
        rows = np.flatnonzero((a_across < 0) != (b_across < 0))
        share = a_across[rows] / (a_across[rows] - b_across[rows])
        at = a_along[rows] + share * (b_along[rows] - a_along[rows])
        axes.append(2 * number + (at < 0))
        found.append(of[rows])
        apart.append(np.abs(at))
    return np.concatenate(axes), np.concatenate(found), np.concatenate(apart)


def may_leave_strips(start: Points, end: Points, of: Rows, radius: Floats) -> Mask:
    """
    Whether paths of the tool center lie so far apart, on the way out from their middle, that a strip may stay.

    of: which of the levels each straight line is of, rising; radius: of each level [mm].
    """
    axis, at, apart = crossings(start, end, of, middles(start, of))
    order = np.lexsort((apart, axis, at))
    axis, at, apart = axis[order], at[order], apart[order]
    same = (axis[1:] == axis[:-1]) & (at[1:] == at[:-1])
    step, limit = np.diff(apart), radius[at[1:]]
    found = same & (step > 2 * limit + WITNESS) & (step < _SLANT * 3 * limit)
    result = np.zeros(len(radius), bool)
    result[at[1:][found]] = True
    return result
