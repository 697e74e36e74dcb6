"""The baselines of a run: each program has the one that its settings name."""

from __future__ import annotations

import copy
from collections.abc import Collection, Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from polarcheck.batch import baseline_file
from polarcheck.batch.baseline import Baseline
from polarcheck.batch.baseline_file import Contents
from polarcheck.checking.rule import load_all
from polarcheck.checking.settings import Settings
from polarcheck.errors import BaselineError
from polarcheck.finding import UNREADABLE, FileReport


class Program(NamedTuple):
    """
    A program of a run.

    title: its path in reports.
    path: of the file.
    settings: those that apply to it.
    """

    title: str
    path: str
    settings: Settings


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

    @property
    def unknown_rules(self) -> Iterator[tuple[int, str]]:
        """Yield the line and the rule of each entry whose rule there is not."""
        rules = load_all()
        for line, entry in zip(self.contents.lines, self.contents.entries, strict=False):
            if entry.rule not in rules:
                yield line, entry.rule

    @property
    def without_places(self) -> int:
        """The number of entries of the first schema."""
        return sum(not entry.places for entry in self.contents.entries)


class Baselines:
    """
    The baselines of the programs of a run, read once.

    files: each baseline file with its known findings.
    """

    def __init__(self, programs: Iterable[Program], walked: Sequence[str] | None) -> None:
        """
        walked: the files and folders that the run was started with; known findings of other files are left alone.

        Raises BaselineError for a file that cannot be read, and names the key of the job file that names it.
        """
        of_path: dict[Path, list[Program]] = {}
        for program in programs:
            if program.settings.baseline is not None:
                of_path.setdefault(program.settings.baseline, []).append(program)
        self._walked = walked
        self._programs = of_path
        contents = {path: _read(path, its[0].settings.baseline_named_by) for path, its in of_path.items()}
        self.files = [self._of_file(path, contents[path]) for path in of_path]
        self._of_program = self._by_program()

    def _of_file(self, path: Path, contents: Contents) -> OfFile:
        places = [program.path for program in self._programs[path]]
        return OfFile(path, contents, Baseline(contents, path.parent, places, self._walked))

    def _by_program(self) -> dict[str, tuple[Baseline, Settings]]:
        return {
            program.title: (file.baseline, program.settings)
            for file in self.files
            for program in self._programs[file.path]
        }

    def copy(self) -> Baselines:
        """Return the same baselines as if no file had been checked."""
        copied = copy.copy(self)
        copied.files = [self._of_file(file.path, file.contents) for file in self.files]
        copied._of_program = copied._by_program()
        return copied

    def without_known(self, report: FileReport) -> FileReport:
        """Return the report without the findings that the baseline of its file knows."""
        if report.path not in self._of_program:
            return report
        baseline, settings = self._of_program[report.path]
        return baseline.without_known(report, evaluated(report, settings))


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
