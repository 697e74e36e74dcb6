"""The moves of a path as columns in the units of the trace: what JSON lines, CSV and the interface for Python hold."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.columns.path.moves import programmed_moves, z_along
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane_path import PlanePath

#: Kinds of moves on the plane by their states; all others are lines.
KINDS = {Motion.CW: "cw", Motion.CCW: "ccw"}
TOOL, PROGRAMMED = "tool", "programmed"


class ExecutedMoves(PlanePath, frozen=True, eq=False):
    """
    Moves inside polar sections; NaN is unknown.

    row: of the trace. line: of the block; in a program called from another file, that of the call. section: from 0 in
    each channel. is_of_tool: the tool center runs there. z: float64[n, 2], before and after [mm]. radius: R of the
    offset in force [mm]. feed: F in force [mm/min]. x_axis: float64[n, 2], X of the machine as a radius, from and to
    [mm]. c_axis: float64[n, 2], C of the machine [deg]. nearest: smallest distance of the tool center to the center of
    C [mm]. c_feed, x_feed: highest rates [deg/min, mm/min]. c_acceleration, x_acceleration: highest accelerations
    [deg/s2, mm/s2]. time: of the move [s]. On the path of the tool center these five are those at the actual feed, on
    the programmed path at F in force.
    """

    row: Rows
    line: Rows
    section: Rows
    is_of_tool: Mask
    z: Floats
    radius: Floats
    feed: Floats
    x_axis: Floats
    c_axis: Floats
    nearest: Floats
    c_feed: Floats
    x_feed: Floats
    c_acceleration: Floats
    x_acceleration: Floats
    time: Floats


def executed_moves(trace: Trace, tool_center: ToolCenter, path: str) -> ExecutedMoves:
    """Return the moves of the tool center path ("tool") or of the programmed path ("programmed")."""
    runs = Dynamics(trace, tool_center) if path == TOOL else programmed_moves(trace)
    table = runs.moves if isinstance(runs, Dynamics) else runs
    return ExecutedMoves(
        *table.shape,
        row=table.row,
        line=trace.blocks.line_in_file[table.row],
        section=table.section,
        is_of_tool=table.is_of_tool,
        z=np.stack(z_along(trace, table), axis=1),
        radius=trace.compensation.radius_of_move[table.row],
        feed=table.feed,
        x_axis=np.abs(np.stack((table.start, table.end), axis=1)),
        c_axis=np.stack(table.c_angles, axis=1),
        nearest=table.nearest,
        c_feed=runs.c_feed,
        x_feed=runs.x_feed,
        c_acceleration=runs.c_acceleration,
        x_acceleration=runs.x_acceleration,
        time=runs.move_time if isinstance(runs, Dynamics) else runs.time,
    )
