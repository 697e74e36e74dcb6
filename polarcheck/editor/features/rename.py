"""Rename N numbers, labels, variables and programs over files."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document

#: RequestFailed of the protocol: the editor shows the message.
_FAILED = -32803

Result = TypeVar("Result")


def register(server: Server) -> None:
    """Register the features."""

    async def ask(uri: str, function: Callable[[Document], Result | None]) -> Result | None:
        from polarcheck.editor.structure.renaming import RenameError

        none: Result | None = None
        try:
            return await server.documents.ask(uri, function, none)
        except RenameError as error:
            raise JsonRpcException(str(error), _FAILED) from None

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    async def prepare_rename(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        def find(document: Document) -> types.PrepareRenamePlaceholder | None:
            from polarcheck.editor.structure.renaming import prepare

            return prepare(document, params.position, server.documents.workspace(document))

        return await ask(params.text_document.uri, find)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def rename(params: types.RenameParams) -> types.WorkspaceEdit | None:
        from polarcheck.editor.workspace_edits import workspace_edit

        def find(document: Document) -> types.WorkspaceEdit:
            from polarcheck.editor.structure.renaming import rename

            edits = rename(document, params.position, params.new_name, server.documents.workspace(document))
            return workspace_edit(server, edits)

        return await ask(params.text_document.uri, find)
