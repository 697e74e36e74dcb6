"""Checkstyle's XML, which Jenkins, SonarQube and reviewdog read from any linter."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from polarcheck.reports.ci import xml
from polarcheck.reports.ci.paths import from_root

if TYPE_CHECKING:
    from polarcheck.finding import FileReport, Report
    from polarcheck.reports import Background

_SEVERITIES = {"error": "error", "warning": "warning", "note": "info"}


def checkstyle(report: Report, background: Background) -> str:
    """Return an element for each file, including files without findings."""
    return "".join(checkstyle_pieces(report, background))


def checkstyle_pieces(report: Report, background: Background) -> Iterator[str]:
    """Yield the same text file by file."""
    yield xml.HEAD
    files = (line for file in report.files for line in _file(file, background))
    yield from xml.element("checkstyle", {"version": "4.3"}, files)


def _file(file: FileReport, background: Background) -> Iterator[str]:
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
    return xml.element("file", {"name": from_root(file.path, background)}, errors, depth=1)
