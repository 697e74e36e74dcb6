"""The settings of a program: the command line overrides the nearest job file, which overrides the machine."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.checking.settings import Extra, Settings
from polarcheck.files.settings import decisions, job_files, selection
from polarcheck.files.settings.job_files import JobFile
from polarcheck.files.settings.job_layers import Merged
from polarcheck.files.settings.selection import Rules
from polarcheck.foundation.digest import sha256_of
from polarcheck.foundation.errors import MachineError, UsageError
from polarcheck.foundation.finding import Decided
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.foundation.record import Remembered, note, recorded
from polarcheck.program.machines import profiles, toml_text
from polarcheck.program.machines.job import Job, PunchedTool, Running, check_tools, check_work_offsets, with_tool
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.part_keys import Part
from polarcheck.program.reading.files import STANDARD_INPUT
from polarcheck.rules.rule import Rule, load_all

if TYPE_CHECKING:
    from polarcheck.files.settings.jobs_above import LeftBehind
    from polarcheck.files.settings.keyword_layers import Keywords
    from polarcheck.files.settings.walk_patterns import WalkPatterns


class Options(msgspec.Struct, frozen=True):
    """
    The options of the command line, as written; empty or None if not set.

    use_baseline: False to ignore the baseline that a job file names.
    extras: functions that add data to the reports of files.
    keywords: those of a Python function, which lie over the job files.
    gives_verdicts: False for a command that runs some rules for what it computes, and says nothing of the others.
    named: what has set an option, where that is not the option: `POLARCHECK_SELECT=` by `select`.
    """

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
    use_baseline: bool = True
    drawings: Sequence[Path] = ()
    drawing_layers: Sequence[str] = ()
    tolerance: float | None = None
    max_warnings: int | None = None
    extras: Sequence[Extra] = ()
    gives_verdicts: bool = True
    named: Mapping[str, str] = {}
    exclude: Sequence[str] = ()
    keywords: Keywords | None = None

    def spelled(self, option: str) -> str:
        """Return an option as its user writes it, for messages: --select, or a keyword of a Python function."""
        return option if self.keywords is None else self.keywords.spelled(option)


class OfPrograms:
    """
    Returns the settings of a program by its path; for a path that ends in a separator, those of the folder.

    Each job file is read once, and programs with the same entries share their settings. Raises a PolarcheckError that
    names the option, or the file, line and key at fault.
    """

    def __init__(self, options: Options) -> None:
        self._options = options
        self._nearest = job_files.Nearest()
        self._loaded: dict[Path | None, JobFile] = {}
        self._files: Remembered[Path, JobFile] = Remembered()
        self._of_folder: dict[str, tuple[JobFile, str]] = {}
        # The settings of folders whose programs all have the same settings.
        self._plain: dict[str, Settings] = {}
        self._settings: dict[tuple[Path | None, Layers], Settings] = {}
        self._matched: dict[Path, list[tuple[str, str]]] = {}
        self._maker = SettingsMaker(options)

    def __call__(self, path: str) -> Settings:
        folder, name = os.path.split(path)
        plain = self._plain.get(folder)
        if plain is not None:
            return plain
        file, real = self._job_file(folder)
        layers = file.layers(real, name)
        key = file.path, layers
        if key not in self._settings:
            with recorded() as read:
                settings = self._maker.settings(self._load(file.path), layers)
            self._settings[key] = msgspec.structs.replace(settings, read=[*read.paths])
        if not file.has_entries:
            self._plain[folder] = self._settings[key]
        elif name and file.path is not None:
            self._matched.setdefault(file.path, []).append((real, name))
        return self._settings[key]

    def looked_for(self, path: str, walked: Iterable[str]) -> list[str]:
        """
        Return what the job files of a program were looked for by, and those that say what a walk to it passes over.

        walked: the files and folders of the run.
        """
        folder = os.path.dirname(path)  # noqa: PTH120
        roots = [root for root in map(_as_walked, walked) if path.startswith(root)]
        with recorded() as read:
            self._note_job_file(folder)
            while any(len(root) < len(os.path.join(folder, "")) for root in roots):  # noqa: PTH118
                folder = os.path.dirname(folder)  # noqa: PTH120
                self._note_job_file(folder)
        return [*read.paths]

    def _note_job_file(self, folder: str) -> None:
        """Record again what the job file of a folder was looked for by, and what it is read from."""
        file, real = self._job_file(folder)
        if self._options.use_config and not self._options.config:
            self._nearest.note(real)
        self._load(file.path)

    def applied(self, path: str) -> Applied:
        """Return the settings with the origin of each value."""
        folder, name = os.path.split(path)
        file, real = self._job_file(folder)
        return self._maker.applied(file, file.layers(real, name))

    def excluded_in(self, folder: str) -> Callable[[str, bool], str] | None:
        """Return the function that says what excludes the entries of a folder, for walking.walk; None without any."""
        return self._patterns.of_folder(*self._job_file(folder))

    def extensions_in(self, folder: str) -> list[str]:
        """Return the endings of programs that the job file of a folder lists; none for the usual ones."""
        layer = self._job_file(folder)[0].naming_extensions
        return layer.extensions if layer is not None else []

    def is_within_excluded(self, path: str) -> bool:
        """Return True if a walk from above would skip a file or folder, or a folder around it."""
        folder, name = os.path.split(path.rstrip(os.sep) or path)
        file, real = self._job_file(folder)
        if path == STANDARD_INPUT or not (file.exclude or self._options.exclude):
            return False
        is_folder = os.path.isdir(path)  # noqa: PTH112  Path.is_dir raises for some names
        if name in ("", os.curdir, os.pardir):
            return self._patterns.is_within(file, os.path.realpath(path), "", is_folder=True)
        return self._patterns.is_within(file, real, name, is_folder=is_folder)

    def left(self, paths: Sequence[str], warn: Callable[[str], None]) -> tuple[str, ...]:
        """Return the paths that are not excluded; call `warn` if none is left."""
        remaining = tuple(path for path in paths if not self.is_within_excluded(path))
        if not remaining:
            warn("all that is named is excluded: nothing is checked")
        return remaining

    def left_behind(self) -> list[str]:
        """Return a line for each job file, of those loaded so far, that leaves values of one above it behind."""
        loaded = [
            file
            for file in self._loaded.values()
            if file.path is not None
            and file.path != self._options.config
            and self._nearest.above(file.path) is not None
        ]
        if not loaded:
            return []
        from polarcheck.files.settings import jobs_above

        return jobs_above.warnings(loaded, self._nearest)

    def behind(self, file: JobFile) -> LeftBehind | None:
        """Return what a job file leaves behind of the next one above it; nothing of one that an option names."""
        from polarcheck.files.settings import jobs_above

        return None if file.path == self._options.config else jobs_above.left_behind(file, self._nearest)

    def unmatched(self, paths: Iterable[str], programs: Sequence[str], extensions: Sequence[str] = ()) -> list[str]:
        """
        Return a line for each pattern that has had no effect so far: of programs, of `exclude` and of `extensions`.

        Patterns in job files count only if the whole folder of the file was walked.

        paths: the files and folders that were walked.
        programs: what the walks have read.
        extensions: those of the command line, in place of those of the job files.
        """
        walked = [self._nearest.real.folder(path) for path in paths if os.path.isdir(path)]  # noqa: PTH112
        if not walked:
            return []
        if self._options.exclude:
            # What lies in folders that these exclude is not known: patterns of job files may be for that.
            return self._patterns.unused_options(extensions, programs)
        lines = [
            line
            for path, names in self._matched.items()
            if _is_below(path, walked)
            for line in self._loaded[path].unmatched(names)
        ]
        for file in self._loaded.values():
            if file.excluding is not None and _is_below(file.excluding.written.path, walked):
                lines += self._patterns.unused_in(file)
        return [*dict.fromkeys(lines), *self._unmatched_extensions(walked, programs, extensions)]

    def _unmatched_extensions(
        self, walked: Sequence[str], programs: Sequence[str], extensions: Sequence[str]
    ) -> list[str]:
        lines = self._patterns.unused_options(extensions, programs)
        layers = (
            {}
            if extensions
            else {
                layer.written.path: layer
                for file in self._loaded.values()
                if (layer := file.naming_extensions) is not None and _is_below(layer.written.path, walked)
            }
        )
        if layers:
            from polarcheck.files.settings import walk_patterns

            of_layer: dict[Path, list[str]] = {path: [] for path in layers}
            for program in programs:
                layer = self._job_file(os.path.dirname(program))[0].naming_extensions  # noqa: PTH120
                if layer is not None and layer.written.path in layers:
                    of_layer[layer.written.path].append(program)
            for path, names in of_layer.items():
                lines += walk_patterns.unused_extensions(layers[path], names)
        return lines

    @cached_property
    def _patterns(self) -> WalkPatterns:
        from polarcheck.files.settings.walk_patterns import WalkPatterns

        return WalkPatterns(self._options.exclude, self._options.spelled)

    def _job_file(self, folder: str) -> tuple[JobFile, str]:
        """Return the job file for a folder, and the real path of the folder."""
        if folder not in self._of_folder:
            options = self._options
            nearest = None if not options.use_config else options.config or self._nearest.of(Path(folder))
            file = self._load(nearest)
            with contextlib.suppress(OSError, RuntimeError, ValueError):  # reading the program reports the error
                self._of_folder[folder] = file, self._nearest.real.folder(folder or os.curdir)
                return self._of_folder[folder]
            return file, folder
        return self._of_folder[folder]

    def _load(self, path: Path | None) -> JobFile:
        """Return a job file, which is read once."""
        if path is None:
            self._loaded[None] = JobFile()
        else:
            pipes = path == self._options.config
            self._loaded[path] = self._files.get(path, lambda: job_files.load(path, pipes=pipes))
        return self._loaded[path]


def _as_walked(root: str) -> str:
    """Return the beginning of the paths that a walk through a folder yields."""
    root = "" if root == os.curdir else root
    return os.path.join(root, "") if root else root  # noqa: PTH118


def _is_below(path: Path, folders: Iterable[str]) -> bool:
    """Return True if the folder of a file, with all that is in it, lies in one of these folders."""
    return any(Path(os.path.realpath(path.parent)).is_relative_to(folder) for folder in folders)


Layers = tuple[tuple[int, int], ...]
_Chosen = tuple[list[Rule], dict[str, str], list[str]]


class Applied(msgspec.Struct, frozen=True):
    """
    The settings of a program, with their origins.

    settings: the settings.
    merged: the job of the job files, before the command line.
    profile: the machine.
    file: the job file.
    """

    settings: Settings
    merged: Merged
    profile: profiles.Profile
    file: JobFile


class SettingsMaker:
    """Makes settings; settings with the same machine and rules share these."""

    def __init__(self, options: Options) -> None:
        if options.drawing_layers and not options.drawings:
            layers, drawings = options.spelled("--drawing-layer"), options.spelled("--drawing").rpartition(" ")[2]
            raise UsageError(f"{layers}: give the drawing by {drawings}, too; a [[part]] has layers of its own")
        self._options = options
        self._known = load_all()
        self._changes = options.keywords.changes if options.keywords else changes(options.changes)
        self._profiles: Remembered[str, profiles.Profile] = Remembered()
        self._rules: dict[str, _Chosen] = {}
        self._hashes: dict[int, str] = {}

    def settings(self, file: JobFile, layers: Layers) -> Settings:
        return self.applied(file, layers).settings

    def applied(self, file: JobFile, layers: Layers) -> Applied:
        """Return the settings of layers of a job file."""
        options = self._options
        merged = file.merged(layers, options.keywords.layers if options.keywords else ())
        job = _changed(merged.job, options)
        name = options.machine or job.machine or profiles.DEFAULT
        profile = self._profile(name, merged)
        machine = profile.machine
        check_tools(job, options.tools, machine, merged.at)
        check_work_offsets(job, machine, merged.at)
        rules, levels, deselected = self._chosen(job, merged, profile)
        named = options.baseline or (None if job.baseline is None else Path(job.baseline))
        baseline = named if options.use_baseline else None
        note(*job.run.subprograms, *([baseline] if baseline else []))
        settings = Settings(
            name=name,
            machine=machine,
            job=job,
            rules=rules,
            severities=levels,
            job_file=file.path,
            fail_on=job.fail_on,
            strict=job.strict,
            encoding=job.encoding,
            inline=job.inline,
            baseline=baseline,
            baseline_named_by="" if baseline in (None, options.baseline) else f"{merged.at('baseline')}: baseline",
            decided=self._decided(name, baseline, merged, profile, file),
            deselected=deselected,
            profile_sha256=self._hash(machine),
            doubtful=[key for key, origin in profile.origins.items() if origin.doubtful],
            extras=options.extras,
        )
        return Applied(settings, merged, profile, file)

    def _profile(self, name: str, merged: Merged) -> profiles.Profile:
        over: list[profiles.Change] = [(self._options.spelled("--set"), self._changes)]
        for layer in reversed(merged.layers):
            limits = layer.table.get("limits")
            if limits:
                over.append((layer.title, {"limits": limits}))
        try:
            return self._profiles.get(repr((name, over)), lambda: _profile(name, over, self._known))
        except profiles.UnknownMachineError as error:
            is_of_job = merged.job.machine and not self._options.machine
            raise MachineError(f"{merged.at('machine')}: machine: {error}" if is_of_job else str(error)) from None
        except MachineError as error:
            raise MachineError(_with_line(str(error), merged)) from None

    def _decided(
        self, name: str, baseline: Path | None, merged: Merged, profile: profiles.Profile, file: JobFile
    ) -> Decided:
        """Return what the user has set, for reports."""
        options = {key: getattr(self._options, key) for key in decisions.OPTIONS}
        configuration = [str(path) for path in _configuration(profile, file)]
        return decisions.decided(name, baseline, options, self._options.named, merged, configuration)

    def _hash(self, machine: Machine) -> str:
        """Return the SHA-256 of all values of a machine."""
        if id(machine) not in self._hashes:
            self._hashes[id(machine)] = sha256_of(msgspec.json.encode(machine, order="deterministic"))
        return self._hashes[id(machine)]

    def _chosen(self, job: Job, merged: Merged, profile: profiles.Profile) -> _Chosen:
        """Return the rules to run, the severities that differ from the machine's, and what keeps others from it."""
        options, machine = self._options, profile.machine
        of_job = [job.select, job.ignore, *job.severities.items()]
        # Lines on what a job file deselects name its places.
        places = [layer.title for layer in merged.layers] if any(of_job) else []
        key = repr((id(profile), of_job, places))
        if key not in self._rules:
            names = selection.Names(options.select, options.ignore, options.severities, options.spelled)
            levels = selection.severities(names, job, merged.at, self._known, machine)
            rules = selection.chosen(names, job, merged.at, self._known, machine)
            lines = list[str]()
            if options.gives_verdicts and (any(of_job) or _selects(names, profile)):
                from polarcheck.files.settings.deselection import deselected

                lines = deselected(names, options.named, merged, profile, self._known, rules, levels)
            self._rules[key] = rules, levels, lines
        return self._rules[key]


