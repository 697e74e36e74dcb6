"""The command line: commands without logic of their own. Only here is anything printed, and the exit code decided."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click

from polarcheck import __version__
from polarcheck.errors import PolarcheckError, RuleError
from polarcheck.reading.excerpt import visible
from polarcheck.reports import formats

CLEAN, FINDINGS, COULD_NOT_RUN, BUG, INTERRUPTED = 0, 1, 2, 3, 130
#: Width of reports that go anywhere but to a terminal, and the widest that is good to read.
COLUMNS = 100
#: Reports for people come in the encoding of their terminal; all others are UTF-8.
_FOR_PEOPLE = ("text", "concise")
_SETTINGS = {
    "help_option_names": ["-h", "--help"],
    "max_content_width": COLUMNS,
}


class Commands(click.Group):
    """Commands whose errors are one line on stderr and an exit code that tells findings from faults."""

    def main(  # type: ignore[override]  # one signature for click's two
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        standalone_mode: bool = True,
        **extra: Any,
    ) -> int:
        """Run a command; its exit code is returned, or ends the process in standalone mode."""
        status = COULD_NOT_RUN
        try:
            status = super().main(args, prog_name, standalone_mode=False, **extra) or CLEAN
        except click.ClickException as error:
            _say(error.format_message())
        except PolarcheckError as error:
            _say(str(error))
        except (click.Abort, KeyboardInterrupt):
            _say("interrupted")
            status = INTERRUPTED
        except SystemExit as end:
            if not isinstance(end.__context__, BrokenPipeError):
                raise
            status = CLEAN  # nobody read the help to its end
        if standalone_mode:
            sys.exit(status)
        return status

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; what it did not expect is a bug of ours, never a finding."""
        try:
            return super().invoke(ctx)
        except (click.ClickException, click.Abort, click.exceptions.Exit):
            raise
        except Exception as error:
            if isinstance(error, PolarcheckError) and not isinstance(error, RuleError):
                raise
            _report_bug(error, with_traceback=_DEBUG in ctx.meta)
            ctx.exit(BUG)


def run() -> None:
    """The console script: never returns."""
    # Imports make thousands of objects that stay; looking among them for circles costs a tenth of a small check.
    gc.disable()
    # There is no linear algebra here, and starting its threads is a fifth of the import of NumPy.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    main(prog_name="polarcheck")


def _report_bug(error: Exception, with_traceback: bool) -> None:
    if with_traceback:
        import traceback

        click.echo(visible_lines(traceback.format_exception(error)), err=True, nl=False)
        return
    where = "".join(f", {note}" for note in getattr(error, "__notes__", ()))
    _say(f"internal error: {type(error).__name__}: {error}{where}; run with --debug for the traceback")


def visible_lines(texts: list[str]) -> str:
    """Text of several lines without anything that acts on a terminal."""
    return "".join(visible(line) + "\n" for text in texts for line in text.splitlines())


def _say(message: str) -> None:
    click.echo(f"polarcheck: {visible(message)}", err=True)


def _warn(message: str) -> None:
    _say(f"warning: {message}")


def _print(text: str | bytes, color: bool | None = None) -> None:
    """Write to standard output; if nobody reads on, the exit code is all that is left to say."""
    try:
        click.echo(text, nl=False, color=color)
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


# ---- options ----

_DEBUG = "polarcheck.debug"


def _set_debug(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        ctx.meta[_DEBUG] = True


def _listed(ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]) -> tuple[str, ...]:
    """Options that may be repeated, and may hold several names with commas between."""
    return tuple(name for value in values for name in value.replace(",", " ").split())


def _encoding(ctx: click.Context, parameter: click.Parameter, value: str | None) -> str | None:
    import codecs

    try:
        if value is not None:
            codecs.lookup(value)
    except LookupError:
        raise click.BadParameter(f"unknown encoding {value!r}; for example utf-8, cp1252, shift_jis") from None
    return value


