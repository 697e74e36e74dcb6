"""
Moves on which the control slows the tool down by itself, so that C turns no faster than a rate: automatic override.

FANUC B-64120EN/01 p. 280, B-63324EN/03 p. 192: where C would turn faster than a share of its limit, override is what
is allowed divided by what is asked for. It follows the rate at each moment, so that C turns at the allowed rate all
the while, and F comes back by itself behind the center. Moves are given as in `polar`; each is parted where override
begins and ends, which is a distance from the center of C: on a line r^2 = d / q, on an arc r^2 = (R^2 - e^2) /
(+-2Rq - 1), with q the turn of C per way that F leaves room for.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, Table, first_in_run, last_in_run
from polarcheck.foundation.states import Motion
from polarcheck.geometry import polar, rates
from polarcheck.geometry.plane import arcs_from_center, cross, dot, lines_from_center, quiet, rows_of_arcs
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import ZERO

#: Pieces shorter than this are left out [mm]: an arc shorter than ZERO would be a full circle, and rounding shifts the
#: ends of pieces.
_SHORTEST = 100 * ZERO
#: Points of a piece at which the axes are evaluated; denser near its ends, where most extremes are.
_POINTS = 257
#: Pieces that are evaluated at once.
_AT_ONCE = 1024

#: From points [mm], directions and curvature [1/mm] to a value of the axes.
_OfPoint = Callable[[Points, Points, Floats], Floats]


class Pieces(PlanePath, frozen=True):
    """
    Parts of moves. move: the one that each is of. held: C turns at the rate that is allowed [deg/min], else the tool
    runs at F [mm/min].
    """

    _shared = ("allowed",)

    move: Rows
    held: Mask
    feed: Floats
    allowed: float

    def time(self) -> Floats:
        """The time of each piece [s]; at the center itself the tool waits until C has made its half turn."""
        turning = np.abs(polar.c_sweep(*self.shape)) / self.allowed
        waiting = np.where(np.isinf(rates.c_feed(*self.shape, self.feed)), 180 / self.allowed, 0.0)
        moving = polar.time(self.length, self.feed) / 60
        return np.asarray(60 * np.where(self.held, turning, moving + waiting))

    def c_feed(self) -> Floats:
        """Highest rate of C on each [deg/min]."""
        return np.where(self.held, self.allowed, np.minimum(rates.c_feed(*self.shape, self.feed), self.allowed))

    def c_acceleration(self) -> Floats:
        """Highest acceleration of C within each [deg/s2]: none where its rate is held."""
        return np.where(self.held, 0.0, rates.c_acceleration(*self.shape, self.feed))

    def x_feed(self) -> Floats:
        """Highest rate of X on each [mm/min, radius]."""
        return np.where(self.held, self._of_held(_x_per_turn) * self._turn, rates.x_feed(*self.shape, self.feed))

    def x_acceleration(self) -> Floats:
        """Highest acceleration of X within each [mm/s2, radius]."""
        bend = self._of_held(_x_bend_per_turn) * (self._turn / 60) ** 2
        return np.where(self.held, bend, rates.x_acceleration(*self.shape, self.feed))

    @property
    def _turn(self) -> float:
        """The rate at which C is held [rad/min]."""
        return float(np.radians(self.allowed))

    @quiet
    def _of_held(self, of_point: _OfPoint) -> Floats:
        """The largest value of the points of each piece on which C is held; 0 on the others."""
        largest = np.zeros(len(self.move))
        held = np.flatnonzero(self.held)
        share = (1 - np.cos(np.linspace(0.0, np.pi, _POINTS)[:, None])) / 2
        for first in range(0, len(held), _AT_ONCE):
            rows = held[first : first + _AT_ONCE]
            spokes = Spokes.of(self[rows])
            largest[rows] = np.abs(of_point(*spokes.at(share * spokes.length), spokes.bend)).max(axis=0)
        return largest


class Spokes(Table, frozen=True):
    """
    Moves by their start, direction and curvature [1/mm], above 0 to the left.

    toward: the direction of a line; of an arc that from its center to its start.
    """

    start: Points
    toward: Points
    center: Points
    radius: Floats
    bend: Floats
    length: Floats
    is_arc: Mask

    @classmethod
    @quiet
    def of(cls, path: PlanePath) -> Spokes:
        is_arc = path.is_arc
        spoke = np.where(is_arc, path.start - path.center, path.end - path.start)
        radius = np.where(is_arc, np.abs(spoke), np.inf)
        bend = np.where(is_arc, np.where(path.kind == Motion.CCW, 1.0, -1.0) / radius, 0.0)
        toward = np.asarray(spoke / np.abs(spoke), np.complex128)
        return cls(path.start, toward, path.center, radius, bend, path.length, is_arc)

    @quiet
    def at(self, distance: Floats) -> tuple[Points, Points]:
        """Points and directions at these distances from the start [mm]."""
        turned = self.toward * np.exp(1j * distance * self.bend)
        on_arc = self.center + np.where(self.is_arc, self.radius, 0.0) * turned
        point = np.where(self.is_arc, on_arc, self.start + distance * self.toward)
        return point, np.where(self.is_arc, turned * 1j * np.sign(self.bend), self.toward)


def c_per_way(point: Points, direction: Points) -> Floats:
    """Turn of C per length of path, signed [rad/mm]."""
    return np.asarray(cross(point, direction) / np.abs(point) ** 2)


def _x_per_turn(point: Points, direction: Points, bend: Floats) -> Floats:
    """Way of X per turn of C [mm/rad]: r (p . u) / (p x u)."""
    return np.asarray(np.abs(point) * dot(point, direction) / cross(point, direction))


def _x_bend_per_turn(point: Points, direction: Points, bend: Floats) -> Floats:
    """
    Its change per turn of C [mm/rad^2].

    With a = p . u and b = p x u on a path of the curvature k: a' = 1 - k b, b' = k a and r' = a / r per way.
    """
    r, a, b = np.abs(point), dot(point, direction), cross(point, direction)
    slope = a**2 / (r * b) + r * (1 - bend * b) / b - r * bend * a**2 / b**2
    return np.asarray(slope * r**2 / b)


@quiet
def pieces(start: Points, end: Points, center: Points, kind: States, feed: Floats, allowed: float) -> Pieces:
    """The moves in parts; all is known, and F [mm/min] and the rate of C that is allowed [deg/min] are above 0."""
    room = np.radians(allowed) / feed
    spokes = Spokes.of(PlanePath(start, end, center, kind))
    distance = _limit_distances(start, end, center, kind, room)
    length = spokes.length[:, None]
    distance = np.where((distance > 0) & (distance < length), distance, length)
    distance = np.sort(np.concatenate((np.zeros((len(start), 1)), distance, length), axis=1), axis=1)
    is_piece = np.diff(distance, axis=1) > _SHORTEST
    is_piece[:, 0] |= ~is_piece.any(axis=1)
    move, index = np.nonzero(is_piece)
    last = last_in_run(move)
    # A part that is too short for a piece of its own joins the piece before it.
    finish = np.where(last, spokes.length[move], np.append(distance[move[1:], index[1:]], 0.0))
    spoke = spokes[move]
    begin = np.where(first_in_run(move), 0.0, distance[move, index])
    points = np.where(begin == 0, start[move], spoke.at(begin)[0])
    ends = np.where(last, end[move], spoke.at(finish)[0])
    middle = spoke.at((begin + finish) / 2)
    held = np.abs(c_per_way(*middle)) > room[move]
    return Pieces(points, ends, center[move], kind[move], move, held, feed[move], allowed)


def _limit_distances(start: Points, end: Points, center: Points, kind: States, room: Floats) -> Floats:
    """Where C would turn as fast as there is room for [mm from the start]: four values for each move, NaN for none."""
    lines = lines_from_center(start, end)
    # Through the center itself C makes half a turn in one point, and none beside it.
    reach = np.where(lines.offset == 0, np.nan, np.sqrt(lines.offset / room - lines.offset**2))
    none = np.full(len(start), np.nan)
    distance = np.stack((-lines.before - reach, -lines.before + reach, none, none), axis=1)
    arcs = arcs_from_center(start, end, center, kind, rows := rows_of_arcs(kind))
    power, allowed = arcs.inside * arcs.around, 2 * arcs.radius * room[rows]
    sign = np.copysign(1.0, arcs.sweep)
    distances = []
    for turn in (allowed, -allowed):
        angle = np.arccos((power / (turn - 1) - arcs.radius**2 - arcs.away**2) / (2 * arcs.radius * arcs.away))
        for side in (angle, -angle):
            ahead = np.angle(arcs.center * np.exp(1j * side) / (arcs.start - arcs.center)) * sign
            ahead = np.where(ahead < 0, ahead + 2 * np.pi, ahead)
            distances.append(np.where(arcs.through, np.nan, ahead * arcs.radius))
    distance[rows] = np.stack(distances, axis=1)
    return distance
