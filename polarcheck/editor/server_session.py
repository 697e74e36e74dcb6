"""The session with an editor: its documents and folders, and what the modules in `features/` are built on."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from lsprotocol import types
from pygls.capabilities import get_capability
from pygls.lsp.server import LanguageServer

from polarcheck.editor.buffers import Buffer, Buffers
from polarcheck.editor.documents import Documents
from polarcheck.editor.open_text import OpenText, path_of
from polarcheck.editor.protocol import Protocol
from polarcheck.foundation.version import __version__
from polarcheck.program.reading.excerpt import shortened, visible

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis, SettingsOf

#: How often settings and called programs are checked for changes: network drives send no events [s].
_POLL_EVERY = 2.0
#: The longest text of an exception that is shown [characters].
_LONGEST_ERROR = 200
#: Extensions of documents that are no NC programs.
_NO_PROGRAMS = (".toml", ".json", ".md", ".py")

Result = TypeVar("Result")


class Server(LanguageServer):
    """
    A session with one editor.

    settings_of: returns the settings of a program; raises a PolarcheckError.
    trusted: folders outside the workspace from which files may be opened, too.
    buffers: the open documents.
    documents: the same as their machines read them, for answers that need no check.
    rewritings: return code actions that need no check.
    options: called with the options that the editor sends first of all.
    configured: called once the editor is ready, and with its settings whenever they change.
    published: called with each document and the result of its check, once its diagnostics are sent.
    gone: called with the URI of each document that is closed.
    """

    def __init__(self, settings_of: SettingsOf, trusted: Sequence[Path] = ()) -> None:
        super().__init__("polarcheck", __version__, protocol_cls=Protocol)
        self._trusted = [Path(os.path.realpath(folder)) for folder in trusted]
        self._roots: list[Path] = []
        self._bugs: set[str] = set()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._polling: asyncio.Task[None] | None = None
        self.buffers = Buffers(settings_of, self.folders_of, self._publish, self._report_bug)
        self.documents = Documents(self.buffers, settings_of, self.folders_of)
        self.rewritings: list[Callable[[types.CodeActionParams], Awaitable[list[types.CodeAction]]]] = []
        self.options: list[Callable[[Any], object]] = []
        self.configured: list[Callable[..., Awaitable[None]]] = []
        self.published: list[Callable[[Buffer, Analysis], None]] = []
        self.gone: list[Callable[[str], None]] = []

    # ---- what may be opened ----

    def folders_of(self, path: Path) -> list[Path]:
        """
        Return the folders from which files may be opened for a program, with all links resolved.

        They are those of the workspace; without a workspace it is the folder of the program, if it has been saved.
        """
        folder = [Path(os.path.realpath(path.parent))] if path.is_absolute() else []
        return [*(self._roots or folder), *self._trusted]

    def find_roots(self) -> None:
        """Take the folders of the workspace from the editor."""
        uris = [folder.uri for folder in self.workspace.folders.values()] or [self.workspace.root_uri or ""]
        self._roots = [Path(os.path.realpath(path)) for path in map(path_of, uris) if path is not None]

    # ---- documents ----

    @property
    def units(self) -> str:
        """Return the units in which the editor counts characters."""
        chosen = self.server_capabilities.position_encoding
        return str(chosen.value if isinstance(chosen, types.PositionEncodingKind) else chosen or "utf-16")

    def opened(self, document: types.TextDocumentItem) -> None:
        """Check an opened document at once."""
        path = path_of(document.uri)
        if path is None:
            path = (self._roots[0] if self._roots else Path()) / "untitled"
        if path.suffix.lower() in _NO_PROGRAMS:
            return
        self.buffers.put(Buffer(document.uri, path, OpenText(document.text, self.units), document.version))

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """Check a changed document; the check of its former text is cancelled."""
        buffer = self.buffers.open.get(params.text_document.uri)
        if buffer is not None:
            self.buffers.change(buffer, buffer.text.changed(params.content_changes), params.text_document.version)
            self.documents.read_ahead(buffer.uri)

    def closed(self, uri: str) -> None:
        """Remove the diagnostics of a closed document."""
        if self.buffers.drop(uri) is not None:
            self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, []))
            for forget in self.gone:
                forget(uri)

    async def _publish(self, buffer: Buffer, analysis: Analysis) -> None:
        from polarcheck.editor.diagnostics import diagnostics

        marks = await self.buffers.worker.do(diagnostics, analysis, buffer.uri)
        if buffer.judged is not analysis:
            return
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(buffer.uri, marks, buffer.version))
        for notify in self.published:
            notify(buffer, analysis)

    # ---- requests ----

    async def ask(
        self, uri: str, function: Callable[[Analysis], Result], none: Result, *, soon: bool = False
    ) -> Result:
        """Apply a function to the checked document; return `none` if there is no such document."""
        analysis = await self.buffers.judged(uri, soon=soon)
        return none if analysis is None else await self.buffers.ask(function, analysis)

    # ---- internal errors ----

    def _report_bug(self, error: Exception, path: str) -> None:
        """Log every bug, and show one message for each kind of bug; called from the worker thread."""
        import traceback

        text = "".join(traceback.format_exception(error))
        summary = f"polarcheck: internal error: {type(error).__name__}: {shortened(str(error), _LONGEST_ERROR)}"
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._show_bug, visible(f"{summary} while checking {path}"), text)

    def _show_bug(self, summary: str, text: str) -> None:
        lines = "\n".join(visible(line) for line in text.splitlines())
        self.window_log_message(types.LogMessageParams(types.MessageType.Error, f"{summary}\n{lines}"))
        kind = summary.partition(" while checking ")[0]
        if kind not in self._bugs:
            self._bugs.add(kind)
            self.window_show_message(types.ShowMessageParams(types.MessageType.Error, summary))

    def report_server_error(self, error: Exception, source: Any) -> None:
        """Log an error of the protocol; it is not shown, since the user can do nothing about it."""
        message = visible(f"{getattr(source, '__name__', source)}: {error}")
        self.window_log_message(types.LogMessageParams(types.MessageType.Error, message))

    # ---- the session ----

    async def begin(self) -> None:
        """Watch the files that settings come from, and load what a check needs; called once the editor is ready."""
        self._loop = asyncio.get_running_loop()
        self._polling = asyncio.create_task(self._poll())
        loaded = asyncio.ensure_future(self.buffers.worker.do(_load))
        if get_capability(self.client_capabilities, "workspace.did_change_watched_files.dynamic_registration"):
            options = types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher("**/*.toml")])
            watched = types.Registration("settings", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
            # If the editor refuses, polling still sees the changes.
            with contextlib.suppress(Exception):
                await self.client_register_capability_async(types.RegistrationParams([watched]))
        await loaded

    async def _poll(self) -> None:
        while True:
            await asyncio.sleep(_POLL_EVERY)
            await self.buffers.check_stale()

    def end(self) -> None:
        """End the session: cancel all checks."""
        if self._polling is not None:
            self._polling.cancel()
        for uri in list(self.buffers.open):
            self.buffers.drop(uri)
        self.buffers.worker.end()
        self.documents.end()


def _load() -> None:
    """Import and load in advance what takes time at the first check."""
    import gc

    from polarcheck.editor import analysis  # noqa: F401
    from polarcheck.editor.structure import reference_search  # noqa: F401
    from polarcheck.rules.rule import load_all

    load_all()
    # What is loaded stays: looking through it for garbage would double the time of answers about a long program.
    gc.freeze()
