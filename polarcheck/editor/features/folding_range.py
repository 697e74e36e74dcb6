"""Folding of programs, tools, polar sections, loops and comments."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    async def folding_range(params: types.FoldingRangeParams) -> list[types.FoldingRange]:
        def find(document: Document) -> list[types.FoldingRange]:
            from polarcheck.editor.structure.folding import folding_ranges

            of_text = server.client_capabilities.text_document
            of_folding = of_text.folding_range if of_text is not None else None
            return folding_ranges(document, of_folding.range_limit if of_folding is not None else None)

        return await server.documents.ask(params.text_document.uri, find, [])
