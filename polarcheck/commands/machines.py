"""`polarcheck machines`: lists the known lathes, shows one, and writes or checks a machine file."""

from __future__ import annotations

import os
from pathlib import Path

import click

from polarcheck.commands import options
from polarcheck.commands.exit_codes import CLEAN, COULD_NOT_RUN
from polarcheck.commands.options import option
from polarcheck.commands.output import say, show
from polarcheck.foundation.errors import MachineError, UsageError


@click.command(short_help="List the machines, show one, write or check one of your own.")
@click.argument("name", required=False)
@click.argument("lathe", required=False, metavar="[LATHE]")
@option("--from", "inherits", metavar="NAME|FILE", help="What the new one inherits from.")
@option("--short", is_flag=True, help="Of the new one only the ten answers that a setter can give.")
@options.debug
def machines(name: str | None, lathe: str | None, inherits: str | None, *, short: bool) -> int:
    """
    List the machines; with the NAME or TOML file of one, show its values and where each comes from.

    \b
    polarcheck machines fanuc-30i
    polarcheck machines check NL2000.toml              whether the file is sound, and what is still to be answered
    polarcheck machines new NL2000 --from fanuc-30i    write NL2000.toml for a lathe of your own
    polarcheck machines new NL2000 --from fanuc-30i --short    the same in ten answers
    """
    from polarcheck.program.machines import profiles
    from polarcheck.program.reading.excerpt import head
    from polarcheck.reports.pages import manual

    if name in ("new", "check") and not lathe:
        raise click.UsageError(f"machines {name}: expected the {'NAME of the new lathe' if name == 'new' else 'FILE'}")
    if inherits and name != "new":
        raise click.UsageError("--from is for `machines new LATHE`")
    if short and name != "new":
        raise click.UsageError("--short is for `machines new LATHE`")
    if name == "check":
        return _check(str(lathe))
    if name == "new":
        path = head(str(_write(str(lathe), inherits or profiles.DEFAULT, short=short)))
        show(
            f"{path} written; take the # from what you answer, then `polarcheck machines check {path}`;"
            f" check programs with --machine {path}\n"
        )
        return CLEAN
    if lathe:
        raise click.UsageError(f"{lathe}: a second name is for `machines new LATHE` and `machines check FILE`")
    show(_profile(name) if name else manual.machine_list())
    return CLEAN


def _profile(name: str) -> str:
    from polarcheck.files.settings.of_programs import profile_of
    from polarcheck.reports.pages import manual

    return manual.profile_text(profile_of(name))


def _check(name: str) -> int:
    """Show what is to say about a sound file, or all faults of one that is not; return the exit code."""
    from polarcheck.files.settings import selection
    from polarcheck.files.settings.of_programs import profile_of
    from polarcheck.program.machines import faults, profiles
    from polarcheck.reports.pages import machine_check
    from polarcheck.rules.rule import load_all

    rules = load_all()
    try:
        show(machine_check.text(profile_of(name), rules))
    except profiles.UnknownMachineError:
        raise
    except MachineError as first:
        lines = faults.faults(name, lambda profile: selection.check_names(profile, rules))
        for line in lines or [str(first)]:
            say(line)
        return COULD_NOT_RUN
    return CLEAN


def _write(name: str, inherits: str, *, short: bool) -> Path:
    """Write NAME.toml into the working folder; an existing file is not overwritten."""
    from polarcheck.files.settings.of_programs import profile_of
    from polarcheck.program.reading import files
    from polarcheck.reports.pages import new_machine

    profile_of(inherits)
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    if os.path.lexists(path):
        raise UsageError(f"{path} is there already")
    write = new_machine.short_text if short else new_machine.text
    files.write(path, write(path.stem, inherits))
    return path
