"""The rates and accelerations of C and X that a move on the polar plane needs."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Points, States
from polarcheck.geometry.plane import (
    ArcsFromCenter,
    arcs_from_center,
    cross,
    dot,
    lines_from_center,
    passes_toward,
    quiet,
    rows_of_arcs,
)


@quiet
def c_feed(start: Points, end: Points, center: Points, kind: States, feed: Floats | float) -> Floats:
    """
    Largest |C rate| along each move [deg/min] for the feed F [mm/min] along the path.

    Where C turns back within an arc (R < e), the larger of both directions counts. inf through the center.
    Source: FANUC B-62764EN/01 p. 52 has F < L * R * pi / 180, exact where the tool center passes its nearest point
    at a right angle to the radius, on the safe side elsewhere; here the rate itself.
    """
    return _scaled(np.degrees(_c_turn(start, end, center, kind)), feed)


@quiet
def feed_allowed(start: Points, end: Points, center: Points, kind: States, limit: Floats | float) -> Floats:
    """
    Highest F along each move [mm/min] at which the C rate stays at or below the limit [deg/min].

    inf where C does not turn, 0 through the center.
    """
    turn = np.degrees(_c_turn(start, end, center, kind))
    return np.asarray(np.where(turn == 0, np.inf + 0 * np.asarray(limit), limit / turn))


def _scaled(rate: Floats, feed: Floats | float) -> Floats:
    """The rate at this feed; without feed nothing moves, not even through the center."""
    return np.asarray(np.where(np.asarray(feed) == 0, 0 * np.nan_to_num(rate, nan=np.nan, posinf=0.0), rate * feed))


def _c_turn(start: Points, end: Points, center: Points, kind: States) -> Floats:
    """Largest turn of C per way [rad/mm]."""
    lines = lines_from_center(start, end)
    turn = lines.offset / lines.near**2
    turn = np.where(lines.offset == 0, np.where(lines.has_foot, np.inf, 0.0), turn)
    arcs = arcs_from_center(start, end, center, kind, rows := rows_of_arcs(kind))
    turn[rows] = _c_turn_of_arcs(arcs)
    return turn


def _c_turn_of_arcs(arcs: ArcsFromCenter) -> Floats:
    """The rate hangs on r alone, and monotonously: it is largest at the nearest or at the farthest point."""
    turn = np.maximum(_c_turn_at(arcs, arcs.start), _c_turn_at(arcs, arcs.end))
    turn = np.maximum(turn, np.where(arcs.passes_near, 1 / np.abs(arcs.inside), 0.0))
    turn = np.maximum(turn, np.where(arcs.passes_far, 1 / arcs.around, 0.0))
    turn = np.where(arcs.through, np.where(arcs.crosses, np.inf, 0.5 / arcs.radius), turn)
    return np.where(arcs.radius == 0, 0.0, turn) + arcs.unknown


def _c_turn_at(arcs: ArcsFromCenter, point: Points) -> Floats:
    """|cross(p, u)| / r^2 at an end of the arc, from the point itself: exact however near to the center it is."""
    spoke = point - arcs.center
    return np.asarray(np.abs(dot(point, spoke)) / (np.abs(spoke) * np.abs(point) ** 2))


@quiet
def c_acceleration(start: Points, end: Points, center: Points, kind: States, feed: Floats | float) -> Floats:
    """
    Largest |C acceleration| within each move at the feed F [deg/s^2], not at its ends; inf through the center.

    On a line 2 F^2 d s / r^4 with s the distance from the foot, largest at s = d / sqrt(3): 0.6495 F^2 / d^2. On an arc
    F^2 (R^2 - e^2) e sin(psi) / (R r^4) with psi the angle from the center's own direction.
    """
    lines = lines_from_center(start, end)
    shortest = np.where(lines.has_foot, 0.0, np.minimum(np.abs(lines.before), np.abs(lines.after)))
    distance = np.clip(lines.offset / np.sqrt(3), shortest, np.maximum(np.abs(lines.before), np.abs(lines.after)))
    bend = 2 * lines.offset * distance / (lines.offset**2 + distance**2) ** 2
    bend = np.where(lines.offset == 0, np.where(lines.has_foot, np.inf, 0.0), bend)
    arcs = arcs_from_center(start, end, center, kind, rows := rows_of_arcs(kind))
    bend[rows] = _c_bend_of_arcs(arcs)
    return _scaled(np.degrees(bend), (np.asarray(feed) / 60) ** 2)


def _c_bend_of_arcs(arcs: ArcsFromCenter) -> Floats:
    """Largest change of the C turn per way and way [rad/mm^2]; at an end, or where its derivative by psi is 0."""
    bend = np.maximum(_c_bend_at(arcs, arcs.start), _c_bend_at(arcs, arcs.end))
    a, b = arcs.radius**2 + arcs.away**2, 2 * arcs.radius * arcs.away
    root = np.sqrt(a**2 + 8 * b**2)
    # cos(psi) comes near to -1 with the center near to the circle; 1 + cos(psi) then keeps its digits.
    above = 2 * arcs.inside**2 / (a + 2 * b + root)
    sine = np.sqrt(above * (2 - above))
    r_squared = arcs.inside**2 + b * above
    extreme = np.abs(arcs.inside) * arcs.around * arcs.away * sine / (arcs.radius * r_squared**2)
    ahead = arcs.center * (above - 1 + 1j * sine)
    mirrored = arcs.center * (above - 1 - 1j * sine)
    spoke = arcs.start - arcs.center
    passes = passes_toward(spoke, arcs.sweep, ahead) | passes_toward(spoke, arcs.sweep, mirrored)
    bend = np.where(passes, np.maximum(bend, extreme), bend)
    bend = np.where(arcs.through, np.where(arcs.crosses, np.inf, 0.0), bend)
    return np.where((arcs.radius == 0) | (arcs.away == 0), 0.0, bend) + arcs.unknown


def _c_bend_at(arcs: ArcsFromCenter, point: Points) -> Floats:
    power = dot(point, point - 2 * arcs.center)
    spoke = np.abs(point - arcs.center)
    return np.asarray(np.abs(power * cross(arcs.center, point)) / (spoke * np.abs(point) ** 2) ** 2)


@quiet
def x_feed(start: Points, end: Points, center: Points, kind: States, feed: Floats | float) -> Floats:
    """Largest |X rate| along each move [mm/min, X as a radius]; never above F."""
    lines = lines_from_center(start, end)
    distance = np.maximum(np.abs(lines.before), np.abs(lines.after))
    share = np.where(distance == 0, distance, distance / np.hypot(lines.offset, distance))
    arcs = arcs_from_center(start, end, center, kind, rows := rows_of_arcs(kind))
    share[rows] = _x_share_of_arcs(arcs)
    return _scaled(share, feed)


def _x_share_of_arcs(arcs: ArcsFromCenter) -> Floats:
    """Largest |X rate| per feed: e |sin(psi)| / r, at its best F where e > R, where the tool runs straight to C0."""
    share = np.maximum(_x_share_at(arcs, arcs.start), _x_share_at(arcs, arcs.end))
    less, more = np.minimum(arcs.radius, arcs.away), np.maximum(arcs.radius, arcs.away)
    cosine = -less / more
    sine = np.sqrt((more - less) * (more + less)) / more
    spoke = arcs.start - arcs.center
    ahead, mirrored = arcs.center * (cosine + 1j * sine), arcs.center * (cosine - 1j * sine)
    passes = passes_toward(spoke, arcs.sweep, ahead) | passes_toward(spoke, arcs.sweep, mirrored)
    share = np.where(passes, arcs.away / more, share)
    return np.where((arcs.radius == 0) | (arcs.away == 0), 0.0, share) + arcs.unknown


def _x_share_at(arcs: ArcsFromCenter, point: Points) -> Floats:
    spoke = np.abs(point - arcs.center)
    share = np.abs(cross(arcs.center, point)) / (spoke * np.abs(point))
    return np.where(point == 0, 1.0, share)


@quiet
def x_acceleration(start: Points, end: Points, center: Points, kind: States, feed: Floats | float) -> Floats:
    """
    Largest |X acceleration| within each move at the feed F [mm/s^2, X as a radius], not at its ends.

    On a line F^2 d^2 / r^3, largest at the nearest point. On an arc F^2 |r^4 - (R^2 - e^2)^2| / (4 R^2 r^3), whose
    signed value rises with r: largest at the nearest or the farthest point. inf through the center, where X turns back
    at once.
    """
    lines = lines_from_center(start, end)
    bend = lines.offset**2 / lines.near**3
    bend = np.where(lines.offset == 0, np.where(lines.has_foot, np.inf, 0.0), bend)
    arcs = arcs_from_center(start, end, center, kind, rows := rows_of_arcs(kind))
    bend[rows] = _x_bend_of_arcs(arcs)
    return _scaled(bend, (np.asarray(feed) / 60) ** 2)


def _x_bend_of_arcs(arcs: ArcsFromCenter) -> Floats:
    """Largest change of the X rate per way and way [1/mm]."""
    bend = np.maximum(_x_bend_at(arcs, arcs.start), _x_bend_at(arcs, arcs.end))
    share = arcs.away / arcs.radius
    bend = np.maximum(bend, np.where(arcs.passes_near, share / np.abs(arcs.inside), 0.0))
    bend = np.maximum(bend, np.where(arcs.passes_far, share / arcs.around, 0.0))
    # With the center of C on the circle, R^2 - e^2 is 0.
    reach = np.maximum(np.abs(arcs.start), np.abs(arcs.end))
    reach = np.where(arcs.passes_far, arcs.around, reach)
    bend = np.where(arcs.through, np.where(arcs.crosses, np.inf, reach / (2 * arcs.radius) ** 2), bend)
    return np.where((arcs.radius == 0) | (arcs.away == 0), 0.0, bend) + arcs.unknown


def _x_bend_at(arcs: ArcsFromCenter, point: Points) -> Floats:
    """At an end of the arc, from the point itself: (p . s) (p . m) / (R^2 r^3) with s the spoke and m the center."""
    spoke = point - arcs.center
    return np.asarray(np.abs(dot(point, spoke) * dot(point, arcs.center)) / (np.abs(spoke) ** 2 * np.abs(point) ** 3))