def _outputs(ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]) -> list[tuple[str, Path]]:
    outputs = []
    for value in values:
        form, _, path = value.partition(":")
        if form not in formats() or not path:
            raise click.BadParameter(f"{value!r}: expected FORMAT:FILE, the format one of {', '.join(formats())}")
        outputs.append((form, Path(path)))
    return outputs


def _option(*names: str, **attributes: Any) -> Callable[[Any], Any]:
    """An option that the environment can give, too: POLARCHECK_FAIL_ON for --fail-on."""
    written = max((name for name in names if name.startswith("--")), key=len)
    return click.option(*names, envvar="POLARCHECK_" + written[2:].upper().replace("-", "_"), **attributes)


_debug = _option(
    "--debug", is_flag=True, expose_value=False, is_eager=True, callback=_set_debug, help="Show tracebacks of bugs."
)
_machine = _option(
    "--machine", metavar="NAME|FILE", help="The lathe: one of `polarcheck machines`, or a TOML file of your own."
)


def _many(*names: str, **attributes: Any) -> Callable[[Any], Any]:
    return _option(*names, multiple=True, callback=_listed, **attributes)


@click.group(cls=Commands, context_settings=_SETTINGS, invoke_without_command=True)
@click.version_option(__version__, message="polarcheck %(version)s")
@_debug
@click.pass_context
def main(ctx: click.Context) -> None:
    """
    Check NC programs that use polar coordinate interpolation (G12.1/G13.1, G112/G113) before the lathe does.

    \b
    polarcheck check O1234.NC --tool 8:radius=0.375
    polarcheck check programs/ --machine fanuc-30i --set limits.c_feed=3600
    polarcheck explain PS0146

    Every option can also be given by the environment: POLARCHECK_MACHINE for --machine.
    """
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help(), err=True)
        ctx.exit(COULD_NOT_RUN)


@main.command(context_settings=_SETTINGS)
@click.argument("paths", nargs=-1, required=True, metavar="PATH...")
@_machine
@_option("--set", "changes", multiple=True, metavar="KEY=VALUE", help="A value of the machine: limits.c_feed=3600.")
@_option("--tool", "tools", multiple=True, metavar="N:KEY=VALUE", help="Tool offset N: 8:radius=0.375,nose=0.")
@_option(
    "--offsets", type=click.Path(exists=True, dir_okay=False, path_type=Path), help="Offset table from the control."
)
@_option("--units", type=click.Choice(["mm", "inch"]), help="Of programs with neither G20 nor G21.")
@_many("--select", metavar="RULE", help="Only these rules, groups or alarms (PS0146).")
@_many("--ignore", metavar="RULE", help="All but these.")
@_many("--severity", "severities", metavar="RULE=LEVEL", help="error, warning, note or off.")
@_option(
    "--fail-on", type=click.Choice(["error", "warning", "note", "never"]), default="warning", show_default=True,
    help="The least severity that fails.",
)  # fmt: skip
@_option("--strict", is_flag=True, help="Fail where something could not be evaluated, too.")
@_option(
    "--format", "form", type=click.Choice(formats()), default="text", show_default=True, help="Of the report on stdout."
)
@_option(
    "-o",
    "--output",
    "outputs",
    multiple=True,
    callback=_outputs,
    metavar="FORMAT:FILE",
    help="A report in a file, too.",
)
@_option(
    "--config",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Instead of the nearest polarcheck.toml.",
)
@_option("--no-config", is_flag=True, help="Read no polarcheck.toml or pyproject.toml.")
@_option("--block-skip", type=click.Choice(["off", "on", "both"]), help="Of blocks with /; both is the default.")
@_option("--subprograms", multiple=True, metavar="FOLDER", help="Where programs that are called lie.")
@_option("--max-blocks", type=click.IntRange(1), help="Executed blocks after which a program counts as endless.")
@_option("--max-statements", type=click.IntRange(1), help="The same for macro statements and calls.")
@_option("--max-seconds", type=click.FloatRange(0, min_open=True), help="The same for seconds.")
@_option("--radius-from-comments", is_flag=True, help="Take unknown radii from comments such as 3/4 DIA. CUTTER.")
@_many("--extensions", metavar="EXT", help="Of the programs in a folder, instead of .nc, .tap, .eia and others.")
@_option("--encoding", callback=_encoding, metavar="NAME", help="Of the programs: cp1252, shift_jis, ...")
@_option("--color", type=click.Choice(["auto", "always", "never"]), default="auto", show_default=True)
@_option("-q", "--quiet", is_flag=True, help="Findings only.")
@_debug
@click.pass_context
def check(ctx: click.Context, /, paths: tuple[str, ...], **asked: Any) -> None:
    """
    Check NC programs: files, folders, or - for standard input.

    Ends with 0 if all is well, 1 with findings, 2 if something could not be read or understood, 3 for a bug.
    """
    ctx.exit(_check(paths, **asked))


