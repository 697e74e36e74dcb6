"""F in polar sections as the other machine takes it, so that the tool center runs as fast on the plane."""

from __future__ import annotations

import math

import numpy as np

from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import FeedMode
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.writing.pen import Pen


class SectionFeeds:
    """
    The feeds of a program on another machine.

    moves: of the tool center. One machine measures F along the plane, another along the way in space; one at the tool
    center, another at the contour (polar.feed_measures, codes of feed_at_contour).
    """

    def __init__(self, trace: Trace, moves: Moves, target: Machine) -> None:
        self.trace, self.target = trace, target
        self._share = np.ones(len(trace))
        of_contour = ~moves.corner & ~np.isnan(moves.plane_share)
        self._share[moves.row[of_contour]] = moves.plane_share[of_contour]
        self._length = np.zeros(len(trace))
        np.add.at(self._length, moves.row, np.nan_to_num(moves.length))

    def of_row(self, row: int) -> float | None:
        """F of a row [mm/min, or mm per revolution]; None where none is in force."""
        feedrate = self.trace.feedrate
        is_per_minute = int(feedrate.feed_mode[row]) == FeedMode.PER_MINUTE
        feed = float(feedrate.programmed_feed[row] if is_per_minute else feedrate.feed_number[row])
        if math.isnan(feed):
            return None
        ours, theirs = float(self._share[row]), self._target_share(row)
        return feed if math.isclose(ours, theirs, rel_tol=1e-9) else feed * ours / theirs

    def _target_share(self, row: int) -> float:
        """The share of F with which the tool center will run on the plane."""
        path, length = self.trace.path, float(self._length[row])
        if self.target.polar.feed_measures != "space" or not bool(path.moves_z[row]) or not length:
            return 1.0
        rise = abs(float(path.z[row]) - float(path.z_before[row]))
        return length / math.hypot(length, rise) if rise == rise else 1.0

    def word_in_force(self, row: int, pen: Pen) -> str:
        """The F word of what is in force in a row; empty without one."""
        feed = float(self.trace.feedrate.feed_number[row])
        return "" if math.isnan(feed) else "F" + pen.numbers.feed(feed)
