"""A run over programs, from the paths to what came of each; what goes wrong with one costs that one only."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from polarcheck.commands import jobs, silencing
from polarcheck.commands.exit_codes import BUG, CLEAN, COULD_NOT_RUN
from polarcheck.commands.output import said_of_bug, say, say_lines, warn

if TYPE_CHECKING:
    from polarcheck.checking.batch import Checked, Outcome, Task
    from polarcheck.commands.progress import Bar
    from polarcheck.commands.settings import OfPrograms
    from polarcheck.commands.watching import Seen
    from polarcheck.finding import FileReport


class Faults:
    """What could not be read or done, and what polarcheck itself did wrong: lines for standard error."""

    def __init__(self, debug: bool) -> None:
        """debug: whether bugs are told with their tracebacks."""
        self._debug = debug
        self.failures: list[str] = []
        self.bugs: list[str] = []

    def bug(self, error: Exception) -> None:
        """What polarcheck did wrong."""
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
    from polarcheck.checking import batch

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


class Crew:
    """Who checks: how many processes, or which cluster. most: bytes of a program. seen: with --watch, what is known."""

    def __init__(self, most: int, workers: int, cluster: str | None, seen: Seen | None = None) -> None:
        self._asked = most, workers, cluster, seen

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
        What came of the programs, up to an interrupt.

        baseline: the file of known findings, which are silenced. show: gets each report when it is its turn.
        taken: takes off the reports what is not told.
        """
        from polarcheck.checking import batch

        with (
            jobs.outcomes(tasks, *self._asked) as outcomes,
            contextlib.closing(bar.watched(outcomes)) as watched,
        ):
            answered = silencing.answered(watched, tasks, baseline)
            told = answered if taken is None else taken(answered)
            return batch.gather(told, faults.failures.append, faults.bug, show)


def tell_unused(tools: Iterable[str], called: set[str]) -> None:
    """Warn of each --tool that no program of the run calls."""
    from polarcheck.machines.job import key_of_option

    for key in dict.fromkeys(map(key_of_option, tools)):
        if key not in called:
            warn(f"--tool {key}: no program of this run calls offset {key}")
