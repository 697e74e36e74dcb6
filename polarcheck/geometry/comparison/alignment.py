"""The angle by which a drawing is turned to fit a part; lengths in mm, plane points complex, x + 1j*c."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, folded
from polarcheck.geometry.comparison.measured_path import MeasuredPath

#: Directions from the center in which distances are compared; points sampled along a path.
_DIRECTIONS, _POINTS = 3600, 20_000
#: Candidate angles that are refined, points compared for each, and steps of the refinement.
_TURNS, _FEW, _STEPS = 12, 400, 22
#: Turns whose mean distances differ by less [mm] fit equally well: distances between points rounded to 0.001 mm.
_AS_GOOD = 1e-3
#: Distances are cut off at this multiple of the size of the part, for lines without an end.
_FARTHEST = 1.5
_GOLDEN = (5**0.5 - 1) / 2


def best_turn(path: MeasuredPath, drawn: MeasuredPath, center: complex) -> float:
    """
    The angle [rad] by which the drawing is to be turned about the center to fit the path, from -pi to pi.

    Both are described by their distances from the center in each direction. The correlation of these distances yields a
    few candidate angles; the least mean distance along the path decides between them.
    """
    measured, seen = _distances(path, center, np.inf)
    nominal, _ = _distances(drawn, center, _FARTHEST * float(measured[seen].max(initial=0)))
    cost = _correlated(seen * measured**2, np.ones_like(measured)) - 2 * _correlated(seen * measured, nominal)
    cost += _correlated(seen.astype(float), nominal**2)
    turns = np.flatnonzero((cost <= np.roll(cost, 1)) & (cost <= np.roll(cost, -1)))
    turns = turns[np.argsort(cost[turns], kind="stable")][:_TURNS]
    step = 2 * np.pi / _DIRECTIONS
    angles = np.angle(np.exp(1j * turns * step))
    points, _ = path.at(np.linspace(0, path.length, _FEW))
    means = np.array([_mean(points, drawn, center, angle) for angle in angles.tolist()])
    near = means <= 2 * means.min() + step * float(np.abs(points - center).max())
    least = float(angles[near][np.argmin(np.abs(angles[near]))])
    # If several angles fit, as for a hexagon, the smallest turn is taken.
    refined = [
        _refined(points, drawn, center, turn - 2 * step, turn + 2 * step)
        for turn in (least, float(angles[means.argmin()]))
    ]
    return refined[0][1] if refined[0][0] <= refined[1][0] + _AS_GOOD else refined[1][1]


def _mean(points: Points, drawn: MeasuredPath, center: complex, angle: float) -> float:
    """The mean distance from points to a drawing that is turned by an angle [mm]."""
    turned = center + (points - center) * np.exp(-1j * angle)
    return float(drawn.nearest(turned)[0].mean())


def _distances(path: MeasuredPath, center: complex, farthest: float) -> tuple[Floats, Mask]:
    """The least distance of a path from the center in each direction; a mask of the measured directions."""
    points, _ = path.at(np.linspace(0, path.length, _POINTS))
    if np.isfinite(farthest):
        points = np.concatenate([points, _near(path, center, farthest)])
    spoke = points - center
    direction = np.round(np.angle(spoke) / (2 * np.pi / _DIRECTIONS)).astype(np.int64) % _DIRECTIONS
    nearest = folded(np.minimum, direction, np.abs(spoke), _DIRECTIONS, np.inf)
    seen = np.isfinite(nearest)
    measured = np.flatnonzero(seen)
    nearest = np.interp(np.arange(_DIRECTIONS), measured, nearest[measured], period=_DIRECTIONS)
    return np.minimum(nearest, farthest), seen


def _near(path: MeasuredPath, center: complex, farthest: float) -> Points:
    """Points on the long segments of a path, dense enough near the center for every direction."""
    long = np.abs(path.end - path.start) > farthest / 10
    start, along = path.start[long], (path.end - path.start)[long]
    foot = np.clip(((center - start) * along.conj()).real / np.abs(along) ** 2, 0, 1)
    reach = np.minimum(2 * farthest / np.abs(along), 1)
    share = foot[:, None] + reach[:, None] * np.linspace(-1, 1, _DIRECTIONS)
    return np.asarray((start[:, None] + along[:, None] * np.clip(share, 0, 1)).ravel())


def _correlated(first: Floats, second: Floats) -> Floats:
    """For each turn k the sum of first[i] * second[i - k]."""
    return np.fft.irfft(np.fft.rfft(first) * np.conj(np.fft.rfft(second)), _DIRECTIONS)


def _refined(points: Points, drawn: MeasuredPath, center: complex, low: float, high: float) -> tuple[float, float]:
    """The least mean distance [mm] between two angles, and its angle, by golden section search."""
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
