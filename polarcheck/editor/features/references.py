"""References and highlights of what stands under the cursor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document


def register(server: Server) -> None:
    """Register the features."""

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def references(params: types.ReferenceParams) -> list[types.Location]:
        def find(document: Document) -> list[types.Location]:
            from polarcheck.editor.structure.reference_search import references

            workspace = server.documents.workspace(document)
            declared = params.context.include_declaration
            return references(document, params.position, workspace, with_declaration=declared)

        return await server.documents.ask(params.text_document.uri, find, [])

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    async def document_highlight(params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        def find(document: Document) -> list[types.DocumentHighlight]:
            from polarcheck.editor.structure.reference_search import highlights

            return highlights(document, params.position)

        return await server.documents.ask(params.text_document.uri, find, [])
