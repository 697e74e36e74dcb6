"""How far a section reaches on the face, and the bar around it."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Points, side_by_side
from polarcheck.view.drawn_moves import LENGTH
from polarcheck.view.part_rings import Ring

#: The room around all that is drawn, as a share of its size.
_AROUND = 0.04
#: Corners of a drawn circle.
_CORNERS = 180


def frame(point: Points, radius: float | None, bar: float) -> tuple[float, float, float, float]:
    """
    Return [x0, c0, x1, c1] of paths, the cutter that runs on them, the center and the bar [mm].

    point: the points of the paths; NaN is left out [mm].
    radius: of the cutter; None if unknown [mm].
    bar: the diameter of the bar; NaN if unknown [mm].
    """
    finite = np.append(point[np.isfinite(point)], 0)
    reach = abs(radius) if radius is not None else 0.0
    outside = bar / 2 if bar > 0 else 0.0
    low = [min(float(column.min()) - reach, -outside) for column in (finite.real, finite.imag)]
    high = [max(float(column.max()) + reach, outside) for column in (finite.real, finite.imag)]
    room = _AROUND * max(high[0] - low[0], high[1] - low[1], 1.0)
    x0, c0, x1, c1 = (round(value, LENGTH) for value in (*(end - room for end in low), *(end + room for end in high)))
    return x0, c0, x1, c1


def bar_rings(outside: float, bore: float) -> list[Ring]:
    """Return the outline of a bar and of its bore, diameters in mm; NaN is unknown, and a bore of 0 is none."""
    turn = np.exp(2j * np.pi * np.arange(_CORNERS) / _CORNERS)
    rings = [diameter / 2 * turn for diameter in (outside, bore) if diameter > 0] if outside > 0 else []
    return [list(side_by_side(np.round(ring.real, LENGTH), np.round(ring.imag, LENGTH))) for ring in rings]
