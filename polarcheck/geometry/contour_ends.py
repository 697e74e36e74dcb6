"""
Cheap tests at the ends of contours: which contours may leave a rib or a strip, which nearly close, and their gaps.

Lengths in mm, plane points complex, x + 1j*c.
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, first_in_run, mask_at, ranges
from polarcheck.geometry.segments import Curves, first_of_its_kind, segments
from polarcheck.geometry.tolerances import TOUCH

#: Ribs above this height [mm] count: a lower one cannot be felt, and a worn cutter leaves as much.
WITNESS = 0.02
#: Largest gap [mm] of a contour that counts as closed: its points are rounded.
CLOSED = 0.005
#: Number of blocks at either end of a contour that may be leads.
_LEADS = 4
#: Least cosine of the angle between a gap and the direction of the contour.
_AHEAD = 0.87
#: From this number of arcs, repeated arcs are searched for and left out.
_MANY = 2000
#: Greatest ratio between the oblique and the perpendicular width of a strip.
_SLANT = 1.6
#: Largest turn of a corner [rad]; beyond it the contour runs back over itself.
_SHARPEST = 2.65


class Loops(Table, frozen=True):
    """
    The loops of a contour, n of them.

    curves: the curves in offset mode, loop after loop.
    left: bool[curves], the tool runs left of the curve.
    first, last: int[n], the first and the last curve of each loop.
    radius: float64[n] [mm], R of each loop.
    """

    _shared = ("curves", "left")

    curves: Curves
    left: Mask
    first: Rows
    last: Rows
    radius: Floats

    def __len__(self) -> int:
        return len(self.first)

    def rows(self) -> tuple[Rows, Rows]:
        """The numbers of all curves of the loops, loop after loop, and the number of the loop of each."""
        count = self.last - self.first + 1
        loop, index = ranges(count)
        return self.first[loop] + index, loop


def distinct(loops: Loops, program: Rows, z: Floats) -> Rows:
    """
    The deepest of loops that are equal on the plane in one program; of several equally deep, the last.

    program: int[loops]. z: float64[loops] [mm].
    All of them leave what the deepest one leaves, since the tool goes no deeper there.
    """
    if len(loops) < 2:
        return np.arange(len(loops))
    curves = loops.curves
    center = np.where(np.isnan(curves.center), 0, curves.center)
    sums = [
        np.add.reduceat(column, loops.first)
        for column in (curves.start, curves.start * curves.end.conj(), center, center * curves.kind)
    ]
    columns = [np.round(part, 5) for total in sums for part in (total.real, total.imag)]
    columns += [program, loops.last - loops.first, np.round(loops.radius, 5), loops.left[loops.first]]
    _, shape = np.unique(np.stack(columns, axis=1), axis=0, return_inverse=True)
    order = np.lexsort((np.arange(len(loops)), -np.nan_to_num(z, nan=np.inf), shape.ravel()))
    return np.sort(order[np.append(np.diff(shape.ravel()[order]) != 0, True)])


class Corners(Table, frozen=True):
    """
    Inside corners, n of them, that keep the tool away from the material beside them.

    point: complex128[n] [mm].
    reach: float64[n] [mm], distance before the corner at which the tool stops.
    turn: float64[n] [rad].
    loop: int[n], the number of the loop.
    """

    point: Points
    reach: Floats
    turn: Floats
    loop: Rows


def lead_corners(loops: Loops, winds: Mask) -> Corners:
    """
    Inside corners where a lead may meet its contour: near the ends of a loop, or anywhere in a loop of several turns.

    At such a corner the tool stops R * tan(turn / 2) before the programmed point.
    """
    near = np.arange(_LEADS + 1)
    head, tail = loops.first[:, None] + near, loops.last[:, None] - 1 - near
    loop = np.repeat(np.arange(len(loops)), len(near))
    curve, loop = np.append(head, tail), np.append(loop, loop)
    if winds.any():
        rows, winding = loops[winds].rows()
        curve, loop = np.append(curve, rows), np.append(loop, np.flatnonzero(winds)[winding])
    inside = (curve >= loops.first[loop]) & (curve < loops.last[loop])
    curve, first_use = np.unique(curve[inside], return_index=True)
    loop = loop[inside][first_use]

    curves, after = loops.curves, curve + 1
    joined = np.abs(curves.end[curve] - curves.start[after]) < TOUCH
    curve, after, loop = curve[joined], after[joined], loop[joined]
    turn = np.angle(curves[after].leaving * curves[curve].arriving.conj()) * np.where(loops.left[curve], 1, -1)
    reach = loops.radius[loop] * np.tan(np.clip(turn, 0, _SHARPEST) / 2)
    # The same corner on both sides leaves a rib of R - sqrt(R**2 - reach**2), a little more than this.
    sharp = reach**2 / (2 * loops.radius[loop]) > WITNESS / 2
    return Corners(curves.end[curve[sharp]], reach[sharp], turn[sharp], loop[sharp])


class Gaps(msgspec.Struct, frozen=True):
    """
    Possible gaps of loops, from the end of a curve near the last one to the start of a curve near the first one.

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
        """True where the gap continues the direction of the contour."""
        return np.asarray(self.ahead >= _AHEAD * self.length)


