"""Checkstyle's XML, which Jenkins, SonarQube and reviewdog read from any linter."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING

from msgspec import UNSET

from polarcheck.foundation.finding import UNREADABLE
from polarcheck.reports.ci import xml
from polarcheck.reports.ci.repository_paths import from_root

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, Report
    from polarcheck.reports import Background

_SEVERITIES = {"error": "error", "warning": "warning", "note": "info"}


def checkstyle(report: Report, background: Background) -> str:
    """Return an element for each file, including files without findings."""
    return "".join(checkstyle_pieces(report, background))


def checkstyle_pieces(report: Report, background: Background) -> Iterator[str]:
    """Yield the same text file by file."""
    yield xml.HEAD
    files = chain((line for file in report.files for line in _file(file, background)), _interrupted(report, background))
    yield from xml.element("checkstyle", {"version": "4.3"}, files)


def _interrupted(report: Report, background: Background) -> Iterator[str]:
    if report.interrupted is not UNSET:
        path = from_root(report.interrupted.next_path or ".", background)
        yield from xml.element("file", {"name": path}, _failure("interrupted", report.interrupted.reason), depth=1)


def _failure(name: str, reason: str) -> Iterator[str]:
    """Yield the element of a file that was not checked; without it the file would look clean."""
    attributes: dict[str, str | int] = {"line": 1, "column": 1, "severity": "error", "message": reason}
    return xml.element("error", {**attributes, "source": f"polarcheck.{name}"}, depth=2)


def _file(file: FileReport, background: Background) -> Iterator[str]:
    path: dict[str, str | int] = {"name": from_root(file.path, background)}
    if file.verdict == UNREADABLE:
        return xml.element("file", path, _failure(UNREADABLE, file.reason or ""), depth=1)
    errors = (
        line
        for finding in file.findings
        for line in xml.element(
            "error",
            {
                "line": finding.line,
                "column": finding.column,
                "severity": _SEVERITIES.get(finding.severity, "info"),
                "message": finding.full_message,
                "source": f"polarcheck.{finding.rule}",
            },
            depth=2,
        )
    )
    return xml.element("file", path, errors, depth=1)
