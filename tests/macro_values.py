"""What the tests of expressions, statements and macros share."""

from __future__ import annotations

from typing import Any

from polarcheck.execution.expression import Characters, Expression, evaluate, read_expression
from polarcheck.execution.macro import Variables


def variables(**values: float | None) -> Variables:
    """Variables with v1=5. for #1 = 5."""
    some = Variables()
    for name, value in values.items():
        assert some.write(int(name[1:]), value) == ""
    return some


def expression(text: str, **bounds: int) -> Expression:
    reading = read_expression(Characters(text), 0, whole=True, **bounds)
    assert reading.expression is not None, reading.fault
    assert reading.at == len(Characters(text).text)
    return reading.expression


def value(text: str, given: Variables | None = None, **settings: Any) -> float | None:
    result, fault = evaluate(expression(text), given or Variables(), **settings)
    assert fault is None
    return result


def same(a: float | None, b: float | None) -> bool:
    """Equal, where vacant equals vacant and unknown equals unknown."""
    return a is b or (a is not None and b is not None and (a == b or (a != a and b != b)))