def _check(
    paths: tuple[str, ...],
    *,
    fail_on: str,
    strict: bool,
    form: str,
    outputs: list[tuple[str, Path]],
    no_config: bool,
    extensions: tuple[str, ...],
    encoding: str | None,
    color: str,
    quiet: bool,
    **asked: Any,
) -> int:
    from polarcheck import reports
    from polarcheck.checking import batch, rule
    from polarcheck.commands import settings
    from polarcheck.commands.progress import watched
    from polarcheck.machines import profiles
    from polarcheck.reading import files

    failures: list[str] = []
    options = settings.Options(use_config=not no_config, **asked)
    tasks = batch.plan(paths, settings.in_folders(options), extensions, failures.append, _warn)
    checked = batch.check_files(watched(tasks, not quiet), failures.append, encoding, fail_on)
    name = options.machine or (tasks[0].settings.name if tasks else profiles.DEFAULT)
    report = batch.report(checked.files, name)
    for failure in failures:
        _say(failure)
    status = COULD_NOT_RUN if failures else batch.status(report, strict)
    plain = reports.Background(checked.lines, rule.load_all(), COLUMNS, color=False, quiet=quiet)
    for kind, path in outputs:
        try:
            files.write(path, reports.render(kind, report, plain))
        except PolarcheckError as error:
            _say(str(error))
            status = COULD_NOT_RUN
    in_color = _in_color(color)
    shown = reports.Background(checked.lines, plain.rules, _columns(), in_color, quiet)
    text = reports.render(form, report, shown)
    _print(text if form in _FOR_PEOPLE else text.encode(), in_color or None)
    if form == "concise" and not quiet and any(file.verdict == "unverified" for file in report.files):
        _warn("some rules could not be evaluated; --format text says which, and what to give")
    return status


def _in_color(choice: str) -> bool:
    """--color, else NO_COLOR, else FORCE_COLOR, else whether it is a terminal."""
    if choice != "auto":
        return choice == "always"
    if os.environ.get("NO_COLOR"):
        return False
    return bool(os.environ.get("FORCE_COLOR")) or (sys.stdout.isatty() and os.environ.get("TERM") != "dumb")


def _columns() -> int:
    if not sys.stdout.isatty():
        return COLUMNS
    import shutil

    return min(shutil.get_terminal_size().columns, COLUMNS)


