"""Workflow commands for GitHub Actions: annotations at the lines of a pull request, and findings for the log."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from msgspec import UNSET

from polarcheck.foundation.errors import counted
from polarcheck.foundation.finding import UNREADABLE
from polarcheck.program.reading.excerpt import visible
from polarcheck.program.reading.files import STANDARD_INPUT
from polarcheck.reports import SEVERITIES, settings_lines
from polarcheck.reports.ci.repository_paths import from_root
from polarcheck.reports.concise import line, unreadable_line
from polarcheck.reports.text import summary, verdict

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, Finding, Report
    from polarcheck.reports import Background

_LEVELS = {"error": "error", "warning": "warning", "note": "notice"}
#: How many annotations of a level GitHub shows per step.
MOST = 10


def github(report: Report, background: Background) -> str:
    """
    Return annotations, the worst first and no more than GitHub shows; then all findings, grouped by file, for the log;
    then a summary line, and a line on the findings without an annotation.
    """
    return "".join(text + "\n" for text in _lines(report, background))


def _lines(report: Report, background: Background) -> Iterator[str]:
    findings = [(file, finding) for file in report.files for finding in file.findings]
    ranks = {severity: rank for rank, severity in enumerate(SEVERITIES)}
    counts = Counter[str]()
    for file, finding in sorted(findings, key=lambda entry: ranks.get(entry[1].severity, len(ranks))):
        counts[_level(finding)] += 1
        if counts[_level(finding)] <= MOST:
            yield _annotation(file, finding, background)
    for name, reason, path in _not_checked(report):
        counts["error"] += 1
        if counts["error"] <= MOST:
            properties = {"title": name, **({"file": from_root(path, background)} if path else {})}
            yield _command("error", properties, reason)
    for file in report.files:
        texts = [unreadable_line(file)] if file.verdict == UNREADABLE else []
        texts += [line(file, finding) for finding in file.findings]
        texts += dict.fromkeys(visible(f"not evaluated: {gap.reason}") for gap in file.not_evaluated if gap.matters)
        if texts and not background.quiet:
            yield f"::group::{_data(visible(f'{file.path}: {verdict(file)}'))}"
            yield from (_plain(f"- {text}") for text in texts)
            yield "::endgroup::"
    if report.files and not background.quiet:
        yield from (_plain(f"polarcheck: {text}") for text in (*settings_lines(report), summary(report)))
    unlisted = {level: number - MOST for level, number in counts.items() if number > MOST}
    if unlisted:
        kinds = ", ".join(counted(number, level) for level, number in unlisted.items())
        where = "run without -q for all" if background.quiet else "the groups above hold all"
        yield f"polarcheck: {kinds} more without an annotation, of which GitHub shows {MOST} of a kind; {where}"


def _not_checked(report: Report) -> Iterator[tuple[str, str, str]]:
    """Yield name, reason and path of what was not checked: unreadable files, and the rest of an interrupted run."""
    for file in report.files:
        if file.verdict == UNREADABLE:
            yield UNREADABLE, f"{file.path}: {file.reason}", "" if file.path == STANDARD_INPUT else file.path
    if report.interrupted is not UNSET:
        yield "interrupted", report.interrupted.reason, ""


def _level(finding: Finding) -> str:
    return _LEVELS.get(finding.severity, "notice")


def _annotation(file: FileReport, finding: Finding, background: Background) -> str:
    properties: dict[str, str | int] = {
        "title": f"{finding.rule}, alarm {finding.alarm}" if finding.alarm else finding.rule
    }
    if file.path != STANDARD_INPUT:
        properties["file"] = from_root(file.path, background)
    properties |= {"line": finding.line, "endLine": finding.end_line}
    if finding.line == finding.end_line:
        # GitHub counts the last column in; a finding ends at the column after it.
        properties |= {"col": finding.column, "endColumn": max(finding.end_column - 1, finding.column)}
    return _command(_level(finding), properties, finding.full_message)


def _command(level: str, properties: Mapping[str, str | int], message: str) -> str:
    written = ",".join(f"{key}={_property(visible(str(value)))}" for key, value in properties.items())
    return f"::{level} {written}::{_data(visible(message))}"


def _plain(text: str) -> str:
    """Escape a line so that the runner takes it for no command: a file name could hold ##[, which begins one."""
    return text.replace("##[", "##\\x5b")


def _data(text: str) -> str:
    """Escape the text after a command; % first, since it begins the escapes."""
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
