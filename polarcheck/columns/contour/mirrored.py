"""Loops with the cutter on the wrong side: both ramps run through the part, and on the other side all is well."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.contour.skipped_loops import SkipReason
from polarcheck.columns.modes.since import Since
from polarcheck.columns.path.ramps import Ramps
from polarcheck.columns.path.tool_center import OtherRadius, ToolCenter
from polarcheck.columns.path.trial import Trial
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, mask_at
from polarcheck.foundation.time_limit import keep_time

#: Share of R that is taken for a cutter that goes in everywhere.
_SMALL = 1 / 16


class Mirrored(Columns, frozen=True):
    """
    Columns of one trace, one value per row.

    A cutter that is too large for its contour comes from the right side, and one wrong point or ramp leaves the rest of
    the contour as it is: only a loop that is wholly legal on the other side, and of which both ramps come out of the
    part that it leaves as it is written, is taken for the reverse of what is meant. And a smaller cutter is no help.
    """

    trace: Trace
    tool_center: ToolCenter
    ramps: Ramps
    overcuts: Overcuts
    since: Since

    @cached_property
    def _loop(self) -> Rows:
        """From one G41 or G42 to the next, which is one loop where compensation begins but once."""
        return self.since.compensation

    def _any(self, rows: Mask) -> Mask:
        """All rows of the loops with any of these rows."""
        has_row = mask_at(int(self._loop[-1]) + 1, self._loop[rows])
        return has_row[self._loop]

    @cached_property
    def _fails(self) -> Mask:
        """Rows that the control objects to, or that cut into the contour."""
        tool, overcuts = self.tool_center, self.overcuts
        fails = tool.inside_arc_too_small | tool.interferes | tool.no_intersection
        fails[overcuts.cuts.row] = True
        fails[overcuts.sweeps.row] = True
        return fails | self._fails_beyond_bar

    @property
    def _fails_beyond_bar(self) -> Mask:
        """
        Rows that would cut into the contour where the bar were larger, of sections with one G41 or G42.

        A ramp that comes to the far side of the only wall comes through the part, though the bar ends before it.
        """
        trace = self.trace
        alone = np.zeros(len(trace), bool)
        if np.isnan(self.overcuts.bar):
            return alone
        count = trace.mode.count_in_section(trace.compensation.writes_side)
        alone = np.append(count == 1, False)[trace.mode.section]
        return self._trial(alone, 1).faulty if alone.any() else alone

    @cached_property
    def is_mirrored(self) -> Mask:
        """Rows with the G41 or G42 of a loop that is meant for the other one."""
        trace, candidates = self.trace, self._fails
        if not candidates.any():
            return candidates
        candidates = self._any(candidates) & ~self._any(self.ramps.writes_side_again)
        # A contour that crosses itself too often does so on either side.
        overcuts = self.overcuts
        candidates &= ~self._any(overcuts.skipped.rows(overcuts.loop, SkipReason.CROSSES))
        # The cheap tests come first; the search ends when no candidate is left.
        for test in (
            self._comes_out_at_both_ends,
            lambda rows: ~self._any(self._trial(rows, -1).objects),
            lambda rows: ~self._any(self._trial(rows, -1).faulty),
            lambda rows: self._any(self._trial(rows, _SMALL).faulty),
        ):
            if not candidates.any():
                break
            candidates &= test(candidates)
        written = candidates & trace.compensation.writes_side
        # Blocks that run again, as of a subprogram, are right or wrong each time: a way to them is wrong here.
        blocks = trace.run.block
        right = mask_at(int(blocks.max()) + 1, blocks[trace.compensation.writes_side & ~candidates])
        return np.asarray(written & ~right[blocks])

    def _comes_out_at_both_ends(self, rows: Mask) -> Mask:
        """All rows of the loops whose start-up and offset cancel run through the part."""
        ramp = self.overcuts.comes_out_of_part(rows)
        return self._any(ramp & self.trace.compensation.starts_up) & self._any(ramp & self.trace.compensation.cancels)

    def _trial(self, rows: Mask, share: float) -> Trial:
        """These rows with a share of their R; below 0 it is the other side."""
        keep_time()
        return Trial(self.trace, OtherRadius(rows.copy(), self._loop, share * self.trace.compensation.radius))
