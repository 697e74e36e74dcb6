"""The summary page of a GitHub Actions job, in Markdown: counts by rule, and the findings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from msgspec import UNSET

from polarcheck.foundation.errors import counted
from polarcheck.foundation.finding import UNREADABLE
from polarcheck.program.reading.excerpt import visible
from polarcheck.reports import SEVERITIES, settings_lines
from polarcheck.reports.ci.repository_paths import from_root
from polarcheck.reports.pages.statistics import counts
from polarcheck.reports.text import summary

if TYPE_CHECKING:
    from polarcheck.foundation.finding import Report
    from polarcheck.reports import Background

#: The largest page that GitHub accepts, all steps together [bytes].
LARGEST = 1024 * 1024
#: Room for the line that says how much is left out [bytes].
_FOR_THE_REST = 200
#: Characters with a meaning in a line of Markdown, and those that would make a link of an address or a name.
_MARKS = {ord(mark): f"\\{mark}" for mark in "\\`*_~<>&[]|#$!@:."}


def step_summary(report: Report, background: Background, room: int = LARGEST) -> str:
    """Return the page, cut between two findings to fit into `room` [bytes]; empty if there is no room."""
    pieces: list[str] = []
    remaining = room - _FOR_THE_REST
    lines = list(_lines(report, background))
    for number, piece in enumerate(lines):
        remaining -= len(piece.encode())
        if remaining < 0:
            if pieces:
                pieces.append(f"\n{counted(len(lines) - number, 'line')} more: this page takes no more than 1 MiB.\n")
            break
        pieces.append(piece)
    return "".join(pieces)


def _lines(report: Report, background: Background) -> Iterator[str]:
    yield f"### polarcheck\n\n{_cell(summary(report))}\n" if report.files else "### polarcheck\n\nno files checked\n"
    yield from (f"\n{_cell(line)}\n" for line in settings_lines(report))
    rows = [entry for entry in counts(report) if entry.findings]
    if rows:
        yield "\n| findings | files | severity | rule |\n|---:|---:|---|---|\n"
        yield from (
            f"| {entry.findings} | {entry.files} | {_cell(entry.severity)} | {_cell(entry.rule)} |\n" for entry in rows
        )
    ranks = {severity: rank for rank, severity in enumerate(SEVERITIES)}
    findings = [(file, entry) for file in report.files for entry in file.findings]
    findings.sort(key=lambda entry: ranks.get(entry[1].severity, len(ranks)))
    if findings:
        yield "\n| severity | where | what | rule |\n|---|---|---|---|\n"
    for file, entry in findings:
        location = f"{from_root(file.path, background)}:{entry.line}"
        yield f"| {_cell(entry.severity)} | {_cell(location)} | {_cell(entry.message)} | {_cell(entry.rule)} |\n"
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
    failures = [f"{file.path}: {file.reason}" for file in report.files if file.verdict == UNREADABLE]
    failures += [report.interrupted.reason] if report.interrupted is not UNSET else []
    if failures:
        yield "\n| not checked |\n|---|\n"
    yield from (f"| {_cell(failure)} |\n" for failure in failures)


def _cell(text: str) -> str:
    """Return text without a character that has a meaning in Markdown or HTML."""
    return visible(text).translate(_MARKS)
