"""Counts of findings by rule: what to look at first in a folder of many programs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from polarcheck.program.reading.excerpt import visible
from polarcheck.reports import SEVERITIES, painted
from polarcheck.reports.json import encoded
from polarcheck.reports.text import summary

if TYPE_CHECKING:
    from polarcheck.foundation.finding import Report
    from polarcheck.reports import Background

_HEADS = ("findings", "files", "fixable", "silenced", "severity", "rule")
#: Columns of text, aligned to the left.
_OF_TEXT = ("severity", "rule")


class Count(msgspec.Struct, frozen=True, kw_only=True):
    """
    The findings of a rule with a severity.

    findings: their number.
    files: the number of files with such findings.
    fixable: the number of those with a fix.
    silenced: the number of silenced findings, not counted in `findings`.
    """

    rule: str
    severity: str
    findings: int
    files: int
    fixable: int
    silenced: int


def counts(report: Report) -> list[Count]:
    """
    Return the counts by rule and severity, the most frequent first.

    A rule whose findings are all silenced is counted, too.
    """
    keys = {
        (reported.rule, reported.severity) for file in report.files for reported in (*file.findings, *file.silenced)
    }
    numbers = {key: [0, 0, 0, 0] for key in keys}
    for file in report.files:
        seen = set()
        for finding in file.findings:
            key = finding.rule, finding.severity
            number = numbers[key]
            number[0] += 1
            number[1] += key not in seen
            number[2] += finding.fix is not None
            seen.add(key)
        for silenced in file.silenced:
            numbers[silenced.rule, silenced.severity][3] += 1
    unsorted = [
        Count(rule=rule, severity=severity, findings=n[0], files=n[1], fixable=n[2], silenced=n[3])
        for (rule, severity), n in numbers.items()
    ]
    return sorted(unsorted, key=lambda count: (-count.findings, _rank(count.severity), count.rule))


def _rank(severity: str) -> int:
    return SEVERITIES.index(severity) if severity in SEVERITIES else len(SEVERITIES)


def statistics(report: Report, background: Background, form: str) -> str:
    """Return the counts as `json` or `jsonl`, else as a table for people with the summary line below it."""
    entries = counts(report)
    if form == "json":
        return encoded(entries, indent=2) + "\n"
    if form == "jsonl":
        return "".join(encoded(entry) + "\n" for entry in entries)
    table = [[str(getattr(entry, head)) for head in _HEADS] for entry in entries]
    chosen = [
        column for column, head in enumerate(_HEADS) if head != "silenced" or any(entry.silenced for entry in entries)
    ]
    widths = [max(len(visible(row[column])) for row in [list(_HEADS), *table]) for column in range(len(_HEADS))]
    lines = []
    for row in [list(_HEADS), *table] if table else []:
        cells = []
        for column in chosen:
            text, width = visible(row[column]), widths[column]
            cell = text.ljust(width) if _HEADS[column] in _OF_TEXT else text.rjust(width)
            is_severity = background.color and text in SEVERITIES
            cells.append(cell.replace(text, painted(text, text)) if is_severity else cell)
        lines.append("  ".join(cells).rstrip())
    if report.files and not background.quiet:
        lines += [""] * bool(lines) + [summary(report)]
    return "".join(line + "\n" for line in lines)
