"""`polarcheck config show`: the settings of a program, and where each value comes from."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from polarcheck.commands import options
from polarcheck.commands.output import show as print_out
from polarcheck.commands.output import warn

if TYPE_CHECKING:
    from polarcheck.reports.pages.applied import Row


@click.group(invoke_without_command=True)
@options.debug
@click.pass_context
def config(ctx: click.Context) -> None:
    """Show what polarcheck.toml and the options say of a program."""
    options.need_command(ctx)


@config.command
@click.argument("path", metavar="FILE")
@options.executing("programs")
@options.judging
@options.comparing
@options.extensions
@options.exclude
@options.text_or_json
@options.debug
@click.pass_context
def show(ctx: click.Context, /, path: str, **arguments: Any) -> None:
    """
    Show every value that applies to FILE, a program, and where it comes from: a line of a job file or of one of its
    entries, the machine, the command line, the environment, or the built-in default.

    \b
    polarcheck config show O1234.NC
    polarcheck config show O1234.NC --tool 8:radius=4
    """
    text = _effective(ctx, path, **arguments)
    print_out(text if arguments["form"] == "text" else text.encode())


def _effective(
    ctx: click.Context, path: str, *, form: str, no_config: bool, extensions: tuple[str, ...], **arguments: Any
) -> str:
    from polarcheck.files.settings import origins
    from polarcheck.files.settings.of_programs import OfPrograms, Options
    from polarcheck.program.reading import files
    from polarcheck.reports.pages import applied as page

    exclude: tuple[str, ...] = arguments["exclude"]
    settings_of = OfPrograms(Options(use_config=not no_config, **arguments))
    applied = settings_of.applied(path)
    if path != files.STANDARD_INPUT and not os.path.lexists(path):
        warn(f"{files.display_path(path)}: there is no such file; this is what would apply to it")
    of_command = dict(pair.split("=", 1) for pair in arguments["severities"])
    rows = [page.Row(*value) for value in origins.values(applied, _sources(ctx), of_command)]
    if exclude:
        rows = [_with_excluded(row, exclude) for row in rows]
    if extensions:
        rows = [
            row._replace(value=list(extensions), kind="command line", origin="command line --extensions")
            if row.key == "extensions"
            else row
            for row in rows
        ]
    names = [str(name) for name in applied.file.paths]
    entries = [
        f"{layer.at('files')}: {', '.join(applied.file.patterns(layer))}"
        for layer in applied.merged.layers
        if layer.entry
    ]
    excluded = settings_of.is_within_excluded(path)
    ignored = settings_of.behind(applied.file)
    if form == "json":
        not_taken = {"file": str(ignored.outer), "keys": ignored.keys} if ignored else None
        return page.as_json(files.display_path(path), names, entries, excluded, rows, not_taken)
    heads = [f"job file: {' extends '.join(names) or 'none'}", *(f"[[programs]]: {entry}" for entry in entries)]
    if ignored:
        heads.append(f'not taken over from {ignored.outer}: {", ".join(ignored.keys)}; extend = ".." would')
    if excluded:
        heads.append("excluded: no walk through a folder finds it")
    heads.append(f"the other values of the machine: polarcheck machines {applied.settings.name}")
    return page.text(files.display_path(path), heads, rows)


def _with_excluded(row: Row, patterns: Sequence[str]) -> Row:
    """Return the row of `exclude` with the patterns of the command line added; any other row as it is."""
    if row.key != "exclude":
        return row
    option = "command line --exclude"
    origin = f"{row.origin} and {option}" if row.value else option
    return row._replace(value=[*row.value, *patterns], kind="command line", origin=origin)


def _sources(ctx: click.Context) -> dict[str, str]:
    """Return where each option comes from, `command line` or `environment`; options that were not set are left out."""
    kinds = {
        click.core.ParameterSource.COMMANDLINE: "command line",
        click.core.ParameterSource.ENVIRONMENT: "environment",
    }
    sources = {name: ctx.get_parameter_source(name) for name in ctx.params}
    return {name: kinds[source] for name, source in sources.items() if source in kinds}
