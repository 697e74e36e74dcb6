"""
The polar plane and the two machine axes behind it: X as a radius, and C.

Moves come as arrays of one length n. start, end, center: complex128 [mm], plane points x + 1j*c, center NaN for lines.
kind: int16, Motion LINE, CW or CCW; all else counts as LINE, a rapid being the worst case of its straight way.
A line of no length is a point. An arc that ends where it starts is a full circle; its radius is that of its start.
Unknown (NaN) in, unknown out; nothing is raised.

Formulas: with R the radius of an arc, e the distance of its center from the center of C, r that of the tool center and
u the direction of travel, C turns by cross(p, u) / r^2 and X moves by dot(p, u) / r per mm of path. On a line at the
distance d the former is d / r^2, on an arc (1 + (R^2 - e^2) / r^2) / 2R. The rest is where these are largest.

A path exactly through the center asks C for half a turn in no time: its rates are inf, and the half turn counts as
+180 deg. A move that only begins or ends at the center comes and goes along one direction; it does not turn C on the
way, and what C must turn at the center between two moves belongs to neither.
"""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Points, States, first_in_run
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import (
    NOISE,
    angle_between,
    arc_sweep,
    arcs_from_center,
    cleared,
    cross,
    dot,
    lines_from_center,
    quiet,
    rows_of_arcs,
)
from polarcheck.geometry.tolerances import ZERO


class CAxis(msgspec.Struct, frozen=True):
    """
    How C stands to the angle of plane points.

    sense: 1 where it grows with that angle, -1 where it falls. is_fixed: the plane stands still on the part; else it
    begins at each G12.1 anew, with the tool on the linear axis.
    """

    sense: int = 1
    is_fixed: bool = False


_AS_PLANE = CAxis()
#: The cross product of start and end, as a share of the square of their size, below which a line may be radial; what
#: counts as radial is decided by plane.NOISE, and this share is far above it.
_RADIAL = 1e-9


def _size(point: Points) -> Floats:
    return np.abs(point.real) + np.abs(point.imag)


@quiet
def length(start: Points, end: Points, center: Points, kind: States) -> Floats:
    """Length of each move in the plane [mm]."""
    result = np.abs(end - start)
    rows = rows_of_arcs(kind)
    sweep = arc_sweep(start[rows], end[rows], center[rows], kind[rows])
    result[rows] = np.abs(start[rows] - center[rows]) * np.abs(sweep)
    return result


@quiet
def center_from_radius(
    start: Points, end: Points, radius: Floats, kind: States, tolerance: Floats | float = 0.0
) -> Points:
    """
    Centers of arcs written with R [mm, signed]: R above 0 turns through at most 180 deg, below 0 through more.

    Where the chord is longer than 2R by no more than the tolerance [mm], the middle of the chord; beyond it NaN, and so
    for lines, for R = 0 and where start and end are one point, since no circle is given (no movement at the control,
    FANUC 16/18-C lathe manual B-62754EN/01 p. 67).
    """
    half = (end - start) / 2
    reach = np.abs(half)
    height = np.sqrt(np.maximum((np.abs(radius) - reach) * (np.abs(radius) + reach), 0))
    left = (kind == Motion.CCW) == (radius > 0)
    center = start + half + np.where(left, 1j, -1j) * half * (height / reach)
    fits = 2 * (reach - np.abs(radius)) <= np.maximum(tolerance, NOISE * reach)
    has_center = fits & (reach > ZERO / 2) & (radius != 0) & ((kind == Motion.CW) | (kind == Motion.CCW))
    return np.where(has_center, center, complex("nan+nanj"))


@quiet
def nearest(start: Points, end: Points, center: Points, kind: States) -> Floats:
    """L, the smallest distance of each move from the center of C [mm]."""
    result = lines_from_center(start, end).near
    arcs = arcs_from_center(start, end, center, kind, rows := rows_of_arcs(kind))
    near = np.where(arcs.passes_near, np.abs(arcs.inside), np.inf)
    ends = np.minimum(np.abs(arcs.start), np.abs(arcs.end))
    result[rows] = np.where(arcs.crosses, 0.0, np.minimum(ends, near)) + arcs.unknown
    return result


@quiet
def farthest(start: Points, end: Points, center: Points, kind: States) -> Floats:
    """The largest distance of each move from the center of C [mm]."""
    result = np.maximum(np.abs(start), np.abs(end))
    arcs = arcs_from_center(start, end, center, kind, rows := rows_of_arcs(kind))
    far = np.where(arcs.passes_far, arcs.around, 0.0)
    result[rows] = np.maximum(result[rows], far) + arcs.unknown
    return result


