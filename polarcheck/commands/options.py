"""Options of several commands; the environment can set each of them, too."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import click

from polarcheck.commands.exit_codes import COULD_NOT_RUN
from polarcheck.files.settings.declarations import SETTINGS
from polarcheck.foundation.patterns import lazy_pattern

Decorator = Callable[[Any], Any]

#: The key of --debug in the meta of the context, which a group shares with its commands.
DEBUG = "polarcheck.debug"


#: 512MB, 2G, 1.5 GiB, 100k, 4096: k is 1000 bytes, Ki 1024.
_SIZE = lazy_pattern(r"\s*+(\d{1,15}|\d{0,15}\.\d{1,15})\s*+(?:([KMGT])(I?))?B?\s*+", re.IGNORECASE | re.ASCII)
_PREFIXES = " KMGT"


class _Narrower(click.Option):
    """A choice whose values differ from those in `check`; values of the environment that it lacks are ignored."""

    def resolve_envvar_value(self, ctx: click.Context) -> str | None:
        """Return the value of the environment, unless only `check` has this value."""
        value = super().resolve_envvar_value(ctx)
        return value if isinstance(self.type, click.Choice) and value in self.type.choices else None


def option(*names: str, **attributes: Any) -> Decorator:
    """Return an option of click that the environment can set, too: POLARCHECK_FAIL_ON for --fail-on."""
    written = max((name.partition("/")[0] for name in names if name.startswith("--")), key=len)
    return click.option(*names, envvar="POLARCHECK_" + written[2:].upper().replace("-", "_"), **attributes)


def narrower(*names: str, **attributes: Any) -> Decorator:
    """Return such an option for a choice whose values differ from those of this option in `check`."""
    return option(*names, cls=_Narrower, **attributes)


def many(*names: str, **attributes: Any) -> Decorator:
    """Return an option that may be repeated, and may hold several names with commas between."""
    return option(*names, multiple=True, callback=_listed, **attributes)


def _listed(ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(name for value in values for name in value.replace(",", " ").split())


def outputs(formats: Sequence[str]) -> Decorator:
    """Return the option --output, which may be repeated: a format and a file each."""
    return option(
        "-o",
        "--output",
        "outputs",
        multiple=True,
        callback=partial(_outputs, formats),
        metavar="FORMAT:FILE",
        help="A report in a file, too.",
    )


def _outputs(
    formats: Sequence[str], ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> list[tuple[str, Path]]:
    reports = []
    for value in values:
        form, _, path = value.partition(":")
        if form not in formats or not path:
            raise click.BadParameter(f"{value!r}: expected FORMAT:FILE, the format one of {', '.join(formats)}")
        if path == "-":
            raise click.BadParameter(f"{value!r}: --format chooses the report on standard output")
        reports.append((form, Path(path)))
    return reports


def _known_encoding(ctx: click.Context, parameter: click.Parameter, value: str | None) -> str | None:
    if value is None:
        return None
    from polarcheck.program.reading.source import is_encoding

    if not is_encoding(value):
        raise click.BadParameter(f"unknown encoding {value!r}; for example utf-8, cp1252, shift_jis")
    return value


def _in_bytes(ctx: click.Context, parameter: click.Parameter, value: str) -> int:
    match = _SIZE.fullmatch(value)
    size = 0
    if match:
        size = round(float(match[1]) * (1024 if match[3] else 1000) ** _PREFIXES.index((match[2] or " ").upper()))
    if not size:
        raise click.BadParameter(f"{value!r}: expected a size above 0, such as 512MB, 2G, 100k or 4096 (bytes)")
    return size


#: The most processes; a higher number is a typing error.
_MOST_PROCESSES = 1024


def _number_of_processes(ctx: click.Context, parameter: click.Parameter, value: str) -> int:
    text = value.strip().lower()
    if text == "auto":
        return 0
    if text.isascii() and text.isdecimal() and int(text) <= _MOST_PROCESSES:
        return int(text)
    raise click.BadParameter(f"{value!r}: expected a number of processes up to {_MOST_PROCESSES}, or auto")


jobs = option(
    "-j", "--jobs", "workers", callback=_number_of_processes, default="auto", show_default="all cores where it pays",
    metavar="N", help="Processes that check; 1 for this one alone.",
)  # fmt: skip
cache_dir = option(
    "--cache-dir", metavar="FOLDER", type=click.Path(file_okay=False),
    help="Where results are kept for the next run, instead of .polarcheck_cache beside polarcheck.toml.",
)  # fmt: skip
no_cache = option("--no-cache", is_flag=True, help="Keep no results, and use none of earlier runs.")
cluster = option("--cluster", metavar="tcp://HOST:PORT", help="Let a cluster of dask.distributed check.")
max_size = option(
    "--max-size", callback=_in_bytes, default="64MB", show_default=True, metavar="SIZE",
    help="Of a program: a larger one is not read; it would take some 40 bytes of memory for each byte.",
)  # fmt: skip


def variables(ctx: click.Context) -> dict[str, str]:
    """Return the variables of the environment that have set options, as `POLARCHECK_SELECT=`, by the option's name."""
    named = {}
    for parameter in ctx.command.params:
        name = parameter.name or ""
        if ctx.get_parameter_source(name) is click.core.ParameterSource.ENVIRONMENT:
            variable = parameter.envvar
            named[name] = f"{variable if isinstance(variable, str) else name}="
    return named


