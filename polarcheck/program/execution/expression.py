"""
Expressions as steps in postfix order, calculated with the variables of the moment.

`expression_reader` reads them from the text. A value is a float, None where a variable is vacant (#0, or never
assigned), NaN where it is unknown. Constants are real numbers: 123 is 123.0. The calculation takes one step after
another, without recursion, in linear time.

Source: FANUC B-62754EN/01, chapter 16.3 and p. 287.
"""

from __future__ import annotations

from typing import Final, NamedTuple, Protocol

import msgspec

from polarcheck.program.execution.arithmetic import (
    FAULTY,
    OPERAND_COUNTS,
    UNKNOWN,
    Arithmetic,
    FromVacant,
    Value,
    calculate,
)
from polarcheck.program.execution.kinds import FaultKind

DEFAULT: Final = Arithmetic()


class Fault(msgspec.Struct, frozen=True):
    """
    A fault in a block.

    kind: what is wrong.
    start, end: the characters at fault within the block, end exclusive.
    number: the argument of the function at fault, or the number of the variable; None where neither matters.
    """

    kind: FaultKind
    start: int
    end: int
    number: float | None = None


class Step(NamedTuple):
    """
    One step of a calculation.

    name: "number" (push a constant), "#" (read the variable of that number), a function or an operator.
    number: the constant; 0 in other steps.
    start, end: its characters within the block, end exclusive.
    """

    name: str
    number: float
    start: int
    end: int


class Expression(msgspec.Struct, frozen=True):
    """
    The steps of an expression in postfix order.

    start, end: its characters within the block, end exclusive.
    condition: its result is true or false, not a number.
    mixed: start and end of the first operator whose precedence is in doubt; None where there is none.
    """

    steps: tuple[Step, ...]
    start: int
    end: int
    condition: bool = False
    mixed: tuple[int, int] | None = None


def constant(number: float, start: int, end: int) -> Expression:
    """The expression of one number."""
    return Expression((Step("number", number, start, end),), start, end)


class Readable(Protocol):
    """Where the values of variables come from; `macro.Variables` is the only implementation."""

    def exists(self, number: float) -> bool: ...

    def value(self, number: float) -> Value: ...


def evaluate(
    expression: Expression, variables: Readable, arithmetic: Arithmetic = DEFAULT, increment: float = 1.0
) -> tuple[Value, Fault | None]:
    """
    Return the value and the first fault. A step at fault gives an unknown value, and the calculation continues.

    increment: what ROUND rounds to: 1 in a macro statement, the least increment of the address in an NC word.
    The value of a variable alone may be vacant; in a calculation vacant counts as 0.
    """
    stack: list[Value] = []
    fault: Fault | None = None
    vacant = 0
    for name, number, start, end in expression.steps:
        count = OPERAND_COUNTS.get(name, 1)
        operands = stack[len(stack) - count :]
        del stack[len(stack) - count :]
        result: Value | FaultKind
        if name == "number":
            result = "overflow" if abs(number) > arithmetic.largest else number
        elif name == "#":
            variable = operands[0] or 0.0
            if variable != variable:
                result = variable
            else:
                result = variables.value(variable) if variables.exists(variable) else "variable-number"
                vacant = round(variable) if result is None else vacant
        else:
            result = calculate(name, operands, arithmetic, increment)
            if result != result:
                result = next((operand for operand in operands if operand != operand), UNKNOWN)
            elif isinstance(result, float):
                result = _with_vacant(result, operands, vacant)
        if isinstance(result, str):
            fault = fault or Fault(result, start, end, (operands[0] or 0.0) if operands else None)
            result = FAULTY
        stack.append(result)
    return stack[-1], fault


def _with_vacant(result: float, operands: list[Value], vacant: int) -> float:
    """The result of a step with the vacant variable among its operands; vacant: the one read last."""
    for operand in operands:
        if operand is None or isinstance(operand, FromVacant):
            return FromVacant(result, vacant if operand is None else operand.variable)
    return result


def decide(
    condition: Expression, variables: Readable, arithmetic: Arithmetic = DEFAULT
) -> tuple[bool | None, Fault | None]:
    """Return True or False for a condition, None where it is unknown; and the first fault."""
    value, fault = evaluate(condition, variables, arithmetic)
    return (None if value is None or value != value else bool(value)), fault
