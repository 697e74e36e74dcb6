"""A run over programs, from the paths to an outcome for each; an error in one program does not stop the others."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from polarcheck.commands import silencing
from polarcheck.commands.exit_codes import BUG, CLEAN, COULD_NOT_RUN
from polarcheck.commands.output import bug_lines, say, say_lines, warn
from polarcheck.files.batch import batch_run
from polarcheck.foundation import record
from polarcheck.program.reading.files import STANDARD_INPUT

if TYPE_CHECKING:
    from polarcheck.commands.progress import Bar
    from polarcheck.commands.watching import Seen
    from polarcheck.files.baselines.baselines import Baselines
    from polarcheck.files.batch.tasks import Checked, Outcome, Task
    from polarcheck.files.cache.outcomes import Cache
    from polarcheck.files.settings.of_programs import OfPrograms
    from polarcheck.foundation.finding import FileReport
    from polarcheck.program.reading.walking import Skipped


#: Leads to the file behind standard input, where the system has it.
_STANDARD_INPUT = "/dev/stdin"


class Faults:
    """
    The failures of a run, for standard error.

    failures: a line for each file that could not be read or checked.
    nothing: why nothing is checked.
    bugs: lines on internal errors of polarcheck.
    """

    def __init__(self, debug: bool) -> None:
        """debug: show tracebacks of bugs."""
        self._debug = debug
        self.failures: list[str] = []
        self.nothing: list[str] = []
        self.bugs: list[str] = []

    def bug(self, error: Exception) -> None:
        """Add an internal error."""
        self.bugs += bug_lines(error, self._debug)

    def report(self) -> int:
        """Write all failures to standard error; return their exit code."""
        for failure in (*self.failures, *self.nothing):
            say(failure)
        say_lines(self.bugs)
        return BUG if self.bugs else COULD_NOT_RUN if self.failures or self.nothing else CLEAN


def planned(
    paths: Sequence[str],
    settings_of: OfPrograms,
    extensions: Sequence[str],
    faults: Faults,
    *,
    force_exclude: bool = False,
    named: Mapping[str, Any] | None = None,
    skipped: list[Skipped] | None = None,
) -> list[Task]:
    """
    Return the programs of paths, with the settings of each.

    Where all programs of the folders are excluded or have other endings, that is a failure: nothing was checked.

    force_exclude: skip excluded files even if they are named; nothing need be left.
    named: the file that standard input is judged as (standard_input.judged_as).
    skipped: takes what the walks did not read.
    """
    plan = batch_run.planned(paths, settings_of, extensions, force_exclude=force_exclude, named=named, skipped=skipped)
    faults.failures += plan.failures
    faults.nothing += plan.nothing
    for line in plan.doubts:
        warn(line)
    record.note(*(_STANDARD_INPUT if task.place == STANDARD_INPUT else task.place for task in plan.tasks))
    return plan.tasks


class Runner:
    """
    How the programs of a run are checked.

    most: bytes of a program.
    workers: processes, 0 for as many as pay.
    cluster: address of a scheduler.
    seen: with --watch, the outcomes of the last run, of which those that cannot have changed are used again.
    cache: the outcomes of earlier runs; with a cluster or `seen` it is not used.
    """

    def __init__(
        self, most: int, workers: int, cluster: str | None, seen: Seen | None = None, cache: Cache | None = None
    ) -> None:
        self._most, self._workers, self._cluster = most, workers, cluster
        # Both take outcomes from before, and have the others checked.
        self._before = seen if cluster is not None or seen is not None else cache

    def check(
        self,
        tasks: Sequence[Task],
        bar: Bar,
        faults: Faults,
        baselines: Baselines | None = None,
        show: Callable[[FileReport, Mapping[int, str]], None] | None = None,
        take: Callable[[Iterable[Outcome]], Iterator[Outcome]] | None = None,
        also: Iterable[Outcome] = (),
    ) -> Checked:
        """
        Return the outcomes of the programs, up to an interrupt.

        baselines: of known findings, which are silenced.
        show: takes each report in its turn.
        take: removes data from the reports that is not shown, such as pictures.
        also: outcomes that stand behind those of the programs: folders that could not be read.

        Raises ClusterError if the cluster cannot be used.
        """
        from polarcheck.files.batch import tasks as batch

        with (
            self._outcomes(tasks) if self._before is None else self._before.outcomes(tasks, self._outcomes) as outcomes,
            contextlib.closing(bar.watched(outcomes)) as watched,
        ):
            suppressed = silencing.without_known(watched, baselines)
            reported = suppressed if take is None else take(suppressed)
            return batch.gather(itertools.chain(reported, also), faults.failures.append, faults.bug, show)

    def _outcomes(self, tasks: Sequence[Task]) -> contextlib.AbstractContextManager[Generator[Outcome, None, None]]:
        return batch_run.outcomes(tasks, self._most, self._workers, self._cluster)


def cache(most: int, folder: str | None) -> Cache:
    """Return the outcomes of earlier runs. most: bytes of a program. folder: instead of those beside job files."""
    from polarcheck.files.cache.outcomes import Cache

    return Cache(most, folder)


def warn_without_part(tolerance: float | None, tasks: Sequence[Task]) -> None:
    """Warn of a --tolerance that no comparison takes."""
    if tolerance is not None and tasks and not any(task.settings.job.part for task in tasks):
        warn("--tolerance: nothing is compared; give a --drawing, or a [[part]] in polarcheck.toml")


def warn_unused(tools: Iterable[str], called: set[str]) -> None:
    """Warn of each --tool that no program of the run calls."""
    from polarcheck.program.machines.job import key_of_option

    for key in dict.fromkeys(map(key_of_option, tools)):
        if key not in called:
            warn(f"--tool {key}: no program of this run calls offset {key}")
