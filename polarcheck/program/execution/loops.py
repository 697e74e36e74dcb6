"""The loops of custom macro: pairs of DO and END."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from polarcheck.program.execution.kinds import FaultKind
from polarcheck.program.execution.statement import Kind, Statement


class LoopFault(msgspec.Struct, frozen=True):
    """
    A loop that does not close, or crosses another.

    number: of its DO or END.
    other: number of the loop that it lies in or crosses; 0 for none.
    levels: how deep the control can nest loops.
    """

    kind: FaultKind
    block: int
    number: int
    other: int
    levels: int


class Loops(msgspec.Struct):
    """
    The loops of one program, by their blocks.

    end: block of WHILE or DO -> block of its END.
    head: block of END -> block of its WHILE or DO.
    """

    end: dict[int, int] = {}
    head: dict[int, int] = {}
    faults: list[LoopFault] = []


def find_loops(statements: Sequence[tuple[int, Statement]], levels: int) -> Loops:
    """
    Pair the DO and END statements of a program, given with their blocks in order.

    Source: B-62754EN/01, chapter 16 (the same number may be used again, loops may not cross, three deep); alarm 124.
    """
    loops = Loops()
    open_loops: list[tuple[int, int]] = []

    def wrong(kind: FaultKind, block: int, number: int, rival: int = 0) -> None:
        loops.faults.append(LoopFault(kind, block, number, rival, levels))

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
