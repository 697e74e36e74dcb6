"""JSON lines: what `json` says, an object per line, for whoever reads as it comes or looks for lines."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.reports.json import encoded

if TYPE_CHECKING:
    from polarcheck.checking.finding import FileReport, Report
    from polarcheck.reports import Background

_LISTED = ("findings", "silenced")


def jsonl(report: Report, background: Background | None = None) -> str:
    """
    A line for each finding, then for each one that is silenced, then for the file itself; the last line is the summary.

    `type` says which: finding, silenced, file, summary. All other fields are those of `json`; `path` is in each line
    but the last.
    """
    return "".join(encoded(line) + "\n" for line in _lines(report))


def _lines(report: Report) -> Iterator[dict[str, Any]]:
    for file in report.files:
        yield from lines(file)
    fields = {key: value for key, value in msgspec.to_builtins(report).items() if key not in ("files", "summary")}
    yield {"type": "summary", **fields, **msgspec.to_builtins(report.summary)}


def lines(file: FileReport) -> Iterator[dict[str, Any]]:
    """What is said of one file."""
    for found in file.findings:
        yield {"type": "finding", "path": file.path, **msgspec.to_builtins(found)}
    for found in file.silenced:
        yield {"type": "silenced", "path": file.path, **msgspec.to_builtins(found)}
    fields = {name: getattr(file, name) for name in file.__struct_fields__ if name not in _LISTED}
    yield {"type": "file", **msgspec.to_builtins(fields)}
