"""The largest R with which the cutter would not cut into a loop, for the message that names it."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.modes.since import Since
from polarcheck.columns.path.tool_center import OtherRadius
from polarcheck.columns.path.trial import Trial
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, cached_property, folded
from polarcheck.foundation.time_limit import keep_time

#: A cutter of this share of R counts as fitting everywhere; relative accuracy of the result; most trials.
_SMALL, _NEAR, _TRIALS = 1 / 16, 0.01, 9
#: Beyond this number of rows no trials are run.
_MANY = 20_000


class Fitting(Columns, frozen=True):
    """Columns of one trace, one value per row, for loops that are cut into."""

    trace: Trace
    overcuts: Overcuts
    since: Since

    def _worst(self, values: Floats) -> Floats:
        """The largest of these values in the loop of each row, for each row."""
        loop = self.since.compensation
        worst = folded(np.maximum, loop, values, int(loop.max(initial=0)) + 1, 0.0)
        return worst[loop]

    def _any(self, rows: Mask) -> Mask:
        """True in all rows of a loop that has one of these rows."""
        return self._worst(rows.astype(float)) > 0

    @cached_property
    def _candidates(self) -> Mask:
        """The rows of the loops that are cut into; none if they are too many."""
        cut_into = self._any(self.overcuts.depth > 0)
        return cut_into & (np.count_nonzero(cut_into) <= _MANY)

    def _trial(self, radius: Floats) -> Trial:
        """The tool center path of the candidates with another R, its sign unchanged."""
        signed = radius * np.sign(self.trace.compensation.radius)
        return Trial(self.trace, OtherRadius(self._candidates, self.since.compensation, signed))

    @cached_property
    def never(self) -> Mask:
        """Rows of loops that even a very small cutter cuts into: a point of the contour is wrong."""
        cut = np.zeros(len(self.trace), bool)
        if self._candidates.any():
            cut[self._trial(np.abs(self.trace.compensation.radius) * _SMALL).cuts.row] = True
        return self._candidates & self._any(cut)

    @cached_property
    def radius(self) -> Floats:
        """The largest R that does not cut into the loop of the row [mm]; NaN if there is none, or it is not known."""
        programmed = np.abs(self.trace.compensation.radius)
        searched = self._candidates & ~self.never
        low, high = np.where(searched, 0.0, np.nan), programmed
        if not searched.any():
            return low
        depth = self.overcuts.depth
        tried = programmed - self._worst(depth) / 2  # exact between parallel walls
        for _ in range(_TRIALS):
            keep_time()
            trial = self._trial(tried)
            fails = self._any(trial.fails)
            low, high = np.where(fails, low, tried), np.where(fails, tried, high)
            depth = folded(np.maximum, trial.cuts.row, trial.cuts.depth, len(programmed), 0.0)
            nearer = tried - self._worst(depth) / 2
            half = np.where(low > 0, (low + high) / 2, np.where(nearer < tried, nearer, tried / 2))
            tried = np.where(fails, half, np.minimum(low * (1 + _NEAR), half))
            if not (high - low > _NEAR * high).any():
                break
        return np.where(searched & (low > 0) & (high - low <= 2 * _NEAR * high), low, np.nan)
