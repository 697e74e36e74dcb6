"""What applies to a program: the command line beats the job file nearest to it, which beats the machine."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.checking.rule import load_all
from polarcheck.checking.settings import Settings
from polarcheck.commands import job_files, selection
from polarcheck.commands.job_files import JobFile
from polarcheck.commands.selection import Rules
from polarcheck.errors import MachineError, UsageError
from polarcheck.machines import profiles, toml_text
from polarcheck.machines.job import Job, Running, check_tools, check_work_offsets, with_tool
from polarcheck.machines.machine import Machine


class Options(msgspec.Struct, frozen=True):
    """What the command line asks for, as it is written there; empty where it does not say."""

    machine: str | None = None
    changes: Sequence[str] = ()
    tools: Sequence[str] = ()
    offsets: Path | None = None
    config: Path | None = None
    use_config: bool = True
    units: str | None = None
    select: Sequence[str] = ()
    ignore: Sequence[str] = ()
    severities: Sequence[str] = ()
    block_skip: str | None = None
    subprograms: Sequence[str] = ()
    max_blocks: int | None = None
    max_statements: int | None = None
    max_seconds: float | None = None
    radius_from_comments: bool = False
    fail_on: str | None = None
    strict: bool | None = None
    encoding: str | None = None
    inline: bool | None = None


def of_programs(options: Options) -> Callable[[str], Settings]:
    """
    The settings for a program by its path; each job file is read once and makes one profile. Of a path that ends in a
    separator they are those of the folder.

    The function raises a PolarcheckError that names the option, or the file and key, at fault.
    """
    job_in = jobs_in_folders(options)
    known = load_all()
    of_job: dict[Path | None, Settings] = {}

    @cache
    def in_folder(folder: str) -> Settings:
        found = job_in(Path(folder))
        if found.path not in of_job:
            of_job[found.path] = _settings(options, found, known)
        return of_job[found.path]

    def of_program(path: str) -> Settings:
        # "-" lies in the working folder, where standard input belongs.
        return in_folder(os.path.dirname(path))  # noqa: PTH120  once for each of thousands

    return of_program


def jobs_in_folders(options: Options) -> Callable[[Path], JobFile]:
    """The job files for folders, with the options of the command line merged over it."""

    @cache
    def read(path: Path | None) -> JobFile:
        job = job_files.load(path, pipes=path == options.config) if path else Job()
        return JobFile(_changed(job, options), path)

    nearest = job_files.Nearest()

    def in_folder(folder: Path) -> JobFile:
        if not options.use_config:
            return read(None)
        return read(options.config or nearest.of(folder))

    return in_folder


def _changed(job: Job, options: Options) -> Job:
    if options.offsets is not None:
        from polarcheck.machines import offset_table

        listed = offset_table.read(options.offsets, str(options.offsets), pipes=True)
        job = msgspec.structs.replace(job, tools={**job.tools, **listed})
    for tool in options.tools:
        job = with_tool(job, tool)
    if options.units:
        job = msgspec.structs.replace(job, program_units=options.units)
    if options.radius_from_comments:
        job = msgspec.structs.replace(job, radius_from_comments=True)
    asked = {name: getattr(options, name) for name in Running.__struct_fields__ if getattr(options, name, None)}
    if "subprograms" in asked:
        asked["subprograms"] = [*asked["subprograms"], *job.run.subprograms]
    return msgspec.structs.replace(job, run=msgspec.structs.replace(job.run, **asked)) if asked else job


def _settings(options: Options, found: JobFile, known: Rules) -> Settings:
    name = machine_name(options.machine, found)
    of_job = {"limits": found.job.limits} if found.job.limits else {}
    over = [("--set", changes(options.changes)), (str(found.path), of_job)]
    profile = _profile(name, over, known, "" if options.machine else f"{found.path}: machine: ")
    machine = profile.machine
    check_tools(found.job, options.tools, machine, str(found.path))
    check_work_offsets(found.job, machine, str(found.path))
    levels = selection.severities(options.severities, options.select, found, known, machine)
    rules = selection.chosen(options.select, options.ignore, found, known, machine)
    return Settings(
        name,
        machine,
        found.job,
        rules,
        levels,
        _read(options, found, profile),
        options.fail_on or "warning",
        bool(options.strict),
        options.encoding,
        options.inline is not False,
    )


def _read(options: Options, found: JobFile, profile: profiles.Profile) -> list[Path]:
    """The job file, the offset tables and the machine files of the user's own."""
    own = [Path(title) for title in profile.chain if title not in profiles.names()]
    tables = [options.offsets] if options.offsets else []
    if found.path is None:
        return [*own, *tables]
    return [*own, *tables, found.path, *([found.path.parent / found.job.offsets] if found.job.offsets else [])]


def machine_name(asked: str | None, found: JobFile) -> str:
    """The machine of the command line, else of the job (a name, or a file beside the job file), else the default."""
    name = asked or found.job.machine
    if name is None:
        return profiles.DEFAULT
    if asked is None and found.path is not None and name not in profiles.names():
        beside = found.path.parent / name
        return str(beside) if profiles.is_meant(beside, name) else name
    return name


def changes(options: Iterable[str]) -> dict[str, Any]:
    """
    What to change in a profile: `--set limits.c_feed=3600`.

    Raises UsageError for an option that is not TABLE.KEY=VALUE.
    """
    found: dict[str, Any] = {}
    for option in options:
        key, equals, text = (part.strip() for part in option.partition("="))
        table, _, name = key.partition(".")
        if not equals or not table or not name:
            raise UsageError(f"--set {option}: expected TABLE.KEY=VALUE as in limits.c_feed=3600")
        found.setdefault(table, {})[name] = toml_value(text)
    return found


def _profile(name: str, over: Sequence[profiles.Change], known: Rules, asked_by: str) -> profiles.Profile:
    """asked_by: the file and key of the name, before what is said of a name that there is not."""
    try:
        profile = profiles.load(name, over)
    except profiles.UnknownMachineError as error:
        raise MachineError(f"{asked_by}{error}") from None
    selection.check_names(profile, known)
    return profile


def toml_value(text: str) -> Any:
    """A number, true or false, or a list as TOML writes it, or else the text itself: quotes may be left out."""
    try:
        table = toml_text.parsed(f"value = {text}")
    except ValueError:
        return text
    value = table["value"]
    return value if len(table) == 1 and isinstance(value, bool | int | float | str | list) else text


def here(machine: str | None) -> tuple[str, Machine]:
    """The machine for a command without programs: the one asked for, else that of the job of the working folder."""
    found = JobFile(Job()) if machine else jobs_in_folders(Options())(Path())
    name = machine_name(machine, found)
    return name, _profile(name, (), load_all(), "" if machine else f"{found.path}: machine: ").machine
