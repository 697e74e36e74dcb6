"""`polarcheck feeds`: the feed table and its times as text; the feed curve as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator

from polarcheck.columns.feed import dynamics as reasons
from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.columns.feed.feed_curve import feed_curve
from polarcheck.columns.feed.highest_feeds import HighestFeeds
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.reading.excerpt import head, shortened, visible
from polarcheck.rewrite.feeds.table import FeedReport, FeedRow, FeedTable, FeedTotal, highest
from polarcheck.rules.quantity import rounded
from polarcheck.rules.tables import Tables

#: The longest text of a block in the table [characters].
_BLOCK = 36
#: Smaller differences of times are none [s]: they are shown with one digit.
_SHOWN = 0.05
#: The columns of the curve.
_CURVE = ("time", "section", "line", "feed", "true_feed", "highest", "c_feed", "channel")
#: What to do about an unknown time.
_REMEDIES = {
    reasons.RAPIDS: "give limits.x_rapid, limits.z_rapid and limits.c_rapid, and where the tool stands before",
    reasons.RADIUS: "give the radius of the tool",
    reasons.PER_REVOLUTION: "the spindle that F depends on is the C axis, or its S is not known",
    reasons.DWELL: "feed.dwell_words of the machine says which words are a dwell, and in which unit",
}


def text(report: FeedReport) -> str:
    """Return the tables of a file, for people, in the units of the program."""
    parts = []
    for table in report.tables:
        name = f"{head(report.path)}{f' {table.channel}' if table.channel else ''}"
        parts.append(
            "\n".join([f"{name} on {visible(report.machine)}: {_limits(table)}", *_table(table), *_totals(table)])
        )
    return "\n\n".join(parts) + "\n"


def _limits(table: FeedTable) -> str:
    limits = table.limits
    facts = [f"C {_number(limits.c_feed, 0)} deg/min"]
    if not limits.c_feed_given:
        facts = [f"limits.c_feed is not given, {facts[0]} is taken, which is more than any C axis cuts with"]
    if limits.c_acceleration is not None:
        facts.append(f"{_number(limits.c_acceleration, 0)} deg/s2")
    if limits.x_feed is not None:
        facts.append(f"X {_feed(limits.x_feed, table)} {table.units}/min as a radius")
    if limits.x_acceleration is not None:
        facts.append(f"{_number(limits.x_acceleration, 0)} mm/s2")
    if limits.polar_feed is not None:
        facts.append(f"F in the mode {_feed(limits.polar_feed, table)} {table.units}/min")
    return ", ".join(facts)


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
            cell.ljust(width) if index in (1, 4) else cell.rjust(width)
            for index, (cell, width) in enumerate(zip(line, widths, strict=True))
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
        yield "* its runs have, or need, different F; this is the lowest"
    for section in table.sections:
        yield f"section of line {section.line}: {_cost(section, table)}"
    yield f"program: {_cost(table.program, table)}"


def _cost(total: FeedTotal, table: FeedTable) -> str:
    """Return the times of a section or program, what the table would change, and why a time is not known."""
    text = f"takes {total.time:.1f} s{' and a time that is not known' if total.unknown else ''}"
    change = (
        f"{abs(total.lost):.1f} s {'more' if total.lost > 0 else 'less'}" if abs(total.lost) >= _SHOWN else "the same"
    )
    text += f"; cutting takes {total.cutting:.1f} s, or {total.highest_cutting:.1f} s with F of this table ({change})"
    if total.won:
        limit = (
            "one F in each section" if total.one_feed is None else f"F{_feed(total.one_feed, table)} for all cutting"
        )
        text += f", or {total.one_feed_cutting:.1f} s with {limit} ({total.won:.1f} s more than with this table)"
    for gap in total.unknown:
        blocks = f"{gap.blocks} block{'s' * (gap.blocks > 1)}"
        remedy = _REMEDIES.get(gap.reason)
        text += f"\n  not known: {gap.reason}, {blocks} from line {gap.line}{f': {remedy}' if remedy else ''}"
    return text


def _scale(table: FeedTable) -> float:
    """Return mm per unit of length of the program."""
    return MM_PER_INCH if table.units == "inch" else 1.0


def _feed(value: float | None, table: FeedTable) -> str:
    """Return F in the units of the program, with the same digits as in messages."""
    return "-" if value is None else _number(value / _scale(table), 4 if table.units == "inch" else 3)


def _number(value: float | None, digits: int) -> str:
    if value is None:
        return "-"
    text = f"{value:.{digits}f}"
    return text.rstrip("0").rstrip(".") if digits > 2 else text


def curve(tables: Tables) -> Iterator[tuple[str | int | float | None, ...]]:
    """Yield the curve of one run, a row of _CURVE for each point in time; [s], [mm/min], [deg/min]."""
    trace: Trace = tables["trace"]
    runs: Dynamics = tables["dynamics"]
    feeds: HighestFeeds = tables["highest_feeds"]
    lowest, points, channel = highest(trace, feeds), feed_curve(runs), str(trace.text.source.channel or "")
    for index, row in enumerate(points.row.tolist()):
        yield (
            rounded(points.time[index]),
            int(trace.mode.section[row]),
            trace.line(row),
            rounded(trace.feedrate.programmed_feed[row]),
            rounded(points.feed[index]),
            rounded(lowest[row]),
            rounded(points.c_feed[index]),
            channel,
        )


def as_csv(tables: list[Tables]) -> Iterator[str]:
    """Yield the curves of a file as CSV, with a line of column names."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(_CURVE)
    for run in tables:
        for row in curve(run):
            writer.writerow(["" if value is None else value for value in row])
            yield buffer.getvalue()
            buffer.seek(0)
            buffer.truncate()
    yield buffer.getvalue()


def is_empty(report: FeedReport) -> bool:
    """Return True if no program of the file has a section."""
    return not any(table.sections for table in report.tables)
