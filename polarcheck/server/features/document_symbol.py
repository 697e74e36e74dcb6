"""The outline of a document."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.server.judged import Judged
    from polarcheck.server.session import Server


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def document_symbol(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        def find(judged: Judged) -> list[types.DocumentSymbol]:
            from polarcheck.server.outline import symbols

            return symbols(judged)

        return await server.ask(params.text_document.uri, find, [])
