"""`polarcheck plot`: pages with pictures of the part and of the tool path."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from polarcheck.commands import options, picturing
from polarcheck.commands.options import option


@click.command(short_help="Draw what a program makes and how the tool runs, as a page.")
@click.argument("paths", nargs=-1, required=True, metavar="PATH...")
@options.executing("programs")
@option(
    "-o",
    "--output",
    metavar="FILE",
    help="The page; or a folder, for a page of each program and index.html.",
)
@options.extensions
@options.exclude
@options.max_size
@options.jobs
@options.debug
@click.pass_context
def plot(
    ctx: click.Context,
    /,
    paths: tuple[str, ...],
    output: str | None,
    extensions: tuple[str, ...],
    max_size: int,
    workers: int,
    no_config: bool,
    **arguments: Any,
) -> None:
    """
    Draw what programs make and how the tool runs: files, folders, or - for standard input.

    The page holds all that it needs, and works without a network: of each polar section the programmed contour, the
    path of the tool center, the finished part and the cutter, with the rates of C and X over time; and the findings of
    `check`. It is written to FILE, or to standard output. In FOLDER, one that is there or a new one whose name has no
    ending, each of several programs gets its page, beside an index.html that leads to them.

    Ends with 0 where all pages were made, whatever was found, 2 if something could not be read or written, 3 for a
    bug.
    """
    from polarcheck import reports
    from polarcheck.batch import tasks as batch
    from polarcheck.checking import rule
    from polarcheck.commands import overwriting, progress, reporting, running, signals
    from polarcheck.commands.output import say, show
    from polarcheck.machines import profiles
    from polarcheck.memory import keep_within_memory
    from polarcheck.reading import files
    from polarcheck.settings.of_programs import OfPrograms, Options

    keep_within_memory()
    applies = Options(use_config=not no_config, extras=picturing.extras(), **arguments)
    faults = running.Faults(options.DEBUG in ctx.meta)
    tasks = running.planned(paths, OfPrograms(applies), extensions, faults)
    outputs = [] if output is None else [(picturing.FORMAT, Path(output))]
    pictures, pages, written = picturing.of_outputs(outputs, output is None, tasks, "-o ")
    overwriting.refuse(written, tasks)
    plain = reports.Background(rules=rule.load_all(), drawn=pictures.drawn)
    background = reporting.background(plain, tasks)
    pictures.begin(background)
    bar = progress.Bar(len(tasks), True)
    checked = running.Runner(max_size, workers, None).check(tasks, bar, faults, take=pictures.split)
    status = faults.report()
    if checked.stopped is not None:
        status, how = signals.exit_status(checked.stopped)
        say(f"{how} after {len(checked.files)} of {len(tasks)} files")
    pictures.end()
    readable = checked.readable if pages or output is None else []
    if readable:
        report = batch.report(readable, profiles.machine_id(applies.machine or profiles.DEFAULT))
        page = reports.render(picturing.FORMAT, report, background)
        for _, path in pages:
            files.write(path, page)
        if output is None:
            show(page.encode())
    if checked.stopped is None:
        running.warn_unused(applies.tools, checked.called)
    ctx.exit(status)
