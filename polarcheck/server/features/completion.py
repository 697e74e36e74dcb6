"""Completion of what is being typed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.server.session import Server


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(
        types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=[" "], resolve_provider=True)
    )
    async def completion(params: types.CompletionParams) -> list[types.CompletionItem]:
        from polarcheck.server.allowing import completions

        # Completion uses the text alone, since no check finishes while somebody types.
        buffer = server.buffers.open.get(params.text_document.uri)
        if buffer is None:
            return []
        return await server.buffers.worker.do(completions, buffer.text, params.position, buffer.judged)

    @server.feature(types.COMPLETION_ITEM_RESOLVE)
    async def resolve(item: types.CompletionItem) -> types.CompletionItem:
        from polarcheck.server.allowing import with_page

        return await server.buffers.worker.do(with_page, item, True)
