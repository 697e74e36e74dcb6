"""The radius of the bar over Z: what turning has left, between bounds."""

import functools
from typing import NamedTuple

import numpy as np

from polarcheck.columns.metal.turning_tools import Cuts
from polarcheck.foundation.arrays import Floats, Rows, different, side_by_side
from polarcheck.geometry.tolerances import ROUNDING

#: A radius that is larger than that of any bar [mm]: it stands for one that is not known between heights.
_FAR = 1e9


class Bounds(NamedTuple):
    """Radii of the bar where nothing is turned [mm]: metal within `inner`, none outside `outer`; NaN unknown."""

    inner: float
    outer: float


class Profile:
    """
    The radius of the bar over Z.

    z: float64[n], rising [mm]. inner: float64[n], within it there is metal for certain. outer: float64[n], outside of
    it there is none for certain; inf where that is not known. row: int[n], the cut that leaves it; -1 for the bar.
    Between two heights the radius is on the line between theirs.
    """

    def __init__(self, cuts: Cuts, bar: Bounds, top: float) -> None:
        """cuts: of the outside and of faces. top: Z of the face [mm]; above there is no metal."""
        finite = np.concatenate([cuts.low, cuts.high[np.isfinite(cuts.high)], [top]])
        around = np.array([-3, -1, 1, 3])[:, None] * ROUNDING
        self.z = different((finite + around).ravel())
        self.row: Rows = np.full(len(self.z), -1)
        self.inner: Floats = np.full(len(self.z), np.inf)
        self.outer: Floats = np.full(len(self.z), np.inf if np.isnan(bar.outer) else bar.outer)
        self._cut(cuts)
        below = self.z <= top + ROUNDING / 2
        rest = bar.inner
        if np.isnan(rest):
            # What was turned was no larger before.
            rest = float(np.max(self.inner[below & np.isfinite(self.inner)], initial=0.0))
        self.row[self.inner > rest + ROUNDING] = -1
        self.inner = np.maximum(np.minimum(self.inner, rest), 0.0)
        self.inner[~below] = self.outer[~below] = 0.0
        self._rest = Bounds(rest, float(np.inf if np.isnan(bar.outer) else bar.outer))

    def _cut(self, cuts: Cuts) -> None:
        # A cut of a face leaves what is below it.
        margin = np.where(np.isinf(cuts.high), -0.5, 1.5) * ROUNDING
        first = np.searchsorted(self.z, cuts.low - margin)
        until = np.searchsorted(self.z, cuts.high + ROUNDING * 1.5)
        for number, (i, j) in enumerate(side_by_side(first, until)):
            low, high, bulge = cuts.low[number], cuts.high[number], cuts.bulge[number]
            length = high - low if np.isfinite(high) and high > low else 1.0
            share = np.clip((self.z[i:j] - low) / length, 0, 1)
            x = cuts.x_low[number] + (cuts.x_high[number] - cuts.x_low[number]) * share
            self.row[i:j] = np.where(x - bulge < self.inner[i:j], cuts.row[number], self.row[i:j])
            self.inner[i:j] = np.minimum(self.inner[i:j], x - bulge)
            if cuts.is_surface[number]:
                self.outer[i:j] = np.minimum(self.outer[i:j], x + bulge)

    @functools.cached_property
    def _largest_above(self) -> tuple[Floats, Floats]:
        """The largest inner and outer radius from each height up [mm]; 0 behind the last."""
        inner, outer = (np.maximum.accumulate(column[::-1])[::-1] for column in (self.inner, self.outer))
        return np.append(inner, 0.0), np.append(outer, 0.0)

    def reach(self, z: Floats) -> tuple[Floats, Floats]:
        """
        The largest inner and outer radius between heights and the face [mm], float64[n] each.

        NaN where z is NaN.
        """
        index = np.searchsorted(self.z, z)
        result = []
        for column, above, rest in zip((self.inner, self.outer), self._largest_above, self._rest, strict=True):
            local = np.interp(z, self.z, np.minimum(column, _FAR), left=min(rest, _FAR))
            local = np.where(local > _FAR / 2, np.inf, local)
            result.append(np.where(np.isnan(z), np.nan, np.maximum(local, above[index])))
        return result[0], result[1]

    def steps(self, z: float) -> list[tuple[float, float, int]]:
        """
        What stands for certain between a height and the face: radius [mm], the lowest height at which it stands [mm],
        and the cut that leaves it, -1 for the bar.

        First at the height itself, then where the bar is largest above, if it is larger there.
        """
        index = int(np.searchsorted(self.z, z))
        if index == len(self.z):
            return []
        local = float(np.interp(z, self.z, self.inner, left=self._rest.inner))
        steps = [(local, z, int(self.row[index - 1]) if index and self.z[index] > z else int(self.row[index]))]
        best = index + int(np.argmax(self.inner[index:]))
        if self.inner[best] > local + ROUNDING:
            steps.append((float(self.inner[best]), max(float(self.z[best]), z), int(self.row[best])))
        return steps

    def between(self, low: float, high: float) -> tuple[float, float, Rows]:
        """The least inner and the largest outer radius between two heights [mm], and the cuts that leave them."""
        within = np.flatnonzero((self.z >= low - ROUNDING) & (self.z <= high))
        inner, outer, rows = self.inner[within], self.outer[within], self.row[within]
        rest = self._rest if low < self.z[0] else Bounds(np.inf, 0.0)
        return (
            float(np.min(inner, initial=rest.inner)),
            float(np.max(outer, initial=rest.outer)),
            rows[rows >= 0],
        )
