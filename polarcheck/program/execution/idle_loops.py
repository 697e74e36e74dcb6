"""
Counting loops that never run, whatever the machine holds: the numbers of their condition stand in the program.

The counter begins with a number that is written before the loop, and its limit is written, too. A limit of which the
program makes a parameter says nothing where the counter leads away from it: no pass may be wanted.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Final, NamedTuple

import msgspec

from polarcheck.program.execution.expression import Expression, Readable, decide, evaluate
from polarcheck.program.execution.statement import Kind, Statement

#: Comparisons, and what may stand in the place of each.
_COMPARISONS: Final = {"EQ": ("LE", "GE"), "GT": ("LT",), "GE": ("LE",), "LT": ("GT",), "LE": ("GE",)}


class IdleLoop(NamedTuple):
    """
    A loop that never runs.

    condition: of its WHILE. block, target: where the loop sets its counter. start: what that begins with. instead: the
    comparison with which it would run to its limit; "" where there is none.
    """

    condition: Expression
    block: int
    target: Expression
    start: float
    instead: str


class _Side(NamedTuple):
    """One side of a comparison: a number, or the number of a variable."""

    number: float
    is_number: bool


class _Written(Readable):
    """Variables that hold what was written into them."""

    def __init__(self, values: dict[int, float]) -> None:
        self.values = values

    def exists(self, number: float) -> bool:
        return round(number) in self.values

    def value(self, number: float) -> float:
        return self.values[round(number)]


def idle_loop(statements: Sequence[tuple[int, Statement]], head: int, end: int) -> IdleLoop | None:
    """The loop from its WHILE in block `head` to its end, if it never runs; statements: of its program, with blocks."""
    condition = next(statement.condition for block, statement in statements if block == head)
    if condition is None or not condition.steps or condition.steps[-1].name not in _COMPARISONS:
        return None
    for block, statement in statements:
        counter, step = _target(statement), statement.value
        if not head < block < end or counter is None or step is None or _variables(step) != {counter}:
            continue
        start, limit = _written_before(statements, head, counter), _other_side(condition, counter)
        if start is None or limit is None:
            continue
        bound = limit.number if limit.is_number else _written_before(statements, head, round(limit.number))
        after = evaluate(step, _Written({counter: start}))[0]
        if bound is None or after is None:
            continue
        leads_there = abs(bound - after) < abs(bound - start)
        if (limit.is_number or leads_there) and statement.target is not None:
            instead = _instead(condition, {counter: start, round(limit.number): bound}) if leads_there else ""
            return IdleLoop(condition, block, statement.target, start, instead)
    return None


def _instead(condition: Expression, values: dict[int, float]) -> str:
    """The comparison with which a condition would be true."""
    *sides, last = condition.steps
    for name in _COMPARISONS[last.name]:
        corrected = msgspec.structs.replace(condition, steps=(*sides, last._replace(name=name)))
        if decide(corrected, _Written(values))[0]:
            return name
    return ""


def _written_before(statements: Sequence[tuple[int, Statement]], head: int, variable: int) -> float | None:
    """The number that is last written into a variable before a block; None for a calculated one or a skipped block."""
    earlier = [statement for block, statement in statements if block < head and _sets(statement, variable)]
    if not earlier or earlier[-1].kind is not Kind.ASSIGN or earlier[-1].skips:
        return None
    value = earlier[-1].value
    if value is None or _variables(value) != set():
        return None
    return evaluate(value, _Written({}))[0]


def _other_side(condition: Expression, counter: int) -> _Side | None:
    """What a counter is compared with, `#1 GE 4.`; one whose # is missing, `1 GE 4.`, is a counter, too."""
    sides: list[_Side] = []
    for step in condition.steps[:-1]:
        if step.name == "number":
            sides.append(_Side(step.number, is_number=True))
        elif step.name == "#" and sides and sides[-1].is_number:
            sides[-1] = _Side(sides[-1].number, is_number=False)
        elif step.name == "NEGATE" and sides and sides[-1].is_number:
            sides[-1] = _Side(-sides[-1].number, is_number=True)
        else:
            return None
    if len(sides) != 2:
        return None
    for side, rival in (sides, sides[::-1]):
        if side.number == counter and (not side.is_number or rival.is_number):
            return rival
    return None


def _sets(statement: Statement, variable: int) -> bool:
    """The statement sets a variable, or one that is computed."""
    parts = (statement, *statement.more, *([statement.then] if statement.then else []))
    return any(part.kind is Kind.ASSIGN and _target(part) in (variable, None) for part in parts)


def _target(statement: Statement) -> int | None:
    """The variable that a statement sets, if its number is written."""
    target = statement.target if statement.kind is Kind.ASSIGN else None
    if target is None or [step.name for step in target.steps] != ["number"]:
        return None
    return round(target.steps[0].number)


def _variables(expression: Expression) -> set[int | None]:
    """The variables that an expression reads; None for one whose number is computed."""
    steps = expression.steps
    return {
        round(before.number) if before.name == "number" else None
        for before, step in itertools.pairwise(steps)
        if step.name == "#"
    }
