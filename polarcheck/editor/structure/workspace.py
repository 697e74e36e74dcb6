"""The other files that the server may open: open documents as they are typed, all else as it is saved."""

from __future__ import annotations

import contextlib
import itertools
import os
import re
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from polarcheck.editor.open_text import OpenText
from polarcheck.editor.structure.document import Document
from polarcheck.foundation import bounded
from polarcheck.program.execution.called_programs import Library, names_of
from polarcheck.program.execution.programs import ProgramName
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.source import read_source
from polarcheck.program.reading.walking import EXTENSIONS, walk

#: The most files that are looked at for a request, the largest of them [bytes], and how long that may take [s].
_MOST_FILES, _LARGEST, _PATIENCE = 5_000, 50_000_000, 4.0
#: The most files that are read as programs.
_MOST_READ = 200
#: The most files of one name.
_MOST_NAMED = 8


class Opened(NamedTuple):
    """An open document."""

    uri: str
    path: Path
    text: OpenText


class Workspace:
    """
    The files around a document; made for one request.

    document: the document.
    opened: the open documents.
    folders: from which files may be opened, with all links resolved; without any the document stands alone.
    machine_of: returns the machine of a file and the folders of the programs that it calls.
    is_complete: False once a file could not be looked at, or time was up.
    """

    def __init__(
        self,
        document: Document,
        opened: Sequence[Opened],
        folders: Sequence[Path],
        machine_of: Callable[[Path], tuple[Machine, Sequence[str]]],
    ) -> None:
        self.document, self._folders, self._machine_of = document, folders, machine_of
        self.is_complete = True
        self._documents: dict[str, Document] = {os.path.realpath(document.path): document}
        self._opened = {
            os.path.realpath(document_opened.path): document_opened
            for document_opened in opened
            if document_opened.uri != document.uri
        }
        self._paths: list[str] | None = None
        self._data: dict[str, bytes | None] = {}
        self._ends = time.monotonic() + _PATIENCE

    def matching(self, pattern: re.Pattern[bytes]) -> Iterator[Document]:
        """Yield the documents whose bytes match a pattern: this one, the open ones, those in the folders."""
        yield self.document
        seen = {os.path.realpath(self.document.path)}
        for real, document in self._opened.items():
            seen.add(real)
            if pattern.search(document.text.data):
                yield self._of_open(real, document)
        for path in self._listed():
            if not self.has_time():
                return
            real = os.path.realpath(path)
            if real in seen:
                continue
            seen.add(real)
            if real in self._documents:
                yield self._documents[real]
                continue
            if path not in self._data:
                self._data[path] = self._read(Path(path))
            data = self._data[path]
            if data is not None and pattern.search(data):
                yield self._of_file(Path(real), data)

    def has_time(self) -> bool:
        """Return True while there is time for more files, and room; else what is found is not complete."""
        has_time = time.monotonic() <= self._ends and len(self._documents) <= _MOST_READ
        self.is_complete &= has_time
        return has_time

    def _listed(self) -> list[str]:
        """Return the programs in the folders, up to a limit."""
        if self._paths is None:
            self._paths = list(itertools.islice(self._walk(), _MOST_FILES + 1))
            self.is_complete &= len(self._paths) <= _MOST_FILES
        return self._paths

    def _walk(self) -> Iterator[str]:
        endings = {*EXTENSIONS, self.document.path.suffix.lower()}
        for folder in dict.fromkeys(self._folders):
            yield from walk(str(folder), endings, lambda _: None)

    def _read(self, path: Path) -> bytes | None:
        try:
            with bounded.only_below(self._folders):
                return bounded.read_file(path, _LARGEST, "")
        except OSError:
            # What lies outside of the folders is none of this document's business; all else is not looked at.
            with bounded.only_below(self._folders):
                self.is_complete &= not bounded.may_read(path)
            return None

    def called(self, caller: Document, name: ProgramName) -> list[Document]:
        """Return the documents in the folders of subprograms that can hold a program."""
        if not caller.folders or not self._folders:
            return []
        with contextlib.suppress(OSError):
            places = Library(caller.folders, caller.machine).places(name)
            return [self._of_file(file.path, file.data) for file in places]
        return []

    def file(self, path: Path) -> Document | None:
        """Return the document of a file: one below the folders, or in a folder of called programs."""
        data = self._read(path)
        if data is None:
            folders = [Path(os.path.realpath(folder)) for folder in self.document.folders]
            if not any(Path(os.path.realpath(path)).is_relative_to(folder) for folder in folders):
                return None
            with contextlib.suppress(OSError), bounded.only_below(folders):
                data = bounded.read_file(path, _LARGEST, "")
        return None if data is None else self._of_file(path, data)

    def of_file_name(self, caller: Document, name: ProgramName) -> list[Document]:
        """Return the documents of the workspace whose file has the name of a program, beside the caller first."""
        pattern = names_of(name)
        if pattern is None:
            return []
        paths = [path for path in self._listed() if pattern.fullmatch(os.path.basename(path))]  # noqa: PTH119
        folder = os.path.realpath(caller.path.parent)
        paths.sort(key=lambda path: os.path.realpath(Path(path).parent) != folder)
        contents = ((path, self._read(Path(path))) for path in paths[:_MOST_NAMED])
        return [self._of_file(Path(path), data) for path, data in contents if data is not None]

    def _of_open(self, real: str, opened: Opened) -> Document:
        if real not in self._documents:
            self._documents[real] = Document(opened.uri, opened.path, opened.text, *self._machine_of(opened.path))
        return self._documents[real]

    def _of_file(self, path: Path, data: bytes) -> Document:
        real = os.path.realpath(path)
        if real in self._opened:
            return self._of_open(real, self._opened[real])
        if real not in self._documents:
            source = read_source(data, path.name)
            text = OpenText("\ufeff" * bool(source.bom) + source.text, self.document.text.units)
            uri = path.absolute().as_uri()
            self._documents[real] = Document(uri, path, text, *self._machine_of(path))
        return self._documents[real]


def naming(keys: Sequence[int | str]) -> re.Pattern[bytes]:
    """Return a pattern of bytes that every file matches that names a program of one of these numbers and names."""
    parts = []
    for key in keys:
        if isinstance(key, int):
            parts.append(rb"[POL:<][ \t]{0,3}O?[0-9]{0,12}%d(?![0-9])" % key)
        else:
            parts.append(re.escape(key.encode("utf-8", "replace")))
    return re.compile(b"|".join(parts), re.IGNORECASE)


def writing(variable: int | str) -> re.Pattern[bytes]:
    """Return a pattern of bytes that every file matches that writes a variable: 500 for #500, R5, #_NAME."""
    digits = str(variable).lstrip("RVC")
    if digits.isdecimal():
        letters = b"#" if isinstance(variable, int) else variable[:1].encode()
        return re.compile(rb"%s[ \t]{0,3}0{0,8}%s(?![0-9])" % (letters, digits.encode()), re.IGNORECASE)
    return re.compile(re.escape(str(variable).encode()), re.IGNORECASE)
