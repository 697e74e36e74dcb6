"""IF .. ELSE .. ENDIF, WHILE, FOR, LOOP, REPEAT .. UNTIL: which statements belong together, by their nesting."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from polarcheck.execution.kinds import FaultKind
from polarcheck.execution.statement import Kind, Statement

#: What closes each structure, and what it closes.
CLOSES: Final = {"ENDIF": "IF", "ENDWHILE": "WHILE", "ENDFOR": "FOR", "ENDLOOP": "LOOP", "UNTIL": "REPEAT"}
_ENDS: Final = {head: end for end, head in CLOSES.items()}


class StructureFault(NamedTuple):
    """A structure that does not close, or an end without its head; missing: the keyword that it lacks."""

    kind: FaultKind
    block: int
    keyword: str
    missing: str


@dataclass(slots=True)
class Structures:
    """
    The structures of one program, by their blocks.

    end: of the last statement of each head, and of each ELSE. head: the reverse, without ELSE. other: of the ELSE of
    each IF.
    """

    end: dict[int, int] = field(default_factory=dict)
    head: dict[int, int] = field(default_factory=dict)
    other: dict[int, int] = field(default_factory=dict)
    faults: list[StructureFault] = field(default_factory=list)


def find_structures(statements: Sequence[tuple[int, Statement]]) -> Structures:
    """Pair the heads and ends of a program, given with their blocks in order; where an end is missing, that is all."""
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
            wanted = "IF" if keyword == "ELSE" else CLOSES[keyword]
            if not open_of[wanted]:
                structures.faults.append(StructureFault("end-without-structure", block, keyword, wanted))
                continue
            while open_heads[-1][0] != wanted:
                head, at = open_heads.pop()
                open_of[head] -= 1
                structures.faults.append(StructureFault("structure-without-end", at, head, _ENDS[head]))
            _, at = open_heads[-1]
            if keyword == "ELSE":
                structures.other[at] = block
                continue
            open_heads.pop()
            open_of[wanted] -= 1
            structures.end[at], structures.head[block] = block, at
            if at in structures.other:
                structures.end[structures.other[at]] = block
    for head, at in open_heads:
        structures.faults.append(StructureFault("structure-without-end", at, head, _ENDS[head]))
    return structures
