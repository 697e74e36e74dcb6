"""Passes that begin outside the bar and end inside it, and then leave it another way: metal stays beyond their end."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.metal.air_cuts import AirCuts
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.workpiece import Workpiece
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Points, Rows, cached_property, folded
from polarcheck.geometry.tolerances import ROUNDING

#: A pass that ends no deeper inside the bar is meant for its edge [mm].
_EDGE = 0.5
#: A feed is one to position if it is as many times as large as that of the cut before.
_FASTER = 3.0


class PassEnds(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    bar: Bar
    air_cuts: AirCuts
    workpiece: Workpiece

    @cached_property
    def leaves_metal(self) -> Mask:
        """The last cut of a pass that begins outside the bar and ends inside it; the next move leads out of it."""
        trace = self.trace
        result = np.zeros(len(trace), bool)
        if self.bar.known.source == "none" or not self.air_cuts.walls.any():
            return result
        moving = np.flatnonzero(trace.mode.in_polar & trace.path.travels)
        cuts = self._cuts[moving]
        begins = cuts & ~np.append(False, cuts[:-1] & (np.diff(trace.mode.section[moving]) == 0))
        ends = cuts & ~np.append(cuts[1:] & (np.diff(trace.mode.section[moving]) == 0), False)
        first, last = np.flatnonzero(begins), np.flatnonzero(ends)
        has_next = last + 1 < len(moving)
        first, last = first[has_next], last[has_next]
        start, end = trace.path.start[moving[first]], trace.path.end[moving[last]]
        half = self.bar.inner(moving[last], trace.path.z[moving[last]])
        out = moving[last + 1]
        leads_out = np.abs(trace.path.end[out]) > half + ROUNDING
        leads_out &= (trace.mode.section[out] == trace.mode.section[moving[last]]) & ~trace.path.moves_z[out]
        # An arc at the end leads away from a contour.
        leads_out &= ~trace.path.is_arc[moving[last]]
        # A slot without compensation ends where it is to end: the tool is lifted out of it.
        is_lifted = trace.path.z_before[out] > trace.path.z[moving[last]] + ROUNDING
        leads_out &= trace.compensation.compensates[moving[last]] | ~is_lifted
        below = trace.path.z[moving[last]] < self.workpiece.top - ROUNDING
        leaves = (np.abs(start) > half - ROUNDING) & (np.abs(end) < half - _EDGE) & leads_out & below
        leaves &= ~self._goes_back(out, start) & ~self._comes_round(moving[first], moving[last])
        result[moving[last[leaves]]] = True
        return result

    @property
    def _cuts(self) -> Mask:
        """Cuts of passes: in offset mode, or without compensation at no more than the feed of a cut."""
        trace = self.trace
        compensated = trace.compensation.compensates
        rows = np.flatnonzero(self.air_cuts.walls & ~np.isnan(trace.feedrate.feed))
        section, feed = trace.mode.section, trace.feedrate.feed
        slowest = folded(np.minimum, section[rows], feed[rows], len(trace.mode.sections) + 1, np.inf)
        slow = feed < _FASTER * slowest[section]
        return np.asarray(self.air_cuts.walls & (compensated | slow))

    def _goes_back(self, out: Rows, start: Points) -> Mask:
        """The way out comes back to where the pass began: it runs in what the pass has cut."""
        path = self.trace.path
        chord = path.end[out] - path.start[out]
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.clip(((start - path.start[out]) * chord.conj()).real / np.abs(chord) ** 2, 0, 1)
        apart = np.abs(start - path.start[out] - share * chord)
        return np.asarray(apart <= np.nan_to_num(self.workpiece.radius[out]) / 2)

    def _comes_round(self, first: Rows, last: Rows) -> Mask:
        """The last cut crosses the first one: what lies beyond its end has been cut there."""
        path = self.trace.path

        def parted(wall: Rows, of: Rows) -> Mask:
            """The ends of a cut lie on two sides of another, or on it."""
            along = path.end[wall] - path.start[wall]
            sides = [
                (along.conj() * (point - path.start[wall])).imag / np.abs(along)
                for point in (path.start[of], path.end[of])
            ]
            return np.asarray((np.minimum(*sides) <= ROUNDING) & (np.maximum(*sides) >= -ROUNDING))

        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray((first != last) & parted(first, last) & parted(last, first))
