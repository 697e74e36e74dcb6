"""Of many files: a line for each finding, one over all files, and what shows one of them in full."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from polarcheck.reading.excerpt import visible
from polarcheck.reading.files import STANDARD_INPUT
from polarcheck.reports import Background, Parts, of_each, painted
from polarcheck.reports.concise import lines
from polarcheck.reports.text import summary

if TYPE_CHECKING:
    from polarcheck.finding import FileReport, Report

_FULL = {"fail": "What is wrong with one of them, in full", "unverified": "Why one of them is unverified"}


def short(report: Report, background: Background) -> str:
    """The lines of `concise`, then the summary, then a command for a file that fails and for one that is unverified."""
    return "".join(short_pieces(report, background))


def short_pieces(report: Report, background: Background) -> Iterator[str]:
    """The same, file by file."""
    return of_each(short_parts(background), report, background)


def short_parts(background: Background) -> Parts:
    """The same, of files as they are finished."""

    def of_file(file: FileReport, _: Mapping[int, str]) -> str:
        return "".join(text + "\n" for text in lines(file, background.silenced, background.color))

    return Parts(of_file, lambda report: "".join(text + "\n" for text in _end(report, background)))


def _end(report: Report, background: Background) -> Iterator[str]:
    if background.quiet or not report.files:
        return
    total = report.summary
    if total.errors or total.warnings or total.notes or (background.silenced and total.silenced):
        yield ""
    yield summary(report, background.fixed)
    for verdict, told in _FULL.items():
        of_verdict = (file.path for file in report.files if file.verdict == verdict and file.path != STANDARD_INPUT)
        path = next(of_verdict, None)
        if path is not None:
            name = f"./{path}" if path.startswith("-") else path
            full = visible(f"{told}: {background.command} {shlex.quote(name)}")
            yield painted("aside", full) if background.color else full
