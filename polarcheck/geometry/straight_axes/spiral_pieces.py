"""The true way of a block in which X and C move evenly: a piece of a spiral of Archimedes."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Points
from polarcheck.geometry.plane import cross, dot, quiet

#: Places on a piece, between its ends, at which it is measured, as shares of its time.
SHARES = np.arange(1, 8)[None, :] / 8

#: Turn by which a place may lie before an arc by rounding [rad].
_BEFORE = 0.05


def along(x_start: Floats, x_end: Floats, c_start: Floats, c_end: Floats, shares: Floats = SHARES) -> Points:
    """
    Plane points of pieces, complex128[pieces, shares].

    x: [mm, radius]. c: angles on the plane [rad]. shares: of the time, float64[1, n].
    """
    x = x_start[:, None] + (x_end - x_start)[:, None] * shares
    c = c_start[:, None] + (c_end - c_start)[:, None] * shares
    return np.asarray(x * np.exp(1j * c))


@quiet
def distances(points: Points, start: Points, end: Points, center: Points, sweep: Floats) -> Floats:
    """
    Distances [mm] of points from lines, or along the radius from arcs.

    points: complex128[moves, n]. start, end, center: complex128[moves]; center NaN for lines. sweep: of arcs about
    their centers [rad]. The radius of an arc goes evenly from that of its start to that of its end.
    """
    vector = (end - start)[:, None]
    offset = points - start[:, None]
    unit = vector / np.abs(vector)
    beyond = np.maximum(np.maximum(-dot(offset, unit), dot(offset, unit) - np.abs(vector)), 0)
    from_line = np.hypot(cross(offset, unit), beyond)
    spoke, first, last = points - center[:, None], (start - center)[:, None], (end - center)[:, None]
    sign = np.sign(sweep)[:, None]
    turned = sign * np.arctan2(cross(first, spoke), dot(first, spoke))
    # A place just before the start is not a turn behind it.
    share = np.where(turned < -_BEFORE, turned + 2 * np.pi, turned) / np.abs(sweep)[:, None]
    radius = np.abs(first) + (np.abs(last) - np.abs(first)) * np.clip(share, 0, 1)
    return np.where(np.isnan(center)[:, None], from_line, np.abs(np.abs(spoke) - radius))
