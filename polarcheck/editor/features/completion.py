"""Completion of what is being typed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document

#: A blank continues an allow comment; the others begin a word that has a list.
_TRIGGERS = (" ", "#", "G", "M", "T", "P", "Q", ".")


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(
        types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=_TRIGGERS, resolve_provider=True)
    )
    async def completion(params: types.CompletionParams) -> types.CompletionList | list[types.CompletionItem]:
        from polarcheck.editor.allowing import completions as allowing

        # Completion uses the text alone, since no check finishes while somebody types.
        uri = params.text_document.uri
        buffer = server.buffers.open.get(uri)
        if buffer is None:
            return []
        settings = buffer.settings

        def find(document: Document) -> types.CompletionList | list[types.CompletionItem]:
            from polarcheck.editor.words.completions import completions

            in_comment = allowing(document.text, params.position, buffer.judged)
            return in_comment or completions(document, settings, params.position)

        return await server.documents.ask(uri, find, [])

    @server.feature(types.COMPLETION_ITEM_RESOLVE)
    async def resolve(item: types.CompletionItem) -> types.CompletionItem:
        from polarcheck.editor.allowing import with_page

        return await server.buffers.worker.do(with_page, item, True)
