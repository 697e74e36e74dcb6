"""The call hierarchy: which programs call a program, and which it calls, over files."""

from __future__ import annotations

from typing import Any

from lsprotocol import types

from polarcheck.editor.structure import block_ranges
from polarcheck.editor.structure.document import Document
from polarcheck.editor.structure.mention import Kind, Mention, Role
from polarcheck.editor.structure.uses import Owner, Use, Uses, called_name
from polarcheck.editor.structure.workspace import Workspace
from polarcheck.program.reading.excerpt import visible

#: The most programs of an answer.
_MOST = 500


def prepare(document: Document, position: types.Position, workspace: Workspace) -> list[types.CallHierarchyItem]:
    """Return the program that is named at a position, else the one that stands there."""
    uses = Uses(document, workspace)
    use = uses.at(document.text.character_of(position))
    if use is not None and use.mention.kind is Kind.PROGRAM and use.mention.role is Role.REFERS:
        return [_item(owner) for owner in uses.resolved(use.owner, called_name(use.mention))][:_MOST]
    return [_item(owner) for owner in uses.owners_at(position)[:1]]


def incoming(document: Document, item: Any, workspace: Workspace) -> list[types.CallHierarchyIncomingCall]:
    """Return the programs that call the program of an item; item: its data."""
    uses = Uses(document, workspace)
    owner = _owner(uses, document, item)
    if owner is None:
        return []
    return [
        types.CallHierarchyIncomingCall(_item(uses_of[0].owner), [_range(use.owner, use.mention) for use in uses_of])
        for uses_of in _grouped(uses.calls_of([owner]))[:_MOST]
    ]


def outgoing(document: Document, item: Any, workspace: Workspace) -> list[types.CallHierarchyOutgoingCall]:
    """Return the programs that the program of an item calls."""
    uses = Uses(document, workspace)
    owner = _owner(uses, document, item)
    if owner is None:
        return []
    uses_called = [
        Use(called, mention) for mention in owner.calls for called in uses.resolved(owner, called_name(mention))
    ]
    return [
        types.CallHierarchyOutgoingCall(_item(uses_of[0].owner), [_range(owner, use.mention) for use in uses_of])
        for uses_of in _grouped(uses_called)[:_MOST]
    ]


def _grouped(uses_listed: list[Use]) -> list[list[Use]]:
    """Return mentions by their program, in order."""
    groups: dict[tuple[str, str, int], list[Use]] = {}
    for use in uses_listed:
        groups.setdefault(use.owner.key, []).append(use)
    return list(groups.values())


def _range(owner: Owner, mention: Mention) -> types.Range:
    return owner.document.range(mention.begin, mention.end)


def _item(owner: Owner) -> types.CallHierarchyItem:
    program, blocks = owner.program, owner.mentions.listing.text.blocks
    number, name = program.number, program.name or owner.document.path.name
    last = block_ranges.last_written(owner.mentions.listing, program)
    begin, end = int(blocks.start[program.first]), int(blocks.end[last])
    return types.CallHierarchyItem(
        name=f"O{number:04d}" if number is not None else visible(name),
        kind=types.SymbolKind.Function,
        uri=owner.document.uri,
        range=owner.document.range(begin, end),
        selection_range=owner.document.range(begin, min(int(blocks.end[program.first]), end)),
        detail=visible(owner.document.path.name),
        data=[owner.mentions.listing.text.source.channel, program.first],
    )


def _owner(uses: Uses, document: Document, item: Any) -> Owner | None:
    """Return the program of an item; None if the document has changed meanwhile."""
    return next((owner for owner in uses.owners(document) if list(owner.key[1:]) == item), None)
