"""
Renumber the N numbers of a program, with all that leads to them: GOTO, M99 P, G71 P Q, in other files, too.

What is computed, or can mean several blocks, is refused with the reason.
"""

from __future__ import annotations

from collections import Counter

from lsprotocol import types

from polarcheck.editor.structure.document import Document
from polarcheck.editor.structure.mention import Into, Kind, Mention, Role
from polarcheck.editor.structure.reference_search import by_document
from polarcheck.editor.structure.uses import Owner, Use, Uses
from polarcheck.editor.structure.workspace import Workspace
from polarcheck.foundation.errors import PolarcheckError

#: The steps between numbers, the largest that fits; and the largest number if none has more digits.
_STEPS, _LARGEST, _LARGER = (10, 5, 2, 1), 9_999, 99_999


class RenumberError(PolarcheckError):
    """Why a program cannot be renumbered, in one line."""


def title(document: Document, position: types.Position) -> tuple[str, str] | None:
    """
    Return the title of the action for the program at a position, and why it is refused, or "".

    None for a program without N numbers, or with even ones. No other file is opened.
    """
    owner = _owner_at(Uses(document, _alone(document)), position)
    if owner is None or document.cached(f"even {owner.key}", lambda: _is_even(owner)):
        return None
    reason = document.cached(f"renumber {owner.key}", lambda: _reason(owner))
    program = owner.program
    name = f"O{program.number:04d}" if program.number is not None else program.name or "the program"
    return f"Renumber the N numbers of {name}", reason


def _is_even(owner: Owner) -> bool:
    """Return True if the numbers of a program are those that it would get."""
    numbers = _numbers(owner)
    return numbers == [index * _STEPS[0] for index in range(1, len(numbers) + 1)]


def _reason(owner: Owner) -> str:
    try:
        _check(owner, _new_numbers(owner))
    except RenumberError as error:
        return str(error)
    return ""


def renumber(document: Document, position: types.Position, workspace: Workspace) -> dict[str, list[types.TextEdit]]:
    """Return the edits by the URI of their document. Raises RenumberError."""
    uses = Uses(document, workspace)
    owner = _owner_at(uses, position)
    if owner is None:
        return {}
    new = _new_numbers(owner)
    _check(owner, new)
    leading = [Use(owner, mention) for mention in owner.all if _leads_inside(mention.kind, mention.into)]
    leading += _from_others(uses, owner)
    if not workspace.is_complete:
        raise RenumberError("not all files of the workspace could be looked at: open a smaller folder")
    width = _width(owner)
    edits: dict[str, list[types.TextEdit]] = {}
    for uri, of_document in by_document({user.key: user for user in leading}.values()).items():
        for user in of_document:
            number = new.get(_number(user))
            written = user.mention.written
            text = f"{number:0{width if written.startswith('0') else 0}d}" if number is not None else written
            if text != written:
                range_of_use = user.owner.document.range(user.mention.start, user.mention.end)
                edits.setdefault(uri, []).append(types.TextEdit(range_of_use, text))
    return edits


def _alone(document: Document) -> Workspace:
    return Workspace(document, (), (), lambda _: (document.machine, ()))


def _owner_at(uses: Uses, position: types.Position) -> Owner | None:
    """Return the program at a position; of several channels the first that has N numbers there."""
    return next((owner for owner in uses.owners_at(position) if _numbers(owner)), None)


def _heads(owner: Owner) -> list[Mention]:
    """Return the N numbers at the blocks of a program, in order."""
    return [head for head in owner.all if head.kind is Kind.SEQUENCE and head.role is Role.DEFINES]


def _numbers(owner: Owner) -> list[int]:
    return [int(head.name) for head in _heads(owner)]


def _leads_inside(kind: Kind, into: Into) -> bool:
    return kind is Kind.SEQUENCE and into is Into.OWN


def _number(use: Use) -> int:
    return int(use.mention.name)


def _new_numbers(owner: Owner) -> dict[int, int]:
    """Return the new number of each old one; of the same number at several blocks that of the last."""
    numbers = _numbers(owner)
    largest = _LARGER if max(numbers) > _LARGEST else _LARGEST
    step = next((step for step in _STEPS if len(numbers) * step <= largest), None)
    if step is None:
        raise RenumberError(f"it has {len(numbers)} N numbers, and the largest possible is {largest}")
    return {number: index * step for index, number in enumerate(numbers, 1)}


def _width(owner: Owner) -> int:
    """Return the digits of numbers with zeros before them."""
    return max((len(head.written) for head in _heads(owner) if head.written.startswith("0")), default=0)


def _line(owner: Owner, block: int) -> str:
    return f"line {int(owner.mentions.listing.text.blocks.line[block])}"


def _check(owner: Owner, new: dict[int, int]) -> None:
    """Refuse what is not known: computed numbers, numbers of several blocks, numbers of no block."""
    for computed in owner.mentions.computed:
        inside = owner.program.first <= computed.block < owner.program.end
        if computed.kind is Kind.SEQUENCE and computed.into is Into.OWN and inside:
            raise RenumberError(f"{_line(owner, computed.block)} computes the number that it goes to")
    counts = Counter(_numbers(owner))
    for mention in owner.all:
        if mention.kind is not Kind.SEQUENCE or mention.role is not Role.REFERS or mention.into is not Into.OWN:
            continue
        if counts[int(mention.name)] > 1:
            raise RenumberError(
                f"{_line(owner, mention.block)} goes to {mention.shown}, which {counts[int(mention.name)]} blocks have"
            )
        if int(mention.name) not in new:
            raise RenumberError(f"{_line(owner, mention.block)} goes to {mention.shown}, which no block has")


def _from_others(uses: Uses, owner: Owner) -> list[Use]:
    """Return what leads into a program from those that it calls and from those that call it."""
    numbers = set(_numbers(owner))
    counts = Counter(_numbers(owner))
    leading = []
    callees, callers = uses.callees(owner), uses.callers(owner)
    for owners, into in ((callees if callers else [*callees, owner], Into.CALLER), (callers, Into.CALLED)):
        for caller in owners:
            for computed in caller.mentions.computed:
                inside = caller.program.first <= computed.block < caller.program.end
                if computed.kind is Kind.SEQUENCE and computed.into is into and inside:
                    location = f"{_line(caller, computed.block)} of {caller.document.path.name}"
                    raise RenumberError(f"{location} computes the number that it goes to")
            for mention in caller.all:
                if mention.kind is not Kind.SEQUENCE or mention.into is not into or int(mention.name) not in numbers:
                    continue
                use = Use(caller, mention)
                targets = {target.key for target in uses.targets(use)}
                if owner.key not in targets:
                    continue
                location = f"{_line(caller, mention.block)} of {caller.document.path.name}"
                if len(targets) > 1:
                    raise RenumberError(f"{location} means {mention.shown} of other programs, too")
                if counts[int(mention.name)] > 1:
                    raise RenumberError(
                        f"{location} goes to {mention.shown}, which {counts[int(mention.name)]} blocks have"
                    )
                leading.append(use)
    return leading
