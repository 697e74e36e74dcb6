"""The report of many files: a line for each finding, a summary, and a command that shows one file in full."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from polarcheck.program.reading.excerpt import visible
from polarcheck.program.reading.files import STANDARD_INPUT
from polarcheck.reports import Background, Parts, painted, settings_lines
from polarcheck.reports.concise import lines
from polarcheck.reports.text import summary

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, Report

_FULL = {"fail": "What is wrong with one of them, in full", "unverified": "Why one of them is unverified"}


def short_parts(background: Background) -> Parts:
    """Return the lines of `concise`, the summary, and a command for a failing file and for an unverified one."""

    def of_file(file: FileReport, _: Mapping[int, str]) -> str:
        return "".join(text + "\n" for text in lines(file, background.silenced, background.color))

    return Parts(of_file, lambda report: "".join(text + "\n" for text in _end(report, background)))


def _end(report: Report, background: Background) -> Iterator[str]:
    if background.quiet or not report.files:
        return
    total = report.summary
    counts = total.errors, total.warnings, total.notes, total.unreadable, background.silenced and total.silenced
    if any(counts):
        yield ""
    yield from settings_lines(report)
    yield summary(report, background.fixed)
    for verdict, label in _FULL.items():
        of_verdict = (file.path for file in report.files if file.verdict == verdict and file.path != STANDARD_INPUT)
        path = next(of_verdict, None)
        if path is not None:
            name = f"./{path}" if path.startswith("-") else path
            full = visible(f"{label}: {background.command} {shlex.quote(name)}")
            yield painted("aside", full) if background.color else full
