"""What a terminal shows of a polar section: the points that its paths run through, and the rate of C over time."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.arrays import Floats, Points, Rows
from polarcheck.checking.channels import first_runs
from polarcheck.checking.polar_sections import polar_sections
from polarcheck.checking.tables import Tables
from polarcheck.errors import TooHardError
from polarcheck.finding import FileReport
from polarcheck.geometry.plane import arc_sweep, quiet
from polarcheck.machines.modal import Motion
from polarcheck.table.moves import Moves, programmed_moves
from polarcheck.table.tool_center import ToolCenter
from polarcheck.table.trace import Trace

#: Points lie no further apart than this share of the picture, which has fewer dots.
_DOTS = 400
#: So many points are looked at for a path, besides two for each move.
_MOST = 400_000
#: Sections of a run that are shown.
_SECTIONS = 12
#: Instants of the curve; a terminal has fewer columns.
_INSTANTS = 400


class SectionView(msgspec.Struct, frozen=True, kw_only=True):
    """
    One polar section.

    title: its lines and tool. programmed, tool: points of the paths [mm], in no order; tool is empty where the path is
    not known. marks: where blocks with findings end. time [s], rate [deg/min]: the curve of C, rising in time; inf
    through the center, NaN not known. limit [deg/min], NaN without one. highest_line: of the block with the highest
    rate, 0 where C does not turn. remarks: what is not shown, and why.
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


class ViewedReport(FileReport, frozen=True, kw_only=True):
    """A report with what a terminal shows of its sections."""

    views: list[SectionView]


def with_views(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """The report with the views of its sections; of two runs with block skip those of the first."""
    lines = {found.line for found in report.findings}
    channels = sorted((tables for _, tables in first_runs(runs)), key=_channel)
    views = [view for tables in channels for view in views_of(tables, lines)]
    fields = {name: getattr(report, name) for name in FileReport.__struct_fields__}
    return ViewedReport(**fields, views=views)


def _channel(tables: Tables) -> str:
    return tables["text"].source.channel or ""


def views_of(tables: Tables, lines: Collection[int] = ()) -> Iterator[SectionView]:
    """The first sections of a run. lines: those that are marked, of the file."""
    trace: Trace = tables["trace"]
    told = polar_sections(tables)
    if not told:
        return
    tool_center: ToolCenter = tables["tool_center"]
    try:
        moves = tool_center.moves
    except TooHardError:
        return
    programmed = programmed_moves(trace)
    is_marked = np.isin(trace.line_in_file, np.array(sorted(lines), np.int64))
    for number, section in enumerate(told[:_SECTIONS]):
        offset = "" if section.offset is None else f", offset {section.offset}"
        channel = f"{trace.text.source.channel}: " if trace.text.source.channel else ""
        own = moves.chosen(moves.section == number)
        remarks = [_NO_RADIUS] if not own.is_of_tool.all() else []
        if number + 1 == _SECTIONS < len(told):
            remarks.append(f"{len(told) - _SECTIONS} more sections are not shown")
        time, rate = _curve(own)
        marks = trace.end[is_marked & (trace.section == number)]
        yield SectionView(
            title=f"{channel}section of lines {section.line} to {section.end_line}{offset}",
            programmed=points_of(programmed.chosen(programmed.section == number)),
            tool=points_of(own.chosen(own.is_of_tool)),
            marks=marks[np.isfinite(marks)],
            time=time,
            rate=rate,
            limit=float(trace.machine.limits.c_feed),
            highest_line=_highest_line(trace, own),
            remarks=remarks,
        )


_NO_RADIUS = "what is run with G41 or G42 is shown as programmed, not as the tool runs: R, or a position, is not known"


def _highest_line(trace: Trace, moves: Moves) -> int:
    rate = np.nan_to_num(moves.c_feed, nan=-1.0, posinf=np.inf)
    if not len(rate) or rate.max() <= 0:
        return 0
    return int(trace.line_in_file[moves.row[int(np.argmax(rate))]])


@quiet
def points_of(moves: Moves) -> Points:
    """Points along some moves, of those at one place in the picture one [mm]."""
    ends = np.concatenate((moves.start, moves.end, np.zeros(1, complex)))
    ends = ends[np.isfinite(ends)]
    size = max(np.ptp(ends.real), np.ptp(ends.imag), float(np.nanmax(moves.farthest, initial=0.0)))
    known = np.isfinite(moves.length) & np.isfinite(moves.start) & np.isfinite(moves.end)
    length = np.where(known, moves.length, 0.0)
    step = max(size / _DOTS, float(length.sum()) / _MOST, np.finfo(float).tiny)
    count = np.where(known, np.ceil(length / step).astype(np.int64) + 1, 0)
    move, share = _shares(count)
    found = _along(moves, move, share)
    place = np.round(found.real / step) + 1j * np.round(found.imag / step)
    return np.asarray(found[np.unique(place, return_index=True)[1]])


def _shares(count: Rows) -> tuple[Rows, Floats]:
    """So many places on each move: the move, and the share of its way, from 0 to 1."""
    move = np.repeat(np.arange(len(count)), count)
    place = np.arange(len(move)) - np.repeat(np.cumsum(count) - count, count)
    return move, place / np.maximum(count - 1, 1)[move]


def _along(moves: Moves, move: Rows, share: Floats) -> Points:
    """The points at these shares of the way of moves [mm]."""
    start, end, center, kind = moves.start[move], moves.end[move], moves.center[move], moves.kind[move]
    is_arc = np.isin(kind, (Motion.CW, Motion.CCW)) & ~np.isnan(center)
    point = start + share * (end - start)
    sweep = arc_sweep(start[is_arc], end[is_arc], center[is_arc], kind[is_arc])
    point[is_arc] = center[is_arc] + (start - center)[is_arc] * np.exp(1j * sweep * share[is_arc])
    return np.asarray(point)


@quiet
def _curve(moves: Moves) -> tuple[Floats, Floats]:
    """
    Time [s] and |C rate| [deg/min] at places along the moves, of the highest in each short time one.

    The rate is that of C between two places of a move; where it is highest stands the highest of the move.
    """
    time = moves.time
    if not len(time) or not np.isfinite(time).all():
        return np.zeros(0), np.zeros(0)
    whole = float(time.sum())
    count = np.minimum(np.ceil(time / max(whole / _INSTANTS, np.finfo(float).tiny)) * 4, 4 * _INSTANTS)
    count = np.maximum(count.astype(np.int64), 1) + 1
    move, share = _shares(count)
    begin = np.cumsum(time) - time
    point = _along(moves, move, share)
    turn = np.abs(np.angle(point[1:] * np.conj(point[:-1])))
    between = np.diff(share) * time[move[:-1]]
    rate = np.degrees(np.append(turn / between, 0.0)) * 60
    last = np.append(np.diff(move) != 0, True)
    rate[last] = np.append(0.0, rate[:-1])[last]
    rate = np.where(moves.c_feed[move] == 0, 0.0, np.minimum(rate, moves.c_feed[move]))
    order = np.lexsort((rate, move))
    rate[order[np.append(np.diff(move[order]) != 0, True)]] = moves.c_feed
    at = begin[move] + share * time[move]
    instant = np.floor(at / whole * _INSTANTS) if whole > 0 else np.zeros(len(at))
    order = np.lexsort((rate, instant))
    chosen = np.sort(order[np.append(np.diff(instant[order]) != 0, True)])
    return at[chosen], rate[chosen]