def is_written(ctx: click.Context, option: str) -> bool:
    """Return True if an option stands on the command line, and not in the environment only. option: such as `port`."""
    flag = f"--{option}"
    name = next(parameter.name or "" for parameter in ctx.command.params if flag in parameter.opts)
    return ctx.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE


def need_command(ctx: click.Context) -> None:
    """Show the help of a group, and end with an exit code, where none of its commands is named."""
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help(), err=True)
        ctx.exit(COULD_NOT_RUN)


def _set_debug(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        ctx.meta[DEBUG] = True


debug = option(
    "--debug", is_flag=True, expose_value=False, is_eager=True, callback=_set_debug, help="Show tracebacks of bugs."
)


def length_up_to(largest: float, example: float) -> Callable[..., float | None]:
    """Return the callback of an option for a length."""

    def checked(ctx: click.Context, parameter: click.Parameter, value: float | None) -> float | None:
        if value is not None and not 0 < value <= largest:
            raise click.BadParameter(f"{value:g}: expected a length above 0 and up to {largest:g}, such as {example:g}")
        return value

    return checked


class _Seconds(click.FloatRange):
    """A time; nan and inf, which float() accepts, are refused."""

    name = "seconds"

    def convert(self, value: Any, parameter: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number of seconds."""
        seconds = float(super().convert(value, parameter, ctx))
        if not math.isfinite(seconds):
            self.fail(f"expected a number above 0, found {value}", parameter, ctx)
        return seconds


_FILE = {"type": click.Path(exists=True, dir_okay=False, path_type=Path)}
#: What click is told of each kind of setting.
_KINDS: dict[str, dict[str, Any]] = {
    "text": {},
    "texts": {"multiple": True},
    "names": {"multiple": True, "callback": _listed},
    "file": _FILE,
    "files": {**_FILE, "multiple": True},
    "folders": {"type": click.Path(exists=True, file_okay=False), "multiple": True},
    "number": {"type": click.IntRange(0)},
    "count": {"type": click.IntRange(1, 10**12)},
    "seconds": {"type": _Seconds(0, min_open=True)},
    "length": {"type": float, "callback": length_up_to(100.0, 0.05)},
    "encoding": {"callback": _known_encoding},
    "switch": {"default": None},
}


def setting(name: str, what: str = "", **attributes: Any) -> Decorator:
    """Return the option of a declared setting. what: what it is said of, where its help leaves that open."""
    declared = SETTINGS[name]
    flag = declared.flag if declared.kind != "switch" else f"--{_dashed(name)}/--no-{_dashed(name)}"
    kind = _KINDS[declared.kind] if isinstance(declared.kind, str) else {"type": click.Choice(declared.kind)}
    return option(flag, name, metavar=declared.metavar, help=declared.help.format(what), **kind, **attributes)


def _dashed(name: str) -> str:
    return name.replace("_", "-")


machine, extensions, exclude = map(setting, ("machine", "extensions", "exclude"))
color = option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
text_or_json = narrower("--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True)
machine_from = option(
    "--from", "--machine", "machine", metavar="NAME|FILE",
    help="The lathe that the program is for: one of `polarcheck machines`, or a TOML file of your own.",
)  # fmt: skip
no_config = option("--no-config", is_flag=True, help="Read no polarcheck.toml or pyproject.toml.")
force_exclude = option(
    "--force-exclude", is_flag=True, help="Pass over what polarcheck.toml excludes where it is named, too."
)
_single_block_skip = narrower(
    "--block-skip", type=click.Choice(["off", "on"]), default="off", show_default=True, help="Of blocks with /."
)


def all_of(*decorators: Decorator) -> Decorator:
    """Combine decorators, in the order in which the help shows them."""

    def decorated(command: Any) -> Any:
        for decorator in reversed(decorators):
            command = decorator(command)
        return command

    return decorated


def executing(what: str, *, both: bool = True, machine: Decorator = machine) -> Decorator:
    """
    Return the options that decide how a program is read and executed, for every command that reads programs.

    what: `program` or `programs`, for the help.
    both: a program may be run with block skip both on and off.
    machine: the option --machine.
    """
    first = map(setting, ("changes", "tools", "offsets", "units", "config"))
    block_skip = setting("block_skip") if both else _single_block_skip
    second = map(setting, ("subprograms", "max_blocks", "max_statements", "max_seconds", "radius_from_comments"))
    return all_of(machine, *first, no_config, block_skip, *second, setting("encoding", what))


#: The options that say what programs should make.
comparing = all_of(*map(setting, ("drawings", "drawing_layers", "tolerance")))

#: The options that decide which rules run, and which findings fail.
judging = all_of(
    *map(setting, ("select", "ignore", "severities")),
    setting("fail_on", show_default="warning"),
    *map(setting, ("max_warnings", "strict", "inline")),
)
