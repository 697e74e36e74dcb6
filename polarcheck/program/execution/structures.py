"""The structures IF .. ELSE .. ENDIF, WHILE, FOR, LOOP, REPEAT .. UNTIL: their heads and ends, by nesting."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Final

import msgspec

from polarcheck.program.execution.kinds import FaultKind
from polarcheck.program.execution.statement import Kind, Statement

#: What closes each structure, and what it closes.
CLOSES: Final = {"ENDIF": "IF", "ENDWHILE": "WHILE", "ENDFOR": "FOR", "ENDLOOP": "LOOP", "UNTIL": "REPEAT"}
_ENDS: Final = {head: end for end, head in CLOSES.items()}


class StructureFault(msgspec.Struct, frozen=True):
    """
    A structure that does not close, or an end without its head.

    keyword: the keyword at the block.
    missing: the keyword that should match it.
    """

    kind: FaultKind
    block: int
    keyword: str
    missing: str


class Structures(msgspec.Struct):
    """
    The structures of one program, by their blocks.

    end: head or ELSE -> last statement of the structure.
    head: last statement -> head.
    other: IF -> its ELSE.
    """

    end: dict[int, int] = {}
    head: dict[int, int] = {}
    other: dict[int, int] = {}
    faults: list[StructureFault] = []


def find_structures(statements: Sequence[tuple[int, Statement]]) -> Structures:
    """Pair the heads and ends among the statements of a program, which come with their blocks, in order."""
    structures = Structures()
    open_heads: list[tuple[str, int]] = []
    open_of: Counter[str] = Counter()
    for block, statement in statements:
        for part in (statement, *statement.more):
            if part.kind is not Kind.STRUCTURE:
                continue
            keyword = part.structure
            if keyword in _ENDS:
                open_heads.append((keyword, block))
                open_of[keyword] += 1
                continue
            opening = "IF" if keyword == "ELSE" else CLOSES[keyword]
            if not open_of[opening]:
                structures.faults.append(StructureFault("end-without-structure", block, keyword, opening))
                continue
            while open_heads[-1][0] != opening:
                head, opened = open_heads.pop()
                open_of[head] -= 1
                structures.faults.append(StructureFault("structure-without-end", opened, head, _ENDS[head]))
            _, opened = open_heads[-1]
            if keyword == "ELSE":
                structures.other[opened] = block
                continue
            open_heads.pop()
            open_of[opening] -= 1
            structures.end[opened], structures.head[block] = block, opened
            if opened in structures.other:
                structures.end[structures.other[opened]] = block
    for head, opened in open_heads:
        structures.faults.append(StructureFault("structure-without-end", opened, head, _ENDS[head]))
    return structures
