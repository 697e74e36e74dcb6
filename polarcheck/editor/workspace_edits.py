"""Edits of several documents, in the form that the editor supports."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.capabilities import get_capability

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document
    from polarcheck.editor.structure.workspace import Workspace


def names_versions(server: Server) -> bool:
    """Return True if edits for this editor may name the version of a document."""
    return bool(get_capability(server.client_capabilities, "workspace.workspace_edit.document_changes"))


def workspace_edit(server: Server, edits: Mapping[str, list[types.TextEdit]]) -> types.WorkspaceEdit:
    """Return edits by URI as one change; with the versions of open documents if the editor knows them."""
    if not names_versions(server):
        return types.WorkspaceEdit(changes=dict(edits))
    opened = server.buffers.open
    return types.WorkspaceEdit(
        document_changes=[
            types.TextDocumentEdit(
                types.OptionalVersionedTextDocumentIdentifier(uri, opened[uri].version if uri in opened else None),
                list(text_edits),
            )
            for uri, text_edits in edits.items()
        ]
    )


def renamed(
    document: Document, position: types.Position, new_name: str, workspace: Workspace, server: Server
) -> types.WorkspaceEdit:
    """Return the edits that give the name at a position a new one. Raises RenameError where that is not possible."""
    from polarcheck.editor.structure.renaming import rename

    return workspace_edit(server, rename(document, position, new_name, workspace))
