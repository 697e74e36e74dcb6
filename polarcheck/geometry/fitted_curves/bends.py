"""
Lines and arcs between two places of a way that pass all places between them within a tolerance.

In coordinates with the first place at 0 and the last at d on the first axis, the circles through both are
y = u w with w = x (x - d) + y^2 and u = 1 / 2h, h being the height of the center; u = 0 is the line. To first order a
place is (u w - y) / sqrt(1 + d^2 u^2) away from the circle, so that each place allows an interval of u. u d is the
tangent of half of the angle of the arc.
"""

from __future__ import annotations

import math

import numpy as np

from polarcheck.foundation.arrays import Floats
from polarcheck.geometry.fitted_curves.spirals import Samples
from polarcheck.geometry.plane import quiet

#: Tangent of half of the widest angle of an arc between two places: 150 deg; wider ones are put together of those.
_WIDEST = math.tan(math.radians(75))
#: Below this u d is a line: an arc that leaves its chord by a 1e-9th of it.
STRAIGHT = 1e-8
_NEAR = 1e-12


def bend(samples: Samples, first: int, last: int, tolerance: float, *, straight: bool = False) -> float | None:
    """
    Return u [1/mm] of the arc from one place to a later one, 0 for a line; None if no line or arc is near enough.

    straight: only a line counts.
    """
    fit = _fit(samples, first, last, tolerance, straight)
    return None if fit is None else fit[0]


def error(samples: Samples, first: int, last: int, tolerance: float, *, straight: bool = False) -> float:
    """Return the sum of the squared distances of the places [mm2], weighted; inf if no line or arc is near enough."""
    fit = _fit(samples, first, last, tolerance, straight)
    if fit is None:
        return math.inf
    return float(np.sum(samples.weight[first + 1 : last] * fit[1] ** 2))


@quiet
def _fit(samples: Samples, first: int, last: int, tolerance: float, straight: bool) -> tuple[float, Floats] | None:
    """Return u and the distances of the samples between."""
    start = samples.point[first]
    chord = samples.point[last] - start
    long = abs(chord)
    if long <= _NEAR:
        return None
    local = (samples.point[first + 1 : last] - start) * (chord.conjugate() / long)
    x, y = local.real, local.imag
    if not len(x):
        return 0.0, x
    reach = tolerance + samples.slack[first + 1 : last]
    u = 0.0
    if not straight:
        fitted = _circle(x, y, samples.weight[first + 1 : last], reach, long)
        if fitted is None:
            return None
        u = fitted
    if abs(u) * long < STRAIGHT:
        u, away, along, width = 0.0, y, x, long
    else:
        center = complex(long / 2, 0.5 / u)
        radius = abs(center)
        spoke = local - center
        away = np.abs(spoke) - radius
        turn = spoke * -center.conjugate()
        along = radius * np.copysign(1.0, u) * np.arctan2(turn.imag, turn.real)
        width = 2 * radius * math.atan(abs(u) * long)
    if (np.abs(away) > reach).any() or not _in_order(along, width, tolerance):
        return None
    z = samples.z[first : last + 1]
    if z[0] != z[-1] or (z != z[0]).any():
        even = z[0] + (z[-1] - z[0]) / width * along
        if (np.abs(z[1:-1] - even) > reach).any():
            return None
    return u, away


def _circle(x: Floats, y: Floats, weight: Floats, reach: Floats, long: float) -> float | None:
    """Return u of the arc by least squares, or the nearest to it that all places allow; None if there is none."""
    w = x * (x - long) + y * y
    if not weight.any():
        weight = np.ones_like(weight)
    scale = float(np.dot(weight * w, w))
    best = float(np.dot(weight * w, y)) / scale if scale > 0 else 0.0
    best = min(max(best, -_WIDEST / long), _WIDEST / long)
    height = math.sqrt(1 + (long * best) ** 2) * reach
    w = np.where(np.abs(w) < _NEAR, -_NEAR, w)
    first, second = (y - height) / w, (y + height) / w
    low, high = float(np.minimum(first, second).max()), float(np.maximum(first, second).min())
    if low > high:
        return None
    chosen = min(max(best, low), high)
    return chosen if abs(chosen) * long <= _WIDEST else None


def _in_order(along: Floats, width: float, tolerance: float) -> bool:
    """Return True if the places follow each other along the element and none lies beyond its ends, but for rounding."""
    inside = along[0] >= -tolerance and along[-1] <= width + tolerance
    return bool(inside and (np.diff(along) >= -tolerance / 2).all())
