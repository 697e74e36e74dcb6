"""What cycles of turning tools cut: turning, facing, threads, grooves."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.metal.turning_tools import ABOVE_ALL, CENTER, INSERT, Cuts, TurningTools
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property
from polarcheck.program.machines.axis_table import INCREMENTS


class TurnedCycles(Columns, frozen=True):
    """Columns of one trace, one value per row, and the cuts of its cycles."""

    trace: Trace
    tools: TurningTools

    @cached_property
    def _cycle_x(self) -> Floats:
        """X to which the turning or facing cycle in force goes [mm], as a radius."""
        return self._cycle_end("X", self.tools.x_and_z[0], self.trace.lengths.x_factor)

    @cached_property
    def _cycle_z(self) -> Floats:
        return self._cycle_end("Z", self.tools.x_and_z[2], 1.0)

    def _cycle_end(self, axis: str, start: Floats, factor: Floats | float) -> Floats:
        """Where the cycle in force ends along an axis [mm]; increments count from where the tool stands."""
        trace = self.trace
        increment = INCREMENTS[axis]
        absolute, steps = (trace.lengths.length_of(word) * factor for word in (axis, increment))
        stays = fill_down(start, self._begins_cycle | trace.blocks.starts, np.nan)
        end = np.where(trace.blocks.has(increment), stays + steps, absolute)
        return fill_down(end, trace.blocks.has(axis, increment) | self._begins_cycle, np.nan)

    @cached_property
    def _begins_cycle(self) -> Mask:
        return self.trace.blocks.listed("turning_cycle", "facing_cycle", "threading_cycle")

    @property
    def is_lost(self) -> Mask:
        """Rows whose cycle ends where nobody knows."""
        if not self._begins_cycle.any():
            return self.trace.blocks.nowhere
        return np.asarray(self._is_of_cycle & np.isnan(self._cycle_x + self._cycle_z))

    @cached_property
    def _kind_of_cycle(self) -> Rows:
        """1 in blocks of a turning cycle, 2 of a facing cycle, 3 of a threading cycle, else 0."""
        trace, begins = self.trace, self._begins_cycle
        kind = np.zeros(len(trace), np.int64)
        for number, name in enumerate(("turning_cycle", "facing_cycle", "threading_cycle"), start=1):
            kind[trace.blocks.listed(name)] = number
        ended = (trace.modal.sets("motion") & ~begins) | trace.tools.changes_tool | trace.blocks.starts
        return fill_down(kind, begins | ended, 0)

    @property
    def _is_of_cycle(self) -> Mask:
        """Blocks that make a cycle cut."""
        if not self._begins_cycle.any():
            return self.trace.blocks.nowhere
        return np.asarray((self._kind_of_cycle > 0) & self.trace.blocks.has("X", "Z", *INCREMENTS.values()))

    @cached_property
    def cuts(self) -> Cuts:
        """
        Each block of a turning, facing or threading cycle: G90 X.. Z.., G94 X.. Z.., G92 X.. Z.. in system A.

        They start where the tool stands; R is how much larger X, or Z of a facing cycle, is at the start than at the
        end of the cut (B-63944EN, canned cycles).
        """
        trace, begins = self.trace, self._begins_cycle
        if not (begins & self.tools.turns).any():
            return Cuts.none()
        x_start, z_start = (
            fill_down(self.tools.x_and_z[index], begins | trace.blocks.starts, np.nan) for index in (0, 2)
        )
        x, z = self._cycle_x, self._cycle_z
        rows = np.flatnonzero(self._is_of_cycle & self.tools.turns & ~np.isnan(x + z + x_start + z_start))
        taper = fill_down(trace.lengths.length_of("R"), trace.blocks.has("R") | begins, np.nan)
        kind = self._kind_of_cycle[rows]
        x, z, x_start, z_start = (column[rows] for column in (x, z, x_start, z_start))
        slope = np.nan_to_num(taper[rows])
        faces = kind == 2
        whole = faces & (np.abs(x) <= CENTER)
        falls = z <= z_start
        at_start = np.where(faces, x, x + slope)
        return Cuts(
            row=rows,
            low=np.minimum(z, z_start) - np.where(faces, np.abs(slope), 0.0),
            high=np.where(faces, ABOVE_ALL, np.maximum(z, z_start)),
            x_low=np.where(whole, 0.0, np.where(falls, x, at_start)),
            x_high=np.where(whole, 0.0, np.where(falls, at_start, x)),
            bulge=np.zeros(len(rows)),
            is_surface=(kind != 3) & ~(faces & (slope != 0)),
            is_bore=(x > x_start) & ~faces,
            is_face=whole & (slope == 0),
        )

    @property
    def repetitive_cuts(self) -> Cuts:
        """Grooves, threads and drilling by a cycle that names its end: between there and where the tool stands."""
        trace = self.trace
        x_before, _, z_before, _ = self.tools.x_and_z
        cycle = trace.blocks.listed("repetitive_cycle") & self.tools.turns & ~self._names_contour
        # The first block of G71 has a U, and no end.
        by_steps = trace.blocks.has(INCREMENTS["X"], INCREMENTS["Z"]) & trace.blocks.has("P", "Q")
        cycle &= trace.blocks.has("X", "Z") | by_steps
        rows = np.flatnonzero(cycle & ~np.isnan(x_before + z_before))
        if not len(rows):
            return Cuts.none()
        x, z = x_before[rows], z_before[rows]
        ends = []
        for axis, start, factor in (("X", x, trace.lengths.x_factor), ("Z", z, np.ones(len(trace)))):
            absolute, steps = (trace.lengths.length_of(word)[rows] * factor[rows] for word in (axis, INCREMENTS[axis]))
            end = np.where(trace.blocks.has(INCREMENTS[axis])[rows], start + steps, absolute)
            ends.append(np.where(trace.blocks.has(axis, INCREMENTS[axis])[rows], end, start))
        x_to, z_to = ends
        return Cuts(
            row=rows,
            low=np.minimum(z, z_to) - INSERT,
            high=np.maximum(z, z_to) + INSERT,
            x_low=x_to,
            x_high=x_to,
            bulge=np.zeros(len(rows)),
            is_surface=np.zeros(len(rows), bool),
            is_bore=x_to > x,
            is_face=np.zeros(len(rows), bool),
        )[~np.isnan(x_to + z_to)]

    @property
    def _names_contour(self) -> Mask:
        """Rows of a cycle whose P and Q are the first and the last block of a contour, which stands in the program."""
        trace = self.trace
        both = trace.blocks.has("P") & trace.blocks.has("Q")
        if not both.any():
            return both
        numbers = trace.blocks.word("N")
        return np.asarray(both & np.isin(trace.blocks.word("P"), numbers[~np.isnan(numbers)]))
