"""What decides for the files of a run one by one: settings that differ, and how many warnings they may have."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from polarcheck.files.batch.tasks import Task, with_settings
from polarcheck.foundation.errors import counted
from polarcheck.foundation.finding import FileReport


def with_own_settings(tasks: Sequence[Task]) -> list[Task]:
    """Return the tasks of a run whose settings differ: the report of each file has its own."""
    return with_settings(tasks, lambda settings: msgspec.structs.replace(settings, differs=True))


def too_many_warnings(reports: Iterable[FileReport], tasks: Iterable[Task]) -> Iterator[str]:
    """
    Yield a line for each `max_warnings` that is exceeded.

    Warnings are counted over all files for which the same option, variable or job file sets it.
    """
    limits: dict[str, tuple[str, int]] = {}
    for task in tasks:
        decided = task.settings.decided
        if decided.max_warnings is not None:
            limits[task.title] = (decided.sources or {}).get("max_warnings", ""), decided.max_warnings
    counts: Counter[tuple[str, int]] = Counter()
    for report in reports if limits else ():
        if report.path in limits:
            counts[limits[report.path]] += sum(finding.severity == "warning" for finding in report.findings)
    for (source, most), count in counts.items():
        if count > most:
            yield f"{counted(count, 'warning')}, more than the {most} of {source}"
