"""`polarcheck check`: checks programs, writes the reports and decides the exit code."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from polarcheck.commands import (
    fixing,
    options,
    picturing,
    reporting,
    running,
    silencing,
    standard_input,
    watching,
)
from polarcheck.commands.diff_base import changed_files, diff_base, narrowed, with_callers
from polarcheck.commands.exit_codes import COULD_NOT_RUN, FINDINGS
from polarcheck.commands.options import option
from polarcheck.commands.output import COLUMNS, columns, draws_dots, in_color, say, show, warn
from polarcheck.reports import formats

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Task
    from polarcheck.files.settings.of_programs import Options
    from polarcheck.foundation.finding import Report
    from polarcheck.program.reading.walking import Skipped
    from polarcheck.reports import Background

#: With more files than this the default format is short.
_LONG = 3
#: Options that change the look or the destination of a report, the workers or the set of files, but no finding.
_OF_OUTPUT = (
    *("stdin_filename", "form", "outputs", "color", "quiet", "following", "silenced", "statistics", "shown_too"),
    *("lists_files", "exclude"),
    *("diff_base", "with_callers", "workers", "cluster", "watch", "cache_dir", "no_cache", *fixing.NAMES),
)
_FORMATS = formats()
#: The formats that count what the walks did not read; for others standard error does.
_WITH_SUMMARY = ("text", "short", "github", "json", "jsonl")
#: The formats that name files as the command line does, whatever repository they are in.
_OF_FILES = ("text", "short", "concise", "json", "jsonl")


@click.command
@click.argument("paths", nargs=-1, metavar="PATH...")
@options.executing("programs")
@options.judging
@options.comparing
@option(
    "--format",
    "form",
    type=click.Choice(_FORMATS),
    show_default=f"text for up to {_LONG} files, else short",
    help="Of the report on stdout.",
)
@options.outputs(_FORMATS)
@silencing.baseline
@silencing.no_baseline
@silencing.fail_on_stale
@reporting.statistics
@diff_base
@with_callers
@options.force_exclude
@options.extensions
@options.exclude
@options.max_size
@standard_input.filename
@options.jobs
@options.cluster
@options.cache_dir
@options.no_cache
@watching.watch
@options.color
@option("--show-following", "following", is_flag=True, help="In text, what follows from a finding, too.")
@silencing.show_silenced
@option("--part", "part", is_flag=True, help="In text, JSON and pages, what the program makes, too.")
@reporting.paths
@reporting.show_files
@option("-q", "--quiet", is_flag=True, help="Findings only.")
@fixing.wanted
@options.debug
@click.pass_context
def check(ctx: click.Context, /, paths: tuple[str, ...], watch: bool, with_callers: bool, **arguments: Any) -> None:
    """
    Check NC programs: files, folders, or - for standard input.

    The verdict of each is one of these (polarcheck explain pass, unverified, fail, unreadable):

    \b
    pass        all that matters was looked at, and nothing is wrong
    unverified  nothing wrong was found, but something that matters could
                not be judged: the report says what to give
    fail        something is wrong, or probably not what was meant
    unreadable  it could not be read, or not be checked to its end

    Ends with 0 if no file fails (nor is unverified, with --strict), 1 if one does, 2 if something could not be read,
    understood or written, 3 for a bug; 130 or 143 where it was interrupted or terminated: what was finished until then
    is reported.
    """
    changed = None
    if with_callers:
        changed = changed_files(paths, {"--diff-base": arguments["diff_base"], "--watch": watch})
        paths = (os.curdir,)
    elif not paths:
        raise click.MissingParameter(
            ctx=ctx, param=next(parameter for parameter in ctx.command.params if parameter.name == "paths")
        )
    fields = {name: arguments.pop(name) for name in _Arguments._fields if name in arguments}
    arguments["named"] = options.variables(ctx)
    chosen = _Arguments(
        **fields, paths=paths, changed=changed, command=_command(ctx), debug=options.DEBUG in ctx.meta, more=arguments
    )
    run = partial(_check, chosen)
    if watch:
        watching.refuse(
            paths, {"--fix": chosen.fixes.fix, "--diff": chosen.fixes.diff, "--diff-base": chosen.diff_base}
        )
    ctx.exit(watching.repeatedly(run, paths, chosen.outputs) if watch else run(None))


class _Arguments(NamedTuple):
    """
    The arguments of the command line.

    changed: the files of --with-callers; None without it.
    command: the command line that checks one of the files with the same options.
    more: the options that apply to programs, for Options.

    All other fields are the parameters of the command, by their names.
    """

    paths: tuple[str, ...]
    changed: Sequence[str] | None
    command: str
    debug: bool
    more: dict[str, Any]
    form: str | None
    outputs: list[tuple[str, Path]]
    no_config: bool
    no_baseline: bool
    fail_on_stale: bool
    force_exclude: bool
    extensions: tuple[str, ...]
    max_size: int
    stdin_filename: str | None
    workers: int
    cluster: str | None
    cache_dir: str | None
    no_cache: bool
    color: str
    quiet: bool
    following: bool
    silenced: bool
    statistics: bool
    part: bool
    lists_files: bool
    shown_too: str | None
    fixes: fixing.Wanted
    diff_base: str | None


def _command(ctx: click.Context) -> str:
    """Return the command line without its paths and without options of the output."""
    words = ["polarcheck check"]
    for parameter in ctx.command.params:
        name = parameter.name or ""
        if isinstance(parameter, click.Option) and name not in _OF_OUTPUT and _is_written(ctx, name):
            value = ctx.params[name]
            values = value if parameter.multiple else [value]
            written = parameter.secondary_opts if parameter.is_flag and not value else parameter.opts
            words += [
                max(written, key=len) + ("" if parameter.is_flag else f" {_quoted(element)}") for element in values
            ]
    return " ".join(words)


def _is_written(ctx: click.Context, name: str) -> bool:
    return ctx.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE and name in ctx.params


def _quoted(value: object) -> str:
    import shlex

    return shlex.quote(str(value))


def _check(arguments: _Arguments, seen: watching.Seen | None) -> int:
    from polarcheck.commands import live, overwriting, progress, signals
    from polarcheck.files.batch import tasks as batch
    from polarcheck.files.settings import decisions
    from polarcheck.files.settings.of_programs import OfPrograms
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.program.machines import profiles

    keep_within_memory()
    reporting.refuse(arguments.form, arguments.statistics)
    if arguments.lists_files:
        from polarcheck.commands import show_files

        needing = {"-o": arguments.outputs, "--fix": arguments.fixes.fix, "--diff": arguments.fixes.diff}
        show_files.refuse(arguments.form, {**needing, "--watch": seen is not None})
    applies = _options(arguments)
    faults = running.Faults(arguments.debug)
    skipped: list[Skipped] = []
    settings_of = OfPrograms(applies)
    tasks = running.planned(
        arguments.paths,
        settings_of,
        arguments.extensions,
        faults,
        # A hook may find that nothing is left.
        force_exclude=arguments.force_exclude or arguments.changed is not None,
        named=standard_input.judged_as(arguments.paths, arguments.stdin_filename),
        skipped=skipped,
    )
    folders = [batch.unreadable_folder(failure) for failure in faults.failures]
    pictures, outputs, written = picturing.of_outputs(
        arguments.outputs, arguments.form == picturing.FORMAT, tasks, "-o html:"
    )
    overwriting.refuse(written, tasks)
    run_settings = decisions.shared((task.settings for task in tasks), arguments.diff_base)
    if run_settings.differing:
        from polarcheck.files.batch.differing_settings import with_own_settings

        tasks = with_own_settings(tasks)
    looked_for = partial(settings_of.looked_for, walked=arguments.paths)
    tasks = narrowed(tasks, looked_for, arguments.diff_base, arguments.changed, arguments.max_size, not arguments.quiet)
    if arguments.lists_files:
        listed = show_files.text(arguments.form or "text", tasks, skipped)
        show(listed if arguments.form in (None, "text") else listed.encode())
        return faults.report()
    is_colored = in_color(arguments.color)
    shown_in = fixing.Shown(arguments.quiet, is_colored, arguments.debug, bool(arguments.outputs))
    baselines = silencing.of_run(tasks, arguments.paths)
    suppress = None if baselines is None else baselines.copy().without_known
    fixed = fixing.run(arguments.fixes, tasks, arguments.max_size, shown_in, suppress)
    if fixed.ends:
        return max(faults.report(), fixed.status)
    form = arguments.form or ("text" if len(tasks) <= _LONG or arguments.shown_too else "short")
    if not arguments.quiet:
        tasks = reporting.with_makes(tasks, (form, *(extra for extra, _ in arguments.outputs)))
    plain = _background(arguments, tasks, pictures, fixed.fixed, has_baseline=baselines is not None)
    bar = progress.Bar(len(tasks), not arguments.quiet)
    console = plain._replace(columns=columns(), color=is_colored)
    live_report = live.Live(
        form, console, len(tasks), bar.hide, in_place_of_findings=arguments.statistics, to_error=fixed.has_output
    )
    cache = None if arguments.no_cache else running.cache(arguments.max_size, arguments.cache_dir)
    runner = running.Runner(arguments.max_size, arguments.workers, arguments.cluster, seen, cache)
    pictures.begin(plain)
    checked = runner.check(tasks, bar, faults, baselines, live_report.file, pictures.split, folders)
    is_stale = arguments.fail_on_stale and baselines is not None and baselines.is_stale
    status = max(int(checked.failed or is_stale), fixed.status, faults.report())
    reason = checked.broken_off
    if checked.stopped is not None:
        status, how = signals.exit_status(checked.stopped)
        reason = f"{how} after {len(checked.files)} of {len(tasks)} files; these are reported"
        say(reason)
    report = batch.report(
        checked.files,
        tasks[0].settings.machine_id if tasks else profiles.machine_id(applies.machine or profiles.DEFAULT),
        settings=run_settings,
        interrupted=batch.interrupted(reason, checked.files, tasks) if reason else None,
        skipped=skipped,
        called_files=checked.called_files,
        assumed=fixed.assumed,
    )
    for excess in _excesses(report, tasks):
        say(excess)
        status = max(status, FINDINGS)
    pictures.end(reporting.unread(report.summary))
    if checked.stopped is None and arguments.diff_base is None and arguments.changed is None:
        running.warn_unused(applies.tools, checked.called)
        running.warn_without_part(applies.tolerance, tasks)
    for error in reporting.written(outputs, form, report, plain._replace(lines=checked.lines)):
        say(str(error))
        status = max(status, COULD_NOT_RUN)
    live_report.end(report, checked.lines)
    if not arguments.quiet:
        _warn_of_the_rest(form, report)
    if checked.stopped is None and baselines is None and cache is not None and _prints_alone(arguments, form, seen):
        cache.keep_run(arguments.paths, status)
    return status


def _prints_alone(arguments: _Arguments, form: str, seen: watching.Seen | None) -> bool:
    """Return True if a run does no more than print a report that rests on files, and on nothing of git."""
    writes = arguments.outputs or arguments.fixes.fix or arguments.fixes.diff or arguments.cluster
    is_narrowed = arguments.diff_base is not None or arguments.changed is not None or seen is not None
    return form in _OF_FILES and not writes and not is_narrowed


def _options(arguments: _Arguments) -> Options:
    """Return the options that apply to programs, with what reports ask of each."""
    from polarcheck.files.settings.of_programs import Options

    extras = reporting.extras(arguments.shown_too, arguments.form, arguments.outputs)
    if picturing.FORMAT in (arguments.form, *(form for form, _ in arguments.outputs)):
        extras += picturing.extras()
    if arguments.part:
        from polarcheck.reports.made_parts.compared_contours import compared_in
        from polarcheck.reports.made_parts.part_report import part_of

        extras = (*extras, part_of, compared_in)
    return Options(
        use_config=not arguments.no_config,
        use_baseline=not arguments.no_baseline,
        extras=extras,
        **arguments.more,
    )


def _background(
    arguments: _Arguments, tasks: Sequence[Task], pictures: picturing.Pictures, fixed: int, *, has_baseline: bool
) -> Background:
    """
    Return what reports in files show; the terminal has its own width and colors.

    fixed: how many fixes were written.
    """
    from polarcheck import reports
    from polarcheck.rules import rule

    return reporting.background(
        reports.Background(
            rules=rule.load_all(),
            columns=COLUMNS,
            quiet=arguments.quiet,
            command=arguments.command,
            following=arguments.following,
            silenced=arguments.silenced,
            fixed=fixed,
            dots=draws_dots(),
            has_baseline=has_baseline,
            drawn=pictures.drawn,
        ),
        tasks,
    )


def _excesses(report: Report, tasks: Sequence[Task]) -> Sequence[str]:
    """Return a line for each --max-warnings that is exceeded."""
    if all(task.settings.decided.max_warnings is None for task in tasks):
        return ()
    from polarcheck.files.batch.differing_settings import too_many_warnings

    return [*too_many_warnings(report.files, tasks)]


def _warn_of_the_rest(form: str, report: Report) -> None:
    """Warn of what a report of this format does not say."""
    if form not in _WITH_SUMMARY:
        for line in reporting.unread(report.summary):
            warn(line)
    if form == "concise" and any(file.verdict == "unverified" for file in report.files):
        warn("some files are unverified; --format text says why, and what to give")
