"""Which END belongs to which DO."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from polarcheck.execution.statement import Kind, Statement


@dataclass(slots=True)
class Loops:
    """
    The loops of one program. end: block of the END of each WHILE or DO; head: the reverse.

    faults: (rule, block, what is wrong) of loops that do not close or cross.
    """

    end: dict[int, int] = field(default_factory=dict)
    head: dict[int, int] = field(default_factory=dict)
    faults: list[tuple[str, int, str]] = field(default_factory=list)


def find_loops(statements: Sequence[tuple[int, Statement]], levels: int = 3) -> Loops:
    """
    Pair the DO and END statements of a program, given with their blocks in order.

    Source: B-62754EN/01, chapter 16 (the same number may be used again, loops may not cross, three deep); alarm 124.
    """
    loops = Loops()
    open_loops: list[tuple[int, int]] = []
    for block, statement in statements:
        if statement.loop is None:
            continue
        number = statement.loop.value
        if statement.kind in (Kind.WHILE_DO, Kind.DO):
            if any(number == other for other, _ in open_loops):
                loops.faults.append(("loop-unbalanced", block, f"DO{number} inside the loop of DO{number}"))
            elif len(open_loops) >= levels:
                loops.faults.append(("nesting-too-deep", block, f"loops more than {levels} deep"))
            open_loops.append((number, block))
        elif statement.kind is Kind.END:
            if not any(number == other for other, _ in open_loops):
                loops.faults.append(("loop-unbalanced", block, f"END{number} without a DO{number}"))
                continue
            while open_loops[-1][0] != number:
                other, at = open_loops.pop()
                loops.faults.append(("loop-unbalanced", at, f"DO{other} crosses the loop of DO{number}"))
            _, at = open_loops.pop()
            loops.end[at] = block
            loops.head[block] = at
    for number, at in open_loops:
        loops.faults.append(("loop-unbalanced", at, f"DO{number} without an END{number}"))
    return loops
