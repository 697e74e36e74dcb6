"""Which END belongs to which DO."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from polarcheck.execution.kinds import FaultKind
from polarcheck.execution.statement import Kind, Statement


class LoopFault(NamedTuple):
    """
    A loop that does not close, or crosses another.

    number: of its DO or END; other: of the loop that it lies in or crosses, 0 where there is none. levels: how many
    loops the control takes inside each other.
    """

    kind: FaultKind
    block: int
    number: int
    other: int
    levels: int


@dataclass(slots=True)
class Loops:
    """The loops of one program. end: block of the END of each WHILE or DO; head: the reverse."""

    end: dict[int, int] = field(default_factory=dict)
    head: dict[int, int] = field(default_factory=dict)
    faults: list[LoopFault] = field(default_factory=list)


def find_loops(statements: Sequence[tuple[int, Statement]], levels: int) -> Loops:
    """
    Pair the DO and END statements of a program, given with their blocks in order.

    Source: B-62754EN/01, chapter 16 (the same number may be used again, loops may not cross, three deep); alarm 124.
    """
    loops = Loops()
    open_loops: list[tuple[int, int]] = []

    def wrong(kind: FaultKind, block: int, number: int, other: int = 0) -> None:
        loops.faults.append(LoopFault(kind, block, number, other, levels))

    for block, statement in statements:
        if statement.loop is None:
            continue
        number = statement.loop.value
        if statement.kind in (Kind.WHILE_DO, Kind.DO):
            if any(number == other for other, _ in open_loops):
                wrong("loop-inside-itself", block, number, number)
            elif len(open_loops) >= levels:
                wrong("loop-levels", block, number)
            open_loops.append((number, block))
        elif statement.kind is Kind.END:
            if not any(number == other for other, _ in open_loops):
                wrong("end-without-loop", block, number)
                continue
            while open_loops[-1][0] != number:
                other, at = open_loops.pop()
                wrong("loops-crossed", at, other, number)
            _, at = open_loops.pop()
            loops.end[at] = block
            loops.head[block] = at
    for number, at in open_loops:
        wrong("loop-without-end", at, number)
    return loops
