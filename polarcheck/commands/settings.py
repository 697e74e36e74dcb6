"""The settings of a program: the command line overrides the nearest job file, which overrides the machine."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.checking.rule import Rule, load_all
from polarcheck.checking.settings import Extra, Settings
from polarcheck.commands import job_files, selection
from polarcheck.commands.job_files import JobFile
from polarcheck.commands.job_layers import Merged
from polarcheck.commands.selection import Rules
from polarcheck.errors import MachineError, UsageError
from polarcheck.machines import profiles, toml_text
from polarcheck.machines.job import Job, PunchedTool, Running, check_tools, check_work_offsets, with_tool
from polarcheck.machines.machine import Machine
from polarcheck.reading.files import STANDARD_INPUT


class Options(msgspec.Struct, frozen=True):
    """The options of the command line as written; empty if absent."""

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
    radius_from_comments: bool | None = None
    fail_on: str | None = None
    strict: bool | None = None
    encoding: str | None = None
    inline: bool | None = None
    baseline: Path | None = None
    drawing: Path | None = None
    #: What the command itself adds to the reports of files.
    extras: Sequence[Extra] = ()


class OfPrograms:
    """
    The settings of programs by their paths; of a path that ends in a separator they are those of the folder.

    Each job file is read once, and makes settings once for all programs to which the same of its entries apply. Raises
    a PolarcheckError that names the option, or file, line and key, at fault.
    """

    def __init__(self, options: Options) -> None:
        self._options = options
        self._nearest = job_files.Nearest()
        self._loaded: dict[Path | None, JobFile] = {}
        self._of_folder: dict[str, tuple[JobFile, str]] = {}
        #: Of folders whose programs all have the same.
        self._plain: dict[str, Settings] = {}
        self._settings: dict[tuple[Path | None, Layers], Settings] = {}
        self._asked: dict[Path, list[tuple[str, str]]] = {}
        self._making = _Making(options)

    def __call__(self, path: str) -> Settings:
        folder, name = os.path.split(path)
        plain = self._plain.get(folder)
        if plain is not None:
            return plain
        found, real = self._job_file(folder)
        layers = found.layers(real, name)
        key = found.path, layers
        if key not in self._settings:
            self._settings[key] = self._making.settings(found, layers)
        if not found.has_entries:
            self._plain[folder] = self._settings[key]
        elif name and found.path is not None:
            self._asked.setdefault(found.path, []).append((real, name))
        return self._settings[key]

    def applied(self, path: str) -> Applied:
        """The same with the origin of each value."""
        folder, name = os.path.split(path)
        found, real = self._job_file(folder)
        return self._making.applied(found, found.layers(real, name))

    def excluded_in(self, folder: str) -> Callable[[str, bool], bool] | None:
        """Return the test for entries that the nearest job file excludes, if it excludes any; see files.walk."""
        found, real = self._job_file(folder)
        exclude = found.exclude
        return (lambda name, is_folder: bool(exclude.itself(real, name, is_folder=is_folder))) if exclude else None

    def is_within_excluded(self, path: str) -> bool:
        """Return True if a walk from above would skip a named file or folder, or a folder around it."""
        folder, name = os.path.split(path.rstrip(os.sep) or path)
        found, real = self._job_file(folder)
        if not found.exclude or path == STANDARD_INPUT:
            return False
        is_folder = os.path.isdir(path)  # noqa: PTH112  Path.is_dir raises for some names
        if name in ("", os.curdir, os.pardir):
            return bool(found.exclude.of_folder(os.path.realpath(path)))
        return bool(found.exclude.of_folder(real) or found.exclude.itself(real, name, is_folder=is_folder))

    def left(self, paths: Sequence[str], warn: Callable[[str], None]) -> tuple[str, ...]:
        """Return the paths that are not excluded; calls warn if none is left."""
        left = tuple(path for path in paths if not self.is_within_excluded(path))
        if not left:
            warn("all that is named is excluded: nothing is checked")
        return left

    def unmatched(self, paths: Iterable[str]) -> list[str]:
        """
        What is to be said of patterns in job files that match none of the programs asked for so far, where all in the
        folder of the job file have been.

        paths: files and folders, which have been walked.
        """
        if not self._asked:
            return []
        walked = [self._nearest.real.folder(path) for path in paths if os.path.isdir(path)]  # noqa: PTH112
        return [
            told
            for path, asked in self._asked.items()
            if any(Path(os.path.realpath(path.parent)).is_relative_to(folder) for folder in walked)
            for told in self._loaded[path].unmatched(asked)
        ]

    def _job_file(self, folder: str) -> tuple[JobFile, str]:
        """The job file for a folder, and the real path of the folder."""
        if folder not in self._of_folder:
            options = self._options
            nearest = None if not options.use_config else options.config or self._nearest.of(Path(folder))
            if nearest not in self._loaded:
                pipes = nearest == options.config
                self._loaded[nearest] = job_files.load(nearest, pipes=pipes) if nearest else JobFile()
            with contextlib.suppress(OSError, RuntimeError, ValueError):  # reading the program will say so
                self._of_folder[folder] = self._loaded[nearest], self._nearest.real.folder(folder or os.curdir)
                return self._of_folder[folder]
            return self._loaded[nearest], folder
        return self._of_folder[folder]


Layers = tuple[tuple[int, int], ...]


class Applied(msgspec.Struct, frozen=True):
    """The settings of a program and their origin: the job as files give it, and its machine."""

    settings: Settings
    merged: Merged
    profile: profiles.Profile
    file: JobFile


class _Making:
    """Makes settings; those of the same machine and rules share what is made of these."""

    def __init__(self, options: Options) -> None:
        self._options = options
        self._known = load_all()
        self._changes = changes(options.changes)
        self._profiles: dict[str, profiles.Profile] = {}
        self._rules: dict[str, tuple[list[Rule], dict[str, str]]] = {}

    def settings(self, found: JobFile, layers: Layers) -> Settings:
        return self.applied(found, layers).settings

    def applied(self, found: JobFile, layers: Layers) -> Applied:
        """The settings of some layers of a job file."""
        options = self._options
        merged = found.merged(layers)
        job = _changed(merged.job, options)
        name = options.machine or job.machine or profiles.DEFAULT
        profile = self._profile(name, merged)
        machine = profile.machine
        check_tools(job, options.tools, machine, merged.at)
        check_work_offsets(job, machine, merged.at)
        rules, levels = self._chosen(job, merged, profile)
        settings = Settings(
            name=name,
            machine=machine,
            job=job,
            rules=rules,
            severities=levels,
            read=_read(options, job, profile, found),
            fail_on=job.fail_on,
            strict=job.strict,
            encoding=job.encoding,
            inline=job.inline,
            extras=options.extras,
        )
        return Applied(settings, merged, profile, found)

    def _profile(self, name: str, merged: Merged) -> profiles.Profile:
        over: list[profiles.Change] = [("--set", self._changes)]
        for layer in reversed(merged.layers):
            limits = layer.table.get("limits")
            if limits:
                over.append((layer.title, {"limits": limits}))
        key = repr((name, over))
        if key not in self._profiles:
            try:
                self._profiles[key] = _profile(name, over, self._known)
            except profiles.UnknownMachineError as error:
                is_of_job = merged.job.machine and not self._options.machine
                raise MachineError(f"{merged.at('machine')}: machine: {error}" if is_of_job else str(error)) from None
            except MachineError as error:
                raise MachineError(_with_line(str(error), merged)) from None
        return self._profiles[key]

    def _chosen(self, job: Job, merged: Merged, profile: profiles.Profile) -> tuple[list[Rule], dict[str, str]]:
        """The rules to run, and their severities where they differ from the machine's."""
        options, machine = self._options, profile.machine
        key = repr((id(profile), job.select, job.ignore, list(job.severities.items())))
        if key not in self._rules:
            levels = selection.severities(options.severities, options.select, job, merged.at, self._known, machine)
            rules = selection.chosen(options.select, options.ignore, job, merged.at, self._known, machine)
            self._rules[key] = rules, levels
        return self._rules[key]


