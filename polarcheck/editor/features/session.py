"""The session itself: its beginning, its folders, and files that have changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server


def register(server: Server) -> None:
    """Register the feature."""
    feature = server.feature

    @feature(types.INITIALIZE)
    def initialize(params: types.InitializeParams) -> None:
        server.find_roots()
        for take in server.options:
            take(params.initialization_options)

    @feature(types.INITIALIZED)
    async def initialized(params: types.InitializedParams) -> None:
        await server.begin()
        for configure in server.configured:
            await configure()

    @feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def folders_changed(params: types.DidChangeWorkspaceFoldersParams) -> None:
        server.find_roots()
        for buffer in server.buffers.open.values():
            server.buffers.touch(buffer, 0.0)

    @feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    async def files_changed(params: types.DidChangeWatchedFilesParams) -> None:
        await server.buffers.check_stale()

    @feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
    async def configured(params: types.DidChangeConfigurationParams) -> None:
        """Take what the editor shows; what is checked is in polarcheck.toml and on the command line."""
        for configure in server.configured:
            await configure(params.settings)

    @feature(types.TEXT_DOCUMENT_DID_SAVE)
    async def saved(params: types.DidSaveTextDocumentParams) -> None:
        await server.buffers.check_stale()
