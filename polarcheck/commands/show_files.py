"""`polarcheck check --show-files`: which files are read and which are not, with the reason, in place of a check."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from polarcheck.foundation.errors import UsageError

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Task
    from polarcheck.program.reading.walking import Skipped

#: The formats that can hold the list.
_FORMATS = ("text", "json", "jsonl")


class Listed(NamedTuple):
    """
    A file or folder.

    path: as in reports.
    read: True for a program that is checked.
    reason: why it is not read; empty for one that is.
    programs: the number of programs in an excluded folder, else 1 for a file and 0 for a folder.
    """

    path: str
    read: bool
    reason: str
    programs: int


def refuse(form: str | None, options: dict[str, object]) -> None:
    """Raise UsageError for a format that cannot hold the list, and for options (by name) that need a check."""
    if form not in (None, *_FORMATS):
        raise UsageError(f"--show-files: expected --format {', '.join(_FORMATS)}, found {form}")
    for name, value in options.items():
        if value:
            raise UsageError(f"--show-files checks nothing: leave {name} out")


def text(form: str, tasks: Sequence[Task], skipped: Sequence[Skipped]) -> str:
    """Return the list in a format, those that are read first."""
    from polarcheck.program.reading.excerpt import visible
    from polarcheck.reports.json import encoded

    entries = [*_read(tasks), *_not_read(skipped, tasks)]
    if form == "json":
        return encoded({"files": [entry._asdict() for entry in entries]}, indent=2) + "\n"
    if form == "jsonl":
        return "".join(encoded(entry._asdict()) + "\n" for entry in entries)
    lines = [
        f"read      {entry.path}" if entry.read else f"not read  {entry.path}: {entry.reason}" for entry in entries
    ]
    return "".join(f"{visible(line)}\n" for line in lines)


def _read(tasks: Iterable[Task]) -> Iterator[Listed]:
    for task in tasks:
        yield Listed(task.title, True, "", 1)


def _not_read(skipped: Iterable[Skipped], tasks: Iterable[Task]) -> Iterator[Listed]:
    from polarcheck.program.reading.files import RealPaths, display_path

    real = RealPaths()
    of_jobs = {id(task.settings): task.settings.job.run.subprograms for task in tasks}
    folders = {real.folder(folder) for named in of_jobs.values() for folder in named}
    for entry in skipped:
        path = display_path(entry.path) + ("/" if os.path.isdir(entry.path) else "")  # noqa: PTH112
        is_called = entry.reason == "ending" and os.path.dirname(real.of(entry.path)) in folders  # noqa: PTH120
        reason = _reason(entry) + ("; programs that call it execute it" if is_called else "")
        yield Listed(path, False, reason, entry.programs)


def _reason(entry: Skipped) -> str:
    """Return why a file or folder is not read."""
    if entry.reason == "excluded":
        if os.path.isdir(entry.path):  # noqa: PTH112
            least = "at least " if entry.is_least else ""
            noun = "program" if entry.programs == 1 else "programs"
            return f"excluded by {entry.by}, with {least}{entry.programs} {noun} in it"
        return f"excluded by {entry.by}"
    if entry.reason == "ending":
        what = (
            f"the ending {entry.ending} is"
            if entry.ending
            else "without ending, its first lines show no program, and it is"
        )
        return f"{what} none of the extensions"
    return {
        "folder": "hidden folders and those of packages are not entered",
        "device": "a pipe or device",
        "offset table": "an offset table of a job",
    }[entry.reason]
