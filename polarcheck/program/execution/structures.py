"""The loops of custom macro, DO and END, and the structures IF .. ELSE .. ENDIF, WHILE, FOR, LOOP, REPEAT .. UNTIL."""

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
    A loop or structure that does not close or crosses another, or an end without its head.

    values: for the message. Of a loop: number, of its DO or END; other, that of the loop that it lies in or crosses, 0
    for none; levels, how deep the control can nest loops. Of a structure: keyword, at the block, and missing, the one
    that should match it.
    """

    kind: FaultKind
    block: int
    values: dict[str, str | int]


class Structures(msgspec.Struct):
    """
    The loops, or the structures, of one program, by their blocks.

    end: head or ELSE -> last statement of the structure.
    head: last statement -> head.
    other: IF -> its ELSE.
    """

    end: dict[int, int] = {}
    head: dict[int, int] = {}
    other: dict[int, int] = {}
    faults: list[StructureFault] = []

    def wrong(self, kind: FaultKind, block: int, **values: str | int) -> None:
        """Record a fault."""
        self.faults.append(StructureFault(kind, block, values))


def find_loops(statements: Sequence[tuple[int, Statement]], levels: int) -> Structures:
    """
    Pair the DO and END statements of a program, given with their blocks in order; levels: as in StructureFault.

    Source: B-62754EN/01, chapter 16 (the same number may be used again, loops may not cross, three deep); alarm 124.
    """
    loops = Structures()
    open_loops: list[tuple[int, int]] = []

    def wrong(kind: FaultKind, block: int, number: int, rival: int = 0) -> None:
        loops.wrong(kind, block, number=number, other=rival, levels=levels)

    for block, statement in statements:
        if statement.loop is None:
            continue
        number = statement.loop.value
        if statement.kind in (Kind.WHILE_DO, Kind.DO):
            if any(number == open_number for open_number, _ in open_loops):
                wrong("loop-inside-itself", block, number, number)
            elif len(open_loops) >= levels:
                wrong("loop-levels", block, number)
            open_loops.append((number, block))
        elif statement.kind is Kind.END:
            if not any(number == open_number for open_number, _ in open_loops):
                wrong("end-without-loop", block, number)
                continue
            while open_loops[-1][0] != number:
                open_number, head = open_loops.pop()
                wrong("loops-crossed", head, open_number, number)
            _, head = open_loops.pop()
            loops.end[head] = block
            loops.head[block] = head
    for number, head in open_loops:
        wrong("loop-without-end", head, number)
    return loops


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
                structures.wrong("end-without-structure", block, keyword=keyword, missing=opening)
                continue
            while open_heads[-1][0] != opening:
                head, opened = open_heads.pop()
                open_of[head] -= 1
                structures.wrong("structure-without-end", opened, keyword=head, missing=_ENDS[head])
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
        structures.wrong("structure-without-end", opened, keyword=head, missing=_ENDS[head])
    return structures
