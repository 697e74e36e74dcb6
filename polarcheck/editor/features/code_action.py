"""Code actions: fixes and allow comments of findings, and rewritings that need no check."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis
    from polarcheck.editor.server_session import Server


#: What the findings of a check offer, and what needs no check.
_FIXES, _REWRITES = types.CodeActionKind.QuickFix, types.CodeActionKind.RefactorRewrite


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(
        types.TEXT_DOCUMENT_CODE_ACTION,
        types.CodeActionOptions(code_action_kinds=[_FIXES, _REWRITES], resolve_provider=True),
    )
    async def code_action(params: types.CodeActionParams) -> list[types.CodeAction]:
        rewrites = _is_wanted(_REWRITES, params.context.only)
        rewritten = [action for offered in server.rewritings if rewrites for action in await offered(params)]
        if not _is_wanted(_FIXES, params.context.only):
            return rewritten
        uri = params.text_document.uri
        buffer = server.buffers.open.get(uri)
        version = buffer.version if buffer is not None else None

        def find(analysis: Analysis) -> list[types.CodeAction]:
            from polarcheck.editor.actions import actions
            from polarcheck.editor.workspace_edits import names_versions

            return actions(analysis, uri, version, params.range, names_versions(server))

        none: list[types.CodeAction] = []
        return [*await server.ask(uri, find, none, soon=True), *rewritten]


def _is_wanted(kind: types.CodeActionKind, only: Iterable[types.CodeActionKind | str] | None) -> bool:
    """Return True if the editor asks for this kind: `source` means `source.fixAll`, too."""
    values = [
        str(requested.value) if isinstance(requested, types.CodeActionKind) else requested for requested in only or ()
    ]
    return not values or any(f"{kind.value}.".startswith(f"{value}.") or not value for value in values)
