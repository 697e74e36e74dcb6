"""The moves of a path as columns in the units of the trace: what JSON lines, CSV and the interface for Python hold."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.columns.path.moves import Moves, programmed_moves, z_along
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, Table
from polarcheck.foundation.states import Motion

#: Kinds of moves on the plane by their states; all others are lines.
KINDS = {Motion.CW: "cw", Motion.CCW: "ccw"}
TOOL, PROGRAMMED = "tool", "programmed"
_RATES = ("c_feed", "x_feed", "c_acceleration", "x_acceleration")


class ExecutedMoves(Table, frozen=True, eq=False):
    """
    One element per move inside polar sections, in order; NaN is unknown.

    line: of the block; in a program called from another file, that of the call. section: from 0 in each channel.
    kind: Motion. start, end, center: plane points [mm]; center NaN for lines. z_from, z_to: Z before and after [mm].
    is_of_tool: the tool center runs there. radius: R of the offset in force [mm]. feed: F in force [mm/min].
    x_from, x_to: X of the machine as a radius [mm]. c_from, c_to: C of the machine [deg]. nearest: smallest distance of
    the tool center to the center of C [mm]. c_feed, x_feed: highest rates [deg/min, mm/min]. c_acceleration,
    x_acceleration: highest accelerations [deg/s2, mm/s2]. time: of the move [s].
    """

    line: Rows
    section: Rows
    kind: States
    start: Points
    end: Points
    center: Points
    z_from: Floats
    z_to: Floats
    is_of_tool: Mask
    radius: Floats
    feed: Floats
    x_from: Floats
    x_to: Floats
    c_from: Floats
    c_to: Floats
    nearest: Floats
    c_feed: Floats
    x_feed: Floats
    c_acceleration: Floats
    x_acceleration: Floats
    time: Floats


def running(trace: Trace, tool_center: ToolCenter, path: str) -> tuple[Moves, dict[str, Floats]]:
    """
    Return the moves of a path, and their highest rates and times by the names of ExecutedMoves.

    For the path of the tool center ("tool") they are those at the actual feed, for the programmed path at F in force.
    """
    if path != TOOL:
        table = programmed_moves(trace)
        return table, {name: getattr(table, name) for name in (*_RATES, "time")}
    runs = Dynamics(trace, tool_center)
    return runs.moves, {**{name: getattr(runs, name) for name in _RATES}, "time": runs.move_time}


def executed_moves(trace: Trace, tool_center: ToolCenter, path: str) -> ExecutedMoves:
    """Return the moves of the tool center path ("tool") or of the programmed path ("programmed")."""
    table, runs = running(trace, tool_center, path)
    z_from, z_to = z_along(trace, table)
    c_from, c_to = table.c_angles
    return ExecutedMoves(
        line=trace.blocks.line_in_file[table.row],
        section=table.section,
        kind=table.kind,
        start=table.start,
        end=table.end,
        center=table.center,
        z_from=z_from,
        z_to=z_to,
        is_of_tool=table.is_of_tool,
        radius=trace.compensation.radius_of_move[table.row],
        feed=table.feed,
        x_from=np.abs(table.start),
        x_to=np.abs(table.end),
        c_from=c_from,
        c_to=c_to,
        nearest=table.nearest,
        **runs,
    )
