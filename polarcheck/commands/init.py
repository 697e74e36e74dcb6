"""`polarcheck init`: writes a commented polarcheck.toml for a folder, with values from its programs."""

from __future__ import annotations

import os
from collections.abc import Set
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from polarcheck.commands import options
from polarcheck.commands.options import option
from polarcheck.commands.output import show, warn
from polarcheck.foundation.errors import UsageError


@click.command(short_help="Write a commented polarcheck.toml for the programs of a folder.")
@click.argument("folder", type=click.Path(exists=True, file_okay=False), default=".")
@click.option(
    "--part", "parts", type=click.Path(exists=True, dir_okay=False), multiple=True, metavar="FILE",
    help="Show the [[part]] of what this program makes now, and write nothing.",
)  # fmt: skip
@options.executing("programs")
@options.extensions
@options.max_size
@option("--schema/--no-schema", default=True, help="Write the schema beside it, which lets editors complete its keys.")
@option("-q", "--quiet", is_flag=True, help="No bar on the terminal.")
@options.debug
@click.pass_context
def init(
    ctx: click.Context,
    /,
    folder: str,
    parts: tuple[str, ...],
    extensions: tuple[str, ...],
    schema: bool,
    quiet: bool,
    **arguments: Any,
) -> None:
    """
    Write a commented polarcheck.toml into FOLDER, with the lathe and the tools that its programs tell.

    It asks nothing, overwrites nothing, and says what is still to fill in.

    With --part it writes no file, but shows the [[part]] entries of what programs make now, as a start: compare them
    with the drawing, and append them to polarcheck.toml. Then it takes the options that say how a program is read and
    run, and ends with 2 if something could not be read, 3 for a bug.

    \b
    polarcheck init
    polarcheck init programs --machine fanuc-30i
    polarcheck init --part O1234.NC --tool 8:radius=4 >> polarcheck.toml
    """
    written = {name for name in ctx.params if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE}
    if parts:
        _refuse(
            ctx, written & {"folder", "extensions", "schema"}, "cannot be combined with --part, which writes no file"
        )
        ctx.exit(_parts(parts, debug=options.DEBUG in ctx.meta, **arguments))
    _refuse(ctx, written & arguments.keys() - {"machine"}, "is for --part")
    lines = _init(folder, arguments["machine"], extensions, schema, quiet)
    show("".join(f"{line}\n" for line in lines))


def _refuse(ctx: click.Context, names: Set[str], reason: str) -> None:
    """Raise UsageError for the first of these parameters."""
    for parameter in ctx.command.params:
        if parameter.name in names:
            title = parameter.opts[0] if isinstance(parameter, click.Option) else (parameter.name or "").upper()
            raise UsageError(f"{title} {reason}")


def _parts(paths: tuple[str, ...], *, debug: bool, max_size: int, no_config: bool, **arguments: Any) -> int:
    """Show the [[part]] entries of what programs make; return the exit code."""
    from polarcheck.commands import progress, running
    from polarcheck.files.settings.of_programs import OfPrograms, Options
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.reports.made_parts.part_report import part_of
    from polarcheck.reports.pages import new_parts
    from polarcheck.rules.causes import READ_OTHERWISE

    keep_within_memory()
    applies = Options(
        use_config=not no_config,
        select=(*READ_OTHERWISE,),
        gives_verdicts=False,
        extras=(part_of,),
        **arguments,
    )
    faults = running.Faults(debug)
    tasks = running.planned(paths, OfPrograms(applies), (), faults)
    checked = running.Runner(max_size, 1, None).check(tasks, progress.Bar(len(tasks), True), faults)
    units = {task.title: task.settings.job.units for task in tasks}
    show(new_parts.text(checked.readable, units).encode())
    running.warn_unused(applies.tools, checked.called)
    return faults.report()


def _init(folder: str, machine: str | None, extensions: tuple[str, ...], schema: bool, quiet: bool) -> list[str]:
    from polarcheck.checking import survey
    from polarcheck.commands.progress import Bar
    from polarcheck.files.settings import job_files
    from polarcheck.files.settings.of_programs import profile_of
    from polarcheck.program.machines.job import FILE_NAME
    from polarcheck.program.reading import files, walking
    from polarcheck.program.reading.excerpt import head, visible
    from polarcheck.reports.pages import json_schema as schemas
    from polarcheck.reports.pages import new_job

    path = Path(folder, FILE_NAME)
    existing = job_files.in_folder(Path(folder))
    if existing is not None or os.path.lexists(path):
        raise UsageError(f"{existing or path} is there already; `polarcheck config show` tells what it says")
    profile = profile_of(machine) if machine else None
    nearest = job_files.Nearest().of(Path(folder))
    outer = Path(os.path.relpath(nearest, folder)).as_posix() if nearest else None
    endings = walking.extensions(extensions) or walking.EXTENSIONS
    programs = [str(Path(program)) for program in walking.walk(folder, endings, warn)]
    if not programs:
        warn(f"{files.display_path(folder)}: no NC programs in this folder; --extensions names other endings")
    named = [os.path.relpath(program, folder) for program in programs]
    results = survey.survey(programs, profile, Bar(len(programs), not quiet).watched(programs))
    results = new_job.relative(results, dict(zip(programs, named, strict=True)))
    written = _name(machine, Path(folder)) if machine else None
    schema_path = Path(folder, new_job.SCHEMA_FILE)
    is_new = schema and not os.path.lexists(schema_path)
    files.write(path, new_job.text(results, written, outer, schema, extensions))
    if is_new:
        files.write(schema_path, schemas.as_text(schemas.schema("job")))
    lines = [f"{head(files.display_path(path))} written: {new_job.summary(results)}"]
    if schema:
        lies = "beside it, for editors" if is_new else "is there already, and stays as it is"
        lines.append(f"{head(files.display_path(schema_path))} {lies}")
    if outer:
        lines.append(f"{head(outer)} has applied here so far: `extend` in the new file lets it apply still")
    lines += ["still to fill in:", *(f"  {line}" for line in new_job.left_open(results, written))]
    lines.append(f"then: polarcheck check {files.display_path(folder)}")
    return [visible(line) for line in lines]


def _name(machine: str, folder: Path) -> str:
    """Return a machine as a file in this folder must name it."""
    from polarcheck.program.machines import profiles

    return machine if machine in profiles.names() else Path(os.path.relpath(machine, folder)).as_posix()
