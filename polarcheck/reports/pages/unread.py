"""The files and folders that were not read, in words."""

from __future__ import annotations

import os

from polarcheck.foundation.finding import NotRead, Summary
from polarcheck.program.reading.excerpt import visible
from polarcheck.program.reading.walking import is_known_ending

#: The most endings in a line.
_NAMED = 8


def unread(summary: Summary) -> list[str]:
    """Return `not read: 3 .SUB, 1 .B (O1234-REV.B), 2 without ending` and `excluded: 4`, where there are any."""
    kinds = [_kind(entry) for entry in summary.not_read[:_NAMED]]
    more = sum(entry.files for entry in summary.not_read[_NAMED:])
    kinds += [f"{more} of other endings"] if more else []
    parts = [f"not read: {', '.join(kinds)}"] if kinds else []
    return [*parts, f"excluded: {summary.excluded}"] if summary.excluded else parts


def _kind(entry: NotRead) -> str:
    name = entry.first.rpartition("/")[2]
    ending = os.path.splitext(name)[1]  # noqa: PTH122  Path.suffix differs for names that end in a point
    if not ending:
        return f"{entry.files} without ending"
    text = visible(f"{entry.files} {ending}")
    return text if entry.files > 1 or is_known_ending(ending) else visible(f"{text} ({name})")
