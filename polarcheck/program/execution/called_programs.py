"""
The called programs that lie beside the file, in other channels or in folders of the job: each is looked for and read
once, whoever calls it.
"""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import msgspec

from polarcheck.foundation import bounded, record
from polarcheck.foundation.arrays import cached_property
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import ProgramName, Programs, find_programs, read_text
from polarcheck.program.execution.run import Beside
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.files import display_path
from polarcheck.program.reading.source import Source, read_source
from polarcheck.program.reading.words import Text

#: A called program is a program, not an archive [bytes].
_LARGEST = 50_000_000
_MOST_LOOKED_FOR = 100
#: Files that are read for one call, where several can hold the program.
_MOST_READ = 4
#: Endings of copies that were put aside.
_OF_BACKUPS = frozenset((".bak", ".old", ".orig", ".sav", ".tmp", ".new"))
_NAME = lazy_pattern(r"[A-Za-z0-9+_.-]{1,64}")
#: In one line, and nothing of it read again: a file of blank lines is no reason to wait.
_OWN_NAME = lazy_pattern(
    r"^[^\S\n]*+(?:[O:][^\S\n]*+(\d{1,15}(?!\d)|<[^>\n]*+>)|%(?:_N_)?(\w{1,32})_[MS]PF\s*$)",
    re.MULTILINE | re.IGNORECASE | re.ASCII,
)
#: The line that begins a tape. Behind a head it would end the program.
_TAPE_MARK = lazy_pattern(r"[\s\0]*+(?:\$[^%\n]*+)?%[^\n]*+\n")
#: A name that stands at the head as the call has it: OFACE.
_BARE_NAME = lazy_pattern(r"O[A-Z][A-Z0-9]*+", re.IGNORECASE | re.ASCII)


class MovedFolder(str):
    """
    The path of a folder whose programs were brought to this machine.

    named: the path that the job names.
    """

    named: str

    def __new__(cls, path: str, named: str) -> MovedFolder:
        """Return the path, with the one that the job names."""
        folder = super().__new__(cls, path)
        folder.named = named
        return folder


class LibraryFile(NamedTuple):
    """
    A file that can hold a called program.

    path: its path, with all links of the folder resolved.
    title: its path as the job names the folder.
    data: its bytes.
    """

    path: Path
    title: str
    data: bytes


class Library:
    """
    The other channels of a file, the folders of a job, and what has been looked for in them.

    rivals: titles of the files that can hold a program, where there are several that differ.
    """

    def __init__(self, folders: Sequence[str], machine: Machine, channels: Sequence[Text] = ()) -> None:
        self._channels = list(channels)
        self._folders = [(Path(os.path.realpath(folder)), _title(folder)) for folder in folders]
        self._machine = machine
        self._texts: dict[ProgramName, Text | None] = {}
        self.rivals: dict[ProgramName, list[str]] = {}

    @cached_property
    def _paths(self) -> list[tuple[Path, str, list[Path]]]:
        """Each folder that can be listed, its title, and what lies in it, by name; backups come last."""
        paths_of_folders = []
        for folder, title in self._folders:
            record.note(folder)
            with contextlib.suppress(OSError):
                paths = {*folder.iterdir(), *bounded.opened_in(folder)}
                paths_of_folders.append((folder, title, sorted(paths, key=lambda path: (_is_backup(path), path))))
        return paths_of_folders

    @cached_property
    def _programs(self) -> list[Programs]:
        """The programs of each of the other channels."""
        return [find_programs(text) for text in self._channels]

    def text(self, called: ProgramName) -> Text | None:
        """The text with the program of a call; None where there is none, or too many have been looked for."""
        if called not in self._texts:
            for programs in self._programs:
                if programs.named(called):
                    return programs.text
            if len(self._texts) > _MOST_LOOKED_FOR:
                return None
            source = self.find(called)
            self._texts[called] = read_text(source, self._machine) if source is not None else None
        return self._texts[called]

    def find(self, called: ProgramName) -> Source | None:
        """
        A program in the folders of the job, never outside them: O1234, 1234.nc, O1234.NC, or its <name>.

        A file without an O number of its own is given that of the call.
        """
        places = self.places(called)
        if not places:
            return None
        if len(places) > 1:
            self.rivals[called] = [file.title for file in places]
        return _with_head(places[0].data, places[0].path.name, called)

    def places(self, called: ProgramName) -> list[LibraryFile]:
        """
        The files that can hold a program, in the order in which they are looked for.

        Copies of the first one, and backups beside it, are left out.
        """
        pattern = names_of(called)
        if pattern is None:
            return []
        places: list[LibraryFile] = []
        named: list[tuple[str, bytes]] = []
        remaining = _MOST_READ
        for folder, title, paths in self._paths:
            for path in paths:
                if not remaining or not pattern.fullmatch(path.name) or (places and _is_backup(path)):
                    continue
                data = _read_inside(folder, path)
                remaining -= data is not None
                if data is not None and (not places or _content(data) != _content(places[0].data)):
                    named.append((os.path.join(title, path.name), data))  # noqa: PTH118
                    places.append(LibraryFile(path, display_path(named[-1][0]), data))
        record.note_look_up(called, named)
        return places


