"""The moves of a path as columns in the units of the trace: what JSON lines, CSV and the interface for Python hold."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.columns.path.moves import programmed_moves, z_along
from polarcheck.columns.path.standing_moves import with_z_alone
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


def executed_moves(trace: Trace, tool_center: ToolCenter, path: str, *, has_z_alone: bool = False) -> ExecutedMoves:
    """
    Return the moves of the tool center path ("tool") or of the programmed path ("programmed").

    has_z_alone: a block that moves Z alone is a move, too. Its nearest, rates and time are NaN, but for x_feed, which
    is 0 at feed.
    """
    runs = Dynamics(trace, tool_center) if path == TOOL else programmed_moves(trace)
    table = runs.moves if isinstance(runs, Dynamics) else runs
    rates = {name: getattr(runs, name) for name in ("c_feed", "x_feed", "c_acceleration", "x_acceleration")}
    rates |= {"nearest": table.nearest, "time": runs.move_time if isinstance(runs, Dynamics) else runs.time}
    if has_z_alone:
        table, number = with_z_alone(trace, table)
        rates = {name: np.append(values, np.nan)[number] for name, values in rates.items()}
        rates["x_feed"] = np.where((number < 0) & trace.path.moves_at_feed[table.row], 0.0, rates["x_feed"])
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
        **rates,
    )
