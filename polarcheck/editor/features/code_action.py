"""Code actions: a function for each kind of them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.editor.analysis import Analysis
    from polarcheck.editor.server_session import Server


def _quick_fixes(
    analysis: Analysis, uri: str, version: int | None, selected: types.Range, with_versions: bool
) -> list[types.CodeAction]:
    from polarcheck.editor.actions import actions

    return actions(analysis, uri, version, selected, with_versions)


#: Each takes the result of a check, the document with its version, a selection, and True if edits may name a version.
_FUNCTIONS = ((types.CodeActionKind.QuickFix, _quick_fixes),)

#: The kind of those that need no check.
_REWRITES = types.CodeActionKind.RefactorRewrite


def register(server: Server) -> None:
    """Register the feature."""

    @server.feature(
        types.TEXT_DOCUMENT_CODE_ACTION,
        types.CodeActionOptions(
            code_action_kinds=[*(kind for kind, _ in _FUNCTIONS), _REWRITES], resolve_provider=True
        ),
    )
    async def code_action(params: types.CodeActionParams) -> list[types.CodeAction]:
        functions = [function for kind, function in _FUNCTIONS if _is_wanted(kind, params.context.only)]
        rewrites = _is_wanted(_REWRITES, params.context.only)
        rewritten = [action for offered in server.rewritings if rewrites for action in await offered(params)]
        if not functions:
            return rewritten
        uri = params.text_document.uri
        buffer = server.buffers.open.get(uri)
        version = buffer.version if buffer is not None else None

        def find(analysis: Analysis) -> list[types.CodeAction]:
            of_workspace = server.client_capabilities.workspace
            edits = of_workspace.workspace_edit if of_workspace is not None else None
            with_versions = bool(edits is not None and edits.document_changes)
            return [
                action
                for function in functions
                for action in function(analysis, uri, version, params.range, with_versions)
            ]

        none: list[types.CodeAction] = []
        return [*await server.ask(uri, find, none, soon=True), *rewritten]


def _is_wanted(kind: types.CodeActionKind, only: Iterable[types.CodeActionKind | str] | None) -> bool:
    """Return True if the editor asks for this kind: `source` means `source.fixAll`, too."""
    values = [
        str(requested.value) if isinstance(requested, types.CodeActionKind) else requested for requested in only or ()
    ]
    return not values or any(f"{kind.value}.".startswith(f"{value}.") or not value for value in values)
