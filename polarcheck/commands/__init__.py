"""
The command line: a module for each command, without logic of its own.

Only here is anything printed, and the exit code decided.
"""

from __future__ import annotations

import gc
import importlib
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import click

from polarcheck.commands import options, planted_names, signals
from polarcheck.commands.exit_codes import BUG, CLEAN, COULD_NOT_RUN
from polarcheck.commands.output import (
    COLUMNS,
    ON_WINDOWS,
    abandon_output,
    bug_lines,
    is_of_echo,
    say,
    say_lines,
)
from polarcheck.files.cache import repeats
from polarcheck.foundation import ending, record
from polarcheck.foundation.errors import PolarcheckError, RuleError
from polarcheck.foundation.memory import keep_room_for_numpy
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.foundation.version import __version__

NAMES = (
    "baseline",
    "certify",
    "check",
    "compare",
    "compensate",
    "completion",
    "config",
    "convert",
    "explain",
    "feeds",
    "init",
    "machines",
    "part",
    "plot",
    "roll",
    "rules",
    "schema",
    "server",
    "trace",
    "unroll",
)


#: click lists the choices of an argument on lines of their own; they are joined into one line.
_LIST = lazy_pattern(r"([:,])\n\t")


class Modules(Mapping[str, click.Command]):
    """The commands by name: each is the function of that name in the module of that name, imported on first use."""

    def __getitem__(self, name: str) -> click.Command:
        if name not in NAMES:
            raise KeyError(name)
        command: click.Command = getattr(importlib.import_module(f"polarcheck.commands.{name}"), name)
        return command

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)

    def __len__(self) -> int:
        return len(NAMES)


def _variable(error: click.ClickException) -> str:
    """The environment variable that has a wrong value, before the message; empty for other errors."""
    option, ctx = getattr(error, "param", None), getattr(error, "ctx", None)
    if not isinstance(option, click.Option) or ctx is None or option.name is None:
        return ""
    is_variable = ctx.get_parameter_source(option.name) is click.core.ParameterSource.ENVIRONMENT
    return f"{option.envvar}: " if is_variable else ""


class Commands(click.Group):
    """A group of commands whose errors are one line on stderr, with different exit codes for findings and failures."""

    def main(  # type: ignore[override]  # one signature for click's two
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        standalone_mode: bool = True,
        **extra: Any,
    ) -> int:
        """Run a command; return its exit code, or end the process with it in standalone mode."""
        status = COULD_NOT_RUN
        is_completion = "_POLARCHECK_COMPLETE" in os.environ
        if is_completion:
            from polarcheck.commands import completing

            completing.register()
        try:
            if args is None and ON_WINDOWS:
                from polarcheck.commands import wildcards

                args = wildcards.expanded(sys.argv[1:])
            # click would expand globs itself, and lose files with brackets in their names.
            extra["windows_expand_args"] = False
            status = super().main(args, prog_name, standalone_mode=False, **extra) or CLEAN
        except click.ClickException as error:
            say(_variable(error) + _LIST.sub(r"\1 ", error.format_message()))
        except PolarcheckError as error:
            say(str(error))
        except (click.Abort, KeyboardInterrupt) as stop:
            status, how = signals.exit_status(stop)
            say(how)
        except SystemExit:
            # Outside of standalone mode click exits for completion, and if the reader of the help has gone.
            if is_completion:
                raise
            status = CLEAN
        except OSError as error:  # of help and version, which click writes
            abandon_output()
            say(f"standard output: {error.strerror or error}")
        if standalone_mode:
            sys.exit(status)
        return status

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """
        Return the named command; suggest `check` if a program is named in its place.

        Raises UsageError for an option that is the name of a file, too.
        """
        name = args[0]
        if name not in NAMES and (any(mark in name for mark in "./\\") or name == "-" or os.path.exists(name)):  # noqa: PTH110  Path.exists raises for some names
            ctx.fail(f"{name} is no command; did you mean `polarcheck check {' '.join(args)}`?")
        resolved, command, remaining = super().resolve_command(ctx, args)
        if command is not None and not ctx.resilient_parsing:  # of shell completion
            planted_names.refuse(command, remaining)
        return resolved, command, remaining

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; an unexpected exception is a bug of polarcheck, never a finding."""
        try:
            with record.recorded(has_states=repeats.is_noting()):
                return super().invoke(ctx)
        except (click.ClickException, click.Abort, click.exceptions.Exit):
            raise
        except Exception as error:
            if isinstance(error, PolarcheckError) and not isinstance(error, RuleError):
                raise
            stop = signals.interrupt_behind(error)
            if stop is not None:
                raise stop from None
            if isinstance(error, OSError) and is_of_echo(error):  # of help, which click writes
                raise
            if ending.is_of_memory(error):
                say("there is not enough memory")
                ctx.exit(COULD_NOT_RUN)
            say_lines(bug_lines(error, options.DEBUG in ctx.meta))
            ctx.exit(BUG)


def run() -> None:
    """Run the command line, and end the process with its exit code."""
    # Imports create thousands of permanent objects; collecting cycles among them costs a tenth of a small check.
    # Between files it is asked for (batch.forget).
    gc.disable()
    # Linear algebra is not used, and starting its threads takes a fifth of the import of NumPy.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    keep_room_for_numpy()
    try:
        signals.listen()
        main(prog_name="polarcheck")
    finally:
        ending.end_on_signals()
        # The memory is freed with the process; a last collection would cost a tenth of a small check.
        gc.freeze()


@click.group(
    cls=Commands,
    commands=Modules(),
    invoke_without_command=True,
    # The commands inherit these.
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": COLUMNS},
)
@click.version_option(__version__, message="polarcheck %(version)s")
@options.debug
@click.pass_context
def main(ctx: click.Context) -> None:
    """
    Check NC programs that use polar coordinate interpolation (G12.1/G13.1, G112/G113) before the lathe does.

    \b
    polarcheck check O1234.NC --tool 8:radius=0.375
    polarcheck check programs/ --machine fanuc-30i --set limits.c_feed=3600
    polarcheck explain PS0146

    The verdict of a file is pass (all that matters was looked at, and nothing is wrong), fail, or unverified (nothing
    wrong was found, but something that matters could not be judged, such as the path of a cutter whose radius is not
    known). `polarcheck explain unverified` says more, and what to give.

    Every option can also be given by the environment: POLARCHECK_MACHINE for --machine.
    """
    options.need_command(ctx)
