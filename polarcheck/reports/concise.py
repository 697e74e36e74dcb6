"""One line for each finding, as compilers write them: editors and hooks know where to jump to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.reading.excerpt import visible, without_commands
from polarcheck.reports import Background, Parts, of_each, painted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from polarcheck.finding import FileReport, Finding, Report, Silenced


def concise(report: Report, background: Background | None = None) -> str:
    """`path:line:column: severity: message [rule]`, nothing else."""
    return "".join(concise_pieces(report, background or Background()))


def concise_pieces(report: Report, background: Background) -> Iterator[str]:
    """The same, file by file."""
    return of_each(concise_parts(background), report, background)


def concise_parts(background: Background) -> Parts:
    """The same, of files as they are finished."""

    def of_file(file: FileReport, _: Mapping[int, str]) -> str:
        return "".join(text + "\n" for text in lines(file, background.silenced))

    return Parts(of_file, lambda report: "")


def lines(file: FileReport, silenced: bool, color: bool = False) -> Iterator[str]:
    """The lines of the findings of a file, and those of what is silenced where that is asked for."""
    yield from (line(file, found, color) for found in file.findings)
    yield from (silenced_line(file, found) for found in file.silenced if silenced)


def silenced_line(file: FileReport, found: Silenced) -> str:
    """The line of a finding that is silenced; no pattern of an editor takes it for one that is told."""
    return without_commands(f"{_place(file.path, found)}: silenced: {why_silenced(found)}")


def why_silenced(found: Silenced) -> str:
    """What is silenced, by what, and why: in one line."""
    reason = f": {found.reason}" if found.reason else ", no reason given"
    return visible(f"{found.severity}: {found.told} [{found.rule}] (by {found.by}{reason})")


def line(file: FileReport, found: Finding, color: bool = False) -> str:
    """The line of a finding, with its severity in color where that is asked for."""
    severity = visible(found.severity)
    severity = painted(found.severity, severity) if color else severity
    message = visible(f"{found.told} [{found.rule}]")
    return without_commands(f"{_place(file.path, found)}: {severity}: {message}")


def _place(path: str, found: Finding | Silenced) -> str:
    """Where a finding stands; a path that would begin a command of a CI log is written from its folder on."""
    own = f"./{path}" if path.lstrip().startswith("::") else path
    return visible(f"{own}:{found.line}:{found.column}")
