"""`polarcheck feeds`: the feed table as text, and what it costs; its curve as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator

from polarcheck.checking.quantity import rounded
from polarcheck.checking.tables import Tables
from polarcheck.feed_table.table import FeedReport, FeedRow, FeedTable, FeedTotal, highest
from polarcheck.machines.modal import MM_PER_INCH
from polarcheck.reading.excerpt import shortened, visible, without_commands
from polarcheck.table import dynamics as reasons
from polarcheck.table.dynamics import Dynamics
from polarcheck.table.feed_curve import FeedCurve, feed_curve
from polarcheck.table.highest_feeds import HighestFeeds
from polarcheck.table.trace import Trace

#: Characters of a block.
_BLOCK = 36
_CURVE = ("time", "section", "line", "feed", "true_feed", "highest", "c_feed", "channel")
#: What to do about a time that is not known.
_REMEDIES = {
    reasons.RAPIDS: "give limits.x_rapid, limits.z_rapid and limits.c_rapid, and where the tool stands before",
    reasons.RADIUS: "give the radius of the tool",
    reasons.PER_REVOLUTION: "the spindle that F depends on is the C axis, or its S is not known",
}


def text(report: FeedReport) -> str:
    """The tables of a file, for people, in the units of the program."""
    parts = []
    for table in report.tables:
        name = f"{visible(report.path)}{f' {table.channel}' if table.channel else ''}"
        parts.append("\n".join([f"{name} on {report.machine}: {_limits(table)}", *_table(table), *_totals(table)]))
    return without_commands("\n\n".join(parts) + "\n")


def _limits(table: FeedTable) -> str:
    limits = table.limits
    told = [f"C {_number(limits.c_feed, 0)} deg/min"]
    if not limits.c_feed_given:
        told = [f"limits.c_feed is not given, {told[0]} is taken, which is more than any C axis cuts with"]
    if limits.c_acceleration is not None:
        told.append(f"{_number(limits.c_acceleration, 0)} deg/s2")
    if limits.x_feed is not None:
        told.append(f"X {_feed(limits.x_feed, table)} {table.units}/min as a radius")
    if limits.polar_feed is not None:
        told.append(f"F in the mode {_feed(limits.polar_feed, table)} {table.units}/min")
    return ", ".join(told)


def _table(table: FeedTable) -> list[str]:
    if not table.rows:
        return ["no block cuts in the polar mode"]
    loads = any(row.chip_load is not None for row in table.rows)
    heads = ["line", "block", "F", "highest", "limited by", "allowed", "C deg/min", "s", "s then"]
    units = table.units
    lines = [[*heads, f"{units} per tooth"] if loads else heads]
    lines += [_cells(row, table, loads) for row in table.rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if at in (1, 4) else cell.rjust(width)
            for at, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    ]


def _cells(row: FeedRow, table: FeedTable, loads: bool) -> list[str]:
    runs = f" ({row.runs} runs)" if row.runs > 1 else ""
    allowed = "any" if row.allowed is None and row.limited_by == "programmed" else _feed(row.allowed, table)
    load = row.chip_load if row.chip_load is None else row.chip_load / _scale(table)
    return [
        str(row.line),
        shortened(visible(row.block), _BLOCK) + runs,
        _feed(row.feed, table),
        _feed(row.highest, table) + "*" * row.several,
        row.limited_by,
        allowed,
        _number(row.c_feed, 0),
        _number(row.time, 2),
        _number(row.highest_time, 2),
        *([_number(load, 4)] * loads),
    ]


def _totals(table: FeedTable) -> Iterator[str]:
    if any(row.several for row in table.rows):
        yield "* its runs have different F, or need it; this is the lowest"
    for one in table.sections:
        yield f"section of line {one.line}: {_cost(one, table)}"
    yield f"program: {_cost(table.program, table)}"


def _cost(total: FeedTotal, table: FeedTable) -> str:
    said = f"{total.time:.1f} s{' and what is not known' if total.unknown else ''}"
    said += f"; cutting {total.cutting:.1f} s, with this table {total.highest_cutting:.1f} s ({total.lost:+.1f} s)"
    if total.won:
        at = f"F{_feed(total.one_feed, table)}" if total.one_feed is not None else "one F in each section"
        said += f", with no more than {at} {total.one_feed_cutting:.1f} s ({total.won:.1f} s more than the table)"
    for one in total.unknown:
        blocks = f"{one.blocks} block{'s' * (one.blocks > 1)}"
        remedy = _REMEDIES.get(one.reason)
        said += f"\n  not known: {one.reason}, {blocks} from line {one.line}{f': {remedy}' if remedy else ''}"
    return said


def _scale(table: FeedTable) -> float:
    return MM_PER_INCH if table.units == "inch" else 1.0


def _feed(value: float | None, table: FeedTable) -> str:
    """F in the units of the program, with as many digits as messages have."""
    return "-" if value is None else _number(value / _scale(table), 4 if table.units == "inch" else 3)


def _number(value: float | None, digits: int) -> str:
    if value is None:
        return "-"
    shown = f"{value:.{digits}f}"
    return shown.rstrip("0").rstrip(".") if digits > 2 else shown


def curve(tables: Tables) -> Iterator[tuple[str | int | float | None, ...]]:
    """The curve of one run, a row in each moment; [s], [mm/min], [deg/min]."""
    trace: Trace = tables["trace"]
    runs: Dynamics = tables["dynamics"]
    feeds: HighestFeeds = tables["highest_feeds"]
    lowest, found = highest(trace, feeds), feed_curve(runs)
    for at, row in enumerate(found.row.tolist()):
        yield (*_moment(found, at, trace, row), rounded(lowest[row]), rounded(found.c_feed[at]), _channel(trace))


def _moment(found: FeedCurve, at: int, trace: Trace, row: int) -> tuple[str | int | float | None, ...]:
    place = int(trace.section[row]), int(trace.line_in_file[row])
    return rounded(found.time[at]), *place, rounded(trace.programmed_feed[row]), rounded(found.feed[at])


def _channel(trace: Trace) -> str:
    return str(trace.text.source.channel or "")


def as_csv(tables: list[Tables]) -> Iterator[str]:
    """The curves of a file, with a head."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(_CURVE)
    for one in tables:
        for row in curve(one):
            writer.writerow(["" if value is None else value for value in row])
            yield buffer.getvalue()
            buffer.seek(0)
            buffer.truncate()
    yield buffer.getvalue()


def is_empty(report: FeedReport) -> bool:
    """No program of the file has a section."""
    return not any(table.sections for table in report.tables)
