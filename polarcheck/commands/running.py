"""A run over programs, from the paths to what came of each; what goes wrong with one costs that one only."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from polarcheck.commands import silencing
from polarcheck.commands.exit_codes import BUG, CLEAN, COULD_NOT_RUN
from polarcheck.commands.output import said_of_bug, say, say_lines, warn

if TYPE_CHECKING:
    from polarcheck.batch.tasks import Checked, Outcome, Task
    from polarcheck.commands.progress import Bar
    from polarcheck.commands.settings import OfPrograms
    from polarcheck.commands.watching import Seen
    from polarcheck.finding import FileReport

#: Processes are started when they save more than they cost [s]. To fork, as on Linux, costs hardly anything; a spawned
#: process loads the libraries anew.
_COST = 0.1 if sys.platform == "linux" else 1.5
#: A next file of this size starts them at once [bytes].
_WORTH_PROCESSES = 200_000


class Faults:
    """The failures and internal errors of a run, as lines for standard error."""

    def __init__(self, debug: bool) -> None:
        """debug: whether bugs are told with their tracebacks."""
        self._debug = debug
        self.failures: list[str] = []
        self.bugs: list[str] = []

    def bug(self, error: Exception) -> None:
        """Add an internal error."""
        self.bugs += said_of_bug(error, self._debug)

    def told(self) -> int:
        """Tell all of it; the exit code for it."""
        for failure in self.failures:
            say(failure)
        say_lines(self.bugs)
        return BUG if self.bugs else COULD_NOT_RUN if self.failures else CLEAN


def planned(
    paths: Sequence[str],
    settings_of: OfPrograms,
    extensions: Sequence[str],
    faults: Faults,
    *,
    force_exclude: bool = False,
    named: Mapping[str, Any] | None = None,
) -> list[Task]:
    """
    The programs of some paths, with what applies to each.

    force_exclude: whether what is excluded is passed over where it is named, too. named: what standard input is judged
    as (standard_input.judged_as).
    """
    from polarcheck.batch import tasks as batch

    paths = settings_of.left(paths, warn) if force_exclude else paths
    tasks = batch.plan(
        paths,
        settings_of,
        extensions,
        faults.failures.append,
        warn,
        excluded_in=settings_of.excluded_in,
        **(named or {}),
    )
    for unmatched in settings_of.unmatched(paths):
        warn(unmatched)
    return tasks


class Runner:
    """
    How the programs of a run are checked.

    most: bytes of a program.
    workers: processes, 0 for as many as pay.
    cluster: address of a scheduler.
    seen: with --watch, the outcomes of the last run, of which those that cannot have changed are used again.
    """

    def __init__(self, most: int, workers: int, cluster: str | None, seen: Seen | None = None) -> None:
        self._most, self._workers, self._cluster, self._seen = most, workers, cluster, seen

    def check(
        self,
        tasks: Sequence[Task],
        bar: Bar,
        faults: Faults,
        baseline: silencing.Known | None = None,
        show: Callable[[FileReport, Mapping[int, str]], None] | None = None,
        taken: Callable[[Iterable[Outcome]], Iterator[Outcome]] | None = None,
    ) -> Checked:
        """
        The outcomes of the programs, up to an interrupt.

        baseline: the file of known findings, which are silenced. show: gets each report when it is its turn.
        taken: removes from the reports what is not shown. Raises ClusterError where the cluster cannot be used.
        """
        from polarcheck.batch import tasks as batch

        with (
            self._outcomes(tasks) if self._seen is None else self._seen.outcomes(tasks, self._outcomes) as outcomes,
            contextlib.closing(bar.watched(outcomes)) as watched,
        ):
            answered = silencing.answered(watched, tasks, baseline)
            reported = answered if taken is None else taken(answered)
            return batch.gather(reported, faults.failures.append, faults.bug, show)

    @contextlib.contextmanager
    def _outcomes(self, tasks: Sequence[Task]) -> Iterator[Generator[Outcome, None, None]]:
        """The outcome of each task, in order; at the end of the block no worker is left."""
        from polarcheck.batch.tasks import one_by_one

        with contextlib.ExitStack() as stack:
            if self._cluster is not None and tasks:
                from polarcheck.batch import cluster, executors

                workers = stack.enter_context(cluster.workers(self._cluster, tasks, self._most))
                outcomes = executors.outcomes(tasks, workers, self._most)
            elif self._workers == 1 or len(tasks) <= 1:
                outcomes = one_by_one(tasks, self._most)
            elif self._workers:
                outcomes = _by_processes(tasks, self._most, self._workers)
            else:
                outcomes = _as_it_pays(tasks, self._most, cores())
            yield stack.enter_context(contextlib.closing(outcomes))


def cores() -> int:
    """The number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def _as_it_pays(tasks: Sequence[Task], most: int, count: int) -> Generator[Outcome, None, None]:
    """The outcomes by this process, and by so many others as soon as these save more than they cost."""
    from polarcheck.batch.tasks import forget, outcome

    begun = time.monotonic()
    for number, task in enumerate(tasks):
        if count > 1 and _pays(tasks[number:], number, time.monotonic() - begun, count):
            yield from _by_processes(tasks[number:], most, count)
            return
        if number:
            forget()
        yield outcome(task, most)


def _pays(left: Sequence[Task], done: int, seconds: float, count: int) -> bool:
    """Tells whether processes should be started; seconds: time that the finished files took."""
    if len(left) == 1:
        return False
    from polarcheck.reading import files

    # The first file counts twice: forked processes have what it loads and compiles.
    saved = seconds / (done + 1) * len(left) * (1 - 1 / min(count, len(left)))
    return saved > _COST or files.size(left[0].path) >= _WORTH_PROCESSES


def _by_processes(tasks: Sequence[Task], most: int, count: int) -> Generator[Outcome, None, None]:
    from polarcheck.batch import executors

    return executors.by_processes(tasks, most, count)


def tell_unused(tools: Iterable[str], called: set[str]) -> None:
    """Warn of each --tool that no program of the run calls."""
    from polarcheck.machines.job import key_of_option

    for key in dict.fromkeys(map(key_of_option, tools)):
        if key not in called:
            warn(f"--tool {key}: no program of this run calls offset {key}")
