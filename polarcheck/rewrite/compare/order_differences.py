"""What differs between the orders of two programs."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from difflib import SequenceMatcher

from polarcheck.rewrite.compare.comparison_report import Difference
from polarcheck.rewrite.compare.orders import Step

#: The most orders that are paired, not counting those that are equal at both ends.
_PAIRED = 2000
#: The most differences in a list.
_LISTED = 20
#: How the token begins that says where an order of a golden trace stands.
PLACE = "/"
_M_WORD = re.compile(r"M[0-9.]+$")
#: Words that mean in a block of their own what they mean beside an M word: codes, speeds and tools.
_DIVISIBLE = re.compile(rf"{PLACE}|[GM][0-9.]+$|[ST@]$|[A-Z]+[0-9]*=$")
_Change = tuple[Sequence[Step], Sequence[Step]]


def order_differences(
    before: Sequence[Step],
    after: Sequence[Step],
    tolerance: float,
    moved: Callable[[Step, Step], Difference | None] = lambda *_: None,
) -> list[Difference]:
    """
    Return what differs between orders, sorted by line.

    old_line is None for what is added. tolerance: of values, lengths in mm. moved: returns the difference of two equal
    orders in their positions.
    """
    pairs, changes = aligned(before, after)
    differences = []
    for change in changes:
        pieces = [[piece for step in steps for piece in _pieces(step)] for steps in change]
        if [piece.tokens for piece in pieces[0]] == [piece.tokens for piece in pieces[1]]:
            pairs += zip(*pieces, strict=True)
        else:
            differences.append(_of_change(*change))
    for step, new_step in pairs:
        if not _has_same_values(step, new_step, tolerance):
            differences.append(_of_change([step], [new_step]))
        elif (difference := moved(step, new_step)) is not None:
            differences.append(difference)
    return sorted(differences, key=lambda change: change.old_line or change.new_line or 0)


def listed(differences: list[Difference]) -> list[Difference]:
    """Return the first differences of a long list, and how many more there are."""
    if len(differences) <= _LISTED:
        return differences
    return [*differences[:_LISTED], Difference("order", f"and {len(differences) - _LISTED} other orders")]


def aligned(before: Sequence[Step], after: Sequence[Step]) -> tuple[list[tuple[Step, Step]], list[_Change]]:
    """
    Return the orders of two programs that belong together, and what stands in the place of what, the old ones first.

    Where too many differ, all between the equal ends are one change.
    """
    head = 0
    while head < min(len(before), len(after)) and before[head].tokens == after[head].tokens:
        head += 1
    tail = 0
    while tail < min(len(before), len(after)) - head and before[-1 - tail].tokens == after[-1 - tail].tokens:
        tail += 1
    pairs = [*zip(before[:head], after[:head], strict=True)]
    if tail:
        pairs += zip(before[-tail:], after[-tail:], strict=True)
    removed, added = before[head : len(before) - tail], after[head : len(after) - tail]
    changes: list[_Change] = []
    if max(len(removed), len(added)) > _PAIRED:
        return pairs, [(removed, added)]
    matcher = SequenceMatcher(None, [step.tokens for step in removed], [step.tokens for step in added], autojunk=False)
    for kind, low, high, new_low, new_high in matcher.get_opcodes():
        if kind == "equal":
            pairs += zip(removed[low:high], added[new_low:new_high], strict=True)
        else:
            changes.append((removed[low:high], added[new_low:new_high]))
    return pairs, changes


def _pieces(step: Step) -> list[Step]:
    """
    Return an order as blocks may divide it, each M word behind the other words: `S3000 M13` is `S3000`, `M13`.

    A block with other words, as P beside M133, is one piece.
    """
    codes = [token for token in step.tokens if _M_WORD.match(token)]
    if not codes or not all(_DIVISIBLE.match(token) for token in step.tokens):
        return [step]
    others = tuple(token for token in step.tokens if token not in codes)
    place = others[:1] if others[:1] and others[0][0] == PLACE else ()
    first = [step._replace(tokens=others)] if others != place else []
    return [*first, *(step._replace(tokens=(*place, code), values=(), text=code) for code in codes)]


def _has_same_values(step: Step, new_step: Step, tolerance: float) -> bool:
    """Return True if two orders with the same words have the same values, up to a tolerance."""
    pairs = zip(step.values, new_step.values, strict=True)
    return all(abs(value - after) <= tolerance or (value != value and after != after) for value, after in pairs)


def _of_change(removed: Sequence[Step], added: Sequence[Step]) -> Difference:
    lines = removed[0].line if removed else None, added[0].line if added else None
    if max(len(removed), len(added)) > _LISTED:
        return Difference("order", f"{len(removed)} orders have become {len(added)} others", None, None, "", *lines)
    was, is_now = (", ".join(step.text for step in steps) for steps in (removed, added))
    if not is_now:
        text = f"{was} is missing"
    elif was == is_now:
        text = f"{was} stands between other moves"
    else:
        text = f"{was} has become {is_now}" if was else f"{is_now} is added"
    return Difference("order", text, was or None, is_now or None, "", *lines)
