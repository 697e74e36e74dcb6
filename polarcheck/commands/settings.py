"""What applies to a program: the command line beats the job file nearest to it, which beats the machine."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.checking import rule as all_rules
from polarcheck.checking.rule import Rule
from polarcheck.errors import JobError, UsageError
from polarcheck.machines import job as jobs
from polarcheck.machines import profiles
from polarcheck.machines.job import Job, Running
from polarcheck.machines.machine import Machine

LEVELS = ("error", "warning", "note", "off")
_ALARM = re.compile(r"([A-Za-z]{0,3})\s?(\d+)")

Rules = dict[str, Rule]


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


class JobFile(msgspec.Struct, frozen=True):
    """A job and where it was read; no path for a job that nobody wrote."""

    job: Job
    path: Path | None = None


class Settings(msgspec.Struct, frozen=True):
    """What the check of a file needs to know. name: of the machine, as it was asked for."""

    name: str
    machine: Machine
    job: Job
    rules: Sequence[Rule]
    severities: Mapping[str, str]


def in_folders(options: Options) -> Callable[[Path], Settings]:
    """
    The settings for the programs of a folder; each job file is read once and makes one profile.

    The function raises a PolarcheckError that names the option, or the file and key, at fault.
    """
    job_in = job_files(options)
    known = all_rules.load_all()
    of_job: dict[Path | None, Settings] = {}

    @cache
    def in_folder(folder: Path) -> Settings:
        found = job_in(folder)
        if found.path not in of_job:
            of_job[found.path] = _settings(options, found, known)
        return of_job[found.path]

    return in_folder


def job_files(options: Options) -> Callable[[Path], JobFile]:
    """The job file for a folder, with the options of the command line merged over it."""

    @cache
    def read(path: Path | None) -> JobFile:
        return JobFile(_changed(jobs.load(path) if path else Job(), options), path)

    def in_folder(folder: Path) -> JobFile:
        if not options.use_config:
            return read(None)
        return read(options.config or _find(folder))

    return in_folder


def _find(folder: Path) -> Path | None:
    """The job file for a folder, by a path from the working folder where it lies below it."""
    try:
        path = jobs.find(folder)
    except (OSError, RuntimeError) as error:
        unreadable = getattr(error, "filename", None)
        if unreadable and Path(unreadable).name == "pyproject.toml":
            raise JobError(f"{unreadable}: {error}") from None
        return None  # the folder itself cannot be entered; reading the program will say so
    if path is not None and path.is_relative_to(Path.cwd()):
        return path.relative_to(Path.cwd())
    return path


def _changed(job: Job, options: Options) -> Job:
    if options.offsets is not None:
        listed = jobs.read_offsets(options.offsets, str(options.offsets))
        job = msgspec.structs.replace(job, tools={**job.tools, **listed})
    for tool in options.tools:
        job = jobs.with_tool(job, tool)
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
    machine = profiles.load(name, merged_changes(found.job.limits, options.changes)).machine
    severities = _severities(options, found, known, machine)
    return Settings(name, machine, found.job, _chosen(options, found, known, machine), severities)


def machine_name(asked: str | None, found: JobFile) -> str:
    """The machine of the command line, else of the job (a name, or a file beside the job file), else the default."""
    name = asked or found.job.machine
    if name is None:
        return profiles.DEFAULT
    if asked is None and found.path is not None and name not in profiles.names():
        beside = found.path.parent / name
        return str(beside) if beside.is_file() else name
    return name


# ---- rules ----


def select(names: Iterable[str], known: Rules, machine: Machine) -> Rules:
    """
    The rules of names, groups and alarms (PS0146, 146) of a machine.

    Raises UsageError for a name that is none of these.
    """
    found: set[str] = set()
    for name in names:
        alarm = _ALARM.fullmatch(name.strip())
        rules = _of_alarm(alarm, known, machine) if alarm else all_rules.find(name, known)
        if not rules:
            raise UsageError(f"no rule is known to give alarm {name.strip()} on {machine.title}")
        found.update(rule.name for rule in rules)
    return {name: rule for name, rule in known.items() if name in found}


def _of_alarm(alarm: re.Match[str], known: Rules, machine: Machine) -> list[Rule]:
    """The rules for what this machine answers with an alarm; its letters and leading zeros may be left out."""
    letters, number = alarm[1].upper(), int(alarm[2])
    found = []
    for name, text in machine.alarms.items():
        own = _ALARM.fullmatch(text)
        if own and name in known and int(own[2]) == number and letters in ("", own[1].upper()):
            found.append(known[name])
    return found


def _chosen(options: Options, found: JobFile, known: Rules, machine: Machine) -> list[Rule]:
    """The rules to run; --select sets aside what the job selects and ignores."""
    chosen, ignored = known, {}
    if options.select:
        chosen = _named("--select", select, options.select, known, machine)
    else:
        if found.job.select:
            chosen = _named(f"{found.path}: select", select, found.job.select, known, machine)
        ignored = _named(f"{found.path}: ignore", select, found.job.ignore, known, machine)
    ignored = ignored | _named("--ignore", select, options.ignore, known, machine)
    rules = [rule for name, rule in chosen.items() if name not in ignored]
    if not rules:
        raise UsageError("no rule is left to check: all that are selected are ignored, too")
    return rules


def _severities(options: Options, found: JobFile, known: Rules, machine: Machine) -> dict[str, str]:
    """Severities by rule where they differ from the profile; a rule selected by its own name is never off."""
    of_job = _named(f"{found.path}: severities", _levels, found.job.severities.items(), known, machine)
    asked = _named("--severity", _levels, [_pair(option) for option in options.severities], known, machine)
    changed = of_job | asked
    for name in options.select:
        rule = known.get(name.strip().lower().replace("_", "-"))
        if rule and rule.name not in asked and changed.get(rule.name, machine.severities.get(rule.name)) == "off":
            changed[rule.name] = rule.severity.name.lower()
    return changed


def _levels(pairs: Iterable[tuple[str, str]], known: Rules, machine: Machine) -> dict[str, str]:
    """Severity by rule, from severities of rules, groups or alarms; the last that names a rule counts."""
    return {name: level for chosen, level in pairs for name in select([chosen], known, machine)}


def _pair(option: str) -> tuple[str, str]:
    name, equals, level = (part.strip() for part in option.partition("="))
    if not equals or level.lower() not in LEVELS:
        raise UsageError(f"--severity {option}: expected RULE={'|'.join(LEVELS)}")
    return name, level.lower()


def _named(title: str, function: Callable[..., dict[str, Any]], *arguments: Any) -> dict[str, Any]:
    """What the function returns; its errors begin with the option or the key of the file."""
    try:
        return function(*arguments)
    except UsageError as error:
        raise UsageError(f"{title}: {error}") from None


# ---- the profile ----


def merged_changes(limits: Mapping[str, Any], options: Iterable[str]) -> dict[str, Any]:
    """
    What to change in a profile: the limits of the job, and over them `--set limits.c_feed=3600`.

    Raises UsageError for an option that is not TABLE.KEY=VALUE.
    """
    changes: dict[str, Any] = {"limits": dict(limits)} if limits else {}
    for option in options:
        key, equals, text = (part.strip() for part in option.partition("="))
        table, _, name = key.partition(".")
        if not equals or not table or not name:
            raise UsageError(f"--set {option}: expected TABLE.KEY=VALUE as in limits.c_feed=3600")
        changes.setdefault(table, {})[name] = toml_value(text)
    return changes


def toml_value(text: str) -> Any:
    """A number, true or false, or a list as TOML writes it, or else the text itself: quotes may be left out."""
    import tomllib

    try:
        table = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    value = table["value"]
    return value if len(table) == 1 and isinstance(value, bool | int | float | str | list) else text


def here(machine: str | None) -> tuple[str, Machine]:
    """The machine for a command without programs: the one asked for, else that of the job of the working folder."""
    found = JobFile(Job()) if machine else job_files(Options())(Path())
    name = machine_name(machine, found)
    return name, profiles.load(name).machine
