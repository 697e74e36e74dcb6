"""GitLab's Code Quality report: findings in the merge request, and beside the lines that it changes."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from msgspec import UNSET

from polarcheck.foundation.finding import UNREADABLE
from polarcheck.program.reading.excerpt import visible
from polarcheck.reports.ci.repository_paths import from_root
from polarcheck.reports.json import encoded

if TYPE_CHECKING:
    from polarcheck.foundation.finding import Report
    from polarcheck.reports import Background

_SEVERITIES = {"error": "major", "warning": "minor", "note": "info"}


def gitlab(report: Report, background: Background) -> str:
    """Return an array with an entry for each finding that is not silenced, and for each file that was not checked."""
    return encoded(list(_entries(report, background)), indent=2) + "\n"


def _entries(report: Report, background: Background) -> Iterator[dict[str, Any]]:
    occurrences = Counter[str]()
    for file in report.files:
        path = from_root(file.path, background)
        if file.verdict == UNREADABLE:
            yield _failure(UNREADABLE, file.reason or "", path)
        for finding in file.findings:
            # GitLab merges entries with the same fingerprint, so a second occurrence of a mistake needs another one.
            # The line number would not do: a block inserted above would make the finding new.
            mistake = f"{path}\0{visible(finding.rule)}\0{visible(finding.fingerprint)}"
            occurrences[mistake] += 1
            yield {
                "description": visible(finding.full_message),
                "check_name": visible(finding.rule),
                "fingerprint": hashlib.sha256(f"{mistake}\0{occurrences[mistake]}".encode()).hexdigest(),
                "severity": _SEVERITIES.get(finding.severity, "info"),
                "location": {"path": path, "lines": {"begin": finding.line, "end": finding.end_line}},
            }
    if report.interrupted is not UNSET:
        path = from_root(report.interrupted.next_path or ".", background)
        yield _failure("interrupted", report.interrupted.reason, path)


def _failure(name: str, reason: str, path: str) -> dict[str, Any]:
    """Return the entry of a file that was not checked; without it the file would look mended."""
    return {
        "description": visible(reason),
        "check_name": name,
        "fingerprint": hashlib.sha256(f"{path}\0{name}".encode()).hexdigest(),
        "severity": "blocker",
        "location": {"path": path, "lines": {"begin": 1, "end": 1}},
    }
