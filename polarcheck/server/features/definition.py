"""Go to definition."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.server.judged import Judged
    from polarcheck.server.session import Server


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition(params: types.DefinitionParams) -> list[types.Location]:
        def find(judged: Judged) -> list[types.Location]:
            from polarcheck.server.definition import definition

            return definition(judged, params.text_document.uri, params.position)

        return await server.ask(params.text_document.uri, find, [], soon=True)
