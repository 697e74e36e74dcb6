"""Options of several commands; the environment can set each of them, too."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import click

Decorator = Callable[[Any], Any]

#: The key of --debug in the meta of the context, which a group shares with its commands.
DEBUG = "polarcheck.debug"


#: 512MB, 2G, 1.5 GiB, 100k, 4096: k is 1000 bytes, Ki 1024.
_SIZE = re.compile(r"\s*+(\d{1,15}|\d{0,15}\.\d{1,15})\s*+(?:([KMGT])(I?))?B?\s*+", re.IGNORECASE | re.ASCII)
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


def encoding(what: str) -> Decorator:
    """Return the option --encoding of the files that a command reads."""
    return option("--encoding", callback=_known_encoding, metavar="NAME", help=f"Of the {what}: cp1252, shift_jis, ...")


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


def _set_debug(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        ctx.meta[DEBUG] = True


debug = option(
    "--debug", is_flag=True, expose_value=False, is_eager=True, callback=_set_debug, help="Show tracebacks of bugs."
)
machine = option(
    "--machine", metavar="NAME|FILE", help="The lathe: one of `polarcheck machines`, or a TOML file of your own."
)
machine_from = option(
    "--from", "machine", metavar="NAME|FILE",
    help="The lathe that the program is for: one of `polarcheck machines`, or a TOML file of your own.",
)  # fmt: skip
changes = option(
    "--set", "changes", multiple=True, metavar="KEY=VALUE", help="A value of the machine: limits.c_feed=3600."
)
tools = option(
    "--tool",
    "tools",
    multiple=True,
    metavar="N:KEY=VALUE",
    help="Tool offset N: 8:radius=0.375,nose=0; or an edge: MILL_8/1:radius=4.",
)
offsets = option(
    "--offsets", type=click.Path(exists=True, dir_okay=False, path_type=Path), help="Offset table from the control."
)


def _tolerance(ctx: click.Context, parameter: click.Parameter, value: float | None) -> float | None:
    if value is not None and not 0 < value <= _LARGEST_TOLERANCE:
        raise click.BadParameter(f"{value:g}: expected a length above 0 and up to {_LARGEST_TOLERANCE:g}, such as 0.05")
    return value


_LARGEST_TOLERANCE = 100.0
_drawings = option(
    "--drawing", "drawings", type=click.Path(exists=True, dir_okay=False, path_type=Path), multiple=True,
    metavar="FILE.dxf", help="What the programs should make, in place of [[part]] in polarcheck.toml.",
)  # fmt: skip
_layers = option(
    "--drawing-layer",
    "drawing_layers",
    multiple=True,
    metavar="LAYER",
    help="Of each --drawing only what lies on this layer.",
)
_tolerances = option(
    "--tolerance", type=float, callback=_tolerance, metavar="LENGTH",
    help="How far a part may differ from a drawing or [[part]] that says nothing else, in the units of the programs, "
    "or of polarcheck.toml where that names them; else 0.02 mm.",
)  # fmt: skip
subprograms = option(
    "--subprograms", type=click.Path(exists=True, file_okay=False), multiple=True, metavar="FOLDER",
    help="Where programs that are called lie.",
)  # fmt: skip
units = option("--units", type=click.Choice(["mm", "inch"]), help="Of programs with neither G20 nor G21.")
radius_from_comments = option(
    "--radius-from-comments/--no-radius-from-comments",
    default=None,
    help="Take unknown radii from comments such as 3/4 DIA. CUTTER.",
)
config = option(
    "--config",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Instead of the nearest polarcheck.toml.",
)
no_config = option("--no-config", is_flag=True, help="Read no polarcheck.toml or pyproject.toml.")
force_exclude = option(
    "--force-exclude", is_flag=True, help="Pass over what polarcheck.toml excludes where it is named, too."
)
extensions = many(
    "--extensions", metavar="EXT", help="Of the programs in a folder, instead of .nc, .tap, .eia and others."
)
exclude = option(
    "--exclude",
    multiple=True,
    metavar="PATTERN",
    help="Files or folders that a walk passes over, beside those of the job.",
)
inline = option("--inline/--no-inline", default=None, help="Whether the allow comments of programs are heeded.")


class _Seconds(click.FloatRange):
    """A time; nan and inf, which float() accepts, are refused."""

    name = "seconds"

    def convert(self, value: Any, parameter: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number of seconds."""
        seconds = float(super().convert(value, parameter, ctx))
        if not math.isfinite(seconds):
            self.fail(f"expected a number above 0, found {value}", parameter, ctx)
        return seconds


_block_skip = option(
    "--block-skip", type=click.Choice(["off", "on", "both"]), help="Of blocks with /; both is the default."
)
_single_block_skip = narrower(
    "--block-skip", type=click.Choice(["off", "on"]), default="off", show_default=True, help="Of blocks with /."
)
_max_blocks = option(
    "--max-blocks", type=click.IntRange(1, 10**12),
    help="Executed blocks, beyond those of the file, after which a run is given up.",
)  # fmt: skip
_max_statements = option(
    "--max-statements", type=click.IntRange(1, 10**12), help="The same for macro statements and calls."
)
_max_seconds = option(
    "--max-seconds", type=_Seconds(0, min_open=True),
    help="The same for seconds of processor time, and for the whole check; a file has so long for each MB.",
)  # fmt: skip


def _all(*decorators: Decorator) -> Decorator:
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
    shared = (machine, changes, tools, offsets, units, config, no_config, _block_skip if both else _single_block_skip)
    more = (subprograms, _max_blocks, _max_statements, _max_seconds, radius_from_comments, encoding(what))
    return _all(*shared, *more)


#: The options that say what programs should make.
comparing = _all(_drawings, _layers, _tolerances)

#: The options that decide which rules run, and which findings fail.
judging = _all(
    many("--select", metavar="RULE", help="Only these rules, groups or alarms (PS0146)."),
    many("--ignore", metavar="RULE", help="All but these."),
    many("--severity", "severities", metavar="RULE=LEVEL", help="error, warning, note or off."),
    option(
        "--fail-on", type=click.Choice(["error", "warning", "note", "never"]), show_default="warning",
        help="The least severity that fails.",
    ),
    option(
        "--max-warnings", type=click.IntRange(0), metavar="N",
        help="More warnings than N, over all programs, fail; up to N do not.",
    ),
    option("--strict/--no-strict", default=None, help="Fail where a file is unverified, too."),
    inline,
)  # fmt: skip
