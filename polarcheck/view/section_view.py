"""The data of a polar section for a terminal: points of its paths, and the rate of C over time."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.checking.channel_reports import first_runs
from polarcheck.checking.polar_sections import polar_sections
from polarcheck.columns.path.moves import Moves, programmed_moves
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Points, Rows, last_in_run, ranges
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import FileReport
from polarcheck.geometry.plane import quiet
from polarcheck.parts.as_meant import as_meant
from polarcheck.program.reading.excerpt import head
from polarcheck.reports.pages.painting import Paint, plain
from polarcheck.rules.tables import Tables
from polarcheck.view.face_view import face_view
from polarcheck.view.strip import strip

#: The largest picture in columns and rows, and the rows of the strip.
_COLUMNS, _ROWS, _STRIP_ROWS = 64, 24, 5
_INDENT = "  "
#: The size of the picture in distances between points; a terminal has fewer dots.
_DOTS = 400
#: The most points computed for a path, besides two for each move.
_MOST = 400_000
#: The most sections of a run that are shown.
_SECTIONS = 12
#: The points in time of the curve; a terminal has fewer columns.
_INSTANTS = 400


class SectionView(msgspec.Struct, frozen=True, kw_only=True):
    """
    One polar section.

    title: its lines and tool.
    programmed, tool: points of the paths, in no order; `tool` is empty if the path is unknown [mm].
    marks: the end points of blocks with findings [mm].
    time: the points in time of the curve, rising [s].
    rate: the rate of C at these times; inf through the center, NaN if unknown [deg/min].
    limit: the limit of C; NaN without one [deg/min].
    highest_line: the line of the block with the highest rate, 0 if C does not turn.
    remarks: what is not shown, and why; what is shown as meant and not as the control reads it.
    """

    title: str
    programmed: Points
    tool: Points
    marks: Points
    time: Floats
    rate: Floats
    limit: float
    highest_line: int
    remarks: list[str]

    def lines(self, columns: int, *, dots: bool, paint: Paint = plain, path: str = "") -> Iterator[str]:
        """
        Yield the lines of one section: its title, the picture, the rate of C over time, and an empty line.

        columns: the width of the terminal.
        dots: draw with Braille and block characters, else ASCII.
        path: the path of the program, if there may be several.
        """
        room = columns - len(_INDENT)
        face = face_view(self.programmed, self.tool, self.marks, min(room, _COLUMNS), _ROWS, dots=dots, paint=paint)
        curve = strip(self.time, self.rate, self.limit, min(room, _COLUMNS), _STRIP_ROWS, dots=dots, paint=paint)
        yield paint("message", f"{head(path)}: {self.title}" if path else self.title)
        legend, remarks = (
            [line for text in texts for line in textwrap.wrap(text, room)]
            for texts in (_legend(self, dots), (_rate(self), *self.remarks))
        )
        yield from (_INDENT + line if line else "" for line in (*face, "", *legend, "", *curve, *remarks))
        yield ""


class ViewedReport(FileReport, frozen=True, kw_only=True):
    """
    A report with views of its sections for a terminal.

    views: the first sections, in the order of channels.
    """

    views: list[SectionView]


def with_views(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """Return the report with the views of its sections; of two runs with block skip the first is shown."""
    lines = {finding.line for finding in report.findings}
    channels = sorted((tables for _, tables in first_runs(runs)), key=_channel)
    views = [view for tables in channels for view in views_of(tables, lines)]
    fields = {name: getattr(report, name) for name in FileReport.__struct_fields__}
    return ViewedReport(**fields, views=views)


def _channel(tables: Tables) -> str:
    return tables["text"].source.channel or ""


def views_of(tables: Tables, lines: Collection[int] = ()) -> Iterator[SectionView]:
    """Yield the first sections of a run. lines: the lines of the file to mark."""
    trace: Trace = tables["trace"]
    sections = polar_sections(tables)
    if not sections:
        return
    tool_center: ToolCenter = tables["tool_center"]
    try:
        moves = tool_center.moves
    except TooHardError:
        return
    programmed = programmed_moves(trace)
    is_marked = np.isin(trace.blocks.line_in_file, np.array(sorted(lines), np.int64))
    for number, section in enumerate(sections[:_SECTIONS]):
        offset = "" if section.offset is None else f", offset {section.offset}"
        channel = f"{trace.text.source.channel}: " if trace.text.source.channel else ""
        in_section = moves[moves.section == number]
        remarks = [_NO_RADIUS] if not in_section.is_of_tool.all() else []
        remarks += [intended] if (intended := as_meant(trace, number)) else []
        if number + 1 == _SECTIONS < len(sections):
            remarks.append(f"{len(sections) - _SECTIONS} more sections are not shown")
        time, rate = _curve(in_section)
        marks = trace.path.end[is_marked & (trace.mode.section == number)]
        yield SectionView(
            title=f"{channel}section of lines {section.line} to {section.end_line}{offset}",
            programmed=points_of(programmed[programmed.section == number]),
            tool=points_of(in_section[in_section.is_of_tool]),
            marks=marks[np.isfinite(marks)],
            time=time,
            rate=rate,
            limit=float(trace.machine.limits.c_feed),
            highest_line=_highest_line(trace, in_section),
            remarks=remarks,
        )


_NO_RADIUS = "what is run with G41 or G42 is shown as programmed, not as the tool runs: R, or a position, is not known"


def _highest_line(trace: Trace, moves: Moves) -> int:
    rate = np.nan_to_num(moves.c_feed, nan=-1.0, posinf=np.inf)
    if not len(rate) or rate.max() <= 0:
        return 0
    return int(trace.blocks.line_in_file[moves.row[int(np.argmax(rate))]])


@quiet
def points_of(moves: Moves) -> Points:
    """Return points along moves, at most one for each place in the picture [mm]."""
    ends = np.concatenate((moves.start, moves.end, np.zeros(1, complex)))
    ends = ends[np.isfinite(ends)]
    size = max(np.ptp(ends.real), np.ptp(ends.imag), float(np.nanmax(moves.farthest, initial=0.0)))
    is_known = np.isfinite(moves.length) & np.isfinite(moves.start) & np.isfinite(moves.end)
    length = np.where(is_known, moves.length, 0.0)
    step = max(size / _DOTS, float(length.sum()) / _MOST, np.finfo(float).tiny)
    count = np.where(is_known, np.ceil(length / step).astype(np.int64) + 1, 0)
    point = moves.points(*_shares(count))
    cell = np.round(point.real / step) + 1j * np.round(point.imag / step)
    return np.asarray(point[np.unique(cell, return_index=True)[1]])


def _shares(count: Rows) -> tuple[Rows, Floats]:
    """Return `count` places on each move: the move, and the share of its length, from 0 to 1."""
    move, number = ranges(count)
    return move, number / np.maximum(count - 1, 1)[move]


@quiet
def _curve(moves: Moves) -> tuple[Floats, Floats]:
    """
    Return times [s] and the absolute rate of C [deg/min], with the highest rate of each short interval.

    The rate is the average between two places of a move; the highest of them is replaced by the highest of the move.
    """
    time = moves.time
    if not len(time) or not np.isfinite(time).all():
        return np.zeros(0), np.zeros(0)
    whole = float(time.sum())
    count = np.minimum(np.ceil(time / max(whole / _INSTANTS, np.finfo(float).tiny)) * 4, 4 * _INSTANTS)
    count = np.maximum(count.astype(np.int64), 1) + 1
    move, share = _shares(count)
    begin = np.cumsum(time) - time
    point = moves.points(move, share)
    turn = np.abs(np.angle(point[1:] * np.conj(point[:-1])))
    between = np.diff(share) * time[move[:-1]]
    rate = np.degrees(np.append(turn / between, 0.0)) * 60
    last = last_in_run(move)
    rate[last] = np.append(0.0, rate[:-1])[last]
    rate = np.where(moves.c_feed[move] == 0, 0.0, np.minimum(rate, moves.c_feed[move]))
    order = np.lexsort((rate, move))
    rate[order[last_in_run(move[order])]] = moves.c_feed
    time_of_point = begin[move] + share * time[move]
    instant = np.floor(time_of_point / whole * _INSTANTS) if whole > 0 else np.zeros(len(time_of_point))
    order = np.lexsort((rate, instant))
    chosen = np.sort(order[last_in_run(instant[order])])
    return time_of_point[chosen], rate[chosen]


def _legend(view: SectionView, dots: bool) -> Iterator[str]:
    first, second = ("\u2812\u2812", "\u00b7\u00b7") if dots else ("oo", "..")
    if len(view.tool):
        yield f"{first} tool center  {second} contour as programmed"
    else:
        yield f"{first} contour as programmed; no path of the tool is known"
    marks = "  x end of a block with a finding" if len(view.marks) else ""
    yield f"+ spindle center, C0 to the right{marks}"
    points = np.concatenate((view.programmed, view.tool, view.marks, np.zeros(1, complex)))
    yield f"shown: {np.ptp(points.real):.3f} x {np.ptp(points.imag):.3f} mm"


def _rate(view: SectionView) -> str:
    """Return the range of the strip in numbers."""
    rates = view.rate[~np.isnan(view.rate)]
    if not len(rates):
        return "rate of C over time: not known"
    limit = "no limit given" if np.isnan(view.limit) else f"limit {view.limit:.0f}"
    if not view.highest_line:
        return f"C does not turn ({limit})"
    highest = f"at most {rates.max():.0f} deg/min" if np.isfinite(rates.max()) else "without bound, through the center,"
    return f"rate of C over {view.time[-1]:.0f} s on the plane: {highest} in line {view.highest_line} ({limit})"