def _selects(names: selection.Names, profile: profiles.Profile) -> bool:
    """Return True if the command line selects rules, or a profile sets a severity without a source that says why."""
    origins = (profile.origins.get(f"severities.{name}") for name in profile.machine.severities)
    given = names.selected or names.ignored or names.levels
    return bool(given) or any(origin is not None and not origin.source for origin in origins)


def _with_line(message: str, merged: Merged) -> str:
    """Add the line of the key to an error in [limits] of a job file."""
    key = re.search(r"limits\.\w+", message)
    for layer in merged.layers if key else ():
        if key and message.startswith((f"{layer.title}: {key[0]}", f"{layer.title}: unknown key")):
            return f"{layer.at(key[0])}: {message.removeprefix(f'{layer.title}: ')}"
    return message


def _changed(job: Job, options: Options) -> Job:
    if options.offsets is not None:
        from polarcheck.program.machines import offset_table

        listed = offset_table.read_offset_table(options.offsets, str(options.offsets), pipes=True, units=job.units)
        written = {key: tool for key, tool in job.tools.items() if not isinstance(tool, PunchedTool)}
        job = msgspec.structs.replace(job, tools={**written, **listed})
    for tool in options.tools:
        job = with_tool(job, tool)
    job = msgspec.structs.replace(job, part=_parts(job.part, options)) if options.drawings or job.part else job
    changes_of_job = {key: value for key in _OVER_JOB if (value := getattr(options, key)) is not None}
    if options.units:
        changes_of_job["program_units"] = options.units
    of_run = {name: getattr(options, name) for name in Running.__struct_fields__ if getattr(options, name, None)}
    if "subprograms" in of_run:
        of_run["subprograms"] = [*of_run["subprograms"], *job.run.subprograms]
    if of_run:
        changes_of_job["run"] = msgspec.structs.replace(job.run, **of_run)
    return msgspec.structs.replace(job, **changes_of_job) if changes_of_job else job


