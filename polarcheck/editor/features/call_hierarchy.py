"""Which programs call a program, and which it calls."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document


def register(server: Server) -> None:
    """Register the features."""

    @server.feature(types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY)
    async def prepare_call_hierarchy(params: types.CallHierarchyPrepareParams) -> list[types.CallHierarchyItem]:
        def find(document: Document) -> list[types.CallHierarchyItem]:
            from polarcheck.editor.structure.call_tree import prepare

            return prepare(document, params.position, server.documents.workspace(document))

        return await server.documents.ask(params.text_document.uri, find, [])

    @server.feature(types.CALL_HIERARCHY_INCOMING_CALLS)
    async def incoming_calls(
        params: types.CallHierarchyIncomingCallsParams,
    ) -> list[types.CallHierarchyIncomingCall]:
        def find(document: Document) -> list[types.CallHierarchyIncomingCall]:
            from polarcheck.editor.structure.call_tree import incoming

            return incoming(document, params.item.data, server.documents.workspace(document))

        return await server.documents.ask_of_any(params.item.uri, find, [])

    @server.feature(types.CALL_HIERARCHY_OUTGOING_CALLS)
    async def outgoing_calls(
        params: types.CallHierarchyOutgoingCallsParams,
    ) -> list[types.CallHierarchyOutgoingCall]:
        def find(document: Document) -> list[types.CallHierarchyOutgoingCall]:
            from polarcheck.editor.structure.call_tree import outgoing

            return outgoing(document, params.item.data, server.documents.workspace(document))

        return await server.documents.ask_of_any(params.item.uri, find, [])
