"""The moves of a program as NumPy columns."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from typing import Any, Literal, Self, TypeAlias, Unpack, overload

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.api.keywords import ExecutionKeywords, PathName, takes
from polarcheck.api.loaded_program import NAMELESS, Call, Program
from polarcheck.api.values import choice, length
from polarcheck.columns.path.executed_moves import KINDS, PROGRAMMED, TOOL, executed_moves
from polarcheck.foundation.arrays import Floats, Points, Rows, Table, side_by_side
from polarcheck.foundation.states import Motion
from polarcheck.geometry.segments import Curves, segments
from polarcheck.program.reading.files import LARGEST

Texts: TypeAlias = NDArray[np.str_]
Which: TypeAlias = Literal["tool", "programmed"]

_STATES = {kind: motion for motion, kind in KINDS.items()}
#: `segments` keeps a quarter of its tolerance between a chord and its arc.
_SAGITTA = 4


class Move(msgspec.Struct, frozen=True, kw_only=True):
    """One move of a trace: its value of each column of `Trace`, as a number, a text, or two numbers (from and to)."""

    line: int
    section: int
    kind: str
    start: complex
    end: complex
    center: complex
    z: tuple[float, float]
    path: str
    radius: float
    feed: float
    x_axis: tuple[float, float]
    c_axis: tuple[float, float]
    nearest: float
    c_feed: float
    x_feed: float
    c_acceleration: float
    x_acceleration: float
    time: float
    channel: str


#: The names of the two columns that each column of pairs, or of points, becomes.
_OF_PAIRS = {"z": ("z_before", "z_after"), "x_axis": ("x_from", "x_to"), "c_axis": ("c_from", "c_to")}


class Trace(Table, frozen=True, eq=False):
    """
    The moves of a program inside its polar sections, in order: a column for each name of the JSON lines of the trace.

    len(trace) is the number of moves; trace[mask], trace[rows] and trace[5:9] are traces of these moves alone; trace[3]
    is a `Move`, and so is each that `for move in trace` gives. Columns are read only. Unknown numbers are NaN. Plane
    points are complex, x + 1j*c, X as a radius. The columns of n moves are:

    line: int64[n], the line of the block; in a program called from another file, that of the call.
    section: int64[n], the number of the polar section, from 0 in each channel.
    kind: str[n], line, cw or ccw.
    start, end: complex128[n], from and to [mm].
    center: complex128[n], of an arc [mm]; NaN for lines.
    z: float64[n, 2], Z before and after [mm].
    path: str[n], tool where the tool center runs there; programmed in offset mode where R or the position is unknown.
    radius: float64[n], R of the offset in force [mm].
    feed: float64[n], F in force [mm/min].
    x_axis: float64[n, 2], X of the machine as a radius, from and to, never negative [mm].
    c_axis: float64[n, 2], C of the machine, from and to, continuous along a section [deg].
    nearest: float64[n], the smallest distance of the tool center to the center of C [mm].
    c_feed: float64[n], the highest rate of C [deg/min].
    x_feed: float64[n], the highest rate of X [mm/min].
    c_acceleration: float64[n], the highest acceleration of C [deg/s2].
    x_acceleration: float64[n], the highest acceleration of X [mm/s2].
    time: float64[n], of the move [s].
    channel: str[n], as $2; empty unless the file has several channels.

    And for all moves together:

    file: the path of the program, as it is reported.
    machine: its id, the name of a built-in machine or that of a machine file without folder and ending.
    missing: in one line, why moves of the tool path are shown as programmed, and what to give; empty if none is.
    """

    _shared = ("file", "machine", "missing")

    line: Rows
    section: Rows
    kind: Texts
    start: Points
    end: Points
    center: Points
    z: Floats
    path: Texts
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
    channel: Texts
    file: str
    machine: str
    missing: str

    def __post_init__(self) -> None:
        for name in self._columns():
            column = getattr(self, name)
            if column.flags.writeable:
                column.setflags(write=False)

    @overload
    def __getitem__(self, rows: int) -> Move: ...

    @overload
    def __getitem__(self, rows: NDArray[np.integer[Any]] | NDArray[np.bool_] | slice) -> Self: ...

    def __getitem__(self, rows: Any) -> Move | Self:
        """Return a move by its number, or the trace of these moves: their numbers, a boolean per move, or a slice."""
        if not isinstance(rows, int | np.integer):
            return super().__getitem__(rows)
        number = range(len(self))[rows]
        return next(iter(super().__getitem__(slice(number, number + 1))))

    def __iter__(self) -> Iterator[Move]:
        names = self._columns()
        for values in side_by_side(*(getattr(self, name) for name in names)):
            fields: dict[str, Any] = dict(zip(names, values, strict=True))
            pairs = {name: tuple(fields[name]) for name in _OF_PAIRS}
            yield Move(**{**fields, **pairs})

    def to_dict(self) -> dict[str, NDArray[Any]]:
        """
        Return the columns as arrays of one dimension each, for a data frame: `pandas.DataFrame(trace.to_dict())`.

        A point is two columns, `start_x` and `start_c` [mm]; z is `z_before` and `z_after`, x_axis `x_from` and `x_to`,
        c_axis `c_from` and `c_to`. The others have their names, and all n elements.
        """
        columns: dict[str, NDArray[Any]] = {}
        for name in self._columns():
            column = getattr(self, name)
            if column.dtype == complex:
                columns |= {f"{name}_x": column.real, f"{name}_c": column.imag}
            elif column.ndim > 1:
                columns |= dict(zip(_OF_PAIRS[name], column.T, strict=True))
            else:
                columns[name] = column
        return columns

    def polyline(self, tolerance: float = 0.01) -> Points:
        """
        Return the path as points to draw, complex128[m] [mm]; NaN stands where it is interrupted.

        tolerance: the largest distance of a chord from its arc [mm]. Moves with unknown points are left out.

        Raises UsageError for a tolerance that is not above 0, TooHardError for more than a million chords.
        """
        chord = length("polyline", tolerance, sys.float_info.max, "a tolerance above 0")
        states = np.array([_STATES.get(kind, Motion.LINE) for kind in self.kind.tolist()], np.int16)
        first = np.zeros(len(self), np.int64)
        parts = segments(Curves(self.start, self.end, self.center, states, first, first), _SAGITTA * chord)
        if not len(parts):
            return np.zeros(0, complex)
        apart = np.append(True, np.abs(parts.start[1:] - parts.end[:-1]) > _TOUCH)
        points = np.stack([np.where(apart, np.nan, parts.start), parts.start, parts.end], axis=1)
        used = np.stack([apart, apart, np.ones(len(parts), bool)], axis=1)
        return np.asarray(points[used][1:])

    def __repr__(self) -> str:
        sections = len({*side_by_side(self.channel, self.section)})
        return f"<Trace of {self.file}: {len(self)} moves in {sections} sections on {self.machine}>"


#: Ends of moves that are nearer than this are one point [mm].
_TOUCH = 1e-6


@takes(ExecutionKeywords)
def trace(
    path: PathName, *, which: Which = "tool", max_size: int = LARGEST, **keywords: Unpack[ExecutionKeywords]
) -> Trace:
    """
    Return the moves of a program inside its polar sections.

    which: "tool" for the path of the tool center, "programmed" for the path as it is written.
    max_size: a larger file is not read [bytes].

    Raises SourceError if the file cannot be read, UsageError, JobError or MachineError for a wrong setting,
    TooHardError if the program takes too long.
    """
    call = Call("polarcheck.trace()", ExecutionKeywords, keywords).with_one_state()
    return _trace(call, call.of_path(path, max_size), which)


@takes(ExecutionKeywords)
def trace_text(
    text: str | bytes, *, name: str = NAMELESS, which: Which = "tool", **keywords: Unpack[ExecutionKeywords]
) -> Trace:
    """
    Return the moves of a text, as `trace` does of a file.

    name: the path that it is reported as, and by which entries of a job file apply to it. No job file is read unless
        `config` names one, or use_config=True asks for the one nearest to this path.

    Raises as `trace` does.
    """
    call = Call("polarcheck.trace_text()", ExecutionKeywords, keywords).with_one_state()
    return _trace(call, call.of_text(text, name), which)


def _trace(call: Call, program: Program, given: str) -> Trace:
    from polarcheck.reports.pages.executed import without_radius

    which = choice(f"{call.function}: which", given, (TOOL, PROGRAMMED), TOOL)
    with program.runs() as runs:
        tables = [run for _, run in runs]
        parts = [executed_moves(run["trace"], run["tool_center"], which) for run in tables]
        missing = [without_radius(run["trace"], run["tool_center"]) for run in tables if which == TOOL]
        channels = [str(run["trace"].text.source.channel) for run in tables]
    counts = [len(part) for part in parts]
    moves = parts[0].concatenated(parts)
    columns = {name: getattr(moves, name) for name in Trace.__struct_fields__ if hasattr(moves, name)}
    columns |= {
        "kind": _texts([KINDS.get(Motion(kind), "line") for kind in moves.kind.tolist()]),
        "path": np.where(moves.is_of_tool, which, PROGRAMMED),
        "channel": np.repeat(_texts(channels), counts),
    }
    return Trace(
        **columns,
        file=program.path,
        machine=program.settings.machine_id,
        missing="; ".join(text for text in missing if text),
    )


def _texts(texts: Sequence[str]) -> Texts:
    return np.array(texts, np.str_)
