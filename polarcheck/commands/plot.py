"""`polarcheck plot`: pages with pictures of the part and of the tool path."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import click

from polarcheck.commands import options, picturing, serving, still_files
from polarcheck.commands.options import option


@click.command(short_help="Draw what a program makes and how the tool runs, as a page.")
@click.argument("paths", nargs=-1, required=True, metavar="PATH...")
@options.executing("programs")
@options.comparing
@option(
    "-o",
    "--output",
    metavar="FILE",
    help="The page; or a folder, for a page of each program and index.html; a picture with the ending .png or .svg.",
)
@still_files.options
@serving.options
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
    png: str | None,
    svg: str | None,
    chosen: tuple[int, ...],
    serve: bool,
    port: int | None,
    opens: bool,
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
    ending, each of several programs gets its page, beside an index.html that leads to them. --png and --svg write the
    face of each section with its findings as a picture for a document. --serve shows the page in a browser, and shows
    it anew as soon as a program is saved, until Ctrl-C.

    Ends with 0 where all pages were made, whatever was found, 2 if something could not be read or written, 3 for a
    bug.
    """
    from polarcheck import reports
    from polarcheck.commands import overwriting, progress, reporting, running, signals
    from polarcheck.commands.output import say, show
    from polarcheck.files.batch import tasks as batch
    from polarcheck.files.settings.of_programs import OfPrograms, Options
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.program.machines import profiles
    from polarcheck.program.reading import files
    from polarcheck.rules import rule

    keep_within_memory()
    serving.refuse(
        serve,
        paths,
        {"-o": output, "--png": png, "--svg": svg, "--section": chosen},
        {name: options.is_written(ctx, name[2:]) for name in ("--port", "--open")},
    )
    if serve:
        applies = Options(use_config=not no_config, extras=picturing.extras(), **arguments)
        debug = options.DEBUG in ctx.meta
        ctx.exit(serving.serve(serving.Wish(paths, applies, extensions, max_size, workers, port or 0, opens, debug)))
    targets, output = still_files.targets(png, svg, output)
    has_page = output is not None or not targets
    applies = Options(use_config=not no_config, extras=picturing.extras(for_page=has_page), **arguments)
    faults = running.Faults(options.DEBUG in ctx.meta)
    tasks = running.planned(paths, OfPrograms(applies), extensions, faults)
    outputs = [] if output is None else [(picturing.FORMAT, Path(output))]
    pictures, pages, written = (
        picturing.of_outputs(outputs, output is None, tasks, "-o ") if has_page else (picturing.Discarded(), [], [])
    )
    stills = still_files.Stills(targets, tasks, chosen)
    overwriting.refuse([*written, *stills.files], tasks, stills.options)
    plain = reports.Background(rules=rule.load_all(), drawn=pictures.drawn)
    background = reporting.background(plain, tasks)
    pictures.begin(background)
    stills.begin()
    pictures.also = partial(stills.write, background=background)
    bar = progress.Bar(len(tasks), True)
    checked = running.Runner(max_size, workers, None).check(tasks, bar, faults, take=pictures.split)
    status = faults.report()
    if checked.stopped is not None:
        status, how = signals.exit_status(checked.stopped)
        say(f"{how} after {len(checked.files)} of {len(tasks)} files")
    pictures.end()
    to_stdout = has_page and output is None
    readable = checked.readable if pages or to_stdout else []
    if readable:
        report = batch.report(readable, profiles.machine_id(applies.machine or profiles.DEFAULT))
        page = reports.render(picturing.FORMAT, report, background)
        for _, path in pages:
            files.write(path, page)
        if to_stdout:
            show(page.encode())
    if checked.stopped is None:
        running.warn_unused(applies.tools, checked.called)
    ctx.exit(status)