def _parts(parts: Sequence[Part], options: Options) -> list[Part]:
    """Return what programs should make: the drawings of the command line, else the parts of the job."""
    if options.drawings:
        from polarcheck.program.machines import drawing_file

        base = Part(drawing="", layers=list(options.drawing_layers))
        parts = [drawing_file.part_of(path, str(path), base) for path in options.drawings]
    tolerance = options.tolerance
    return [
        part if tolerance is None or part.tolerance > 0 else msgspec.structs.replace(part, tolerance=tolerance)
        for part in parts
    ]


#: Options with the name of the key of a job that they set.
_OVER_JOB = ("machine", "radius_from_comments", "fail_on", "max_warnings", "strict", "encoding", "inline")


def _configuration(profile: profiles.Profile, file: JobFile) -> list[Path]:
    """Return the job files, the nearest first, and the user's machine files."""
    return [*file.paths, *(Path(title) for title in profile.chain if title not in profiles.names())]


def changes(options: Iterable[str]) -> dict[str, Any]:
    """
    Return the changes of a profile, from options such as `--set limits.c_feed=3600`.

    Raises UsageError for an option that is not TABLE.KEY=VALUE.
    """
    tables: dict[str, Any] = {}
    for option in options:
        key, equals, text = (part.strip() for part in option.partition("="))
        table, _, name = key.partition(".")
        if not equals or not table or not name:
            raise UsageError(f"--set {option}: expected TABLE.KEY=VALUE as in limits.c_feed=3600")
        tables.setdefault(table, {})[name] = toml_value(text)
    return tables