def gaps_between_ends(curves: Curves, first: Rows, last: Rows) -> Gaps:
    """All pairs of a curve near the end of a loop and one near its start; first, last: the curves of each loop."""
    i, j = (index.ravel() for index in np.mgrid[:_LEADS, :_LEADS])
    after, before = first[:, None] + i, last[:, None] - j
    is_pair = before - after >= 2
    after, before = np.minimum(after, last[:, None]), np.maximum(before, first[:, None])
    vector = curves.start[after] - curves.end[before]
    begins, ends = curves[after].leaving, curves[before].arriving
    ahead = np.maximum((vector * ends.conj()).real, (vector * begins.conj()).real)
    return Gaps(before, after, vector, np.where(is_pair, np.abs(vector), np.inf), ahead)


def may_be_open(loops: Loops) -> Mask:
    """True for loops that have a gap below 2R straight ahead of their end, and no pair of ends that closes them."""
    gaps = gaps_between_ends(loops.curves, loops.first, loops.last)
    fits = gaps.lead_on & (gaps.length < 2 * loops.radius[:, None])
    return np.asarray(fits.any(axis=1) & (gaps.length > CLOSED).all(axis=1))


def gaps_of(loops: Loops, length: Floats) -> tuple[Rows, Rows]:
    """
    The curves after and before the gap of this length [mm], for each loop.

    Leads side by side may be as far apart as the ends of the contour. The gap that lies most straight ahead is chosen.
    """
    gaps = gaps_between_ends(loops.curves, loops.first, loops.last)
    best = np.argmax(np.where(np.abs(gaps.length - length[:, None]) < TOUCH, gaps.ahead, -np.inf), axis=1)
    row = np.arange(len(loops))
    return gaps.after[row, best], gaps.before[row, best]


# ---- turns of a path round its middle ----


def winds(loops: Loops) -> Mask:
    """True for loops that turn round their middle more than once; repeated arcs count once."""
    rows, loop = loops.rows()
    curves = loops.curves if len(rows) == len(loops.curves) else loops.curves[rows]
    start, end, loop = chords(msgspec.structs.replace(curves, loop=loop), float(loops.radius.min(initial=1.0)) / 4)
    axis, crossed_loop, _ = crossings(start, end, loop, middles(start, loop))
    count = np.bincount(4 * crossed_loop + axis, minlength=4 * len(loops)).reshape(-1, 4)
    return np.asarray(count.min(axis=1) > 1)


def chords(curves: Curves, sagitta: float) -> tuple[Points, Points, Rows]:
    """Start, end and loop of the lines and coarse chords of curves, loop after loop; each distinct arc once."""
    is_arc = ~np.isnan(curves.center)
    if not is_arc.any():
        return curves.start, curves.end, curves.loop
    arcs = curves[is_arc]
    parts = segments(arcs[first_of_its_kind(arcs)] if len(arcs) > _MANY else arcs, 4 * sagitta)
    start, end, loop = (
        np.concatenate([getattr(curves, name)[~is_arc], getattr(parts, name)]) for name in ("start", "end", "loop")
    )
    order = np.argsort(loop, kind="stable")
    return start[order], end[order], loop[order]


def middles(points: Points, of: Rows) -> Points:
    """The middle of the box round the points of a group, for each point; of: int[n], the group of each, rising."""
    begins = first_in_run(of)
    first = np.flatnonzero(begins)
    x, c = points.real, points.imag
    low, high = (side.reduceat(x, first) + 1j * side.reduceat(c, first) for side in (np.minimum, np.maximum))
    middle: Points = ((low + high) / 2)[np.cumsum(begins) - 1]
    return middle


def crossings(start: Points, end: Points, of: Rows, middle: Points) -> tuple[Rows, Rows, Floats]:
    """
    Crossings of straight lines with the half axes from their middle.

    of: int[n], the group of each line. middle: complex128[n] [mm], the middle for each line.
    Returns per crossing: the half axis (0 to 3), the group of the line, the distance from the middle [mm].
    """
    a, b = start - middle, end - middle
    axes, groups, apart = [], [], []
    for number, (a_along, a_across, b_along, b_across) in enumerate(
        ((a.real, a.imag, b.real, b.imag), (a.imag, a.real, b.imag, b.real))
    ):
        rows = np.flatnonzero((a_across < 0) != (b_across < 0))
        share = a_across[rows] / (a_across[rows] - b_across[rows])
        position = a_along[rows] + share * (b_along[rows] - a_along[rows])
        axes.append(2 * number + (position < 0))
        groups.append(of[rows])
        apart.append(np.abs(position))
    return np.concatenate(axes), np.concatenate(groups), np.concatenate(apart)


def may_leave_strips(start: Points, end: Points, of: Rows, radius: Floats) -> Mask:
    """
    True for levels whose tool center paths lie so far apart, outward from their middle, that a strip may remain.

    of: int[n], the level of each straight line, rising. radius: float64[levels] [mm].
    """
    axis, level, apart = crossings(start, end, of, middles(start, of))
    order = np.lexsort((apart, axis, level))
    axis, level, apart = axis[order], level[order], apart[order]
    same = (axis[1:] == axis[:-1]) & (level[1:] == level[:-1])
    step, limit = np.diff(apart), radius[level[1:]]
    is_wide = same & (step > 2 * limit + WITNESS) & (step < _SLANT * 3 * limit)
    return mask_at(len(radius), level[1:][is_wide])
