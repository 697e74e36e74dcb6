"""Find references, highlights in the document, and where a name is defined."""

from __future__ import annotations

from collections.abc import Iterable

from lsprotocol import types

from polarcheck.editor.structure.document import Document
from polarcheck.editor.structure.mention import Kind, Role
from polarcheck.editor.structure.uses import Use, Uses
from polarcheck.editor.structure.workspace import Workspace

#: The most places of an answer.
_MOST = 5_000


def references(
    document: Document, position: types.Position, workspace: Workspace, with_declaration: bool
) -> list[types.Location]:
    """Return all places that name what stands at a position, in this document and the files around it."""
    uses = Uses(document, workspace)
    use = uses.at(document.text.character_of(position))
    if use is None:
        return []
    same = uses.same(use)
    return [location(user) for user in same if with_declaration or user.mention.role is not Role.DEFINES][:_MOST]


def assignments(document: Document, position: types.Position, workspace: Workspace) -> list[types.Location]:
    """Return where the variable at a position takes a value."""
    uses = Uses(document, workspace)
    use = uses.at(document.text.character_of(position))
    if use is None or use.mention.kind is not Kind.VARIABLE:
        return []
    return [location(user) for user in uses.same(use) if user.mention.role is Role.ASSIGNS][:_MOST]


def highlights(document: Document, position: types.Position) -> list[types.DocumentHighlight]:
    """Return the places in the document that name what stands at a position; no other file is opened for them."""
    uses = Uses(document, Workspace(document, (), (), lambda _: (document.machine, ())))
    use = uses.at(document.text.character_of(position))
    if use is None:
        return []
    return [
        types.DocumentHighlight(location(user).range, _highlight(user))
        for user in uses.same(use)[:_MOST]
        if user.owner.document is document
    ]


def _highlight(use: Use) -> types.DocumentHighlightKind:
    if use.mention.kind is not Kind.VARIABLE:
        return types.DocumentHighlightKind.Text
    is_assigned = use.mention.role is Role.ASSIGNS
    return types.DocumentHighlightKind.Write if is_assigned else types.DocumentHighlightKind.Read


def location(use: Use) -> types.Location:
    """Return the place of a mention."""
    return use.owner.document.location(use.mention.start, use.mention.end)


def by_document(uses: Iterable[Use]) -> dict[str, list[Use]]:
    """Return mentions by the URI of their document."""
    uses_by_uri: dict[str, list[Use]] = {}
    for use in uses:
        uses_by_uri.setdefault(use.owner.document.uri, []).append(use)
    return uses_by_uri
