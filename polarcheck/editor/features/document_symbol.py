"""The outline of a document."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def document_symbol(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        # The details of polar sections are those of the report.
        analysis = await server.buffers.judged(params.text_document.uri)
        sections = analysis.report.polar_sections if analysis is not None and analysis.report is not None else ()

        def find(document: Document) -> list[types.DocumentSymbol]:
            from polarcheck.editor.structure.symbols import symbols

            return symbols(document, sections)

        return await server.documents.ask(params.text_document.uri, find, [])