def _title(folder: str) -> str:
    return folder.named if isinstance(folder, MovedFolder) else folder


def _is_backup(path: Path) -> bool:
    return path.suffix.lower() in _OF_BACKUPS


def _content(data: bytes) -> bytes:
    """Return what copies of a program have in common, whatever has sent them: not line ends, nor blanks at the ends."""
    return data.replace(b"\r", b"").strip(b"\0 \n")


def names_of(called: ProgramName) -> re.Pattern[str] | None:
    """The names of files that can hold a program; None where none can."""
    number, name = called
    if number is not None:
        return re.compile(rf"O?0*{number}(?:\.[A-Za-z]{{1,4}})?", re.IGNORECASE)
    if name is None or not _NAME.fullmatch(name):
        return None
    return re.compile(
        rf"{re.escape(name)}(?:\.[A-Za-z]{{1,4}})?|_N_{re.escape(name)}_[MS]PF(?:\.[A-Za-z]{{1,4}})?", re.IGNORECASE
    )


def contents(folder: str) -> dict[str, bytes]:
    """All that could be called in a folder of a job, by name: for a machine that does not have the folder."""
    real = Path(os.path.realpath(folder))
    files = {}
    with contextlib.suppress(OSError):
        for path in sorted(real.iterdir()):
            if _NAME.fullmatch(path.name) and (data := _read_inside(real, path)) is not None:
                files[path.name] = data
    return files


def _read_inside(folder: Path, path: Path) -> bytes | None:
    """The bytes of a program; None for what lies outside the folder, is no file, cannot be read, or is too large."""
    real = Path(os.path.realpath(path))
    try:
        return bounded.read_file(real.relative_to(folder), _LARGEST, "", below=folder)
    except (OSError, ValueError):
        return None


def _with_head(data: bytes, file: str, called: ProgramName) -> Source:
    number, name = called
    source = read_source(data, file)
    text = source.text
    match = _OWN_NAME.search(text)
    if match is not None:
        own_name = match[1] or match[2]
        if own_name.isdigit() and number is not None and int(own_name) == number:
            return source
        if name is not None and own_name.strip("<>").upper() == name.upper():
            return source
    if name is not None and _BARE_NAME.fullmatch(name) and re.search(rf"(?im)^[^\S\n]*+{name}[^\S\n]*+(?:\(|$)", text):
        return source
    head = f"O{number:04d}" if number is not None else f"O<{name}>"
    mark = _TAPE_MARK.match(text)
    end = mark.end() if mark else 0
    headed = source.encode(f"{text[:end]}{head}\n{text[end:]}")
    return msgspec.structs.replace(read_source(headed, file), added_lines=1)


class Shelf:
    """
    The listing of a file with all called files that were found so far; it grows where a call names another one.

    From the start it holds the files of all programs that are named literally, and that those name in turn.
    """

    def __init__(self, text: Text, machine: Machine, folders: Sequence[str], channels: Beside | None = None) -> None:
        self.beside = channels or Beside()
        self._library = Library(folders, machine, self.beside.texts)
        #: Titles of the files that can hold a program, where there are several that differ.
        self.rivals: dict[ProgramName, list[str]] = self._library.rivals
        self.listing = Listing([text], machine)
        self._add([called for called in self.listing.calls(0) if not self.listing.programs.named(called)])

    def add(self, called: ProgramName) -> bool:
        """Look for the file of a call whose number was computed; whether the listing has grown by it."""
        before = self.listing
        self._add([called])
        return self.listing is not before

    def _add(self, names: Sequence[ProgramName]) -> None:
        while True:
            missing = [called for called in dict.fromkeys(names) if called not in self.listing.found]
            files = {called: text for called in missing if (text := self._library.text(called)) is not None}
            if not files:
                return
            count = len(self.listing.files)
            self.listing = self.listing.with_files(files)
            added = [called for file in range(count, len(self.listing.files)) for called in self.listing.calls(file)]
            names = [called for called in added if not self.listing.programs.named(called)]
