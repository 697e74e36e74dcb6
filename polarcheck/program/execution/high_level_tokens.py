"""
The tokens of a high-level language: names, letters, numbers, strings and signs; the grammar of its expressions.

Sources: programming manual 840D sl, job planning 03/2006, p. 1-24 (order of the operators) and its chapter on
arithmetic functions.
"""

from __future__ import annotations

import math
import re
from typing import Final

from polarcheck.program.execution.arithmetic import UNKNOWN
from polarcheck.program.execution.expression_reader import Operand
from polarcheck.program.execution.grammar import Function, Grammar, Operator
from polarcheck.program.execution.language_tokens import Language, Token, Tokens
from polarcheck.program.execution.variable_names import FIRST_PARAMETER

#: A name has two letters at least, so that X10Y5 is no name; any other letter is a token of its own.
_TOKEN: Final = re.compile(
    r"""
    (?P<string>"[^"]*+"?+)
    |(?P<coded>'[^']*+'?+)
    |(?P<number>(?:[0-9]++\.?+[0-9]*+|\.[0-9]++)(?:EX[-+]?+[0-9]++)?+)
    |(?P<name>[A-Z_$][A-Z_][A-Z0-9_$]*+)
    |(?P<letter>[A-Z])
    |(?P<sign><>|==|>=|<=|<<|[-+*/()\[\],:=<>])
    |(?P<other>[^\s\0&])
    """,
    re.VERBOSE,
)
GRAMMAR: Final = Grammar(
    operators={
        **{name: Operator(11, name) for name in ("*", "/", "DIV", "MOD")},
        "+": Operator(10, "+"),
        "-": Operator(10, "-"),
        "B_AND": Operator(9, "AND"),
        "B_XOR": Operator(8, "XOR"),
        "B_OR": Operator(7, "OR"),
        "AND": Operator(6, "BOTH"),
        "XOR": Operator(5, "ONE"),
        "OR": Operator(4, "EITHER"),
        "<<": Operator(3, "JOIN"),
        "==": Operator(2, "EQ"),
        "<>": Operator(2, "NE"),
        ">": Operator(2, "GT"),
        "<": Operator(2, "LT"),
        ">=": Operator(2, "GE"),
        "<=": Operator(2, "LE"),
    },
    prefixes={
        "+": None,
        "-": Operator(12, "NEGATE"),
        "NOT": Operator(12, "NOT"),
        "B_NOT": Operator(12, "B_NOT"),
    },
    functions={
        **{
            name: Function({1: (name,)}, ")")
            for name in ("SIN", "COS", "TAN", "ASIN", "ACOS", "SQRT", "ABS", "LN", "EXP")
        },
        "ATAN2": Function({2: ("ATAN2",)}, ")"),
        "TRUNC": Function({1: ("FIX",)}, ")"),
        "ROUND": Function({1: ("WHOLE",)}, ")"),
        "POT": Function({1: ("SQUARE",)}, ")"),
        "MINVAL": Function({2: ("LEAST",)}, ")"),
        "MAXVAL": Function({2: ("GREATEST",)}, ")"),
        "R": Function({1: ("WHOLE", float(FIRST_PARAMETER), "+", "#")}, "]"),
        "": Function({1: ()}, ")"),
    },
    repeatable=frozenset(("+", "-", "NOT", "B_NOT")),
    takes_any_comma=True,
)
_CONSTANTS: Final = {"TRUE": 1.0, "FALSE": 0.0, "$PI": math.pi}
_BASES: Final = {"H": 16, "B": 2}


def _operand(tokens: Tokens, token: Token) -> Operand | None:
    following = tokens.token
    match token.kind:
        case "number":
            return _number(float(token.text.replace("EX", "E")), token)
        case "coded":
            return _number(_coded(token.text), token)
        case "string":
            return _number(UNKNOWN, token)
        case "letter" if token.text == "R" and following.kind == "number" and following.text.isdigit():
            tokens.at += 1
            return Operand("variable", "", FIRST_PARAMETER + _whole(following.text), token.start, following.end)
        case "letter" if token.text == "R" and tokens.take_sign("["):
            return Operand("open", "R", 0.0, token.start, token.end)
        case "name" if token.text in GRAMMAR.functions and tokens.take_sign("("):
            return Operand("open", token.text, 0.0, token.start, token.end)
        case "sign" if token.text == "(":
            return Operand("open", "", 0.0, token.start, token.end)
        case "name" | "sign" if token.text in GRAMMAR.prefixes:
            return Operand("prefix", token.text, 0.0, token.start, token.end)
        case "name":
            return _variable(tokens, token)
        case "letter" if tokens.names.is_declared(token.text):
            return _variable(tokens, token)
    return None


def _variable(tokens: Tokens, token: Token) -> Operand:
    """A name: a constant, a variable, or a value that is not known: an array, a system variable."""
    if token.text in _CONSTANTS:
        return _number(_CONSTANTS[token.text], token)
    has_brackets = tokens.is_sign("(") or tokens.is_sign("[")
    last = tokens.skip_brackets() if has_brackets else token
    is_unknown = has_brackets or token.text[0] == "$"
    if is_unknown or not tokens.names.is_declared(token.text):
        tokens.unknown.append(Token("name", token.text, token.start, last.end))
    if is_unknown:
        return Operand("number", "", UNKNOWN, token.start, last.end)
    return Operand("variable", "", float(tokens.names.variable(token.text)), token.start, token.end)


def _number(value: float, token: Token) -> Operand:
    return Operand("number", "", value, token.start, token.end)


def _whole(digits: str) -> float:
    return float(digits) if len(digits) < 9 else 1e9


def _coded(text: str) -> float:
    """The value of 'H1F' or 'B101'; NaN where it is neither."""
    digits, base = text[2:].removesuffix("'"), _BASES.get(text[1:2])
    try:
        return float(int(digits, base)) if base else UNKNOWN
    except (ValueError, OverflowError):
        return UNKNOWN


HIGH_LEVEL: Final = Language(_TOKEN, GRAMMAR, _operand)
