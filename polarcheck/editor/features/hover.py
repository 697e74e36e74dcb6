"""Hover: manual pages of findings, words, and the state of the control."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis
    from polarcheck.editor.server_session import Server


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def hover(params: types.HoverParams) -> types.Hover | None:
        def find(analysis: Analysis) -> types.Hover | None:
            from polarcheck.editor.hover_text import hover

            of_text = server.client_capabilities.text_document
            formats = of_text.hover.content_format if of_text is not None and of_text.hover is not None else None
            return hover(analysis, params.position, server.prefers_markdown(formats))

        return await server.ask(params.text_document.uri, find, None, soon=True)
