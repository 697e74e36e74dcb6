"""Hints at the ends of blocks, and the setting of the editor that says which."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any

from lsprotocol import types
from pygls.capabilities import get_capability

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis
    from polarcheck.editor.buffers import Buffer
    from polarcheck.editor.server_session import Server

#: The section of the editor's settings, and the key in it.
_SECTION, _KEY = "polarcheck", "inlayHints"
_OFF = "off"


def register(server: Server) -> None:
    """Register the feature."""
    chosen = _OFF

    def choose(settings: Any) -> bool:
        """Take the setting of the editor, if it is there; return True if it has changed."""
        nonlocal chosen
        value = settings.get(_KEY) if isinstance(settings, dict) else None
        before = chosen
        chosen = value if isinstance(value, str) else chosen
        return chosen != before

    async def configure(settings: Any = None) -> None:
        """Take the settings that the editor has sent, or ask it for them."""
        section = settings.get(_SECTION) if isinstance(settings, dict) else None
        if section is None and get_capability(server.client_capabilities, "workspace.configuration"):
            request = types.ConfigurationParams([types.ConfigurationItem(section=_SECTION)])
            with contextlib.suppress(Exception):  # an editor that does not answer has no settings
                section = next(iter(await server.workspace_configuration_async(request)), None)
        if choose(section):
            refresh()

    def refresh() -> None:
        if get_capability(server.client_capabilities, "workspace.inlay_hint.refresh_support"):
            server.workspace_inlay_hint_refresh(None)

    def published(buffer: Buffer, analysis: Analysis) -> None:
        if chosen != _OFF:
            refresh()

    server.published.append(published)
    server.configured.append(configure)
    server.options.append(choose)

    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT)
    async def inlay_hint(params: types.InlayHintParams) -> list[types.InlayHint]:
        def find(analysis: Analysis) -> list[types.InlayHint]:
            from polarcheck.editor.inlay_hints import inlay_hints

            return inlay_hints(analysis, params.range, chosen)

        return [] if chosen == _OFF else await server.ask(params.text_document.uri, find, [])
