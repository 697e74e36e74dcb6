"""By which angle a part would fit what is drawn; lengths in mm, plane points complex, x + 1j*c."""

from __future__ import annotations

import numpy as np

from polarcheck.arrays import Floats, Mask, Points
from polarcheck.geometry.comparison.measured_path import Way

#: In how many directions a way is looked at, and at how many points of it.
_DIRECTIONS, _POINTS = 3600, 20_000
#: Turns that are looked at more closely, at how many points, and how often.
_TURNS, _FEW, _STEPS = 12, 400, 22
#: Turns whose mean distances differ by less [mm] fit equally well: distances between points rounded to 0.001 mm.
_AS_GOOD = 1e-3
#: What is farther out than this many times the part, such as a line without end, is as good as there.
_FARTHEST = 1.5
_GOLDEN = (5**0.5 - 1) / 2


def best_turn(way: Way, drawn: Way, center: complex) -> float:
    """
    The angle [rad] by which the drawing is to be turned about the center to fit the way, from -pi to pi.

    Seen from the center both are distances by direction: their correlation names a few angles, the least mean distance
    along the way decides.
    """
    own, seen = _distances(way, center, np.inf)
    other, _ = _distances(drawn, center, _FARTHEST * float(own[seen].max(initial=0)))
    cost = _correlated(seen * own**2, np.ones_like(own)) - 2 * _correlated(seen * own, other)
    cost += _correlated(seen.astype(float), other**2)
    turns = np.flatnonzero((cost <= np.roll(cost, 1)) & (cost <= np.roll(cost, -1)))
    turns = turns[np.argsort(cost[turns], kind="stable")][:_TURNS]
    step = 2 * np.pi / _DIRECTIONS
    angles = np.angle(np.exp(1j * turns * step))
    points, _ = way.at(np.linspace(0, way.length, _FEW))
    means = np.array([_mean(points, drawn, center, angle) for angle in angles.tolist()])
    near = means <= 2 * means.min() + step * float(np.abs(points - center).max())
    least = float(angles[near][np.argmin(np.abs(angles[near]))])
    # What fits at several angles, as a hexagon does, is turned as little as it can.
    found = [
        _refined(points, drawn, center, at - 2 * step, at + 2 * step) for at in (least, float(angles[means.argmin()]))
    ]
    return found[0][1] if found[0][0] <= found[1][0] + _AS_GOOD else found[1][1]


def _mean(points: Points, drawn: Way, center: complex, angle: float) -> float:
    """The mean distance from points to a drawing that is turned by an angle [mm]."""
    turned = center + (points - center) * np.exp(-1j * angle)
    return float(drawn.nearest(turned)[0].mean())


def _distances(way: Way, center: complex, farthest: float) -> tuple[Floats, Mask]:
    """By direction from the center the distance of the nearest point of a way, and which directions have one."""
    points, _ = way.at(np.linspace(0, way.length, _POINTS))
    if np.isfinite(farthest):
        points = np.concatenate([points, _near(way, center, farthest)])
    spoke = points - center
    direction = np.round(np.angle(spoke) / (2 * np.pi / _DIRECTIONS)).astype(np.int64) % _DIRECTIONS
    nearest = np.full(_DIRECTIONS, np.inf)
    np.minimum.at(nearest, direction, np.abs(spoke))
    seen = np.isfinite(nearest)
    known = np.flatnonzero(seen)
    nearest = np.interp(np.arange(_DIRECTIONS), known, nearest[known], period=_DIRECTIONS)
    return np.minimum(nearest, farthest), seen


def _near(way: Way, center: complex, farthest: float) -> Points:
    """Points of the long segments of a way, as dense as directions ask for where they are near."""
    long = np.abs(way.end - way.start) > farthest / 10
    start, along = way.start[long], (way.end - way.start)[long]
    foot = np.clip(((center - start) * along.conj()).real / np.abs(along) ** 2, 0, 1)
    reach = np.minimum(2 * farthest / np.abs(along), 1)
    share = foot[:, None] + reach[:, None] * np.linspace(-1, 1, _DIRECTIONS)
    return np.asarray((start[:, None] + along[:, None] * np.clip(share, 0, 1)).ravel())


def _correlated(one: Floats, other: Floats) -> Floats:
    """For each turn k the sum of one[i] * other[i - k]."""
    return np.fft.irfft(np.fft.rfft(one) * np.conj(np.fft.rfft(other)), _DIRECTIONS)


def _refined(points: Points, drawn: Way, center: complex, low: float, high: float) -> tuple[float, float]:
    """The least mean distance [mm] between two angles, and where that is: by golden section."""
    inner = [high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)]
    values = [_mean(points, drawn, center, angle) for angle in inner]
    for _ in range(_STEPS):
        if values[0] <= values[1]:
            high, inner[1], values[1] = inner[1], inner[0], values[0]
            inner[0] = high - _GOLDEN * (high - low)
            values[0] = _mean(points, drawn, center, inner[0])
        else:
            low, inner[0], values[0] = inner[0], inner[1], values[1]
            inner[1] = low + _GOLDEN * (high - low)
            values[1] = _mean(points, drawn, center, inner[1])
    return min(zip(values, inner, strict=True))
