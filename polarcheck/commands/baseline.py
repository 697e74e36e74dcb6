"""`polarcheck baseline`: records the known findings, so that only new ones are reported."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from polarcheck.commands import options
from polarcheck.commands.check import check
from polarcheck.commands.output import say, show

if TYPE_CHECKING:
    from polarcheck.files.baselines.baseline import Baseline
    from polarcheck.files.baselines.baseline_file import Contents
    from polarcheck.files.batch.tasks import Checked, Task

#: The argument and options of `check` that decide what is found.
DECIDING = (
    *("paths", "machine", "changes", "tools", "offsets", "units", "select", "ignore", "severities", "inline"),
    *("config", "no_config", "drawings", "drawing_layers", "tolerance", "block_skip", "subprograms"),
    *("max_blocks", "max_statements", "max_seconds"),
    *("radius_from_comments", "extensions", "exclude", "encoding", "max_size", "workers", "cluster"),
)
_FILE = "polarcheck-baseline.json"

#: The new contents of a baseline, and one line on them.
_Result = tuple["Contents", str]


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
    options.need_command(ctx)


def _output(text: str) -> Callable[[Any], Any]:
    return click.option(
        "-o", "--output", type=click.Path(dir_okay=False, path_type=Path),
        show_default=f"the baseline of polarcheck.toml, else {_FILE}",
        envvar="POLARCHECK_BASELINE", metavar="FILE", help=text,
    )  # fmt: skip


_reason = options.option("--reason", default="", metavar="TEXT", help="Why new findings may stay; reports tell it.")


def _deciding(command: click.Command) -> click.Command:
    """Add the parameters of `check` that decide what is found."""
    command.params = [parameter for parameter in check.params if parameter.name in DECIDING] + command.params
    return command


_quiet = click.option("-q", "--quiet", is_flag=True, help="No line on what was written, and no progress.")


@_deciding
@baseline.command
@_output("To write; it must not be there yet.")
@_reason
@_quiet
@options.debug
@click.pass_context
def create(ctx: click.Context, /, paths: tuple[str, ...], **arguments: Any) -> None:
    """
    Write down all findings of the programs.

    Nothing is overwritten: `polarcheck baseline update` takes a file that is there.
    """
    ctx.exit(_run(paths, options.DEBUG in ctx.meta, _none_yet, _updated, **arguments))


@_deciding
@baseline.command
@_output("To rewrite.")
@_reason
@_quiet
@options.debug
@click.pass_context
def update(ctx: click.Context, /, paths: tuple[str, ...], **arguments: Any) -> None:
    """
    Take what is found now: new findings come in, those that no longer occur go, reasons stay.

    Programs that are not among the paths keep what is known of them.
    """
    ctx.exit(_run(paths, options.DEBUG in ctx.meta, _contents, _updated, **arguments))


@_deciding
@baseline.command
@_output("To rewrite.")
@_quiet
@options.debug
@click.pass_context
def prune(ctx: click.Context, /, paths: tuple[str, ...], **arguments: Any) -> None:
    """
    Drop what no longer occurs; nothing new comes in.

    Kept is what could not be evaluated now, and what is known of programs that are not among the paths.
    """
    ctx.exit(_run(paths, options.DEBUG in ctx.meta, _contents, _pruned, **arguments))


def _none_yet(path: Path) -> Contents:
    """Return an empty baseline. Raises BaselineError for a file that is there."""
    from polarcheck.files.baselines.baseline_file import Contents
    from polarcheck.foundation.errors import BaselineError
    from polarcheck.program.reading import files

    if path.exists() or path.is_symlink():
        name = files.display_path(path)
        raise BaselineError(f"-o {name}: is there already; `polarcheck baseline update` rewrites it, or name another")
    return Contents()


def _contents(path: Path) -> Contents:
    from polarcheck.files.baselines import baseline_file
    from polarcheck.foundation.errors import BaselineError
    from polarcheck.program.reading import files

    if not path.exists():
        raise BaselineError(f"-o {files.display_path(path)}: there is none; `polarcheck baseline create` writes it")
    return baseline_file.read(path)


def _run(
    paths: tuple[str, ...],
    debug: bool,
    read: Callable[[Path], Contents],
    make: Callable[[Baseline, Contents, Checked, list[Task], str], _Result],
    *,
    output: Path | None,
    quiet: bool,
    no_config: bool,
    extensions: tuple[str, ...],
    max_size: int,
    workers: int,
    cluster: str | None,
    reason: str = "",
    **arguments: Any,
) -> int:
    import msgspec

    from polarcheck.commands import overwriting, running, signals
    from polarcheck.commands.progress import Bar
    from polarcheck.files.baselines import baseline_file
    from polarcheck.files.baselines.baseline import Baseline
    from polarcheck.files.batch.tasks import with_settings
    from polarcheck.files.settings.of_programs import OfPrograms, Options
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.program.reading import files
    from polarcheck.program.reading.excerpt import head

    keep_within_memory()
    if output is not None:
        read(output)
    faults = running.Faults(debug)
    applies = Options(use_config=not no_config, **arguments)
    tasks = running.planned(paths, OfPrograms(applies), extensions, faults)
    target = output or _of_jobs(tasks)
    contents = read(target)
    tasks = with_settings(tasks, lambda settings: msgspec.structs.replace(settings, baseline=target))
    overwriting.refuse_name(os.path.realpath(target), f"-o {files.display_path(target)}")
    checked = running.Runner(max_size, workers, cluster).check(tasks, Bar(len(tasks), not quiet), faults)
    status = faults.report()
    if checked.stopped is not None:
        interrupted, how = signals.exit_status(checked.stopped)
        say(f"{how}; nothing is written")
        return interrupted
    baseline = Baseline(contents, target.parent, (task.place for task in tasks), paths)
    updated, summary = make(baseline, contents, checked, tasks, reason)
    files.write(target, baseline_file.text_of(updated), rewrites=True)
    if not quiet:
        show(f"{head(files.display_path(target))}: {summary}\n")
    return status


def _of_jobs(tasks: list[Task]) -> Path:
    """Return the baseline that the job files name. Raises UsageError if they name several."""
    from polarcheck.foundation.errors import UsageError
    from polarcheck.program.reading import files

    named = {str(task.settings.baseline) for task in tasks if task.settings.baseline is not None}
    if len(named) > 1:
        paths_listed = ", ".join(files.display_path(path) for path in sorted(named))
        raise UsageError(f"-o: these programs have several baselines, {paths_listed}; update those of one at a time")
    return Path(named.pop() if named else _FILE)


def _updated(baseline: Baseline, before: Contents, checked: Checked, tasks: list[Task], reason: str) -> _Result:
    from polarcheck.files.baselines.baselines import evaluated
    from polarcheck.files.batch.tasks import settings_of

    settings = settings_of(tasks)
    updated = baseline.updated(((report, evaluated(report, settings[report.path])) for report in checked.files), reason)
    was, now = baseline.total(before.entries), baseline.total(updated.contents.entries)
    changed = f"; {updated.new} new, {was + updated.new - now} gone" if was else ""
    return updated.contents, f"{_counts(updated.contents)} known{changed}"


def _pruned(baseline: Baseline, before: Contents, checked: Checked, tasks: list[Task], reason: str) -> _Result:
    from polarcheck.files.baselines.baselines import evaluated
    from polarcheck.files.batch.tasks import settings_of

    settings = settings_of(tasks)
    for report in checked.files:
        baseline.without_known(report, evaluated(report, settings[report.path]))
    pruned = baseline.pruned()
    return pruned, f"{_counts(pruned)} known; {baseline.total(before.entries) - baseline.total(pruned.entries)} gone"


def _counts(contents: Contents) -> str:
    from polarcheck.files.baselines.baseline import Baseline
    from polarcheck.foundation.errors import counted

    files = len({entry.file for entry in contents.entries})
    return f"{counted(Baseline.total(contents.entries), 'finding')} of {counted(files, 'file')}"
