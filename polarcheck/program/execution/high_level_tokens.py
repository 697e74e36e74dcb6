"""
The tokens of a high-level language: names, letters, numbers, strings and signs; the grammar of its expressions.

Sources: programming manual 840D sl, job planning 03/2006, p. 1-24 (order of the operators) and its chapter on
arithmetic functions.
"""

from __future__ import annotations

import itertools
import math
import re
from typing import Final, NamedTuple

from polarcheck.program.execution.arithmetic import UNKNOWN
from polarcheck.program.execution.expression import Expression, Fault
from polarcheck.program.execution.expression_reader import (
    Following,
    Function,
    Grammar,
    Operand,
    Operator,
    Unreadable,
    read_expression,
)
from polarcheck.program.execution.kinds import FaultKind
from polarcheck.program.execution.macro_tokens import in_capitals
from polarcheck.program.execution.variable_names import FIRST_PARAMETER, Names

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
    repeats_prefixes=True,
    takes_any_comma=True,
)
_CONSTANTS: Final = {"TRUE": 1.0, "FALSE": 0.0, "$PI": math.pi}
_BASES: Final = {"H": 16, "B": 2}


class Token(NamedTuple):
    """
    A token and its characters within the block.

    kind: string, coded ('H1F'), number, name, letter, sign, other, or end behind the last.
    text: in capitals; of a string without its quotes, as written.
    start, end: its characters within the block, end exclusive.
    """

    kind: str
    text: str
    start: int
    end: int


def tokens_of(block: str, limit: int) -> list[Token]:
    """The first tokens of a block without comments, up to a limit, and one of the kind end behind them."""
    capitals = block.upper() if block.isascii() else in_capitals(block)
    tokens = []
    for match in itertools.islice(_TOKEN.finditer(capitals), limit):
        kind = match.lastgroup or ""
        start, end = match.span()
        text = block[start + 1 : end].removesuffix('"') if kind == "string" else match[0]
        tokens.append(Token(kind, text, start, end))
    last = len(block.rstrip())
    return [*tokens, Token("end", "", max(last - 1, 0), last)]


class Tokens:
    """
    The tokens of a block while they are read, and the expressions among them. Positions are characters of the block.

    tokens: all of them.
    at: the index of the next token.
    fault: the first so far.
    unknown: the names whose values this check does not know.
    size: limit of the steps and of the open brackets of an expression.
    """

    def __init__(self, block: str, names: Names, size: int) -> None:
        self.tokens, self.names, self.size = tokens_of(block, size), names, size
        self.at = 0
        self.fault: Fault | None = None
        self.unknown: list[Token] = []

    @property
    def token(self) -> Token:
        """The next token; the last one where all have been passed over."""
        return self.tokens[min(self.at, len(self.tokens) - 1)]

    def is_sign(self, sign: str, ahead: int = 0) -> bool:
        """True where the next token, or the one at this distance behind it, is this sign."""
        index = min(self.at + ahead, len(self.tokens) - 1)
        return self.tokens[index].kind == "sign" and self.tokens[index].text == sign

    def take_sign(self, sign: str) -> bool:
        """Pass over a sign if it is the next token."""
        is_next = self.is_sign(sign)
        self.at += is_next
        return is_next

    def wrong(self, kind: FaultKind, first: Token, last: Token | None = None) -> None:
        """Record a fault, unless there is one already."""
        self.fault = self.fault or Fault(kind, *self.span(first.start, (last or first).end))

    def skip_brackets(self) -> Token:
        """Pass over brackets and their contents; the next token opens them. Returns the last token passed over."""
        depth, last = 0, self.token
        while self.token.kind != "end":
            last = self.token
            self.at += 1
            if last.kind == "sign":
                depth += (last.text in "([") - (last.text in ")]")
                if depth <= 0:
                    break
        return last

    def expression(self) -> Expression | None:
        """Read an expression; None where it cannot be calculated, and then the rest of the block is passed over."""
        expression, fault = read_expression(self, GRAMMAR, levels=self.size, size=self.size)
        self.fault = self.fault or fault
        if expression is None:
            self.at = len(self.tokens) - 1
        return expression

    # ---- the lexer of expressions ----

    @property
    def start(self) -> int:
        return self.token.start

    @staticmethod
    def span(start: int, end: int) -> tuple[int, int]:
        return start, max(end, start + 1)

    def operand(self) -> Operand:
        token = self.token
        self.at += 1
        following = self.token
        match token.kind:
            case "number":
                return _number(float(token.text.replace("EX", "E")), token)
            case "coded":
                return _number(_coded(token.text), token)
            case "string":
                return _number(UNKNOWN, token)
            case "letter" if token.text == "R" and following.kind == "number" and following.text.isdigit():
                self.at += 1
                return Operand("variable", "", FIRST_PARAMETER + _whole(following.text), token.start, following.end)
            case "letter" if token.text == "R" and self.take_sign("["):
                return Operand("open", "R", 0.0, token.start, token.end)
            case "name" if token.text in GRAMMAR.functions and self.take_sign("("):
                return Operand("open", token.text, 0.0, token.start, token.end)
            case "sign" if token.text == "(":
                return Operand("open", "", 0.0, token.start, token.end)
            case "name" | "sign" if token.text in GRAMMAR.prefixes:
                return Operand("prefix", token.text, 0.0, token.start, token.end)
            case "name":
                return self._variable(token)
            case "letter" if self.names.is_declared(token.text):
                return self._variable(token)
        self.at -= 1
        raise Unreadable(Fault("format", *self.span(token.start, token.end)))

    def _variable(self, token: Token) -> Operand:
        """A name: a constant, a variable, or a value that is not known: an array, a system variable."""
        if token.text in _CONSTANTS:
            return _number(_CONSTANTS[token.text], token)
        has_brackets = self.is_sign("(") or self.is_sign("[")
        last = self.skip_brackets() if has_brackets else token
        is_unknown = has_brackets or token.text[0] == "$"
        if is_unknown or not self.names.is_declared(token.text):
            self.unknown.append(Token("name", token.text, token.start, last.end))
        if is_unknown:
            return Operand("number", "", UNKNOWN, token.start, last.end)
        return Operand("variable", "", float(self.names.variable(token.text)), token.start, token.end)

    def following(self) -> Following:
        token = self.token
        return Following(token.text if token.kind in ("sign", "name") else "", token.start, token.end)

    def pass_over(self, token: Following) -> None:
        self.at += 1

    def take(self, text: str) -> int | None:
        return self.token.start if self.take_sign(text) else None

    def unclosed(self, start: int, token: Following) -> Fault:
        return Fault("missing-close-bracket", *self.span(start, token.end))


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
