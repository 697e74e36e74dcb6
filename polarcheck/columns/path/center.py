"""Where the tool center meets the center of C, and where it cuts away from it."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.path.moves import any_in_row
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, cached_property
from polarcheck.foundation.states import Side


class Center(Columns, frozen=True):
    """Columns of one trace, one value per row where nothing else is said."""

    trace: Trace
    tool_center: ToolCenter
    arcs: Arcs

    @cached_property
    def cuts_off_center(self) -> Mask:
        """Cutting moves that stay away from the center of C, be it by little; what is not known counts as away."""
        trace = self.trace
        return np.asarray(
            trace.path.cuts & ~(self.tool_center.nearest < self.trace.lengths.least_step) & ~self.arcs.is_no_circle
        )

    @cached_property
    def stops_at_center(self) -> Mask:
        """Per move of the tool center: it ends at the center of C. Without compensation that is the programmed end."""
        trace, moves = self.trace, self.tool_center.moves
        is_known = moves.known | (trace.compensation.side[moves.row] == Side.OFF)
        return np.asarray((np.abs(moves.end) < self.trace.lengths.least_step[moves.row]) & is_known)

    @cached_property
    def meets_center(self) -> Mask:
        """
        Rows in which the tool center passes through the center of C or stops there.

        Of a move that only leaves it, the one before says so; except for the first of which anything is known.
        """
        moves, stops = self.tool_center.moves, self.stops_at_center
        least = self.trace.lengths.least_step[moves.row]
        leaves = np.abs(moves.start) < least
        follows = np.append(False, (moves.known | stops)[:-1] & (moves.section[1:] == moves.section[:-1]))[: len(moves)]
        return any_in_row(stops | ((moves.nearest < least) & ~(leaves & follows)), moves, len(self.trace))
