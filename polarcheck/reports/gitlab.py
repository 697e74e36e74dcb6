"""GitLab's Code Quality report: findings in the merge request, and beside the lines that it changes."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from polarcheck.reading.excerpt import visible
from polarcheck.reports.ci.paths import from_root
from polarcheck.reports.json import encoded

if TYPE_CHECKING:
    from polarcheck.finding import Report
    from polarcheck.reports import Background

_SEVERITIES = {"error": "major", "warning": "minor", "note": "info"}


def gitlab(report: Report, background: Background) -> str:
    """An array with an entry for each finding; those that somebody has answered for are no entries."""
    return encoded(list(_entries(report, background)), indent=2) + "\n"


def _entries(report: Report, background: Background) -> Iterator[dict[str, Any]]:
    told = Counter[str]()
    for file in report.files:
        path = from_root(file.path, background)
        for found in file.findings:
            # GitLab takes entries of one fingerprint for one, so the same mistake in another place of the file needs
            # another; the number of the line would make a new finding of it wherever a block is inserted above.
            mistake = f"{path}\0{visible(found.rule)}\0{visible(found.fingerprint)}"
            told[mistake] += 1
            yield {
                "description": visible(found.told),
                "check_name": visible(found.rule),
                "fingerprint": hashlib.sha256(f"{mistake}\0{told[mistake]}".encode()).hexdigest(),
                "severity": _SEVERITIES.get(found.severity, "info"),
                "location": {"path": path, "lines": {"begin": found.line, "end": found.end_line}},
            }
