"""The options for silenced findings, and the warnings of baselines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from polarcheck.commands.options import option
from polarcheck.commands.output import warn

if TYPE_CHECKING:
    from polarcheck.files.baselines.baselines import Baselines
    from polarcheck.files.batch.tasks import Outcome, Task


def _readable(ctx: click.Context, parameter: click.Parameter, value: Path | None) -> Path | None:
    """Read the file before anything is checked, since a check of many files takes minutes."""
    if value is not None:
        from polarcheck.files.baselines import baseline_file

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
    from polarcheck.files.baselines.baselines import Baselines

    baselines = Baselines(tasks, walked)
    for line in baselines.faults:
        warn(line)
    return baselines


def without_known(outcomes: Iterable[Outcome], baselines: Baselines | None) -> Iterator[Outcome]:
    """Silence the findings of baselines in outcomes; at the end warn of known findings that no longer occur."""
    if baselines is None:
        yield from outcomes
        return
    yield from baselines.outcomes(outcomes)
    for line in baselines.leftovers:
        warn(line)
