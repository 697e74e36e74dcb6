"""Answers about the open documents that need no check: they are read as their machine reads them, in a thread."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from polarcheck.editor.buffers import Buffer, Buffers
from polarcheck.editor.open_text import path_of
from polarcheck.editor.worker import Worker
from polarcheck.foundation.errors import PolarcheckError

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings
    from polarcheck.editor.analysis import SettingsOf
    from polarcheck.editor.open_text import OpenText
    from polarcheck.editor.structure.document import Document
    from polarcheck.editor.structure.workspace import Workspace
    from polarcheck.program.machines.machine import Machine

Result = TypeVar("Result")

#: The pause after a key before the names of a text are read ahead; shorter than that before a check [s].
_PAUSE = 0.2


class Documents:
    """
    The open documents as their machines read them.

    buffers: the open documents.
    settings_of: returns the settings of a program.
    folders_of: returns the folders from which files may be opened for a program.
    worker: a thread, so that no answer waits for a check.
    """

    def __init__(self, buffers: Buffers, settings_of: SettingsOf, folders_of: Callable[[Path], Sequence[Path]]) -> None:
        self.buffers, self.settings_of, self.folders_of = buffers, settings_of, folders_of
        self.worker = Worker()
        self._known: dict[str, tuple[Settings | None, Document]] = {}
        self._reading: asyncio.Task[None] | None = None

    async def ask(self, uri: str, function: Callable[[Document], Result], none: Result) -> Result:
        """Apply a function to the present text of a document; return `none` if there is no such document."""
        buffer = self.buffers.open.get(uri)
        if buffer is None:
            return none
        settings = buffer.judged.settings if buffer.judged is not None else None
        return await self.worker.do(self._apply, function, buffer, buffer.text, settings)

    def read_ahead(self, uri: str) -> None:
        """Read the names of a text once nobody has typed for a moment, so that the first answer about them is quick."""
        if self._reading is not None:
            self._reading.cancel()
        self._reading = asyncio.create_task(self._read_ahead(uri))

    async def _read_ahead(self, uri: str) -> None:
        await asyncio.sleep(_PAUSE)
        await self.ask(uri, _read_names, None)

    async def ask_of_any(self, uri: str, function: Callable[[Document], Result], none: Result) -> Result:
        """Apply a function to a document that is open, or that is a file beside those that are open."""
        path = path_of(uri)
        if uri in self.buffers.open or path is None:
            return await self.ask(uri, function, none)
        folders = [folder for buffer in self.buffers.open.values() for folder in self.folders_of(buffer.path)]
        documents = [document for _, document in self._known.values()]
        return await self.worker.do(self._apply_to_file, function, path, folders, documents, none)

    def _apply_to_file(
        self,
        function: Callable[[Document], Result],
        path: Path,
        folders: Sequence[Path],
        documents: Sequence[Document],
        none: Result,
    ) -> Result:
        from polarcheck.editor.structure.workspace import Workspace

        for document in documents:
            document_of_file = Workspace(document, (), folders, self.machine_of).file(path)
            if document_of_file is not None:
                return function(document_of_file)
        return none

    def _apply(
        self, function: Callable[[Document], Result], buffer: Buffer, text: OpenText, settings: Settings | None
    ) -> Result:
        return function(self._document(buffer, text, settings))

    def _document(self, buffer: Buffer, text: OpenText, settings: Settings | None) -> Document:
        """Return a document; while its text is not checked yet, with the settings of the last check."""
        from polarcheck.editor.structure.document import Document

        for uri in self._known.keys() - self.buffers.open.keys():
            self._known.pop(uri, None)
        known_settings, cached = self._known.get(buffer.uri, (None, None))
        settings = settings or known_settings
        if cached is not None and cached.text is text and settings is known_settings:
            return cached
        machine, folders = self.machine_of(buffer.path, settings)
        document = Document(buffer.uri, buffer.path, text, machine, folders)
        self._known[buffer.uri] = settings, document
        return document

    def workspace(self, document: Document) -> Workspace:
        """Return the files around a document, for one request."""
        from polarcheck.editor.structure.workspace import Opened, Workspace

        opened = [Opened(buffer.uri, buffer.path, buffer.text) for buffer in list(self.buffers.open.values())]
        return Workspace(document, opened, self.folders_of(document.path), self.machine_of)

    def machine_of(self, path: Path, settings: Settings | None = None) -> tuple[Machine, Sequence[str]]:
        """Return the machine of a program and the folders of those it calls; the default if its settings are broken."""
        from polarcheck.foundation import bounded
        from polarcheck.program.machines import profiles

        try:
            if settings is None:
                with bounded.only_below(self.folders_of(path)):
                    settings = self.settings_of(path)
            return settings.machine, settings.job.run.subprograms
        except PolarcheckError:
            return profiles.load(profiles.DEFAULT).machine, ()

    def end(self) -> None:
        """End the thread."""
        if self._reading is not None:
            self._reading.cancel()
        self.worker.end()


def _read_names(document: Document) -> None:
    from polarcheck.editor.structure.mentions import mentions_of

    mentions_of(document)
