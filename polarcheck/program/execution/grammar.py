"""What differs between the languages of expressions: operators, functions, brackets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

import msgspec

#: Families of operators, and those whose precedence beside one another is in doubt: more than one order is taught.
SUM, PRODUCT, OR, AND = 1, 2, 4, 8
#: With Grammar.compares_first the precedence of AND, OR and XOR between comparisons is by this much lower.
JOIN_OFFSET: Final = 3
DOUBTFUL: Final = frozenset((AND | PRODUCT, AND | SUM, OR | SUM))


class Operator(NamedTuple):
    """
    An operator of a language.

    precedence: the operator with the higher one is calculated first.
    step: its step in the calculation.
    family: a bit for operators of equal nature, for Grammar.doubtful; 0 for none.
    """

    precedence: int
    step: str
    family: int = 0


class Function(msgspec.Struct, frozen=True):
    """
    A function with its opening bracket, or a bracket alone.

    steps: the steps behind the arguments, by the number of arguments; a number in it is a constant.
    closing: the closing bracket.
    again: the characters that open a bracket for the second argument, as in ATAN[1]/[2]; "" where none do.
    """

    steps: Mapping[int, tuple[str | float, ...]]
    closing: str
    again: str = ""


class Grammar(msgspec.Struct, frozen=True):
    """
    What differs between the languages of expressions.

    operators: those between two values, by their characters.
    prefixes: those before a value, by their characters; None where it does nothing, as +.
    functions: what opens a bracket, by Operand.text.
    doubtful: sums of families whose precedence is in doubt where they stand together without brackets.
    checks_conditions: a condition is not a number, nor the reverse.
    compares_first: what stands on both sides of AND, OR and XOR is compared first: [VC1 EQ 1 AND VC2 EQ 2].
    repeatable: prefixes beside which another prefix may stand before a value.
    takes_any_comma: a comma too many is a fault of the whole bracket, not of the comma.
    """

    operators: Mapping[str, Operator]
    prefixes: Mapping[str, Operator | None]
    functions: Mapping[str, Function]
    doubtful: frozenset[int] = frozenset()
    checks_conditions: bool = False
    compares_first: bool = False
    repeatable: frozenset[str] = frozenset()
    takes_any_comma: bool = False
