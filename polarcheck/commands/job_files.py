"""Job files: the polarcheck.toml, or pyproject.toml with [tool.polarcheck], that is nearest to a program."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from polarcheck import bounded
from polarcheck.commands import job_layers
from polarcheck.commands.job_layers import Layer, Merged, PartLayer, Written
from polarcheck.errors import JobError
from polarcheck.machines import toml_text
from polarcheck.machines.fitting import MisfitError, fitted, shown
from polarcheck.machines.job import FILE_NAME, PROJECT, Job
from polarcheck.reading.files import RealPaths

if TYPE_CHECKING:
    from polarcheck.reading.globs import Globs

#: Files that may extend each other.
_LONGEST_CHAIN = 10


class _Part(NamedTuple):
    """
    One file of a chain: what it says of all programs, its entries, the patterns of these, with the entry and the text
    of each, and what it excludes; None of these where it does not say. parts: its [[part]] entries, with the patterns
    of each, None for all programs.
    """

    own: Layer
    entries: tuple[Layer, ...]
    parts: tuple[tuple[PartLayer, Globs | None], ...]
    files: Globs | None
    patterns: tuple[tuple[Layer, str], ...]
    exclude: Globs | None


class JobFile(msgspec.Struct, frozen=True):
    """A job file with those that it extends, the farthest first; nothing of a job that nobody wrote."""

    path: Path | None = None
    parts: tuple[_Part, ...] = ()

    @property
    def read(self) -> list[Path]:
        """The files themselves."""
        return [part.own.written.path for part in reversed(self.parts)]

    @property
    def has_entries(self) -> bool:
        """True if the settings depend on the name of the program."""
        return any(part.patterns or any(files for _, files in part.parts) for part in self.parts)

    def layers(self, folder: str, name: str) -> tuple[tuple[int, int], ...]:
        """
        Which layers apply to a program, by file and entry (0 for the file itself, -1 for its first [[part]]), the
        nearest last.

        folder: its real path. name: empty for what applies to the folder itself.
        """
        found: list[tuple[int, int]] = []
        for number, part in enumerate(self.parts):
            found.append((number, 0))
            for entry, (_, files) in enumerate(part.parts, 1):
                if files is None or (name and files.of_file(folder, name)):
                    found.append((number, -entry))
            if part.files is not None and name:
                matched = {part.patterns[index][0].entry for index in part.files.of_file(folder, name)}
                found += [(number, entry) for entry in sorted(matched)]
        return tuple(found)

    def merged(self, layers: Sequence[tuple[int, int]]) -> Merged:
        """The job of some layers. Raises JobError, which names file, line and key."""
        return job_layers.merged([self._layer(number, entry) for number, entry in layers])

    @property
    def excluding(self) -> Layer | None:
        """The layer that says what walks pass over."""
        return next((part.own for part in reversed(self.parts) if part.exclude is not None), None)

    def patterns(self, layer: Layer) -> list[str]:
        """The patterns of an entry."""
        return [pattern for part in self.parts for own, pattern in part.patterns if own is layer]

    def _layer(self, number: int, entry: int) -> Layer:
        part = self.parts[number]
        if entry < 0:
            return part.parts[-entry - 1][0]
        return part.entries[entry - 1] if entry else part.own

    @property
    def exclude(self) -> Globs | None:
        """The excluded patterns of the nearest file."""
        return next((part.exclude for part in reversed(self.parts) if part.exclude is not None), None)

    def unmatched(self, names: Iterable[tuple[str, str]]) -> list[str]:
        """Return a message for each pattern of the nearest file that matches none of these programs (folder, name)."""
        part = self.parts[-1] if self.parts else None
        if part is None or part.files is None:
            return []
        left = set(range(len(part.patterns)))
        for folder, name in names:
            left -= part.files.of_file(folder, name)
        return [
            f"{layer.at('files')}: files: no program of this folder matches {shown(pattern)}"
            for layer, pattern in (part.patterns[index] for index in sorted(left))
        ]


class Nearest:
    """
    The job files of many programs and folders, the nearest from there upward; from the working folder where it lies
    below it. Each folder is looked into once, however deep it lies.
    """

    def __init__(self) -> None:
        #: Of folders, which are asked for by thousands of programs.
        self.real = RealPaths()
        self._known: dict[str, Path | None] = {}

    def of(self, path: Path) -> Path | None:
        """The job file of a program or folder. Raises JobError for a pyproject.toml that cannot be read."""
        try:
            found = self._from(self.real.folder(str(path if path.is_dir() else path.parent)))
        except (OSError, RuntimeError, ValueError):
            return None  # the folder itself cannot be entered; reading the program will say so
        return _from_here(found) if found is not None else None

    def _from(self, folder: str) -> Path | None:
        passed: list[str] = []
        while folder not in self._known:
            passed.append(folder)
            found, outer = own(Path(folder)), os.path.dirname(folder)  # noqa: PTH120  long paths of pathlib are slow
            if found is not None or outer == folder:
                self._known[folder] = found
            else:
                folder = outer
        self._known.update(dict.fromkeys(passed, self._known[folder]))
        return self._known[folder]


def _from_here(path: Path) -> Path:
    """From the working folder where it lies below it."""
    with contextlib.suppress(OSError):  # the working folder may be gone
        if path.is_relative_to(Path.cwd()):
            return path.relative_to(Path.cwd())
    return path


def own(folder: Path) -> Path | None:
    """The job file that lies in a folder."""
    if not bounded.may_read(folder):
        return None
    # A link that leads nowhere, a folder or a pipe of this name is told when it is read, and not passed over.
    if os.path.lexists(folder / FILE_NAME):
        return folder / FILE_NAME
    return folder / PROJECT if _is_job_file(folder / PROJECT) else None


def _is_job_file(project: Path) -> bool:
    if not project.is_file():
        return False
    try:
        text = bounded.read_file(project, toml_text.LARGEST, "no job file is")
    except OSError as error:
        raise JobError(f"{_from_here(project)}: {error.strerror}") from None
    if b"polarcheck" not in text.replace(b"\0", b""):  # every other byte of UTF-16
        return False
    try:
        tools = toml_text.parsed(bounded.decoded(text).replace("\r\n", "\n")).get("tool")
    except ValueError:  # somebody else's fault, unless it is meant for us: reading it will say so
        return b"[tool.polarcheck" in text
    return isinstance(tools, dict) and "polarcheck" in tools


def load(path: Path, *, pipes: bool = False) -> JobFile:
    """
    The job file of a path, a polarcheck.toml or pyproject.toml, and those that it extends.

    pipes: whether it may be a pipe, as a shell hands over `<(...)`. Raises JobError with file, line and key.
    """
    parts: list[_Part] = []
    real: set[str] = set()
    asked_by = ""
    while True:
        identity = os.path.realpath(path)
        if identity in real:
            raise JobError(f"{asked_by}: extend: {path} extends itself")
        if len(real) == _LONGEST_CHAIN:
            raise JobError(f"{asked_by}: extend: more than {_LONGEST_CHAIN} job files, one behind the other")
        real.add(identity)
        part, extended = _part(path, asked_by, pipes=pipes and not parts)
        parts.append(part)
        if extended is None:
            return JobFile(parts[0].own.written.path, tuple(reversed(parts)))
        asked_by = part.own.at("extend")
        path = _from_here(Path(os.path.normpath(job_layers.beside(path.parent, extended))))


def _part(path: Path, asked_by: str, *, pipes: bool) -> tuple[_Part, str | None]:
    """Return the part that a file gives, and the path of the file that it extends. asked_by: what names it."""
    before = f"{asked_by}: extend: " if asked_by else ""
    try:
        text = toml_text.text_of(path, "job file", pipes=pipes)
        table: Any = toml_text.parsed(text)
    except ValueError as error:
        from polarcheck.machines import toml_lines

        raise JobError(f"{before}{toml_lines.placed(str(path), str(error))}") from None
    prefix = ""
    if path.name == PROJECT:
        prefix = "tool.polarcheck."
        tools = table.get("tool", {})
        table = tools.get("polarcheck", {}) if isinstance(tools, dict) else {}
        if not isinstance(table, dict):
            raise JobError(f"{path}: tool.polarcheck: expected a table, found {shown(table)}")
    written = Written(path, text, prefix)
    try:
        job = fitted(table, Job)
    except MisfitError as misfit:
        raise JobError(f"{before}{written.at(misfit.key)}: {misfit}") from None
    own = Layer(written, table)
    entries = [Layer(written, entry, number) for number, entry in enumerate(table.get("programs", ()), 1)]
    for layer, said in ((own, job), *zip(entries, job.programs, strict=True)):
        _check_encoding(layer, said.encoding)
    base = os.path.realpath(path.parent)
    owners = [(layer, pattern) for layer, said in zip(entries, job.programs, strict=True) for pattern in said.files]
    files = exclude = None
    if owners:
        files = _globs(base, [pattern for _, pattern in owners], lambda number: owners[number][0].at("files"), "files")
    parts = []
    for number, (part, entry) in enumerate(zip(job.part, table.get("part", ()), strict=True), 1):
        layer = PartLayer(written, entry, number)
        of_part = _globs(base, part.files, _place_of(layer), f"part.{number}.files") if part.files else None
        parts.append((layer, of_part))
    if "exclude" in table:
        exclude = _globs(base, job.exclude, lambda _: own.at("exclude"), "exclude")
    return _Part(own, tuple(entries), tuple(parts), files, tuple(owners), exclude), job.extend


def _place_of(layer: PartLayer) -> Callable[[int], str]:
    return lambda _: layer.at("part.files")


def _globs(base: str, patterns: Sequence[str], at: Callable[[int], str], key: str) -> Globs:
    from polarcheck.reading.globs import Globs, is_pattern

    for number, pattern in enumerate(patterns):
        if not is_pattern(pattern):
            raise JobError(
                f"{at(number)}: {key}: expected a pattern such as O12*.nc or lathe7/**, found {shown(pattern)}"
            )
    return Globs(base, patterns)


def _check_encoding(layer: Layer, name: str | None) -> None:
    from polarcheck.reading.source import is_encoding

    if name is not None and not is_encoding(name):
        raise JobError(
            f"{layer.at('encoding')}: encoding: unknown encoding {shown(name)}; for example utf-8, cp1252, shift_jis"
        )