def _with_line(said: str, merged: Merged) -> str:
    """Return the message about [limits], with the line of the key."""
    key = re.search(r"limits\.\w+", said)
    for layer in merged.layers if key else ():
        if key and said.startswith((f"{layer.title}: {key[0]}", f"{layer.title}: unknown key")):
            return f"{layer.at(key[0])}: {said.removeprefix(f'{layer.title}: ')}"
    return said


def _changed(job: Job, options: Options) -> Job:
    if options.offsets is not None:
        from polarcheck.machines import offset_table

        listed = offset_table.read(options.offsets, str(options.offsets), pipes=True, units=job.units)
        own = {key: tool for key, tool in job.tools.items() if not isinstance(tool, PunchedTool)}
        job = msgspec.structs.replace(job, tools={**own, **listed})
    for tool in options.tools:
        job = with_tool(job, tool)
    if options.drawing is not None:
        from polarcheck.machines import drawing

        job = msgspec.structs.replace(job, part=[drawing.part_of(options.drawing, str(options.drawing))])
    asked = {key: value for key in _OVER_JOB if (value := getattr(options, key)) is not None}
    if options.units:
        asked["program_units"] = options.units
    of_run = {name: getattr(options, name) for name in Running.__struct_fields__ if getattr(options, name, None)}
    if "subprograms" in of_run:
        of_run["subprograms"] = [*of_run["subprograms"], *job.run.subprograms]
    if of_run:
        asked["run"] = msgspec.structs.replace(job.run, **of_run)
    return msgspec.structs.replace(job, **asked) if asked else job


#: Options that a job has a key of the same name for.
_OVER_JOB = ("radius_from_comments", "fail_on", "strict", "encoding", "inline")


def _read(options: Options, job: Job, profile: profiles.Profile, found: JobFile) -> list[Path]:
    """The job files, the offset tables, the baseline and the machine files of the user's own."""
    own = [Path(title) for title in profile.chain if title not in profiles.names()]
    tables = [path for path in (options.offsets, options.baseline, options.drawing) if path]
    tables += [Path(part.drawing) for part in job.part if part.drawing is not None and options.drawing is None]
    return [*own, *tables, *found.read, *([Path(job.offsets)] if job.offsets else [])]


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


def _profile(name: str, over: Sequence[profiles.Change], known: Rules) -> profiles.Profile:
    try:
        profile = profiles.load(name, over)
        selection.check_names(profile, known)
    except profiles.UnknownMachineError:
        raise
    except MachineError as error:
        from polarcheck.machines import toml_lines

        raise MachineError(toml_lines.located(str(error))) from None
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
    if machine:
        return machine, profile_of(machine).machine
    found = OfPrograms(Options())("")
    return found.name, found.machine


def profile_of(machine: str) -> profiles.Profile:
    """The profile of a name or file as it is. Raises MachineError for one that cannot be used."""
    return _profile(machine, (), load_all())
