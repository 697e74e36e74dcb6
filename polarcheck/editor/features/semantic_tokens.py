"""Semantic colors, of a whole document or of the lines that are shown."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.server_session import Server
    from polarcheck.editor.structure.document import Document

#: The answers to which a difference can be asked for.
_MOST_REMEMBERED = 4


def register(server: Server) -> None:
    """Register the feature."""
    from polarcheck.editor.color_names import LEGEND

    answers: OrderedDict[str, list[int]] = OrderedDict()
    count = 0

    def remember(data: list[int]) -> str:
        nonlocal count
        count += 1
        answers[str(count)] = data
        while len(answers) > _MOST_REMEMBERED:
            answers.popitem(last=False)
        return str(count)

    def full(document: Document) -> list[int]:
        from polarcheck.editor.structure import token_colors

        return token_colors.full(document)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND)
    async def semantic_tokens_full(params: types.SemanticTokensParams) -> types.SemanticTokens:
        data: list[int] = await server.documents.ask(params.text_document.uri, full, [])
        return types.SemanticTokens(data, remember(data))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, LEGEND)
    async def semantic_tokens_delta(
        params: types.SemanticTokensDeltaParams,
    ) -> types.SemanticTokens | types.SemanticTokensDelta:
        before = answers.pop(params.previous_result_id, None)
        data: list[int] = await server.documents.ask(params.text_document.uri, full, [])
        number = remember(data)
        if before is None:
            return types.SemanticTokens(data, number)
        from polarcheck.editor.structure import token_colors

        return types.SemanticTokensDelta(token_colors.difference(before, data), number)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, LEGEND)
    async def semantic_tokens_range(params: types.SemanticTokensRangeParams) -> types.SemanticTokens:
        def find(document: Document) -> list[int]:
            from polarcheck.editor.structure import token_colors

            return token_colors.within(document, params.range)

        return types.SemanticTokens(await server.documents.ask(params.text_document.uri, find, []))
