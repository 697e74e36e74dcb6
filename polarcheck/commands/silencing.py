"""Silences the findings of a baseline, and the options for silenced findings."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from polarcheck.commands.options import option
from polarcheck.commands.output import warn

if TYPE_CHECKING:
    from polarcheck.batch.baseline import Baseline, Leftover
    from polarcheck.batch.tasks import Outcome, Task
    from polarcheck.checking.settings import Settings
    from polarcheck.finding import FileReport

#: The most entries in a line on findings that no longer occur, or on moved files.
_NAMED = 5


def _readable(ctx: click.Context, parameter: click.Parameter, value: Path | None) -> Path | None:
    """Read the file before anything is checked, since a check of many files takes minutes."""
    if value is not None:
        from polarcheck.batch import baseline_file

        baseline_file.read(value)
    return value


baseline = option(
    "--baseline", type=click.Path(exists=True, dir_okay=False, path_type=Path), callback=_readable, metavar="FILE",
    help="Known findings, of `polarcheck baseline create`: only others are told.",
)  # fmt: skip
show_silenced = option(
    "--show-silenced", "silenced", is_flag=True, help="In text, what is silenced, too, with by what and why."
)


class Known(NamedTuple):
    """
    The baseline of a run.

    path: the file of known findings.
    walked: the paths of the run; known findings of other files are left alone.
    """

    path: Path
    walked: Sequence[str]


def without_known(outcomes: Iterable[Outcome], tasks: Sequence[Task], baseline: Known | None) -> Iterator[Outcome]:
    """Silence the findings of a baseline in outcomes; at the end warn of known findings that no longer occur."""
    if baseline is None:
        yield from outcomes
        return
    import msgspec

    from polarcheck.batch.tasks import fails
    from polarcheck.finding import UNREADABLE

    known, settings = _baseline(tasks, baseline), settings_of(tasks)
    suppress = _suppressor(known, settings)
    for outcome in outcomes:
        if outcome.report is None or outcome.report.verdict == UNREADABLE:
            yield outcome
        else:
            report = suppress(outcome.report)
            yield msgspec.structs.replace(outcome, report=report, failed=fails(report, settings[report.path]))
    _warn_leftovers(known, baseline.path)


def suppressor(tasks: Sequence[Task], baseline: Known | None) -> Callable[[FileReport], FileReport] | None:
    """Return a function that silences the findings of a baseline in a report; None without a baseline."""
    return None if baseline is None else _suppressor(_baseline(tasks, baseline), settings_of(tasks))


def _suppressor(known: Baseline, settings: Mapping[str, Settings]) -> Callable[[FileReport], FileReport]:
    def suppress(report: FileReport) -> FileReport:
        return known.without_known(report, evaluated(report, settings[report.path]))

    return suppress


def _baseline(tasks: Iterable[Task], known: Known) -> Baseline:
    from polarcheck.batch import baseline_file
    from polarcheck.batch.baseline import Baseline

    entries = baseline_file.read(known.path)
    return Baseline(entries, known.path.parent, (task.place for task in tasks), known.walked)


def settings_of(tasks: Iterable[Task]) -> dict[str, Settings]:
    """Return the settings of each file, by its path in reports."""
    return {task.title: task.settings for task in tasks}


def evaluated(report: FileReport, settings: Settings) -> Collection[str]:
    """Return the rules that were evaluated for a file: only their known findings may have disappeared."""
    from polarcheck.finding import UNREADABLE

    missing = {gap.rule for gap in report.not_evaluated if gap.matters}
    if "all" in missing or report.verdict == UNREADABLE:
        return ()
    levels = {**settings.machine.severities, **settings.severities}
    return {rule.name for rule in settings.rules if rule.level(levels) != "off"} - missing


def _warn_leftovers(known: Baseline, path: Path) -> None:
    """Warn of known findings that no longer occur, and of moved files, in a line each."""
    from polarcheck.reading import files
    from polarcheck.reports import counted

    name = files.shown(os.fspath(path))
    moved = sorted((old, new) for new, old in known.moved.items() if old)
    if moved:
        named = _listed(f"{old} is {new}" for old, new in moved)
        warn(f"{name}: {_were(len(moved), 'file')} moved: {named}; `polarcheck baseline update` takes the new paths")
    leftovers = list(known.leftovers())
    if leftovers:
        count = sum(leftover.missing for leftover in leftovers)
        occur = "occurs" if count == 1 else "occur"
        named = _listed(_places(leftovers))
        warn(
            f"{name}: {counted(count, 'known finding')} no longer {occur}: {named}; `polarcheck baseline prune` drops "
            f"{'it' if count == 1 else 'them'}"
        )


def _were(count: int, noun: str) -> str:
    from polarcheck.reports import counted

    return f"{counted(count, noun)} {'was' if count == 1 else 'were'}"


def _places(leftovers: Iterable[Leftover]) -> list[str]:
    """Return entries such as `rapid-in-polar in a.nc (2)`, and the files that no longer exist."""
    counts: Counter[str] = Counter()
    for leftover in leftovers:
        entry = leftover.entry
        counts[f"{entry.file}, which is gone" if leftover.is_gone else f"{entry.rule} in {entry.file}"] += (
            leftover.missing
        )
    return [f"{place} ({count})" if count > 1 else place for place, count in counts.items()]


def _listed(texts: Iterable[str]) -> str:
    entries = list(texts)
    more = len(entries) - _NAMED
    return ", ".join(entries[:_NAMED]) + (f" and {more} more" if more > 0 else "")
