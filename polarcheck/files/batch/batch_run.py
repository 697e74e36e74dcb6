"""A run over programs: which programs with which settings, which processes check them, and the root of their paths."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Generator, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Outcome, Task
    from polarcheck.files.settings.of_programs import OfPrograms
    from polarcheck.program.reading.walking import Skipped

#: Processes are started once they save more time than this [s]. A fork, as on Linux, costs little; a spawned process
#: loads the libraries again.
_COST = 0.1 if sys.platform == "linux" else 1.5
#: If the next file is at least this large, processes are started at once [bytes].
_WORTH_PROCESSES = 200_000


class Planned(NamedTuple):
    """
    The programs of a run.

    tasks: the programs, with the settings of each.
    failures: a line for each folder that cannot be read.
    doubts: a line for each path or setting that may not say what was meant.
    nothing: reasons why nothing is checked: all programs of the folders are excluded or have other endings.
    """

    tasks: list[Task]
    failures: list[str]
    doubts: list[str]
    nothing: Sequence[str] = ()


def planned(
    paths: Sequence[str],
    settings_of: OfPrograms,
    extensions: Sequence[str],
    *,
    force_exclude: bool = False,
    named: Mapping[str, Any] | None = None,
    skipped: list[Skipped] | None = None,
) -> Planned:
    """
    Return the programs of files and folders.

    If all programs of the folders are excluded or have other endings, nothing is checked, which is a failure.

    extensions: endings of programs in folders; if empty, those of the job files or else the usual ones.
    force_exclude: skip excluded files even if they are named; none may remain, without a failure.
    named: keyword arguments of tasks.plan that say which file standard input stands for.
    skipped: a list to which entries that the walks did not read are added.

    Raises a PolarcheckError for settings that cannot be used.
    """
    from polarcheck.files.batch import tasks as batch

    failures, doubts, empty, nothing = list[str](), list[str](), list[str](), list[str]()
    paths = settings_of.left(paths, doubts.append) if force_exclude else paths
    skipped = [] if skipped is None else skipped
    tasks = batch.plan(
        paths,
        settings_of,
        extensions,
        failures.append,
        empty.append,
        excluded_in=settings_of.excluded_in,
        extensions_in=settings_of.extensions_in,
        skipped=skipped,
        **(named or {}),
    )
    if not tasks and not force_exclude and any(entry.programs for entry in skipped):
        nothing = [f"nothing to check: {line}" for line in empty]
    else:
        doubts += [*empty, *settings_of.unmatched(paths, [task.place for task in tasks], extensions)]
        doubts += settings_of.left_behind()
    return Planned(tasks, failures, doubts, nothing)


@contextlib.contextmanager
def outcomes(
    tasks: Sequence[Task], most: int, workers: int, cluster: str | None = None
) -> Iterator[Generator[Outcome, None, None]]:
    """
    Yield a generator of the outcomes, in the order of the tasks; no worker is left at the end of the block.

    most: bytes of a program.
    workers: number of processes; 0 for as many as save time.
    cluster: address of a scheduler.

    Raises ClusterError if the cluster cannot be used.
    """
    from polarcheck.files.batch.tasks import one_by_one

    with contextlib.ExitStack() as stack:
        if cluster is not None and tasks:
            from polarcheck.files.batch import cluster as clusters
            from polarcheck.files.batch import executors

            outcomes = executors.outcomes(tasks, stack.enter_context(clusters.workers(cluster, tasks, most)), most)
        elif workers == 1 or len(tasks) <= 1:
            outcomes = one_by_one(tasks, most)
        elif workers:
            outcomes = _by_processes(tasks, most, workers)
        else:
            outcomes = _with_processes_if_faster(tasks, most, cores())
        yield stack.enter_context(contextlib.closing(outcomes))


def cores() -> int:
    """Return the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def _with_processes_if_faster(tasks: Sequence[Task], most: int, count: int) -> Generator[Outcome, None, None]:
    """Yield outcomes from this process, then from `count` worker processes once they save more than they cost."""
    from polarcheck.files.batch.tasks import forget, outcome

    begun = time.monotonic()
    for number, task in enumerate(tasks):
        if count > 1 and _saves_time(tasks[number:], number, time.monotonic() - begun, count):
            yield from _by_processes(tasks[number:], most, count)
            return
        if number:
            forget()
        yield outcome(task, most)


def _saves_time(remaining: Sequence[Task], done: int, seconds: float, count: int) -> bool:
    """Return True if processes save time. done, seconds: number of finished files, and the time they took."""
    if len(remaining) == 1:
        return False
    from polarcheck.program.reading import files

    # The first file counts twice, since forked processes inherit what it has loaded.
    saved = seconds / (done + 1) * len(remaining) * (1 - 1 / min(count, len(remaining)))
    return saved > _COST or files.size(remaining[0].path) >= _WORTH_PROCESSES


def _by_processes(tasks: Sequence[Task], most: int, count: int) -> Generator[Outcome, None, None]:
    from polarcheck.files.batch import executors

    return executors.by_processes(tasks, most, count)


def folders() -> tuple[str, str]:
    """Return the root of the repository, and the folder that paths are relative to, with slashes; empty if unknown."""
    folder = ""
    with contextlib.suppress(OSError):  # the working folder may be gone
        folder = os.getcwd()  # noqa: PTH109
    return _root(folder).replace(os.sep, "/"), folder.replace(os.sep, "/")


def _root(folder: str) -> str:
    """Return the folder of the repository, else the working folder."""
    from polarcheck.files.git import Repositories
    from polarcheck.program.reading.files import RealPaths

    return (Repositories(RealPaths()).root_above(folder) if folder else None) or folder
