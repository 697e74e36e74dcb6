"""`polarcheck baseline`: records the known findings, so that only new ones are reported."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from polarcheck.commands import options
from polarcheck.commands.check import check
from polarcheck.commands.exit_codes import COULD_NOT_RUN
from polarcheck.commands.output import say, show

if TYPE_CHECKING:
    from polarcheck.batch.baseline import Baseline
    from polarcheck.batch.baseline_file import Entry
    from polarcheck.batch.tasks import Checked, Task

#: The argument and options of `check` that decide what is found.
DECIDING = (
    *("paths", "machine", "changes", "tools", "offsets", "units", "select", "ignore", "severities", "inline"),
    *("config", "no_config", "drawings", "drawing_layers", "tolerance", "block_skip", "subprograms"),
    *("max_blocks", "max_statements", "max_seconds"),
    *("radius_from_comments", "extensions", "encoding", "max_size", "workers", "cluster"),
)
_FILE = "polarcheck-baseline.json"

#: The new entries of a baseline, and one line on them.
_Result = tuple[list["Entry"], str]


@click.group(invoke_without_command=True, short_help="Write down what is known, so that new findings alone are told.")
@options.debug
@click.pass_context
def baseline(ctx: click.Context) -> None:
    """
    Write down the findings that are known, so that `check --baseline FILE` tells new ones only.

    \b
    polarcheck baseline create programs/
    polarcheck check --baseline polarcheck-baseline.json programs/

    A finding is known by its rule and its block, whatever its line: programs can be renumbered, punched out and moved.
    Give the options that you give to check.
    """
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help(), err=True)
        ctx.exit(COULD_NOT_RUN)


def _output(text: str) -> Callable[[Any], Any]:
    return click.option(
        "-o", "--output", type=click.Path(dir_okay=False, path_type=Path), default=_FILE, show_default=True,
        envvar="POLARCHECK_BASELINE", metavar="FILE", help=text,
    )  # fmt: skip


_reason = options.option("--reason", default="", metavar="TEXT", help="Why new findings may stay; reports tell it.")


def _deciding(command: click.Command) -> click.Command:
    """Add the parameters of `check` that decide what is found."""
    command.params = [parameter for parameter in check.params if parameter.name in DECIDING] + command.params
    return command


@_deciding
@baseline.command
@_output("To write; it must not be there yet.")
@_reason
@options.debug
@click.pass_context
def create(ctx: click.Context, /, paths: tuple[str, ...], output: Path, **arguments: Any) -> None:
    """
    Write down all findings of the programs.

    Nothing is overwritten: `polarcheck baseline update` takes a file that is there.
    """
    from polarcheck.errors import BaselineError
    from polarcheck.reading import files

    if output.exists() or output.is_symlink():
        name = files.shown(str(output))
        raise BaselineError(f"-o {name}: is there already; `polarcheck baseline update` rewrites it, or name another")
    ctx.exit(_run(paths, output, options.DEBUG in ctx.meta, [], _updated, **arguments))


@_deciding
@baseline.command
@_output("To rewrite.")
@_reason
@options.debug
@click.pass_context
def update(ctx: click.Context, /, paths: tuple[str, ...], output: Path, **arguments: Any) -> None:
    """
    Take what is found now: new findings come in, those that no longer occur go, reasons stay.

    Programs that are not among the paths keep what is known of them.
    """
    ctx.exit(_run(paths, output, options.DEBUG in ctx.meta, _known(output), _updated, **arguments))


@_deciding
@baseline.command
@_output("To rewrite.")
@options.debug
@click.pass_context
def prune(ctx: click.Context, /, paths: tuple[str, ...], output: Path, **arguments: Any) -> None:
    """
    Drop what no longer occurs; nothing new comes in.

    Kept is what could not be evaluated now, and what is known of programs that are not among the paths.
    """
    ctx.exit(_run(paths, output, options.DEBUG in ctx.meta, _known(output), _pruned, **arguments))


def _known(path: Path) -> list[Entry]:
    from polarcheck.batch import baseline_file
    from polarcheck.errors import BaselineError
    from polarcheck.reading import files

    if not path.exists():
        raise BaselineError(f"-o {files.shown(str(path))}: there is none; `polarcheck baseline create` writes it")
    return baseline_file.read(path)


def _run(
    paths: tuple[str, ...],
    output: Path,
    debug: bool,
    entries: list[Entry],
    make: Callable[[Baseline, list[Entry], Checked, list[Task], str], _Result],
    *,
    no_config: bool,
    extensions: tuple[str, ...],
    max_size: int,
    workers: int,
    cluster: str | None,
    reason: str = "",
    **arguments: Any,
) -> int:
    from polarcheck.batch import baseline_file
    from polarcheck.batch.baseline import Baseline
    from polarcheck.commands import overwriting, running, signals
    from polarcheck.commands.progress import Bar
    from polarcheck.memory import keep_within_memory
    from polarcheck.reading import files
    from polarcheck.settings.of_programs import OfPrograms, Options

    keep_within_memory()
    faults = running.Faults(debug)
    applies = Options(use_config=not no_config, **arguments)
    tasks = running.planned(paths, OfPrograms(applies), extensions, faults)
    overwriting.refuse([output], tasks)
    checked = running.Runner(max_size, workers, cluster).check(tasks, Bar(len(tasks), True), faults)
    status = faults.report()
    if checked.stopped is not None:
        interrupted, how = signals.exit_status(checked.stopped)
        say(f"{how}; nothing is written")
        return interrupted
    known = Baseline(entries, output.parent, (task.place for task in tasks), paths)
    updated, summary = make(known, entries, checked, tasks, reason)
    files.write(output, baseline_file.text_of(updated))
    show(f"{files.shown(str(output))}: {summary}\n")
    return status


def _updated(known: Baseline, entries: list[Entry], checked: Checked, tasks: list[Task], reason: str) -> _Result:
    from polarcheck.commands.silencing import evaluated, settings_of
    from polarcheck.reports import counted

    settings = settings_of(tasks)
    updated = known.updated(((report, evaluated(report, settings[report.path])) for report in checked.files), reason)
    before, now = known.total(entries), known.total(updated.entries)
    files = len({entry.file for entry in updated.entries})
    changed = f"; {updated.new} new, {before + updated.new - now} gone" if before else ""
    return updated.entries, f"{counted(now, 'finding')} of {counted(files, 'file')} known{changed}"


def _pruned(known: Baseline, entries: list[Entry], checked: Checked, tasks: list[Task], reason: str) -> _Result:
    from polarcheck.commands.silencing import evaluated, settings_of
    from polarcheck.reports import counted

    settings = settings_of(tasks)
    for report in checked.files:
        known.without_known(report, evaluated(report, settings[report.path]))
    left = known.pruned()
    now = known.total(left)
    files = len({entry.file for entry in left})
    return left, f"{counted(now, 'finding')} of {counted(files, 'file')} known; {known.total(entries) - now} gone"
