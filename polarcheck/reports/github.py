"""What GitHub Actions makes annotations of, at the lines of a pull request; and the same for its log."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

from polarcheck.reading.excerpt import visible
from polarcheck.reading.files import STANDARD_INPUT
from polarcheck.reports import SEVERITIES, counted
from polarcheck.reports.ci.paths import from_root
from polarcheck.reports.concise import line
from polarcheck.reports.text import summary, verdict

if TYPE_CHECKING:
    from polarcheck.finding import FileReport, Finding, Report
    from polarcheck.reports import Background

_LEVELS = {"error": "error", "warning": "warning", "note": "notice"}
#: Annotations of one level that GitHub shows of a step.
MOST = 10


def github(report: Report, background: Background) -> str:
    """
    Annotations, the worst first and no more than are shown; then all findings by file in groups of the log; then a line
    over all files, and one on what has no annotation.
    """
    return "".join(text + "\n" for text in _lines(report, background))


def _lines(report: Report, background: Background) -> Iterator[str]:
    all_found = [(file, found) for file in report.files for found in file.findings]
    ranks = {severity: rank for rank, severity in enumerate(SEVERITIES)}
    shown = Counter[str]()
    for file, found in sorted(all_found, key=lambda one: ranks.get(one[1].severity, len(ranks))):
        shown[_level(found)] += 1
        if shown[_level(found)] <= MOST:
            yield _annotation(file, found, background)
    for file in report.files:
        told = [line(file, found) for found in file.findings]
        told += dict.fromkeys(visible(f"not evaluated: {gap.reason}") for gap in file.not_evaluated if gap.matters)
        if told and not background.quiet:
            yield f"::group::{_data(visible(f'{file.path}: {verdict(file)}'))}"
            yield from (_plain(f"- {text}") for text in told)
            yield "::endgroup::"
    if report.files and not background.quiet:
        yield _plain(f"polarcheck: {summary(report)}")
    left = {level: number - MOST for level, number in shown.items() if number > MOST}
    if left:
        kinds = ", ".join(counted(number, level) for level, number in left.items())
        where = "run without -q for all" if background.quiet else "the groups above hold all"
        yield f"polarcheck: {kinds} more without an annotation, of which GitHub shows {MOST} of a kind; {where}"


def _level(found: Finding) -> str:
    return _LEVELS.get(found.severity, "notice")


def _annotation(file: FileReport, found: Finding, background: Background) -> str:
    place: dict[str, str | int] = {"title": f"{found.rule}, alarm {found.alarm}" if found.alarm else found.rule}
    if file.path != STANDARD_INPUT:
        place["file"] = from_root(file.path, background)
    place |= {"line": found.line, "endLine": found.end_line}
    if found.line == found.end_line:
        # The last column counts here, not the one behind it.
        place |= {"col": found.column, "endColumn": max(found.end_column - 1, found.column)}
    written = ",".join(f"{key}={_property(visible(str(value)))}" for key, value in place.items())
    return f"::{_level(found)} {written}::{_data(visible(found.told))}"


def _plain(text: str) -> str:
    """A line that is no command to the runner: those begin a line, which the name of a file could be, or hold ##[."""
    return text.replace("##[", "##\\x5b")


def _data(text: str) -> str:
    """Text behind a command; % first, since it begins what is spelled out."""
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
