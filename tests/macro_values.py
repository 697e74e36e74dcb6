"""What the tests of expressions, statements and macros share: the functions of the package, on one control."""

from __future__ import annotations

from typing import Any

import msgspec
from programs import machine_of

from polarcheck.program.execution import custom_macro, macro
from polarcheck.program.execution.arithmetic import Value
from polarcheck.program.execution.expression import Expression, evaluate
from polarcheck.program.execution.expression_reader import read_expression
from polarcheck.program.execution.macro import Arguments, ProgramCall
from polarcheck.program.execution.macro_tokens import GRAMMAR, Characters, MacroLexer
from polarcheck.program.execution.statement import Statement

MACRO = machine_of().macro


class Variables(macro.Variables):
    """Variables of the control; changes are those of keys of its table [macro]."""

    def __init__(self, given: dict[int, Value] | None = None, **changes: Any) -> None:
        super().__init__(msgspec.structs.replace(MACRO, **changes), given)


def variables(**values: float | None) -> Variables:
    """Variables with v1=5. for #1 = 5."""
    some = Variables()
    for name, value in values.items():
        assert some.write(int(name[1:]), value) is None
    return some


def read_statement(block: str, **bounds: int) -> Statement:
    limits = {"loops": MACRO.loop_numbers, "levels": MACRO.bracket_levels, **bounds}
    return custom_macro.read_statement(block, calls=MACRO.flow_codes, **limits)


def assign_arguments(statement: Statement, given: Variables, **options: Any) -> Arguments:
    """increments, or keys of [macro] to change."""
    increments = options.pop("increments", None)
    return macro.assign_arguments(statement, given, msgspec.structs.replace(MACRO, **options), increments=increments)


def called_program(statement: Statement, given: Variables, **changes: Any) -> ProgramCall:
    """changes: keys of [macro]."""
    return macro.called_program(statement, given, msgspec.structs.replace(MACRO, **changes))


def expression(text: str, *, levels: int = 5, size: int = 20_000) -> Expression:
    lexer = MacroLexer(Characters.of_block(text), 0)
    read, fault = read_expression(lexer, GRAMMAR, levels=levels, size=size)
    assert read is not None, fault
    assert lexer.at == len(lexer.text)
    return read


def value(text: str, given: Variables | None = None, **settings: Any) -> float | None:
    result, fault = evaluate(expression(text), given or Variables(), **settings)
    assert fault is None
    return result


def same(a: float | None, b: float | None) -> bool:
    """Equal, where vacant equals vacant and unknown equals unknown."""
    return a is b or (a is not None and b is not None and (a == b or (a != a and b != b)))
