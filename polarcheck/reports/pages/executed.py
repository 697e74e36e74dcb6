"""The executed table and the moves of a path as lines of text: CSV and JSON lines."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import Any

import msgspec
import numpy as np
from msgspec import UNSET, UnsetType

from polarcheck.columns.path.executed_moves import KINDS, PROGRAMMED, executed_moves
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import FeedMode, Motion, Side
from polarcheck.rules.quantity import rounded
from polarcheck.rules.wording.offsets import called_tool, key_of, option


class Move(msgspec.Struct, frozen=True):
    """
    A move on the polar plane inside a polar section; a contract. null is unknown.

    line: the line of the block; in a program called from another file, that of the call.
    section: the number of the section, from 0 in each channel.
    kind: "line", "cw" or "ccw".
    start, end, center: plane points [x, c], x as a radius [mm].
    z: Z before and after [mm]. A block that moves Z alone is a move in golden traces only; the next move begins at
        the Z where it ends.
    path: the requested path, "tool" or "programmed". A move of the tool path is "programmed" if it runs in offset mode,
        start-up and offset cancel included, and R or the position is unknown. Without G41 and G42 both paths coincide.
    radius: R of the offset in force, used or not [mm].
    feed: F in force, clamped if the control does so [mm/min].
    x_axis: X of the machine as a radius, from and to, never negative [mm].
    c_axis: C of the machine, from and to, continuous along the section [deg].
    nearest: the smallest distance of the tool center to the center of C [mm].
    c_feed, x_feed: the highest rates of C [deg/min] and X [mm/min] in the move.
    c_acceleration, x_acceleration: the highest accelerations of C [deg/s2] and X [mm/s2] in the move.
    time: the time of the move [s].
    channel: as `$2`, if the file has several.

    On the tool path the rates, the accelerations and the time are those that automatic override leaves. They are null
    in rapid traverse. A rate is also null where it has no bound, in a move through the center of C.
    """

    line: int
    section: int
    kind: str
    start: list[float | None]
    end: list[float | None]
    center: list[float | None] | None
    z: list[float | None]
    path: str
    radius: float | None
    feed: float | None
    x_axis: list[float | None]
    c_axis: list[float | None]
    nearest: float | None
    c_feed: float | None
    x_feed: float | None
    c_acceleration: float | None
    x_acceleration: float | None
    time: float | None
    channel: str | UnsetType = UNSET


#: Columns of numbers that are not known everywhere.
_NUMBERS = ("radius", "feed", "nearest", "c_feed", "x_feed", "c_acceleration", "x_acceleration", "time")


def _point(value: complex) -> list[float | None]:
    return [rounded(value.real), rounded(value.imag)]


def moves(trace: Trace, tool_center: ToolCenter, path: str, *, has_z_alone: bool = False) -> Iterator[Move]:
    """
    Yield the moves of the tool center path ("tool") or of the programmed path ("programmed"), in order.

    has_z_alone: with the blocks that move Z alone, as golden traces have them.
    """
    table = executed_moves(trace, tool_center, path, has_z_alone=has_z_alone)
    for index in range(len(table)):
        center = table.center[index]
        yield Move(
            line=int(table.line[index]),
            section=int(table.section[index]),
            kind=KINDS.get(Motion(int(table.kind[index])), "line"),
            start=_point(table.start[index]),
            end=_point(table.end[index]),
            center=None if np.isnan(center) else _point(center),
            z=[rounded(z) for z in table.z[index]],
            path=path if table.is_of_tool[index] else PROGRAMMED,
            x_axis=[rounded(x) for x in table.x_axis[index]],
            c_axis=[rounded(c) for c in table.c_axis[index]],
            channel=trace.text.source.channel or UNSET,
            **{name: rounded(getattr(table, name)[index]) for name in _NUMBERS},
        )


def without_radius(trace: Trace, tool_center: ToolCenter) -> str:
    """
    Return one line on the moves of the tool center path that are shown as programmed, since R is unknown.

    Empty if there are none.
    """
    table = tool_center.moves
    unknown = table.row[~table.is_of_tool & np.isnan(trace.compensation.radius_of_move[table.row])]
    offsets = trace.tools.offset_number[unknown]
    rows = list(
        {int(number): int(row) for number, row in zip(offsets[::-1], unknown[::-1], strict=True) if number}.values()
    )[::-1]
    causes = [f"no radius for {', '.join(called_tool(trace.tools, row) for row in rows)}"] * bool(rows)
    options = " ".join(option(trace.tools, row, "radius") for row in rows)
    remedies = [f"give {options} or --offsets FILE"] * bool(rows)
    if not offsets.all():
        line = int(trace.blocks.line_in_file[unknown[offsets == 0][0]])
        causes.append(f"no tool offset is in force at line {line}")
        remedies.append("call one with T")
    effect = "what is run with G41 or G42 is shown as programmed, not as the tool runs"
    return f"{', '.join(causes)}: {effect}; {', '.join(remedies)}" if causes else ""


SIDES = {Side.OFF: "G40", Side.LEFT: "G41", Side.RIGHT: "G42"}
FEED_MODES = {
    FeedMode.PER_MINUTE: "per minute",
    FeedMode.PER_REVOLUTION: "per revolution",
    FeedMode.INVERSE_TIME: "inverse time",
}


def rows(trace: Trace, tool_center: ToolCenter) -> Iterator[dict[str, Any]]:
    """
    Yield the executed table, one row per executed block.

    x [mm, radius], z [mm], c [deg, machine], plane_x and plane_c [mm, radius] inside sections, feed [mm/min], f
    [mm per min or per revolution], nearest [mm] and c_feed [deg/min] of the tool center path, channel as `$2` if the
    file has several.
    """
    channel = {"channel": trace.text.source.channel} if trace.text.source.channel else {}
    for row in range(len(trace)):
        in_polar = bool(trace.mode.in_polar[row])
        moving = in_polar and bool(trace.axes.moves_plane[row])
        mode = FeedMode(int(trace.feedrate.feed_mode[row]))
        yield {
            "line": int(trace.blocks.line_in_file[row]),
            "program": int(trace.blocks.program[row]),
            "depth": int(trace.run.depth[row]),
            "section": int(trace.mode.section[row]),
            "motion": Motion(int(trace.path.motion[row])).name.lower(),
            "side": SIDES[Side(int(trace.compensation.side[row]))],
            "tool": trace.run.names.get(int(trace.tools.tool[row]), int(trace.tools.tool[row])),
            "offset_number": key_of(trace.tools, int(trace.tools.offset_number[row])) or 0,
            "radius": rounded(trace.compensation.radius[row]),
            "feed_mode": FEED_MODES[mode],
            "feed": rounded(trace.feedrate.feed[row]),
            "f": rounded((trace.feedrate.feed if mode == FeedMode.PER_MINUTE else trace.feedrate.feed_number)[row]),
            "x": rounded(trace.path.x[row]),
            "z": rounded(trace.path.z[row]),
            "c": rounded(trace.path.c_angle[row]),
            "plane_x": rounded(trace.path.end[row].real),
            "plane_c": rounded(trace.path.end[row].imag),
            "nearest": rounded(tool_center.nearest[row]) if moving else None,
            "c_feed": rounded(tool_center.c_feed[row]) if moving else None,
            **channel,
        }


def as_jsonl(items: Iterator[Any]) -> Iterator[str]:
    """Yield one JSON object per line."""
    encoder = msgspec.json.Encoder()
    for item in items:
        yield encoder.encode(item).decode() + "\n"


def as_csv(items: Iterator[Any]) -> Iterator[str]:
    """Yield a header and one line per item; a point becomes two columns."""
    header: list[str] = []
    for item in items:
        flat = _flat(item if isinstance(item, dict) else msgspec.to_builtins(item))
        if not header:
            header = list(flat)
            yield _line(header)
        yield _line(["" if value is None else value for value in flat.values()])


def _flat(item: dict[str, Any]) -> dict[str, Any]:
    if "start" not in item:
        return item
    flat: dict[str, Any] = {}
    for name, value in item.items():
        if name in _PAIRS:
            flat |= {f"{name}_{end}": part for end, part in zip(_PAIRS[name], value or (None, None), strict=True)}
        else:
            flat[name] = value
    return flat


_PAIRS = {
    **dict.fromkeys(("start", "end", "center"), ("x", "c")),
    **dict.fromkeys(("z", "x_axis", "c_axis"), ("from", "to")),
}


def _line(values: list[Any]) -> str:
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerow(values)
    return buffer.getvalue()
