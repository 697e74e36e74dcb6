"""Where the tool center goes on the machine: to the center of C, and along X and Z to the ends of their travel."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.machines.modal import MM_PER_INCH, Side, Units
from polarcheck.table.arcs import Arcs
from polarcheck.table.moves import any_in_row, per_row
from polarcheck.table.tool_center import ToolCenter
from polarcheck.table.trace import Trace


class Reach:
    """Columns of one trace, one value per row."""

    def __init__(self, trace: Trace, tool_center: ToolCenter, arcs: Arcs) -> None:
        self.trace = trace
        self.tool_center = tool_center
        self.arcs = arcs

    # ---- the center of C ----

    @cached_property
    def least_increment(self) -> Floats:
        """The smallest step that the control takes [mm]."""
        control = self.trace.machine.control
        inch = control.least_increment_inch * MM_PER_INCH
        return np.where(self.trace.units == Units.INCH, inch, control.least_increment)

    @cached_property
    def cuts_off_center(self) -> Mask:
        """Cutting moves that stay away from the center of C, be it by little; what is not known counts as away."""
        trace = self.trace
        return np.asarray(trace.cuts & ~(self.tool_center.nearest < self.least_increment) & ~self.arcs.is_no_circle)

    @cached_property
    def stops_at_center(self) -> Mask:
        """Per move of the tool center: it ends at the center of C. Without compensation that is the programmed end."""
        trace, moves = self.trace, self.tool_center.moves
        known = moves.known | (trace.side[moves.row] == Side.OFF)
        return np.asarray((np.abs(moves.end) < self.least_increment[moves.row]) & known)

    @cached_property
    def meets_center(self) -> Mask:
        """
        Cutting moves in which the tool center passes through the center of C or stops there.

        Of a move that only leaves it, the one before says so; except for the first of which anything is known.
        """
        trace, moves, stops = self.trace, self.tool_center.moves, self.stops_at_center
        least = self.least_increment[moves.row]
        leaves = (np.abs(moves.start) < least) & ~stops
        follows = np.zeros(len(moves), bool)
        follows[1:] = (moves.known | stops)[:-1] & (moves.section[1:] == moves.section[:-1])
        hit = stops | ((moves.nearest < least) & ~(leaves & follows))
        return any_in_row(hit, moves, len(trace)) & trace.cuts & ~self.arcs.is_no_circle

    # ---- travel ----

    @cached_property
    def least_x(self) -> Floats:
        """Smallest X of the machine axis on the way [mm, radius]; inf where X does not move, NaN unknown."""
        moves = self.tool_center.moves
        return self._with_x_outside(per_row(moves.nearest, moves, len(self.trace), np.inf, largest=False), np.inf)

    @cached_property
    def most_x(self) -> Floats:
        """Largest X of the machine axis on the way [mm, radius]; -inf where X does not move, NaN unknown."""
        moves = self.tool_center.moves
        return self._with_x_outside(per_row(moves.farthest, moves, len(self.trace), -np.inf), -np.inf)

    def _with_x_outside(self, inside: Floats, none: float) -> Floats:
        """Outside the mode the end of a move is one extreme, the end of the move before the other."""
        trace = self.trace
        outside = np.where(trace.uses_axes & trace.has("X", "U"), trace.x, none)
        return np.where(trace.in_polar, inside, outside)

    @cached_property
    def is_limited_in_x(self) -> Mask:
        """Moves, if the profile limits the travel of X."""
        limits = self.trace.machine.limits
        return np.asarray(self.trace.moves & (not np.isnan(np.fmax(limits.x_minimum, limits.x_maximum))))

    @cached_property
    def leaves_travel(self) -> Mask:
        """X or Z goes beyond its travel; staying outside is not leaving again."""
        trace, limits = self.trace, self.trace.machine.limits
        if np.all(np.isnan((limits.x_minimum, limits.x_maximum, limits.z_minimum, limits.z_maximum))):
            return np.zeros(len(trace), bool)
        x = (self.most_x > limits.x_maximum + ROUNDING) | (self.least_x < limits.x_minimum - ROUNDING)
        z = (trace.z > limits.z_maximum + ROUNDING) | (trace.z < limits.z_minimum - ROUNDING)
        return self._first(x, np.isfinite(self.most_x)) | self._first(z, trace.moves_z)

    def _first(self, beyond: Mask, moving: Mask) -> Mask:
        """Of the moving rows beyond a limit those before which the last moving row was not."""
        rows = np.flatnonzero(moving | self.trace.starts)
        first = beyond & moving
        first[rows[1:]] &= ~(beyond & moving)[rows[:-1]]
        return first
