"""Formatting of a document, or of lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document


def register(server: Server) -> None:
    """Register the features."""

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    async def formatting(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        def find(document: Document) -> list[types.TextEdit]:
            from polarcheck.editor.structure.spacing import formatted

            return formatted(document)

        return await server.documents.ask(params.text_document.uri, find, [])

    @server.feature(types.TEXT_DOCUMENT_RANGE_FORMATTING)
    async def range_formatting(params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
        def find(document: Document) -> list[types.TextEdit]:
            from polarcheck.editor.structure.spacing import formatted

            return formatted(document, params.range)

        return await server.documents.ask(params.text_document.uri, find, [])
