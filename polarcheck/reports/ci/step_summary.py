"""The page that GitHub Actions shows of a job, in Markdown: counts by rule, and the findings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from polarcheck.reading.excerpt import visible
from polarcheck.reports import SEVERITIES, counted
from polarcheck.reports.ci.paths import from_root
from polarcheck.reports.pages.statistics import counts
from polarcheck.reports.text import summary

if TYPE_CHECKING:
    from polarcheck.finding import Report
    from polarcheck.reports import Background

#: Bytes of the pages of all steps before it and of this one that GitHub takes.
LARGEST = 1024 * 1024
#: Bytes for the line that says how much is left out.
_FOR_THE_REST = 200
#: What means something to Markdown inside a line, and what makes a link of an address or of a name.
_MARKS = {ord(mark): f"\\{mark}" for mark in "\\`*_~<>&[]|#$!@:."}


def step_summary(report: Report, background: Background, room: int = LARGEST) -> str:
    """The page, cut between two findings where it would be longer than so many bytes; empty where there is no room."""
    pieces: list[str] = []
    left = room - _FOR_THE_REST
    lines = list(_lines(report, background))
    for number, piece in enumerate(lines):
        left -= len(piece.encode())
        if left < 0:
            if pieces:
                pieces.append(f"\n{counted(len(lines) - number, 'line')} more: this page takes no more than 1 MiB.\n")
            break
        pieces.append(piece)
    return "".join(pieces)


def _lines(report: Report, background: Background) -> Iterator[str]:
    yield f"### polarcheck\n\n{_cell(summary(report))}\n" if report.files else "### polarcheck\n\nno files checked\n"
    found = [one for one in counts(report) if one.findings]
    if found:
        yield "\n| findings | files | severity | rule |\n|---:|---:|---|---|\n"
        yield from (f"| {one.findings} | {one.files} | {_cell(one.severity)} | {_cell(one.rule)} |\n" for one in found)
    ranks = {severity: rank for rank, severity in enumerate(SEVERITIES)}
    all_found = [(file, one) for file in report.files for one in file.findings]
    all_found.sort(key=lambda one: ranks.get(one[1].severity, len(ranks)))
    if all_found:
        yield "\n| severity | where | what | rule |\n|---|---|---|---|\n"
    for file, one in all_found:
        place = f"{from_root(file.path, background)}:{one.line}"
        yield f"| {_cell(one.severity)} | {_cell(place)} | {_cell(one.message)} | {_cell(one.rule)} |\n"
    gaps = list(
        dict.fromkeys(
            (gap.reason, from_root(file.path, background))
            for file in report.files
            for gap in file.not_evaluated
            if gap.matters
        )
    )
    if gaps:
        yield "\n| not evaluated | where |\n|---|---|\n"
    yield from (f"| {_cell(reason)} | {_cell(path)} |\n" for reason, path in gaps)
    if background.failures:
        yield "\n| not checked |\n|---|\n"
    yield from (f"| {_cell(failure)} |\n" for failure in background.failures)


def _cell(text: str) -> str:
    """Text in which nothing means anything to Markdown or HTML."""
    return visible(text).translate(_MARKS)