@main.command(context_settings=_SETTINGS)
@click.argument("path", metavar="FILE")
@_machine
@_option("--set", "changes", multiple=True, metavar="KEY=VALUE", help="A value of the machine: limits.c_feed=3600.")
@_option("--tool", "tools", multiple=True, metavar="N:KEY=VALUE", help="Tool offset N: 8:radius=0.375,nose=0.")
@_option("--units", type=click.Choice(["mm", "inch"]), help="Of programs with neither G20 nor G21.")
@_option("--path", "which", type=click.Choice(["tool", "programmed"]), help="The moves of a path, not the blocks.")
@_option("--format", "form", type=click.Choice(["csv", "jsonl"]), default="csv", show_default=True)
@_option("--block-skip", type=click.Choice(["off", "on"]), default="off", show_default=True, help="Of blocks with /.")
@_option("--radius-from-comments", is_flag=True, help="Take unknown radii from comments such as 3/4 DIA. CUTTER.")
@_option(
    "--config",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Instead of the nearest polarcheck.toml.",
)
@_option("--no-config", is_flag=True, help="Read no polarcheck.toml or pyproject.toml.")
@_option("--encoding", callback=_encoding, metavar="NAME", help="Of the program: cp1252, shift_jis, ...")
@_debug
def trace(path: str, which: str | None, form: str, no_config: bool, encoding: str | None, **asked: Any) -> None:
    """
    Show what FILE does, block by block or, with --path, move by move inside polar sections.

    Lengths are mm, X as a radius, angles deg, feeds mm/min. --path tool is the path of the tool center.
    """
    from polarcheck.checking import check
    from polarcheck.commands import settings
    from polarcheck.reading import files
    from polarcheck.reports.pages import executed

    found = settings.in_folders(settings.Options(use_config=not no_config, **asked))(Path(path).parent)
    tables = check.read(files.read(path), found.machine, found.job, files.shown(path), encoding)[0][1]
    of_path = (tables["trace"], tables["tool_center"])
    items = executed.moves(*of_path, which) if which else executed.rows(*of_path)
    for line in (executed.as_csv if form == "csv" else executed.as_jsonl)(items):
        _print(line.encode())


@main.command(context_settings=_SETTINGS)
@click.argument("rule")
@_machine
@_debug
def explain(rule: str, machine: str | None) -> None:
    """Show the manual page of a RULE, or of the rules of a group or of an alarm: PS0146, 146."""
    from polarcheck.checking.rule import load_all
    from polarcheck.commands import settings
    from polarcheck.reports.pages import manual

    _, profile = settings.here(machine)
    _print(manual.pages(settings.select([rule], load_all(), profile).values(), profile))


@main.command(context_settings=_SETTINGS)
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True)
@_debug
def rules(form: str) -> None:
    """List all rules: severity, name, title."""
    from polarcheck.checking.rule import load_all
    from polarcheck.reports.pages import manual

    _print(manual.catalogue(load_all()) if form == "text" else manual.catalogue_json(load_all()).encode())


@main.command(context_settings=_SETTINGS)
@click.argument("name", required=False)
@click.argument("lathe", required=False, metavar="[LATHE]")
@_option("--from", "inherits", metavar="NAME|FILE", help="What the new one inherits from.")
@_debug
def machines(name: str | None, lathe: str | None, inherits: str | None) -> None:
    """
    List the machines; with the NAME or TOML file of one, show its values and where each comes from.

    \b
    polarcheck machines fanuc-30i
    polarcheck machines new NL2000 --from fanuc-30i    write NL2000.toml for a lathe of your own
    """
    from polarcheck.machines import profiles
    from polarcheck.reports.pages import manual

    if name == "new" and lathe:
        from polarcheck.reports.pages import new_machine

        path = new_machine.write(lathe, inherits or profiles.DEFAULT)
        _print(f"{path} written; check with --machine {path}\n")
        return
    if lathe:
        raise click.UsageError(f"{lathe}: a second name is for `machines new LATHE --from NAME`")
    _print(manual.profile_text(profiles.load(name)) if name else manual.machine_list())


@main.command(context_settings=_SETTINGS)
@click.argument("name", type=click.Choice(["report", "job", "machine"]), default="report")
@_debug
def schema(name: str) -> None:
    """Show the JSON Schema of the JSON report, of polarcheck.toml (job) or of a machine profile."""
    from polarcheck.reports.pages import schema as schemas

    _print(schemas.text(name).encode())
