"""Of many files: a line for each finding, one over all files, and what shows one of them in full."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from typing import TYPE_CHECKING

from polarcheck.reading.excerpt import visible
from polarcheck.reading.files import STANDARD_INPUT
from polarcheck.reports import painted
from polarcheck.reports.concise import line
from polarcheck.reports.text import summary

if TYPE_CHECKING:
    from polarcheck.checking.finding import Report
    from polarcheck.reports import Background

_FULL = {"fail": "What is wrong with one of them, in full", "unverified": "Why one of them is unverified"}


def short(report: Report, background: Background) -> str:
    """The lines of `concise`, then the summary, then a command for a file that fails and for one that is unverified."""
    return "".join(text + "\n" for text in _lines(report, background))


def _lines(report: Report, background: Background) -> Iterator[str]:
    shown = [line(file, found, background.color) for file in report.files for found in file.findings]
    yield from shown
    if background.quiet or not report.files:
        return
    if shown:
        yield ""
    yield summary(report)
    for verdict, told in _FULL.items():
        paths = [file.path for file in report.files if file.verdict == verdict and file.path != STANDARD_INPUT]
        if paths:
            name = f"./{paths[0]}" if paths[0].startswith("-") else paths[0]
            full = visible(f"{told}: {background.command} {shlex.quote(name)}")
            yield painted("aside", full) if background.color else full
