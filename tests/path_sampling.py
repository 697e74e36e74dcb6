"""
What the axes do on a path, from positions alone: a second way to rates, accelerations and times.

The path is walked in small steps of time; X is the distance from the center and C the angle, and their rates are
differences. Nothing of the formulas of the package is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from polarcheck.foundation.arrays import Floats, Points
from polarcheck.foundation.states import Motion


def point_at(start: complex, end: complex, center: complex, kind: int) -> tuple[float, Callable[[Floats], Points]]:
    """The length of a move [mm], and its points by their share of it; they are walked on beyond its ends, too."""
    if kind not in (Motion.CW, Motion.CCW):
        return abs(end - start), lambda share: start + (end - start) * share
    first, last = start - center, end - center
    turn = math.atan2((last / first).imag, (last / first).real) % (2 * math.pi)
    if kind == Motion.CW:
        turn -= 2 * math.pi
    if abs(end - start) < 1e-9:
        turn = 2 * math.pi if kind == Motion.CCW else -2 * math.pi
    return abs(first * turn), lambda share: center + first * np.exp(1j * turn * share)


def sampled(
    move: tuple[complex, complex, complex, int], feed: float, c_allowed: float = math.inf, count: int = 20_001
) -> dict[str, float]:
    """
    time [s], and the largest c_feed [deg/min], x_feed [mm/min], c_acceleration [deg/s2] and x_acceleration [mm/s2].

    feed [mm/min]; c_allowed: the rate at which override holds C [deg/min].
    """
    length, at = point_at(*move)
    share = np.linspace(0, 1, count)
    near, far = 1e-4 / length, 1e-3 / length

    def rates(share: Floats) -> tuple[Floats, Floats, Floats]:
        """F, and the rates of C [rad/min] and X [mm/min]."""
        ahead, behind = at(share + near), at(share - near)
        c_way, x_way = np.angle(ahead / behind) / 2e-4, (np.abs(ahead) - np.abs(behind)) / 2e-4
        allowed = math.radians(c_allowed) / np.maximum(np.abs(c_way), 1e-12)
        f = np.minimum(feed, allowed)
        return f, c_way * f, x_way * f

    before, here, after = rates(share - far), rates(share), rates(share + far)
    # Where override begins and ends the rates have a bend, and a change across it is neither side's.
    one_side = (before[0] < feed) == (after[0] < feed)
    c_change, x_change = (np.abs(after[axis] - before[axis])[one_side] / 2e-3 for axis in (1, 2))
    f = here[0]
    each = length / (count - 1) * (1 / f[1:] + 1 / f[:-1]) / 2
    return {
        "time": 60 * float(each.sum()),
        "c_feed": math.degrees(float(np.abs(here[1]).max())),
        "x_feed": float(np.abs(here[2]).max()),
        "c_acceleration": math.degrees(float((c_change * f[one_side]).max())) / 3600,
        "x_acceleration": float((x_change * f[one_side]).max()) / 3600,
    }
