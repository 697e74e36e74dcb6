"""What decides for all files of a run: the settings that they share, and how many warnings they may have together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from polarcheck import __version__
from polarcheck.batch.tasks import Task
from polarcheck.checking.settings import Settings
from polarcheck.finding import Decided, FileReport, RunSettings


def shared(tasks: Sequence[Task], diff_base: str | None = None) -> tuple[RunSettings, list[Task]]:
    """
    Return the settings that the files of a run share, and the tasks; where settings differ, reports say them by file.

    diff_base: the commit since which a file must have changed.
    """
    of_files = list({id(task.settings): task.settings for task in tasks}.values())
    distinct = [of_file.decided for of_file in of_files] or [Decided()]
    values = {name: [getattr(decided, name) for decided in distinct] for name in Decided.__struct_fields__}
    differing = [name for name, of_each in values.items() if any(value != of_each[0] for value in of_each)]
    common = {name: None if name in differing else of_each[0] for name, of_each in values.items()}
    settings = RunSettings(version=__version__, diff_base=diff_base, differing=differing, **common)
    if not differing:
        return settings, list(tasks)
    # Tasks with the same settings share them: other processes get them once.
    marked: dict[int, Settings] = {id(of_file): msgspec.structs.replace(of_file, differs=True) for of_file in of_files}
    return settings, [msgspec.structs.replace(task, settings=marked[id(task.settings)]) for task in tasks]


def too_many_warnings(reports: Iterable[FileReport], tasks: Iterable[Task]) -> Iterator[str]:
    """
    Yield a line for each `max_warnings` that is exceeded.

    Warnings are counted over all files for which the same option, variable or line of a job file sets it.
    """
    limits: dict[str, tuple[str, int]] = {}
    for task in tasks:
        decided = task.settings.decided
        if decided.max_warnings is not None:
            limits[task.title] = (decided.sources or {}).get("max_warnings", ""), decided.max_warnings
    if not limits:
        return
    counts: Counter[tuple[str, int]] = Counter()
    for report in reports:
        if report.path in limits:
            counts[limits[report.path]] += sum(finding.severity == "warning" for finding in report.findings)
    for (source, most), count in counts.items():
        if count > most:
            warnings = "1 warning" if count == 1 else f"{count} warnings"
            yield f"{warnings}, more than the {most} of {source}"
