"""Job files: finds and reads the polarcheck.toml, or pyproject.toml with [tool.polarcheck], nearest to a program."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from polarcheck.files.settings import job_layers
from polarcheck.files.settings.job_layers import Layer, Merged, PartLayer, Written
from polarcheck.foundation import bounded, record
from polarcheck.foundation.errors import JobError
from polarcheck.foundation.record import Remembered
from polarcheck.program.machines import toml_text
from polarcheck.program.machines.job import FILE_NAME, PROJECT, Job
from polarcheck.program.machines.value_types import MisfitError, display, fitted
from polarcheck.program.reading.files import RealPaths

if TYPE_CHECKING:
    from polarcheck.program.reading.globs import Globs

#: The longest chain of files that extend each other.
_LONGEST_CHAIN = 10


class Part(NamedTuple):
    """
    One file of a chain.

    values: the values for all programs.
    entries: its [[programs]] entries.
    parts: its [[part]] entries, each with its patterns; None for all programs.
    files: the patterns of all entries; None without any.
    patterns: the entry and the text of each pattern.
    exclude: the patterns that it excludes; None without any.
    """

    values: Layer
    entries: tuple[Layer, ...]
    parts: tuple[tuple[PartLayer, Globs | None], ...]
    files: Globs | None
    patterns: tuple[tuple[Layer, str], ...]
    exclude: Globs | None


class JobFile(msgspec.Struct, frozen=True):
    """
    A job file with those that it extends.

    path: the file; None if there is none.
    parts: the chain of files, the farthest first.
    """

    path: Path | None = None
    parts: tuple[Part, ...] = ()

    @property
    def paths(self) -> list[Path]:
        """Return the paths of the files, the nearest first."""
        return [part.values.written.path for part in reversed(self.parts)]

    @property
    def has_entries(self) -> bool:
        """Return True if the settings depend on the name of the program."""
        return any(part.patterns or any(files for _, files in part.parts) for part in self.parts)

    def layers(self, folder: str, name: str) -> tuple[tuple[int, int], ...]:
        """
        Return the layers that apply to a program, the nearest last.

        A layer is a file and an entry: 0 is the file itself, 1 its first [[programs]], -1 its first [[part]].

        folder: the real path of its folder.
        name: the name of the program; empty for the layers of the folder itself.
        """
        applying: list[tuple[int, int]] = []
        for number, part in enumerate(self.parts):
            applying.append((number, 0))
            for entry, (_, files) in enumerate(part.parts, 1):
                if files is None or (name and files.of_file(folder, name)):
                    applying.append((number, -entry))
            if part.files is not None and name:
                matched = {part.patterns[index][0].entry for index in part.files.of_file(folder, name)}
                applying += [(number, entry) for entry in sorted(matched)]
        return tuple(applying)

    def merged(self, layers: Sequence[tuple[int, int]], over: Sequence[Layer] = ()) -> Merged:
        """
        Return the merged job of layers. Raises JobError, which names file, line and key.

        over: layers that lie over those of the file; with a [[part]] among them, those of the file do not count.
        """
        tables = [self.layer(number, entry) for number, entry in layers]
        if any(isinstance(layer, PartLayer) for layer in over):
            tables = [layer for layer in tables if not isinstance(layer, PartLayer)]
        return job_layers.merged([*tables, *over])

    @property
    def excluding(self) -> Layer | None:
        """Return the layer that sets `exclude`."""
        return next((part.values for part in reversed(self.parts) if part.exclude is not None), None)

    @property
    def naming_extensions(self) -> Layer | None:
        """Return the layer that sets `extensions`."""
        return next((part.values for part in reversed(self.parts) if "extensions" in part.values.keys), None)

    def patterns(self, layer: Layer) -> list[str]:
        """Return the patterns of an entry."""
        return [pattern for part in self.parts for entry, pattern in part.patterns if entry is layer]

    def layer(self, number: int, entry: int) -> Layer:
        part = self.parts[number]
        if entry < 0:
            return part.parts[-entry - 1][0]
        return part.entries[entry - 1] if entry else part.values

    @property
    def exclude(self) -> Globs | None:
        """Return the patterns that the nearest file excludes."""
        return next((part.exclude for part in reversed(self.parts) if part.exclude is not None), None)

    def unmatched(self, names: Iterable[tuple[str, str]]) -> list[str]:
        """Return a line for each pattern of the nearest file that matches none of these programs (folder, name)."""
        part = self.parts[-1] if self.parts else None
        if part is None or part.files is None:
            return []
        unused = set(range(len(part.patterns)))
        for folder, name in names:
            unused -= part.files.of_file(folder, name)
        return [
            f"{layer.at('files')}: files: no program of this folder matches {display(pattern)}"
            for layer, pattern in (part.patterns[index] for index in sorted(unused))
        ]


class Nearest:
    """
    Finds the nearest job file of programs and folders, in the folder itself or above it; each folder is read once.

    real: the cached real paths of folders.
    """

    def __init__(self) -> None:
        self.real = RealPaths()
        self._in_folders: Remembered[str, Path | None] = Remembered()
        self._cached: dict[str, Path | None] = {}

    def of(self, path: Path) -> Path | None:
        """
        Return the job file of a program or folder, relative to the working folder if it is below it.

        Raises JobError for a pyproject.toml that cannot be read.
        """
        try:
            nearest = self._from(self.real.folder(str(path if path.is_dir() else path.parent)))
        except (OSError, RuntimeError, ValueError):
            return None  # the folder cannot be entered; reading the program reports that
        return _relative(nearest) if nearest is not None else None

    def above(self, path: Path) -> Path | None:
        """Return the job file that would apply in the folder of another one, were that not there."""
        try:
            folder = self.real.folder(str(path.parent))
            nearest = self._from(os.path.dirname(folder))  # noqa: PTH120  pathlib is slow
        except (OSError, RuntimeError, ValueError):
            return None
        return _relative(nearest) if nearest is not None and nearest.parent != Path(folder) else None

    def note(self, folder: str) -> None:
        """Record again what the job file of a folder, a real path, was looked for by."""
        while self._in(folder) is None and (outer := os.path.dirname(folder)) != folder:  # noqa: PTH120
            folder = outer

    def _in(self, folder: str) -> Path | None:
        return self._in_folders.get(folder, lambda: in_folder(Path(folder)))

    def _from(self, folder: str) -> Path | None:
        passed: list[str] = []
        while folder not in self._cached:
            passed.append(folder)
            nearest = self._in(folder)
            outer = os.path.dirname(folder)  # noqa: PTH120  pathlib is slow
            if nearest is not None or outer == folder:
                self._cached[folder] = nearest
            else:
                folder = outer
        self._cached.update(dict.fromkeys(passed, self._cached[folder]))
        return self._cached[folder]


def _relative(path: Path) -> Path:
    """Return a path relative to the working folder if it is below it."""
    with contextlib.suppress(OSError):  # the working folder may be gone
        if path.is_relative_to(Path.cwd()):
            return path.relative_to(Path.cwd())
    return path


def in_folder(folder: Path) -> Path | None:
    """Return the job file in a folder, or None."""
    if not bounded.may_read(folder):
        return None
    record.note(folder / FILE_NAME)
    # A broken link, a folder or a pipe of this name is not skipped: reading it reports the error.
    if os.path.lexists(folder / FILE_NAME):
        return folder / FILE_NAME
    record.note(folder / PROJECT)
    return folder / PROJECT if _is_job_file(folder / PROJECT) else None


def _is_job_file(project: Path) -> bool:
    if not project.is_file():
        return False
    try:
        text = bounded.read_file(project, toml_text.LARGEST, "no job file is")
    except OSError as error:
        raise JobError(f"{_relative(project)}: {error.strerror}") from None
    if b"polarcheck" not in text.replace(b"\0", b""):  # every other byte of UTF-16
        return False
    try:
        tools = toml_text.parsed(bounded.decoded(text).replace("\r\n", "\n")).get("tool")
    except ValueError:  # an error in a table of another tool is ignored; in ours, reading reports it
        return b"[tool.polarcheck" in text
    return isinstance(tools, dict) and "polarcheck" in tools


def load(path: Path, *, pipes: bool = False) -> JobFile:
    """
    Read a job file, a polarcheck.toml or pyproject.toml, and those that it extends.

    pipes: the path may be a pipe, such as `<(...)` of a shell. Raises JobError with file, line and key.
    """
    parts: list[Part] = []
    real: dict[str, Path] = {}
    named_by = ""
    while True:
        identity = os.path.realpath(path)
        if identity in real:
            between = list(real.values())[list(real).index(identity) + 1 :]
            chain = f", by way of {', '.join(map(str, between))}" if between else ""
            raise JobError(f"{named_by}: extend: {path} extends itself{chain}")
        if len(real) == _LONGEST_CHAIN:
            raise JobError(f"{named_by}: extend: more than {_LONGEST_CHAIN} job files, one behind the other")
        real[identity] = path
        part, extended = _part(path, named_by, pipes=pipes and not parts)
        parts.append(part)
        if extended is None:
            return JobFile(parts[0].values.written.path, tuple(reversed(parts)))
        named_by = part.values.at("extend")
        path = _extended(path, extended, named_by)


def _extended(path: Path, written: str, named_by: str) -> Path:
    """Return the file that `extend` of a job file means; of a folder, the nearest one in it or above it."""
    target = Path(os.path.normpath(job_layers.in_folder(path.parent, written)))
    record.note(target)
    if not target.is_dir():
        return _relative(target)
    nearest = Nearest().of(target)
    if nearest is None:
        raise JobError(f"{named_by}: extend: {display(written)}: there is no {FILE_NAME} in this folder or above it")
    return nearest


def _part(path: Path, named_by: str, *, pipes: bool) -> tuple[Part, str | None]:
    """Read one file; return it and the name of the file that it extends. named_by: the place that names this file."""
    before = f"{named_by}: extend: " if named_by else ""
    try:
        text = toml_text.text_of(path, "job file", pipes=pipes)
        table: Any = toml_text.parsed(text)
    except ValueError as error:
        from polarcheck.program.machines import toml_lines

        raise JobError(f"{before}{toml_lines.placed(str(path), str(error))}") from None
    prefix = ""
    if path.name == PROJECT:
        prefix = "tool.polarcheck."
        tools = table.get("tool", {})
        table = tools.get("polarcheck", {}) if isinstance(tools, dict) else {}
        if not isinstance(table, dict):
            raise JobError(f"{path}: tool.polarcheck: expected a table, found {display(table)}")
    written = Written(path, text, prefix)
    try:
        job = fitted(table, Job)
    except MisfitError as misfit:
        raise JobError(f"{before}{written.at(misfit.key)}: {misfit}") from None
    values = Layer(written, table)
    entries = [Layer(written, entry, number) for number, entry in enumerate(table.get("programs", ()), 1)]
    for layer, part_of_job in ((values, job), *zip(entries, job.programs, strict=True)):
        _check_encoding(layer, part_of_job.encoding)
    base = os.path.realpath(path.parent)
    owners = [
        (layer, pattern)
        for layer, part_of_job in zip(entries, job.programs, strict=True)
        for pattern in part_of_job.files
    ]
    files = exclude = None
    if owners:
        files = _globs(base, [pattern for _, pattern in owners], lambda number: owners[number][0].at("files"), "files")
    parts = []
    for number, (part, entry) in enumerate(zip(job.part, table.get("part", ()), strict=True), 1):
        layer = PartLayer(written, entry, number)
        of_part = _globs(base, part.files, _place_of(layer), f"part.{number}.files") if part.files else None
        parts.append((layer, of_part))
    if "exclude" in table:
        exclude = _globs(base, job.exclude, lambda _: values.at("exclude"), "exclude")
    return Part(values, tuple(entries), tuple(parts), files, tuple(owners), exclude), job.extend


def _place_of(layer: PartLayer) -> Callable[[int], str]:
    return lambda _: layer.at("part.files")


def _globs(base: str, patterns: Sequence[str], where: Callable[[int], str], key: str) -> Globs:
    from polarcheck.program.reading.globs import Globs, is_pattern

    for number, pattern in enumerate(patterns):
        if not is_pattern(pattern):
            raise JobError(
                f"{where(number)}: {key}: expected a pattern such as O12*.nc or lathe7/**, found {display(pattern)}"
            )
    return Globs(base, patterns)


def _check_encoding(layer: Layer, name: str | None) -> None:
    from polarcheck.program.reading.source import is_encoding

    if name is not None and not is_encoding(name):
        raise JobError(
            f"{layer.at('encoding')}: encoding: unknown encoding {display(name)}; for example utf-8, cp1252, shift_jis"
        )