def _profile(name: str, over: Sequence[profiles.Change], catalogue: Rules) -> profiles.Profile:
    try:
        profile = profiles.load(name, over)
        selection.check_names(profile, catalogue)
    except profiles.UnknownMachineError:
        raise
    except MachineError as error:
        from polarcheck.program.machines import toml_lines

        raise MachineError(toml_lines.located(str(error))) from None
    return profile


#: .5 and 4., which TOML does not read.
_SHORT_NUMBER = lazy_pattern(r"[-+]?(?:[0-9]{1,9}\.|\.[0-9]{1,9})")


def toml_value(text: str) -> Any:
    """Return the TOML value of a text, or the number; else the text itself, so that quotes may be left out."""
    try:
        table = toml_text.parsed(f"value = {text}")
    except ValueError:
        return float(text) if _SHORT_NUMBER.fullmatch(text) else text
    value = table["value"]
    return value if len(table) == 1 and isinstance(value, bool | int | float | str | list) else text


def default_machine(machine: str | None) -> tuple[str, Machine]:
    """Return the machine of a command without programs: the named one, else that of the working folder's job."""
    if machine:
        return machine, profile_of(machine).machine
    settings = OfPrograms(Options())("")
    return settings.name, settings.machine


def profile_of(machine: str) -> profiles.Profile:
    """Return the profile of a name or file, unchanged. Raises MachineError if it cannot be used."""
    return _profile(machine, (), load_all())


def on_machine(settings: Settings, machine: str) -> Settings:
    """
    Return the settings of a program on another lathe: its tools and its bar, with the rules of that lathe.

    [limits] of its job file and --set are those of the lathe that it was written for, and do not apply to the other.

    machine: name of a built-in lathe, or the path of a TOML file. Raises MachineError if it cannot be used.
    """
    settings_of_machine = OfPrograms(Options(machine=machine, use_config=False))("")
    return msgspec.structs.replace(
        settings_of_machine,
        job=msgspec.structs.replace(settings.job, machine=machine),
        encoding=settings.encoding,
        read=settings.read,
    )
