"""Go to definition."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition(params: types.DefinitionParams) -> list[types.Location]:
        def find(analysis: Analysis) -> list[types.Location]:
            from polarcheck.editor.go_to_definition import definition

            return definition(analysis, params.text_document.uri, params.position)

        def find_assignments(document: Document) -> list[types.Location]:
            from polarcheck.editor.structure.reference_search import assignments

            # Variables stand in macro blocks alone; elsewhere the text need not be searched for them.
            if not any(listing.text.blocks.is_macro[block] for listing, block in document.at(params.position)):
                return []
            return assignments(document, params.position, server.documents.workspace(document))

        uri = params.text_document.uri
        assigning: list[types.Location] = await server.documents.ask(uri, find_assignments, [])
        return assigning or await server.ask(uri, find, [], soon=True)
