"""The baselines of a run: each program has the one that its settings name."""

from __future__ import annotations

import copy
from collections.abc import Collection, Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.files.baselines import baseline_file
from polarcheck.files.baselines import baseline_warnings as warnings
from polarcheck.files.baselines.baseline import Baseline
from polarcheck.files.baselines.baseline_file import Contents
from polarcheck.files.batch.tasks import Outcome, Task, fails
from polarcheck.foundation.errors import BaselineError
from polarcheck.foundation.finding import UNREADABLE, FileReport


class OfFile(NamedTuple):
    """
    A baseline file and the known findings in it.

    path: the file.
    contents: what it says.
    baseline: its findings, for the programs that it applies to.
    """

    path: Path
    contents: Contents
    baseline: Baseline


class Baselines:
    """
    The baselines of the programs of a run, read once.

    files: each baseline file with its known findings.
    """

    def __init__(self, tasks: Iterable[Task], walked: Sequence[str] | None) -> None:
        """
        walked: the files and folders that the run was started with; known findings of other files are left alone.

        Raises BaselineError for a file that cannot be read, and names the key of the job file that names it.
        """
        of_path: dict[Path, list[Task]] = {}
        for task in tasks:
            if task.settings.baseline is not None:
                of_path.setdefault(task.settings.baseline, []).append(task)
        self._walked = walked
        self._tasks = of_path
        contents = {path: _read(path, its[0].settings.baseline_named_by) for path, its in of_path.items()}
        self.files = [self._of_file(path, contents[path]) for path in of_path]
        self._of_program = self._by_title()

    def _of_file(self, path: Path, contents: Contents) -> OfFile:
        places = [task.place for task in self._tasks[path]]
        return OfFile(path, contents, Baseline(contents, path.parent, places, self._walked))

    def _by_title(self) -> dict[str, tuple[Baseline, Settings]]:
        return {task.title: (file.baseline, task.settings) for file in self.files for task in self._tasks[file.path]}

    def copy(self) -> Baselines:
        """Return the same baselines as if no file had been checked."""
        copied = copy.copy(self)
        copied.files = [self._of_file(file.path, file.contents) for file in self.files]
        copied._of_program = copied._by_title()
        return copied

    def without_known(self, report: FileReport) -> FileReport:
        """Return the report without the findings that the baseline of its file knows."""
        if report.path not in self._of_program:
            return report
        baseline, settings = self._of_program[report.path]
        return baseline.without_known(report, evaluated(report, settings))

    def outcomes(self, outcomes: Iterable[Outcome]) -> Iterator[Outcome]:
        """Yield outcomes without the findings that the baselines know."""
        for outcome in outcomes:
            title = "" if outcome.report is None else outcome.report.path
            if outcome.report is None or outcome.report.verdict == UNREADABLE or title not in self._of_program:
                yield outcome
                continue
            report = self.without_known(outcome.report)
            _, settings = self._of_program[title]
            yield msgspec.structs.replace(outcome, report=report, failed=fails(report, settings))

    @property
    def faults(self) -> Iterator[str]:
        """Lines on what in the files can have no effect, or too much of it."""
        for file in self.files:
            yield from warnings.of_contents(file.path, file.contents)

    @property
    def leftovers(self) -> Iterator[str]:
        """Lines on known findings that no longer occur, and on moved files, once all programs have been checked."""
        for file in self.files:
            yield from warnings.of_leftovers(file.path, file.baseline)

    @property
    def is_stale(self) -> bool:
        """True if known findings no longer occur, or an entry is of a rule that there is not."""
        return any(any(warnings.unknown_rules(file.contents)) or any(file.baseline.leftovers()) for file in self.files)


def _read(path: Path, named_by: str) -> Contents:
    try:
        return baseline_file.read(path)
    except BaselineError as error:
        if not named_by:
            raise
        hint = "" if path.exists() else "; `polarcheck baseline create` writes it, and --no-baseline does without"
        raise BaselineError(f"{named_by}: {error}{hint}") from None


def evaluated(report: FileReport, settings: Settings) -> Collection[str]:
    """Return the rules that were evaluated for a file: only their known findings may have disappeared."""
    missing = {gap.rule for gap in report.not_evaluated if gap.matters}
    if "all" in missing or report.verdict == UNREADABLE:
        return ()
    levels = {**settings.machine.severities, **settings.severities}
    return {rule.name for rule in settings.rules if rule.level(levels) != "off"} - missing
