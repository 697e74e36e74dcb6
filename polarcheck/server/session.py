"""The features of the server, each handed to the module that knows the answer."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from lsprotocol import types
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol, lsp_method

from polarcheck import __version__
from polarcheck.reading.excerpt import shortened, visible
from polarcheck.server.buffers import Buffer, Buffers
from polarcheck.server.open_text import OpenText, path_of

if TYPE_CHECKING:
    from polarcheck.server.judged import Judged, SettingsOf

#: How often it is looked whether settings or called programs have changed: network drives tell nobody [s].
_LOOK_EVERY = 2.0
#: Of what an exception says [characters].
_MOST_SAID = 200
#: A document of these is none of a control.
_NO_PROGRAMS = (".toml", ".json", ".md", ".py")

Found = TypeVar("Found")


class Protocol(LanguageServerProtocol):
    """The protocol with documents of our own: those of pygls end lines where no editor does, as at U+0085."""

    _server: Server

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> None:
        """A document is opened."""
        self._server.opened(params.text_document)

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> None:
        """A document is changed."""
        self._server.changed(params)

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> None:
        """A document is closed."""
        self._server.closed(params.text_document.uri)


class Server(LanguageServer):
    """
    A session with one editor.

    settings_of: what applies to a program; raises a PolarcheckError. trusted: folders outside the workspace from which
    files may be opened, too.
    """

    def __init__(self, settings_of: SettingsOf, trusted: Sequence[Path] = ()) -> None:
        super().__init__("polarcheck", __version__, protocol_cls=Protocol)
        self._trusted = [Path(os.path.realpath(folder)) for folder in trusted]
        self._roots: list[Path] = []
        self._bugs: set[str] = set()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._looking: asyncio.Task[None] | None = None
        self.buffers = Buffers(settings_of, self.folders_of, self._publish, self._tell_bug)
        _register(self)

    # ---- what may be opened ----

    def folders_of(self, path: Path) -> list[Path]:
        """
        The folders from which files are opened for a program, without links to their names.

        Those of the workspace; where the editor has none, the program's own, unless it lies nowhere yet.
        """
        own = [Path(os.path.realpath(path.parent))] if path.is_absolute() else []
        return [*(self._roots or own), *self._trusted]

    def find_roots(self) -> None:
        """The folders of the workspace, as the editor tells them."""
        uris = [folder.uri for folder in self.workspace.folders.values()] or [self.workspace.root_uri or ""]
        self._roots = [Path(os.path.realpath(path)) for path in map(path_of, uris) if path is not None]

    # ---- documents ----

    @property
    def units(self) -> str:
        """In which the editor counts characters."""
        chosen = self.server_capabilities.position_encoding
        return str(chosen.value if isinstance(chosen, types.PositionEncodingKind) else chosen or "utf-16")

    def opened(self, document: types.TextDocumentItem) -> None:
        """A document is opened: it is checked at once."""
        path = path_of(document.uri)
        if path is None:
            path = (self._roots[0] if self._roots else Path()) / "untitled"
        if path.suffix.lower() in _NO_PROGRAMS:
            return
        self.buffers.put(Buffer(document.uri, path, OpenText(document.text, self.units), document.version))

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """A document is changed: what it was is of no interest any more."""
        buffer = self.buffers.open.get(params.text_document.uri)
        if buffer is not None:
            self.buffers.change(buffer, buffer.text.changed(params.content_changes), params.text_document.version)

    def closed(self, uri: str) -> None:
        """A document is closed: its marks go."""
        if self.buffers.drop(uri) is not None:
            self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, []))

    async def _publish(self, buffer: Buffer, judged: Judged) -> None:
        from polarcheck.server.diagnostics import diagnostics

        found = await self.buffers.worker.do(diagnostics, judged, buffer.uri)
        if buffer.judged is not judged:
            return
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(buffer.uri, found, buffer.version))
        if self._refreshes_lenses:
            self.workspace_code_lens_refresh(None)

    @property
    def _refreshes_lenses(self) -> bool:
        of_workspace = self.client_capabilities.workspace
        lens = of_workspace.code_lens if of_workspace is not None else None
        return bool(lens is not None and lens.refresh_support)

    # ---- what is asked ----

    async def ask(self, uri: str, function: Callable[[Judged], Found], none: Found, *, soon: bool = False) -> Found:
        """What a function finds in the present state of a document; none, where there is no such document."""
        judged = await self.buffers.judged(uri, soon=soon)
        return none if judged is None else await self.buffers.worker.do(function, judged)

    def prefers_markdown(self, formats: Sequence[types.MarkupKind] | None) -> bool:
        """Whether the editor shows Markdown, of the kinds of text that it names."""
        return bool(formats) and types.MarkupKind.Markdown in (formats or ())

    # ---- what goes wrong on our side ----

    def _tell_bug(self, error: Exception, path: str) -> None:
        """From the thread: one message for each kind of bug, and every one in the log."""
        import traceback

        text = "".join(traceback.format_exception(error))
        said = f"polarcheck: internal error: {type(error).__name__}: {shortened(str(error), _MOST_SAID)}"
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._show_bug, visible(f"{said} while checking {path}"), text)

    def _show_bug(self, said: str, text: str) -> None:
        shown = "\n".join(visible(line) for line in text.splitlines())
        self.window_log_message(types.LogMessageParams(types.MessageType.Error, f"{said}\n{shown}"))
        kind = said.partition(" while checking ")[0]
        if kind not in self._bugs:
            self._bugs.add(kind)
            self.window_show_message(types.ShowMessageParams(types.MessageType.Error, said))

    def report_server_error(self, error: Exception, source: Any) -> None:
        """What the protocol finds wrong goes to the log: whoever types can do nothing about it."""
        message = visible(f"{getattr(source, '__name__', source)}: {error}")
        self.window_log_message(types.LogMessageParams(types.MessageType.Error, message))

    # ---- the session ----

    async def begin(self) -> None:
        """The editor is ready: watch the files that settings come from, and load what a check needs."""
        self._loop = asyncio.get_running_loop()
        self._looking = asyncio.create_task(self._look_around())
        loaded = asyncio.ensure_future(self.buffers.worker.do(_load))
        of_workspace = self.client_capabilities.workspace
        watching = of_workspace.did_change_watched_files if of_workspace is not None else None
        if watching is not None and watching.dynamic_registration:
            options = types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher("**/*.toml")])
            watched = types.Registration("settings", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
            # An editor that does not want to is asked no more: it is looked at the files all the same.
            with contextlib.suppress(Exception):
                await self.client_register_capability_async(types.RegistrationParams([watched]))
        await loaded

    async def _look_around(self) -> None:
        while True:
            await asyncio.sleep(_LOOK_EVERY)
            await self.buffers.look_around()

    def end(self) -> None:
        """Nobody waits for anything any more."""
        if self._looking is not None:
            self._looking.cancel()
        for uri in list(self.buffers.open):
            self.buffers.drop(uri)
        self.buffers.worker.end()


def _load() -> None:
    """What takes time at the first check is there before it."""
    from polarcheck.checking.rule import load_all
    from polarcheck.server import judged  # noqa: F401

    load_all()


def _register(server: Server) -> None:
    """The features, as methods of the protocol."""
    feature = server.feature

    @feature(types.INITIALIZE)
    def initialize(params: types.InitializeParams) -> None:
        server.find_roots()

    @feature(types.INITIALIZED)
    async def initialized(params: types.InitializedParams) -> None:
        await server.begin()

    @feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def folders_changed(params: types.DidChangeWorkspaceFoldersParams) -> None:
        server.find_roots()
        for buffer in server.buffers.open.values():
            server.buffers.touch(buffer, 0.0)

    @feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    async def files_changed(params: types.DidChangeWatchedFilesParams) -> None:
        await server.buffers.look_around()

    @feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
    def configured(params: types.DidChangeConfigurationParams) -> None:
        """Settings are in polarcheck.toml and on the command line, never in the editor."""

    @feature(types.TEXT_DOCUMENT_DID_SAVE)
    async def saved(params: types.DidSaveTextDocumentParams) -> None:
        await server.buffers.look_around()

    @feature(types.TEXT_DOCUMENT_HOVER)
    async def hover(params: types.HoverParams) -> types.Hover | None:
        def find(judged: Judged) -> types.Hover | None:
            from polarcheck.server.hover import hover

            of_text = server.client_capabilities.text_document
            shown = of_text.hover.content_format if of_text is not None and of_text.hover is not None else None
            return hover(judged, params.position, server.prefers_markdown(shown))

        return await server.ask(params.text_document.uri, find, None, soon=True)

    @feature(types.TEXT_DOCUMENT_CODE_LENS, types.CodeLensOptions())
    async def code_lens(params: types.CodeLensParams) -> list[types.CodeLens]:
        def find(judged: Judged) -> list[types.CodeLens]:
            from polarcheck.server.outline import code_lenses

            return code_lenses(judged)

        return await server.ask(params.text_document.uri, find, [])

    @feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def document_symbol(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        def find(judged: Judged) -> list[types.DocumentSymbol]:
            from polarcheck.server.outline import symbols

            return symbols(judged)

        return await server.ask(params.text_document.uri, find, [])

    @feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition(params: types.DefinitionParams) -> list[types.Location]:
        def find(judged: Judged) -> list[types.Location]:
            from polarcheck.server.definition import definition

            return definition(judged, params.text_document.uri, params.position)

        return await server.ask(params.text_document.uri, find, [], soon=True)

    @feature(
        types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(code_action_kinds=[types.CodeActionKind.QuickFix])
    )
    async def code_action(params: types.CodeActionParams) -> list[types.CodeAction]:
        wanted = params.context.only
        if wanted and not any(
            types.CodeActionKind.QuickFix.value.startswith(str(kind)) for kind in map(_value, wanted)
        ):
            return []
        uri = params.text_document.uri
        buffer = server.buffers.open.get(uri)
        version = buffer.version if buffer is not None else None

        def find(judged: Judged) -> list[types.CodeAction]:
            from polarcheck.server.actions import actions

            of_workspace = server.client_capabilities.workspace
            edits = of_workspace.workspace_edit if of_workspace is not None else None
            return actions(judged, uri, version, params.range, bool(edits is not None and edits.document_changes))

        return await server.ask(uri, find, [], soon=True)

    @feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=[" "], resolve_provider=True))
    async def completion(params: types.CompletionParams) -> list[types.CompletionItem]:
        from polarcheck.server.allowing import completions

        # While somebody types no check comes to an end: the text is what counts.
        buffer = server.buffers.open.get(params.text_document.uri)
        if buffer is None:
            return []
        return await server.buffers.worker.do(completions, buffer.text, params.position, buffer.judged)

    @feature(types.COMPLETION_ITEM_RESOLVE)
    async def resolve(item: types.CompletionItem) -> types.CompletionItem:
        from polarcheck.server.allowing import with_page

        return await server.buffers.worker.do(with_page, item, True)


def _value(kind: types.CodeActionKind | str) -> str:
    return str(kind.value) if isinstance(kind, types.CodeActionKind) else kind
