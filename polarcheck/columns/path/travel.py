"""How far X and Z of the machine go in each row, as far as the profile limits them, and where a way out begins."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.cycle_ends import or_of_cycle
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, cached_property, repeated


class Travel(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    tool_center: ToolCenter

    # Most profiles have no limits: what nothing is compared with is not simulated.

    @cached_property
    def _limits_x(self) -> bool:
        limits = self.trace.machine.limits
        return not np.isnan(np.fmax(limits.x_minimum, limits.x_maximum))

    @cached_property
    def _limits_z(self) -> bool:
        limits = self.trace.machine.limits
        return not np.isnan(np.fmax(limits.z_minimum, limits.z_maximum))

    @cached_property
    def least_x(self) -> Floats:
        """Smallest X of the machine axis on the way [mm, radius]; inf where it does not move or has no limits."""
        return (
            self._x(self.tool_center.nearest, np.inf)
            if self._limits_x
            else repeated(np.float64(np.inf), len(self.trace))
        )

    @cached_property
    def most_x(self) -> Floats:
        """Largest X of the machine axis on the way [mm, radius]; -inf where it does not move or has no limits."""
        return (
            self._x(self.tool_center.farthest, -np.inf)
            if self._limits_x
            else repeated(np.float64(-np.inf), len(self.trace))
        )

    def _x(self, inside: Floats, none: float) -> Floats:
        """Outside the mode the end of a move is one extreme, the end of the move before the other."""
        trace = self.trace
        end = or_of_cycle(trace.path.x, trace.path.x_of_cycles)
        outside = np.where(trace.modal.uses_axes & trace.blocks.has("X", "U"), end, none)
        return np.where(trace.mode.in_polar, inside, outside)

    @cached_property
    def z(self) -> Floats:
        """Z of the machine axis after the row, in a cycle at its end [mm]; NaN while unknown, or without limits."""
        if not self._limits_z:
            return repeated(np.float64(np.nan), len(self.trace))
        return or_of_cycle(self.trace.path.z, self.trace.path.z_of_cycles)

    @cached_property
    def moves_x(self) -> Mask:
        """X of the machine axis moves, has limits, and it is known how far it goes."""
        return np.isfinite(self.most_x)

    @cached_property
    def is_limited_in_x(self) -> Mask:
        """Moves, if the profile limits the travel of X."""
        return np.asarray(self.trace.axes.moves & self._limits_x)

    def first_beyond(self, beyond: Mask, moving: Mask) -> Mask:
        """
        Moving rows beyond a limit whose previous moving row in the program was within it: each excursion once.
        """
        rows = np.flatnonzero(moving | self.trace.blocks.starts)
        first = beyond & moving
        first[rows[1:]] &= ~(beyond & moving)[rows[:-1]] | self.trace.blocks.starts[rows[1:]]
        return first
