"""One report of the channels of a file, in which everything says to which of them it belongs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from operator import attrgetter
from typing import TYPE_CHECKING, TypeVar

from msgspec.structs import replace

from polarcheck.foundation.finding import FileReport, Finding, NotEvaluated, PolarSection
from polarcheck.program.reading.channel_texts import stands_in
from polarcheck.program.reading.source import Source

if TYPE_CHECKING:
    from polarcheck.rules.tables import Tables

Part = TypeVar("Part", NotEvaluated, PolarSection)
AnyFinding = TypeVar("AnyFinding", bound=Finding)

_Reports = Sequence[tuple[Source, FileReport]]


def first_runs(runs: Sequence[tuple[str, Tables]]) -> list[tuple[str, Tables]]:
    """The first run of each channel of a file (check.read), which has block skip off."""
    first: dict[str, tuple[str, Tables]] = {}
    for state, tables in runs:
        first.setdefault(tables["text"].source.channel, (state, tables))
    return list(first.values())


def united(reports: _Reports) -> FileReport:
    """
    Join the reports of the channels, each with its view of the file, to one.

    A finding belongs to the channel in which its line stands, whichever runs it, and is listed once. One before the
    first mark of a channel belongs to none, if all of them have it.
    """
    (_, first), *_ = reports
    sections = _joined(reports, attrgetter("polar_sections"))
    return replace(
        first,
        programs=list(dict.fromkeys(chain.from_iterable(report.programs for _, report in reports))),
        blocks=sum(report.blocks for _, report in reports),
        sections=sum(report.sections for _, report in reports),
        polar_sections=sorted(sections, key=lambda section: section.line),
        findings=list(_once(reports, attrgetter("findings"))),
        silenced=list(_once(reports, attrgetter("silenced"))),
        not_evaluated=list(_joined(reports, attrgetter("not_evaluated"))),
        looked_at=max((report.looked_at for _, report in reports), key=len),
    )


def _once(reports: _Reports, findings: Callable[[FileReport], Sequence[AnyFinding]]) -> Iterator[AnyFinding]:
    counts = Counter(_key(entry) for _, report in reports for entry in findings(report))
    listed: set[tuple[object, ...]] = set()
    for source, report in reports:
        for entry in findings(report):
            key = _key(entry)
            if key in listed:
                continue
            listed.add(key)
            owners = [
                report_of_channel.channel
                for report_of_channel, _ in reports
                if stands_in(report_of_channel, entry.line)
            ]
            if len(owners) == 1:
                yield _of_channel(entry, owners[0])
            else:
                yield entry if counts[key] == len(reports) else _of_channel(entry, source.channel)


def _of_channel(entry: AnyFinding, name: str) -> AnyFinding:
    return replace(entry, channel=name, follows=[_of_channel(follower, name) for follower in entry.follows])


def _key(entry: Finding) -> tuple[object, ...]:
    return entry.rule, entry.line, entry.column, entry.message


def _joined(reports: _Reports, parts: Callable[[FileReport], Sequence[Part]]) -> Iterator[Part]:
    """The entries of one kind in all reports, each with the name of its channel."""
    for source, report in reports:
        for part in parts(report):
            yield replace(part, channel=source.channel)
