"""The executed table and the moves of a path as lines of text: CSV and JSON lines."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import Any

import msgspec
import numpy as np

from polarcheck.machines.modal import FeedMode, Motion, Side
from polarcheck.table.moves import Moves, programmed_moves
from polarcheck.table.tool_center import ToolCenter
from polarcheck.table.trace import Trace

#: Digits behind the point: a nanometer, and as much of a degree.
_DIGITS = 6
_KINDS = {Motion.CW: "cw", Motion.CCW: "ccw"}


class Move(msgspec.Struct, frozen=True):
    """
    One move inside a polar section; a contract.

    Plane points are [x, c] in mm as radius. x_axis: X of the machine as a radius [mm], never negative. c_axis: C of the
    machine [deg], continuous along the section. feed [mm/min], nearest [mm], c_feed [deg/min], time [s]; null unknown.
    """

    line: int
    section: int
    kind: str
    start: list[float | None]
    end: list[float | None]
    center: list[float | None] | None
    feed: float | None
    x_axis: list[float | None]
    c_axis: list[float | None]
    nearest: float | None
    c_feed: float | None
    time: float | None


def _number(value: float) -> float | None:
    """A value as JSON can hold it, without the dust of the last bits."""
    return round(float(value), _DIGITS) + 0.0 if np.isfinite(value) else None


def _point(value: complex) -> list[float | None]:
    return [_number(value.real), _number(value.imag)]


def moves(trace: Trace, tool_center: ToolCenter, path: str) -> Iterator[Move]:
    """The moves of the tool center path ("tool") or of the programmed path ("programmed"), in order."""
    table: Moves = tool_center.moves if path == "tool" else programmed_moves(trace)
    c_from, c_to = table.c_angles
    for index in range(len(table)):
        center = table.center[index]
        yield Move(
            int(trace.line[table.row[index]]),
            int(table.section[index]),
            _KINDS.get(Motion(int(table.kind[index])), "line"),
            _point(table.start[index]),
            _point(table.end[index]),
            None if np.isnan(center) else _point(center),
            _number(table.feed[index]),
            [_number(abs(table.start[index])), _number(abs(table.end[index]))],
            [_number(c_from[index]), _number(c_to[index])],
            _number(table.nearest[index]),
            _number(table.c_feed[index]),
            _number(table.time[index]),
        )


_SIDES = {Side.OFF: "G40", Side.LEFT: "G41", Side.RIGHT: "G42"}
_FEED_MODES = {
    FeedMode.PER_MINUTE: "per minute",
    FeedMode.PER_REVOLUTION: "per revolution",
    FeedMode.INVERSE_TIME: "inverse time",
}


def rows(trace: Trace, tool_center: ToolCenter) -> Iterator[dict[str, Any]]:
    """
    The executed table, one row per executed block.

    x [mm, radius], z [mm], c [deg, machine], plane_x and plane_c [mm, radius] inside sections, feed [mm/min],
    nearest [mm], c_feed [deg/min] of the tool center path.
    """
    for row in range(len(trace)):
        in_polar = bool(trace.in_polar[row])
        moving = in_polar and bool(trace.moves_plane[row])
        yield {
            "line": int(trace.line[row]),
            "program": int(trace.program[row]),
            "depth": int(trace.run.depth[row]),
            "section": int(trace.section[row]),
            "motion": Motion(int(trace.motion[row])).name.lower(),
            "side": _SIDES[Side(int(trace.side[row]))],
            "tool": int(trace.tool[row]),
            "offset_number": int(trace.offset_number[row]),
            "radius": _number(trace.radius[row]),
            "feed_mode": _FEED_MODES[FeedMode(int(trace.feed_mode[row]))],
            "feed": _number(trace.feed[row]),
            "x": _number(trace.x[row]),
            "z": _number(trace.z[row]),
            "c": _number(trace.c_angle[row]),
            "plane_x": _number(trace.end[row].real),
            "plane_c": _number(trace.end[row].imag),
            "nearest": _number(tool_center.nearest[row]) if moving else None,
            "c_feed": _number(tool_center.c_feed[row]) if moving else None,
        }


def as_jsonl(items: Iterator[Any]) -> Iterator[str]:
    """One JSON object per line."""
    encoder = msgspec.json.Encoder()
    for item in items:
        yield encoder.encode(item).decode() + "\n"


def as_csv(items: Iterator[Any]) -> Iterator[str]:
    """A header and one line per item; points become two columns."""
    header: list[str] = []
    for item in items:
        flat: dict[str, Any] = {}
        table = item if isinstance(item, dict) else msgspec.structs.asdict(item)
        for name, value in table.items():
            if name in _PAIRS:
                first, second = value or (None, None)
                flat |= {f"{name}_{_PAIRS[name][0]}": first, f"{name}_{_PAIRS[name][1]}": second}
            else:
                flat[name] = value
        if not header:
            header = list(flat)
            yield _line(header)
        yield _line(["" if value is None else value for value in flat.values()])


_PAIRS = dict.fromkeys(("start", "end", "center"), ("x", "c")) | dict.fromkeys(("x_axis", "c_axis"), ("from", "to"))


def _line(values: list[Any]) -> str:
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerow(values)
    return buffer.getvalue()
