"""`polarcheck part`: the parts that programs make, in the words and numbers of a drawing."""

from __future__ import annotations

from typing import Any

import click

from polarcheck.commands import options


@click.command(short_help="Tell what a program makes: hexagon, 27.000 across flats.")
@click.argument("paths", nargs=-1, required=True, metavar="PATH...")
@options.executing("programs")
@options.comparing
@options.text_or_json
@options.extensions
@options.exclude
@options.max_size
@options.jobs
@options.debug
@click.pass_context
def part(ctx: click.Context, /, paths: tuple[str, ...], **arguments: Any) -> None:
    """
    Tell what programs make: files, folders, or - for standard input.

    Of each polar section and depth the shape of the finished part with its sizes, and what the cutter leaves standing.
    Sizes are in the program's own units. With G41 and G42 the programmed contour is the part; without them the cutter
    runs along the path, and its radius must be known. Where a drawing is given, or polarcheck.toml says what a program
    should make, it is told how far the part agrees with that, or where it differs.

    Ends with 0; with 1 where a part differs from its drawing, or a program is for another control, so that nothing that
    is told can be believed; 2 if something could not be read, 3 for a bug.
    """
    ctx.exit(_part(paths, debug=options.DEBUG in ctx.meta, **arguments))


def _part(
    paths: tuple[str, ...],
    *,
    debug: bool,
    form: str,
    extensions: tuple[str, ...],
    max_size: int,
    workers: int,
    no_config: bool,
    **arguments: Any,
) -> int:
    from polarcheck.api.parts import EXTRAS, RULES
    from polarcheck.commands import progress, running, signals
    from polarcheck.commands.output import columns, say, show
    from polarcheck.files.settings.of_programs import OfPrograms, Options
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.reports.pages import part_lines

    keep_within_memory()
    applies = Options(use_config=not no_config, select=RULES, gives_verdicts=False, extras=EXTRAS, **arguments)
    faults = running.Faults(debug)
    tasks = running.planned(paths, OfPrograms(applies), extensions, faults)
    checked = running.Runner(max_size, workers, None).check(tasks, progress.Bar(len(tasks), True), faults)
    status = max(int(checked.failed), faults.report())
    if checked.stopped is not None:
        status, how = signals.exit_status(checked.stopped)
        say(f"{how} after {len(checked.files)} of {len(tasks)} files; these are reported")
    else:
        running.warn_unused(applies.tools, checked.called)
        running.warn_without_part(applies.tolerance, tasks)
    files = checked.readable
    show(part_lines.json(files).encode() if form == "json" else part_lines.text(files, columns()))
    return status
