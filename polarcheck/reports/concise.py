"""One line for each finding, as compilers write them: editors and hooks know where to jump to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.reading.excerpt import visible
from polarcheck.reports import Background, Parts, of_each, painted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from polarcheck.checking.finding import FileReport, Finding, Report


def concise(report: Report, background: Background | None = None) -> str:
    """`path:line:column: severity: message [rule]`, nothing else."""
    return "".join(concise_pieces(report, background or Background()))


def concise_pieces(report: Report, background: Background) -> Iterator[str]:
    """The same, file by file."""
    return of_each(concise_parts(background), report, background)


def concise_parts(background: Background) -> Parts:
    """The same, of files as they are finished."""

    def of_file(file: FileReport, lines: Mapping[int, str]) -> str:
        return "".join(line(file, found) + "\n" for found in file.findings)

    return Parts(of_file, lambda report: "")


def line(file: FileReport, found: Finding, color: bool = False) -> str:
    """The line of a finding, with its severity in color where that is asked for."""
    severity = visible(found.severity)
    severity = painted(found.severity, severity) if color else severity
    channel = f"{found.channel}: " if found.channel else ""
    place = visible(f"{file.path}:{found.line}:{found.column}")
    message = visible(f"{channel}{found.message} [{found.rule}]")
    return f"{place}: {severity}: {message}"