@quiet
def time(length: Floats, feed: Floats | float) -> Floats:
    """Time of each move [s] from its length [mm] and F [mm/min]; inf where F is 0."""
    return np.asarray(np.where(length == 0, 0 * np.asarray(feed), 60 * length / feed))


@quiet
def c_sweep(start: Points, end: Points, center: Points, kind: States) -> Floats:
    """
    Signed turn of C along each move [deg]; +180 for a line through the center, whichever way it runs.

    An arc round the center turns C as it turns itself but for the angles at which it is seen; one that leaves the
    center outside turns C by no more than half a turn.
    """
    first, last = cleared(start), cleared(end)
    aside = cross(first, last)
    turn = np.arctan2(aside + 0.0, dot(first, last))
    # Lines through the center or along a radius: only where start and end are seen at the same or opposite angles.
    along = np.flatnonzero(~(np.abs(aside) > _RADIAL * (_size(first) + _size(last)) ** 2))
    straight = lines_from_center(start[along], end[along])
    turn[along] = np.where(straight.offset == 0, np.where(straight.has_foot, np.pi, 0.0), turn[along])
    turn += np.where(np.isnan(start) | np.isnan(end), np.nan, 0.0)
    arcs = arcs_from_center(start, end, center, kind, rows := rows_of_arcs(kind))
    leave = angle_between(arcs.end - arcs.center, arcs.end)
    enter = angle_between(arcs.start - arcs.center, arcs.start)
    inside = arcs.sweep + np.where(arcs.sweep == 0, 0, leave - enter)
    outside = np.where(arcs.start == arcs.end, 0.0, angle_between(arcs.start, arcs.end))
    # Seen from a point of the circle itself, an arc is half as wide as from its center.
    through = arcs.sweep / 2 + np.where(arcs.crosses, np.pi, 0.0)
    turned = np.where(arcs.inside > 0, inside, outside)
    turn[rows] = np.where(arcs.radius == 0, 0.0, np.where(arcs.through, through, turned)) + arcs.unknown
    return np.degrees(turn)


@quiet
def c_angles(
    start: Points,
    end: Points,
    center: Points,
    kind: States,
    section: NDArray[np.integer],
    entry: Floats,
    axis: CAxis = _AS_PLANE,
) -> tuple[Floats, Floats]:
    """
    C at the start and at the end of each move [deg], continuous along each section.

    section: int[n], number of the section, moves of one section together; below 0 outside, which gives NaN.
    entry: float64[sections] [deg], C at the G12.1 of each section; of a fixed plane C of its linear axis.
    Where the plane is not fixed, the position at G12.1 counts as angle 0 (B-62764EN/01 p. 51), and C does not jump
    there: a section that begins on the negative side of X has entry there, and the plane lies turned by 180 deg against
    the machine.
    After an unknown move C goes on the shorter way from where it was last known: right but for whole turns.
    """
    count = len(section)
    sweep = c_sweep(start, end, center, kind)
    leaving, arriving = _directions(cleared(start), cleared(end), center, kind)
    is_known = ~np.isnan(sweep) & (section >= 0)
    row = np.arange(count)
    begins = first_in_run(section)
    first = np.maximum.accumulate(np.where(begins, row, 0))
    turned = ((start.imag == 0) & (start.real < 0))[first] & (not axis.is_fixed)
    seen = is_known & (leaving != 0)
    last = np.maximum.accumulate(np.where(seen, row, -1))
    before = np.append(-1, last[:-1])[:count]
    continues = before >= first

    zero = np.where(turned, -1.0 + 0j, 1.0 + 0j)
    here = np.degrees(angle_between(zero, leaving))
    jump = np.where(continues, np.degrees(angle_between(arriving[before], leaving)), here)
    total = np.cumsum(np.where(is_known, np.where(seen, jump, 0.0) + sweep, 0.0))
    earlier = np.append(0.0, total[:-1])[:count]
    turns = total - sweep - earlier[first]
    # The sum knows the whole turns, the point itself the rest; so no rounding piles up.
    turns = np.where(seen, here + 360 * np.round((turns - here) / 360), turns)
    c_from = np.where(is_known, entry[np.where(section >= 0, section, 0)] + axis.sense * turns, np.nan)
    return c_from, c_from + axis.sense * sweep


def _directions(start: Points, end: Points, center: Points, kind: States) -> tuple[Points, Points]:
    """Where start and end are seen from the center; at the center itself, where the move goes to or comes from."""
    leave, arrive = end - start, start - end
    arcs = rows_of_arcs(kind)
    ahead = np.where(kind[arcs] == Motion.CCW, 1j, -1j)
    leave[arcs] = ahead * (start[arcs] - center[arcs])
    arrive[arcs] = -ahead * (end[arcs] - center[arcs])
    return np.where(start == 0, leave, start), np.where(end == 0, arrive, end)
