"""Silences the findings of a baseline, and the options for silenced findings."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from polarcheck.commands.options import option
from polarcheck.commands.output import warn

if TYPE_CHECKING:
    from polarcheck.batch.baseline import Baseline, Leftover
    from polarcheck.batch.baselines import Baselines, OfFile
    from polarcheck.batch.tasks import Outcome, Task
    from polarcheck.checking.settings import Settings

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
no_baseline = option("--no-baseline", is_flag=True, help="No known findings, though a polarcheck.toml names a file.")
fail_on_stale = option(
    "--fail-on-stale", is_flag=True, help="End with 1 where known findings of the baseline no longer occur, too."
)
show_silenced = option(
    "--show-silenced", "silenced", is_flag=True, help="In text, what is silenced, too, with by what and why."
)


def of_run(tasks: Iterable[Task], walked: Sequence[str]) -> Baselines | None:
    """
    Return the baselines of the programs, None without any; warn of what in them can have no effect.

    walked: the paths of the run. Raises BaselineError for a file that cannot be read.
    """
    tasks = [task for task in tasks if task.settings.baseline is not None]
    if not tasks:
        return None
    from polarcheck.batch.baselines import Baselines, Program

    baselines = Baselines((Program(task.title, task.place, task.settings) for task in tasks), walked)
    for file in baselines.files:
        _warn_unknown(file)
    return baselines


def _warn_unknown(file: OfFile) -> None:
    """Warn of entries of unknown rules, and of a baseline of the first schema."""
    from polarcheck.checking.rule import load_all
    from polarcheck.errors import suggestion
    from polarcheck.reading import files
    from polarcheck.reports import counted

    name = files.shown(os.fspath(file.path))
    unknown: dict[str, list[int]] = {}
    for line, rule in file.unknown_rules:
        unknown.setdefault(rule, []).append(line)
    for rule, lines in [*unknown.items()][:_NAMED]:
        more = f" and {len(lines) - 1} more" if len(lines) > 1 else ""
        near = suggestion(rule, load_all()) or "; `polarcheck baseline prune` drops it"
        warn(f"{name}: line {lines[0]}{more}: unknown rule {rule!r}, which silences nothing{near}")
    if len(unknown) > _NAMED:
        warn(f"{name}: {len(unknown) - _NAMED} more unknown rules; `polarcheck baseline prune` drops them")
    if file.without_places:
        it = "it" if file.without_places == 1 else "them"
        warn(
            f"{name}: {counted(file.without_places, 'line')} of an earlier version of polarcheck, where a finding that "
            f"is worse now stays silent; `polarcheck baseline update` upgrades {it}"
        )


def without_known(outcomes: Iterable[Outcome], tasks: Sequence[Task], baselines: Baselines | None) -> Iterator[Outcome]:
    """Silence the findings of baselines in outcomes; at the end warn of known findings that no longer occur."""
    if baselines is None:
        yield from outcomes
        return
    import msgspec

    from polarcheck.batch.tasks import fails
    from polarcheck.finding import UNREADABLE

    settings = settings_of(tasks)
    for outcome in outcomes:
        if outcome.report is None or outcome.report.verdict == UNREADABLE:
            yield outcome
        else:
            report = baselines.without_known(outcome.report)
            yield msgspec.structs.replace(outcome, report=report, failed=fails(report, settings[report.path]))
    for file in baselines.files:
        _warn_leftovers(file.baseline, file.path)


def stale(baselines: Baselines | None) -> bool:
    """Return True if a baseline has entries whose findings no longer occur, or whose rule there is not."""
    return baselines is not None and any(
        any(file.unknown_rules) or any(file.baseline.leftovers()) for file in baselines.files
    )


def settings_of(tasks: Iterable[Task]) -> dict[str, Settings]:
    """Return the settings of each file, by its path in reports."""
    return {task.title: task.settings for task in tasks}


def _warn_leftovers(known: Baseline, path: Path) -> None:
    """Warn of known findings that no longer occur, and of moved files, in a line each."""
    from polarcheck.checking.rule import load_all
    from polarcheck.reading import files
    from polarcheck.reports import counted

    name = files.shown(os.fspath(path))
    moved = sorted((old, new) for new, old in known.moved.items() if old)
    if moved:
        named = _listed(f"{old} is {new}" for old, new in moved)
        warn(f"{name}: {_were(len(moved), 'file')} moved: {named}; `polarcheck baseline update` takes the new paths")
    # Unknown rules have a warning of their own.
    leftovers = [leftover for leftover in known.leftovers() if leftover.entry.rule in load_all()]
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
