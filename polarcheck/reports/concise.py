"""One line for each finding, as compilers write them: editors and hooks know where to jump to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.finding import UNREADABLE
from polarcheck.program.reading.excerpt import head, visible, without_commands
from polarcheck.reports import Background, Parts, painted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from polarcheck.foundation.finding import FileReport, Finding, Silenced


def concise_parts(background: Background) -> Parts:
    """`path:line:column: severity: message [rule]`, nothing else."""

    def of_file(file: FileReport, _: Mapping[int, str]) -> str:
        return "".join(text + "\n" for text in lines(file, background.silenced))

    return Parts(of_file, lambda report: "")


def lines(file: FileReport, silenced: bool, color: bool = False) -> Iterator[str]:
    """Yield the lines of the findings of a file, or why it is unreadable; silenced: those of silenced findings, too."""
    if file.verdict == UNREADABLE:
        yield unreadable_line(file, color)
    yield from (line(file, finding, color) for finding in file.findings)
    for finding in file.silenced if silenced else ():
        # In a form that the patterns of editors do not match.
        yield without_commands(f"{_location(file.path, finding)}: silenced: {why_silenced(finding)}")


def unreadable_line(file: FileReport, color: bool = False) -> str:
    """Return the line of a file that could not be read or checked."""
    severity = painted("error", "error") if color else "error"
    return without_commands(f"{head(file.path)}:1:1: {severity}: {visible(f'{file.reason} [{UNREADABLE}]')}")


def why_silenced(finding: Silenced) -> str:
    """Return one line on a silenced finding: its message, what silences it, and why."""
    reason = f": {finding.reason}" if finding.reason else ", no reason given"
    return visible(f"{finding.severity}: {finding.full_message} [{finding.rule}] (by {finding.by}{reason})")


def line(file: FileReport, finding: Finding, color: bool = False) -> str:
    """Return the line of a finding; color: paint its severity."""
    severity = visible(finding.severity)
    severity = painted(finding.severity, severity) if color else severity
    message = visible(f"{finding.full_message} [{finding.rule}]")
    return without_commands(f"{_location(file.path, finding)}: {severity}: {message}")


def _location(path: str, finding: Finding | Silenced) -> str:
    """Return the position of a finding."""
    return f"{head(path)}:{finding.line}:{finding.column}"
