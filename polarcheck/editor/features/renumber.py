"""The code action that renumbers the N numbers of a program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.capabilities import get_capability
from pygls.exceptions import JsonRpcException

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document

#: RequestFailed of the protocol: the editor shows the message.
_FAILED = -32803


def register(server: Server) -> None:
    """Register the feature."""

    async def offered(params: types.CodeActionParams) -> list[types.CodeAction]:
        """Return the action for the program at the cursor; its edits follow once it is chosen, if the editor asks."""
        uri, position = params.text_document.uri, params.range.start

        def find(document: Document) -> tuple[str, str] | None:
            from polarcheck.editor.structure.renumbering import title

            return title(document, position)

        offer = await server.documents.ask(uri, find, None)
        if offer is None:
            return []
        action = types.CodeAction(offer[0], types.CodeActionKind.RefactorRewrite)
        if offer[1]:
            action.disabled = types.CodeActionDisabled(offer[1])
        elif _can_resolve(server):
            action.data = {"uri": uri, "line": position.line, "character": position.character}
        else:
            action.edit = await edits(uri, position)
        return [action]

    async def edits(uri: str, position: types.Position) -> types.WorkspaceEdit | None:
        from polarcheck.editor.structure.renumbering import RenumberError
        from polarcheck.editor.workspace_edits import workspace_edit

        def find(document: Document) -> types.WorkspaceEdit | None:
            from polarcheck.editor.structure.renumbering import renumber

            return workspace_edit(server, renumber(document, position, server.documents.workspace(document)))

        try:
            return await server.documents.ask(uri, find, None)
        except RenumberError as error:
            raise JsonRpcException(str(error), _FAILED) from None

    server.rewritings.append(offered)

    @server.feature(types.CODE_ACTION_RESOLVE)
    async def resolve(action: types.CodeAction) -> types.CodeAction:
        if isinstance(action.data, dict) and isinstance(action.data.get("uri"), str):
            position = types.Position(int(action.data["line"]), int(action.data["character"]))
            action.edit = await edits(action.data["uri"], position)
        return action


def _can_resolve(server: Server) -> bool:
    client = server.client_capabilities
    resolved = get_capability(client, "text_document.code_action.resolve_support.properties", ())
    return "edit" in resolved and bool(get_capability(client, "text_document.code_action.data_support"))
