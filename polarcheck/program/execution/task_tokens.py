"""
The tokens of user tasks, and the grammar of their expressions: VC1*2+DIA, MOD[V1,2], [VC1 EQ 1] AND [LX GT 0].

Sources: public notes on the manuals of OSP-P200L, 5238-E, and OSP-P300L (source 71138944758): V1, local
variables by name, VTOFX[5]; the operators and functions from help.icam.com, Okuma pre-processor.
"""

from __future__ import annotations

import re
from typing import Final

from polarcheck.program.execution.arithmetic import UNKNOWN
from polarcheck.program.execution.expression_reader import Operand
from polarcheck.program.execution.grammar import AND, DOUBTFUL, OR, PRODUCT, SUM, Function, Grammar, Operator
from polarcheck.program.execution.language_tokens import Language, Token, Tokens
from polarcheck.program.execution.variable_names import Names

#: The $ with which a line goes on is no token.
_TOKEN: Final = re.compile(
    r"""
    \n[ \t\r\0]*+\$
    |(?P<number>[0-9]++\.?+[0-9]*+|\.[0-9]++)
    |(?P<name>VC[0-9]++|[A-Z][A-Z][A-Z0-9]*+)
    |(?P<letter>[A-Z])
    |(?P<sign>[-+*/=,\[\]])
    |(?P<other>[^\s\0])
    """,
    re.VERBOSE,
)
#: The key of the index behind the name of a system variable.
_INDEX: Final = "VTOFX["
GRAMMAR: Final = Grammar(
    operators={
        **{name: Operator(6, name, PRODUCT) for name in ("*", "/", "MOD")},
        **{sign: Operator(5, sign, SUM) for sign in "+-"},
        **{name: Operator(4, name) for name in ("EQ", "NE", "GT", "LT", "GE", "LE")},
        "AND": Operator(6, "AND", AND),
        "OR": Operator(5, "OR", OR),
        "EOR": Operator(5, "XOR", OR),
    },
    prefixes={"+": None, "-": Operator(7, "NEGATE"), "NOT": Operator(7, "NAMED")},
    functions={
        **{
            name: Function({1: (name,)}, "]")
            for name in ("SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "SQRT", "ABS", "FIX", "FUP", "BIN", "BCD")
        },
        "ROUND": Function({1: ("WHOLE",)}, "]"),
        "ATAN2": Function({2: ("ATAN2",)}, "]"),
        "MOD": Function({2: ("MOD",)}, "]"),
        # DROUND rounds to the unit of the machine, NOT depends on the bits of a number.
        **{name: Function({1: ("NAMED",)}, "]") for name in ("NOT", "DROUND", "DFIX", "DFUP", _INDEX)},
        "": Function({1: ()}, "]"),
    },
    doubtful=DOUBTFUL,
    checks_conditions=True,
    compares_first=True,
    repeatable=frozenset(("NOT",)),
)
#: Names of the flow.
FLOW: Final = frozenset(("IF", "GOTO", "CALL", "MODIN", "MODOUT", "RTS", "NOEX"))
SEQUENCE_NAME: Final = re.compile(r"N[A-Z][A-Z0-9]{0,3}")
#: VZOFX, VTOFX[5]: a variable of the system. None of their values is known.
SYSTEM: Final = re.compile(r"V(?!C[0-9])[A-Z][A-Z0-9]*+")
#: V1 is the variable of this number more, so that it is another one than VC1.
_FIRST_COMMON: Final = 100_000


def common_variable(digits: str) -> int | None:
    """The number that stands for V5; None for V with no whole number."""
    return _FIRST_COMMON + int(digits[:12]) if digits.isdecimal() else None


def named_variable(name: str, names: Names) -> int:
    """The number that stands for VC5, or for a local variable."""
    digits = name.removeprefix("VC")
    return (int(digits[:12]) if digits != name and digits.isdecimal() else 0) or names.variable(name)


def _operand(tokens: Tokens, token: Token) -> Operand | None:
    following = tokens.token
    match token.kind:
        case "number":
            return Operand("number", "", float(token.text), token.start, token.end)
        case "letter" if token.text == "V" and following.kind == "number":
            tokens.at += 1
            return _variable(common_variable(following.text), token.start, following.end)
        case "sign" if token.text == "[":
            return Operand("open", "", 0.0, token.start, token.end)
        case "name" if token.text in GRAMMAR.functions and tokens.take_sign("["):
            return Operand("open", token.text, 0.0, token.start, token.end)
        case "name" | "sign" if token.text in GRAMMAR.prefixes:
            return Operand("prefix", token.text, 0.0, token.start, token.end)
        case "name" if token.text in GRAMMAR.functions or token.text in GRAMMAR.operators or token.text in FLOW:
            return None
        case "name" if SYSTEM.fullmatch(token.text):
            is_open = tokens.take_sign("[")
            return Operand("open" if is_open else "number", _INDEX, UNKNOWN, token.start, token.end)
        case "name":
            return _variable(named_variable(token.text, tokens.names), token.start, token.end)
    return None


def _variable(number: int | None, start: int, end: int) -> Operand:
    kind = "number" if number is None else "variable"
    return Operand(kind, "", UNKNOWN if number is None else float(number), start, end)


USER_TASK: Final = Language(_TOKEN, GRAMMAR, _operand)
