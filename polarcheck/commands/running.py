"""A run over programs, from the paths to an outcome for each; an error in one program does not stop the others."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from polarcheck.commands import silencing
from polarcheck.commands.exit_codes import BUG, CLEAN, COULD_NOT_RUN
from polarcheck.commands.output import bug_lines, say, say_lines, warn

if TYPE_CHECKING:
    from polarcheck.batch.tasks import Checked, Outcome, Task
    from polarcheck.commands.progress import Bar
    from polarcheck.commands.watching import Seen
    from polarcheck.finding import FileReport
    from polarcheck.settings.of_programs import OfPrograms

#: Processes are started once they save more time than this [s]. A fork, as on Linux, costs little; a spawned process
#: loads the libraries again.
_COST = 0.1 if sys.platform == "linux" else 1.5
#: If the next file has this size, they are started at once [bytes].
_WORTH_PROCESSES = 200_000


class Faults:
    """
    The failures of a run, for standard error.

    failures: a line for each file that could not be read or checked.
    bugs: lines on internal errors of polarcheck.
    """

    def __init__(self, debug: bool) -> None:
        """debug: show tracebacks of bugs."""
        self._debug = debug
        self.failures: list[str] = []
        self.bugs: list[str] = []

    def bug(self, error: Exception) -> None:
        """Add an internal error."""
        self.bugs += bug_lines(error, self._debug)

    def report(self) -> int:
        """Write all failures to standard error; return their exit code."""
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
    Return the programs of paths, with the settings of each.

    force_exclude: skip excluded files even if they are named.
    named: the file that standard input is judged as (standard_input.judged_as).
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
    for line in (*settings_of.unmatched(paths), *settings_of.left_behind()):
        warn(line)
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
        take: Callable[[Iterable[Outcome]], Iterator[Outcome]] | None = None,
    ) -> Checked:
        """
        Return the outcomes of the programs, up to an interrupt.

        baseline: the file of known findings, which are silenced.
        show: takes each report in its turn.
        take: removes data from the reports that is not shown, such as pictures.

        Raises ClusterError if the cluster cannot be used.
        """
        from polarcheck.batch import tasks as batch

        with (
            self._outcomes(tasks) if self._seen is None else self._seen.outcomes(tasks, self._outcomes) as outcomes,
            contextlib.closing(bar.watched(outcomes)) as watched,
        ):
            suppressed = silencing.without_known(watched, tasks, baseline)
            reported = suppressed if take is None else take(suppressed)
            return batch.gather(reported, faults.failures.append, faults.bug, show)

    @contextlib.contextmanager
    def _outcomes(self, tasks: Sequence[Task]) -> Iterator[Generator[Outcome, None, None]]:
        """Yield a generator of the outcomes, in order of the tasks; no worker is left at the end of the block."""
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
    """Return the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def _as_it_pays(tasks: Sequence[Task], most: int, count: int) -> Generator[Outcome, None, None]:
    """Yield outcomes from this process, then from `count` worker processes once they save more than they cost."""
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
    """Return True if processes should be started; seconds: the time of the finished files."""
    if len(left) == 1:
        return False
    from polarcheck.reading import files

    # The first file counts twice, since forked processes inherit what it has loaded.
    saved = seconds / (done + 1) * len(left) * (1 - 1 / min(count, len(left)))
    return saved > _COST or files.size(left[0].path) >= _WORTH_PROCESSES


def _by_processes(tasks: Sequence[Task], most: int, count: int) -> Generator[Outcome, None, None]:
    from polarcheck.batch import executors

    return executors.by_processes(tasks, most, count)


def warn_without_part(tolerance: float | None, tasks: Sequence[Task]) -> None:
    """Warn of a --tolerance that no comparison takes."""
    if tolerance is not None and tasks and not any(task.settings.job.part for task in tasks):
        warn("--tolerance: nothing is compared; give a --drawing, or a [[part]] in polarcheck.toml")


def warn_unused(tools: Iterable[str], called: set[str]) -> None:
    """Warn of each --tool that no program of the run calls."""
    from polarcheck.machines.job import key_of_option

    for key in dict.fromkeys(map(key_of_option, tools)):
        if key not in called:
            warn(f"--tool {key}: no program of this run calls offset {key}")
