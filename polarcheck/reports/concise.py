"""One line for each finding, as compilers write them: editors and hooks know where to jump to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.reading.excerpt import visible
from polarcheck.reports import painted

if TYPE_CHECKING:
    from polarcheck.checking.finding import FileReport, Finding, Report
    from polarcheck.reports import Background


def concise(report: Report, background: Background | None = None) -> str:
    """`path:line:column: severity: message [rule]`, nothing else."""
    return "".join(line(file, found) + "\n" for file in report.files for found in file.findings)


def line(file: FileReport, found: Finding, color: bool = False) -> str:
    """The line of a finding, with its severity in color where that is asked for."""
    severity = visible(found.severity)
    severity = painted(found.severity, severity) if color else severity
    channel = f"{found.channel}: " if found.channel else ""
    place = visible(f"{file.path}:{found.line}:{found.column}")
    message = visible(f"{channel}{found.message} [{found.rule}]")
    return f"{place}: {severity}: {message}"
