"""`polarcheck trace`: the executed table, or the moves of a path, as CSV or JSON lines."""

from __future__ import annotations

from itertools import chain
from typing import Any

import click

from polarcheck.commands import options
from polarcheck.commands.options import narrower, option
from polarcheck.commands.output import show, warn


@click.command(short_help="Show what a program does, block by block or move by move.")
@click.argument("path", metavar="FILE")
@options.executing("program", both=False)
@option("--path", "which", type=click.Choice(["tool", "programmed"]), help="The moves of a path, not the blocks.")
@narrower("--format", "form", type=click.Choice(["csv", "jsonl"]), default="csv", show_default=True)
@options.max_size
@options.debug
def trace(path: str, which: str | None, form: str, no_config: bool, max_size: int, **asked: Any) -> None:
    """
    Show what FILE does, block by block or, with --path, move by move inside polar sections.

    Lengths are mm, X as a radius, angles deg, feeds mm/min. Of a file with several channels one follows the other, and
    each line names its own. --path tool is the path of the tool center. What is run
    with G41 or G42 while the radius is not known is shown as programmed: those moves have "programmed" under path, and
    a line on standard error says what to give.
    """
    from polarcheck.checking import check
    from polarcheck.commands import settings
    from polarcheck.reading import files
    from polarcheck.reports.pages import executed
    from polarcheck.time_limit import seconds_for, time_limit

    found = settings.OfPrograms(settings.Options(use_config=not no_config, **asked))(path)
    data = files.read(path, max_size)
    with time_limit(seconds_for(len(data), found.job.run.max_seconds)):
        # One run for each channel: --block-skip asks for one state.
        runs = check.read(data, found.machine, found.job, files.shown(path), found.encoding)
        paths = [(tables["trace"], tables["tool_center"]) for _, tables in runs]
        for of_path in paths if which == "tool" else ():
            unknown = executed.without_radius(*of_path)
            if unknown:
                warn(unknown)
        items = chain.from_iterable(executed.moves(*one, which) if which else executed.rows(*one) for one in paths)
        for line in (executed.as_csv if form == "csv" else executed.as_jsonl)(items):
            if not show(line.encode()):
                break
