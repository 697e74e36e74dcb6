"""Loops as they would run with another R, or on the other side, to see what is wrong with them as they are."""

from __future__ import annotations

from functools import cached_property

import msgspec
import numpy as np

from polarcheck.arrays import Floats, Mask, Rows
from polarcheck.geometry.compensation import Path
from polarcheck.table.infeed import Infeed
from polarcheck.table.moves import Moves, compensation_path, of_tool
from polarcheck.table.overcuts import Overcuts
from polarcheck.table.tool_center import ToolCenter
from polarcheck.table.trace import Trace

#: What two points may differ by that are meant as one [tolerances].
_ROUNDINGS = 10


class _OtherRadius(ToolCenter):
    """The path of the tool center in some rows with another R."""

    def __init__(self, trace: Trace, rows: Mask, run: Rows, radius: Floats) -> None:
        super().__init__(trace, Infeed(trace))
        self.chosen = rows
        self.run = run
        self.radius = radius

    @cached_property
    def _rows(self) -> Rows:
        return np.flatnonzero(self.chosen & self.trace.in_polar)

    @cached_property
    def _programmed(self) -> Path:
        path, rows = compensation_path(self.trace, self._rows), self._rows
        return msgspec.structs.replace(path, section=self.run[rows], radius=self.radius[rows])

    @cached_property
    def moves(self) -> Moves:
        return of_tool(self.trace, self._path, self._rows)


class Trial(Overcuts):
    """
    Overcuts of some rows with another R, as columns of the whole trace; the walls of the other rows stay as they are.

    rows: those that are tried, each loop with its G41 or G42. run: int[rows of the trace], the same for those that are
    compensated together. radius: with its sign [mm]; of the other sign it is the other side.
    """

    def __init__(self, trace: Trace, rows: Mask, run: Rows, radius: Floats) -> None:
        super().__init__(trace, _OtherRadius(trace, rows, run, radius))
        self.tried = rows
        self._given = np.where(rows, radius, trace.radius)

    @property
    def radius(self) -> Floats:
        """R that is tried, with its sign [mm]."""
        return self._given

    @cached_property
    def faulty(self) -> Mask:
        """Rows to which the control would object, or that would cut into the part; and those of which nobody knows."""
        faulty = np.zeros(len(self.trace), bool)
        faulty[self.sweeps.row] = True
        return faulty | self.fails

    @cached_property
    def fails(self) -> Mask:
        """The same without the ramps."""
        faulty = self.tangled | self.objects
        faulty[self.cuts.row] = True
        return faulty

    @cached_property
    def objects(self) -> Mask:
        """Rows to which the control would object, and those of which nobody knows, without what is cut."""
        tool = self.tool_center
        faulty = tool.inside_arc_too_small | tool.interferes | tool.no_intersection
        faulty |= tool.movement_missing | tool.arc_center_on_path
        faulty[tool.moves.row[~tool.moves.known]] = True
        return faulty

    @cached_property
    def comes_out_of_part(self) -> Mask:
        """
        Start-ups and offset cancels that run through the part as programmed, if they lie at the depth of their contour;
        others, if the contour begins or ends within the part.

        The part is that for a cutter of any size: only a gap that rounding leaves is closed.
        """
        from polarcheck.geometry.inside import depth_inside

        trace, tolerance = self.trace, self.trace.machine.compensation.overcut_tolerance
        has_walls = np.isin(self._loop_of_ramps, self.walls[0].loop)
        ramp = np.flatnonzero(has_walls & self.tried & (trace.starts_up | trace.cancels) & ~trace.is_arc)
        contour_at = np.where(trace.starts_up, trace.end, trace.start)[ramp]
        far = np.where(trace.starts_up, trace.start, trace.end)[ramp]
        way = np.where(self._at_depth[ramp], far, contour_at), contour_at
        depth = depth_inside(*self.walls, way, self._loop_of_ramps[ramp], tolerance, _ROUNDINGS * tolerance)
        result = np.zeros(len(trace), bool)
        result[ramp[depth > _ROUNDINGS * tolerance]] = True
        return result
