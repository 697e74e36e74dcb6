"""The columns of the executed table and of the moves of a path, as a table for people, and their ranks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.path.executed_moves import KINDS, ExecutedMoves, executed_moves
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.foundation.states import FeedMode, Motion, Side
from polarcheck.program.reading.excerpt import visible
from polarcheck.reports.pages.aligned import Column, table
from polarcheck.reports.pages.executed import FEED_MODES, SIDES
from polarcheck.rules.wording.offsets import key_of

MM, FEED, DEG, C_FEED = "mm", "mm/min", "deg", "deg/min"
#: The decimals of rates and accelerations of axes.
_RATE = 1


def rows_table(trace: Trace, tool_center: ToolCenter, room: int | None, height: int | None) -> Iterator[str]:
    """Yield the executed table of `executed.rows` with the text of each block; see `aligned.table`."""
    yield from _channel(trace)
    yield from table(_of_rows(trace, tool_center), lambda row: _block(trace, row), room, height)


def moves_table(
    trace: Trace, tool_center: ToolCenter, path: str, room: int | None, height: int | None
) -> Iterator[str]:
    """Yield the moves of `executed.moves` on the tool center path ("tool") or the programmed one."""
    moves = executed_moves(trace, tool_center, path)
    yield from _channel(trace)
    yield from table(_of_moves(moves, path), lambda move: _block(trace, int(moves.row[move])), room, height)


def _channel(trace: Trace) -> Iterator[str]:
    if trace.text.source.channel:
        yield f"channel {visible(trace.text.source.channel)}\n"


def _block(trace: Trace, row: int) -> str:
    return trace.text.source.line_text(int(trace.blocks.line[row])).lstrip()


def _of_rows(trace: Trace, tool_center: ToolCenter) -> list[Column]:
    moving = trace.mode.in_polar & trace.axes.moves_plane
    mode, motion = trace.feedrate.feed_mode, trace.path.motion
    number = np.where(mode == FeedMode.PER_MINUTE, trace.feedrate.feed, trace.feedrate.feed_number)
    tools = {tool: str(trace.run.names.get(tool, tool)) for tool in _distinct(trace.tools.tool)}
    keys = {offset: str(key_of(trace.tools, offset) or 0) for offset in _distinct(trace.tools.offset_number)}
    return [
        _count("line", 0, trace.blocks.line_in_file),
        _count("program", 8, trace.blocks.program, usual=0),
        _count("depth", 8, trace.run.depth, usual=0),
        _count("section", 5, trace.mode.section, usual=-1, is_blank=trace.mode.section < 0),
        _words("motion", 1, motion, {kind: Motion(kind).name.lower() for kind in _distinct(motion)},
               is_blank=motion == Motion.NONE),
        _words("side", 2, trace.compensation.side, SIDES, usual=Side.OFF),
        _words("tool", 6, trace.tools.tool, tools, usual=0),
        _words("offset_number", 7, trace.tools.offset_number, keys, usual=0),
        Column("radius", MM, 5, trace.compensation.radius, is_blank=trace.tools.offset_number == 0),
        _words("feed_mode", 8, mode, FEED_MODES, usual=FeedMode.PER_MINUTE),
        Column("feed", FEED, 1, trace.feedrate.feed),
        Column("f", "", 8, number, is_blank=mode == FeedMode.PER_MINUTE),
        Column("x", MM, 1, trace.path.x),
        Column("z", MM, 1, trace.path.z),
        Column("c", DEG, 1, trace.path.c_angle),
        Column("plane_x", MM, 3, trace.path.end.real, is_blank=~trace.mode.in_polar),
        Column("plane_c", MM, 3, trace.path.end.imag, is_blank=~trace.mode.in_polar),
        Column("nearest", MM, 4, tool_center.nearest, is_blank=~moving),
        Column("c_feed", C_FEED, 2, tool_center.c_feed, _RATE, is_blank=~moving),
    ]  # fmt: skip


def _of_moves(moves: ExecutedMoves, path: str) -> list[Column]:
    first = int(moves.section[0]) if len(moves) else 0
    path_key = np.where(moves.is_of_tool, 1, 0) if path == "tool" else np.ones(len(moves), np.int64)
    return [
        _count("line", 0, moves.line),
        _count("section", 5, moves.section, usual=first),
        _words("kind", 1, moves.kind, {kind: KINDS.get(Motion(kind), "line") for kind in _distinct(moves.kind)}),
        _words("path", 1, path_key, {0: "programmed", 1: path}, usual=1),
        *_point("start", 4, moves.start),
        *_point("end", 1, moves.end),
        *_point("center", 6, moves.center, is_blank=np.isnan(moves.center)),
        Column("z_from", MM, 7, moves.z[:, 0]),
        Column("z_to", MM, 2, moves.z[:, 1]),
        Column("radius", MM, 6, moves.radius),
        Column("feed", FEED, 1, moves.feed),
        Column("x_axis_from", MM, 8, moves.x_axis[:, 0]),
        Column("x_axis_to", MM, 7, moves.x_axis[:, 1]),
        Column("c_axis_from", DEG, 8, moves.c_axis[:, 0]),
        Column("c_axis_to", DEG, 3, moves.c_axis[:, 1]),
        Column("nearest", MM, 3, moves.nearest),
        Column("c_feed", C_FEED, 2, moves.c_feed, _RATE),
        Column("x_feed", FEED, 4, moves.x_feed, _RATE),
        Column("c_acceleration", "deg/s2", 7, moves.c_acceleration, _RATE),
        Column("x_acceleration", "mm/s2", 7, moves.x_acceleration, _RATE),
        Column("time", "s", 4, moves.time),
    ]


def _count(
    name: str, rank: int, values: NDArray[np.integer], is_blank: Mask | None = None, usual: float | None = None
) -> Column:
    return Column(name, "", rank, np.asarray(values, np.float64), 0, is_blank=is_blank, usual=usual)


def _words(
    name: str,
    rank: int,
    values: NDArray[np.integer],
    words: Mapping[Any, str],
    is_blank: Mask | None = None,
    usual: float | None = None,
) -> Column:
    """Return a column of words, which may come from the program."""
    display_text = {int(key): visible(word) for key, word in words.items()}
    return Column(name, "", rank, values, words=display_text, is_blank=is_blank, usual=usual)


def _point(name: str, rank: int, point: NDArray[np.complex128], is_blank: Mask | None = None) -> list[Column]:
    return [
        Column(f"{name}_{axis}", MM, rank, values, is_blank=is_blank)
        for axis, values in (("x", point.real), ("c", point.imag))
    ]


def _distinct(values: NDArray[np.integer]) -> list[int]:
    distinct: list[int] = np.unique(values).tolist()
    return distinct
