"""JSON lines: the content of `json`, an object per line, for programs that read a stream or search by line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.reports import Background, Parts
from polarcheck.reports.json import encoded, without_text

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, Report

_LISTED = ("findings", "silenced")


def jsonl_parts(background: Background) -> Parts:
    """
    Return for each file a line per finding, a line per silenced finding and a line for the file; last the summary.

    `type` says which: finding, silenced, file, summary. All other fields are those of `json`; `path` is in each line
    but the last.
    """

    def of_file(file: FileReport, lines_shown: Mapping[int, str]) -> str:
        return "".join(encoded(line) + "\n" for line in lines(file))

    def end(report: Report) -> str:
        about = {"schema": report.schema, "tool": report.tool, "machine": report.machine, "settings": report.settings}
        if report.interrupted is not msgspec.UNSET:
            about["interrupted"] = report.interrupted
        if report.assumed is not msgspec.UNSET:
            about["assumed"] = report.assumed
        return encoded({"type": "summary", **about, **msgspec.to_builtins(report.summary)}) + "\n"

    return Parts(of_file, end)


def lines(file: FileReport) -> Iterator[dict[str, Any]]:
    """Yield the objects of one file."""
    for finding in file.findings:
        yield {"type": "finding", "path": file.path, **msgspec.to_builtins(finding)}
    for finding in file.silenced:
        yield {"type": "silenced", "path": file.path, **msgspec.to_builtins(finding)}
    fields = msgspec.to_builtins(msgspec.structs.replace(without_text(file), findings=[], silenced=[]))
    yield {"type": "file", **{name: value for name, value in fields.items() if name not in _LISTED}}
