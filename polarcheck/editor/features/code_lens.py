"""Code lenses: a line above each polar section."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.capabilities import get_capability

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis
    from polarcheck.editor.buffers import Buffer
    from polarcheck.editor.server_session import Server


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(types.TEXT_DOCUMENT_CODE_LENS, types.CodeLensOptions())
    async def code_lens(params: types.CodeLensParams) -> list[types.CodeLens]:
        def find(analysis: Analysis) -> list[types.CodeLens]:
            from polarcheck.editor.section_lenses import code_lenses

            return code_lenses(analysis)

        return await server.ask(params.text_document.uri, find, [])

    def refresh(buffer: Buffer, analysis: Analysis) -> None:
        if get_capability(server.client_capabilities, "workspace.code_lens.refresh_support"):
            server.workspace_code_lens_refresh(None)

    server.published.append(refresh)
