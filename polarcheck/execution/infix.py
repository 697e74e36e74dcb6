"""
Expressions of a high-level language: `R1+5*SIN(R2)` is read into the steps that custom macro has for it.

Reading goes step by step, without recursion, in linear time. Sources: programming manual 840D sl, job planning 03/2006,
p. 1-24 (order of the operators) and its chapter on arithmetic functions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from polarcheck.execution.expression import Expression, Fault, Step
from polarcheck.execution.kinds import FaultKind
from polarcheck.execution.names import FIRST_PARAMETER, Names
from polarcheck.execution.tokens import Token

#: Operators, by how tightly they bind, and the steps that they are.
_OPERATORS: Final[dict[str, tuple[int, str]]] = {
    "*": (11, "*"),
    "/": (11, "/"),
    "DIV": (11, "DIV"),
    "MOD": (11, "MOD"),
    "+": (10, "+"),
    "-": (10, "-"),
    "B_AND": (9, "AND"),
    "B_XOR": (8, "XOR"),
    "B_OR": (7, "OR"),
    "AND": (6, "BOTH"),
    "XOR": (5, "ONE"),
    "OR": (4, "EITHER"),
    "<<": (3, "JOIN"),
    "==": (2, "EQ"),
    "<>": (2, "NE"),
    ">": (2, "GT"),
    "<": (2, "LT"),
    ">=": (2, "GE"),
    "<=": (2, "LE"),
}
_PREFIX: Final = 12
#: Functions: the steps behind their arguments, and how many arguments they take.
_FUNCTIONS: Final[dict[str, tuple[tuple[str, ...], int]]] = {
    **{name: ((name,), 1) for name in ("SIN", "COS", "TAN", "ASIN", "ACOS", "SQRT", "ABS", "LN", "EXP")},
    "ATAN2": (("ATAN2",), 2),
    "TRUNC": (("FIX",), 1),
    "ROUND": (("WHOLE",), 1),
    "POT": (("SQUARE",), 1),
    "MINVAL": (("LEAST",), 2),
    "MAXVAL": (("GREATEST",), 2),
}
_CONSTANTS: Final = {"TRUE": 1.0, "FALSE": 0.0, "$PI": math.pi}
_BASES: Final = {"H": 16, "B": 2}


@dataclass(slots=True)
class _Open:
    """An open bracket: the function or "R" before it, its token, the operators that wait outside, its arguments."""

    name: str
    token: Token
    outside: int
    arguments: int = 1


class _Stop(Exception):  # noqa: N818 - it ends the reading of one expression and never leaves Infix
    """The fault at which reading ends."""


class Infix:
    """
    Reads expressions from the tokens of one block.

    at: the index of the next token. fault: the first so far. unknown: the names whose values this check does not know,
    with their places. size: bound of the steps and of the open brackets of an expression.
    """

    def __init__(self, found: list[Token], names: Names, size: int) -> None:
        self.tokens, self.names, self.size = found, names, size
        self.at = 0
        self.fault: Fault | None = None
        self.unknown: list[Token] = []

    @property
    def token(self) -> Token:
        """The next token; the last one again where all have been passed over."""
        return self.tokens[min(self.at, len(self.tokens) - 1)]

    def is_sign(self, sign: str, ahead: int = 0) -> bool:
        """Whether a token is this sign: the next one, or one so many ahead of it."""
        at = min(self.at + ahead, len(self.tokens) - 1)
        return self.tokens[at].kind == "sign" and self.tokens[at].text == sign

    def take_sign(self, sign: str) -> bool:
        """Pass over a sign, where it is the next token."""
        found = self.is_sign(sign)
        self.at += found
        return found

    def wrong(self, kind: FaultKind, first: Token, last: Token | None = None) -> None:
        """Keep the first fault."""
        self.fault = self.fault or Fault(kind, first.start, max((last or first).end, first.start + 1))

    def skip_brackets(self) -> Token:
        """Pass over brackets and all that is in them; the next token opens them. Gives the last token passed over."""
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
        """Read up to where no operator follows; None where it cannot be calculated, and what is left is passed over."""
        first = self.token
        reading = _Reading(self)
        try:
            reading.run()
        except _Stop:
            self.at = len(self.tokens) - 1
            return None
        last = self.tokens[max(self.at - 1, 0)]
        return Expression(tuple(reading.steps), first.start, max(last.end, first.end))


class _Reading:
    """One expression: values go out at once, an operator waits for those that bind more tightly."""

    def __init__(self, infix: Infix) -> None:
        self.infix = infix
        self.steps: list[Step] = []
        self.waiting: list[tuple[int, str, Token]] = []
        self.brackets: list[_Open] = []

    def stop(self, kind: FaultKind, first: Token, last: Token | None = None) -> _Stop:
        self.infix.wrong(kind, first, last)
        return _Stop()

    def put(self, name: str, token: Token, number: float = 0.0) -> None:
        if len(self.steps) >= self.infix.size:
            raise self.stop("too-long", token)
        self.steps.append(Step(name, number, token.start, token.end))

    def settle(self, order: int) -> None:
        outside = self.brackets[-1].outside if self.brackets else 0
        while len(self.waiting) > outside and self.waiting[-1][0] >= order:
            _, name, token = self.waiting.pop()
            self.put(name, token)

    def open(self, name: str, token: Token) -> None:
        if len(self.brackets) >= self.infix.size:
            raise self.stop("bracket-levels", token)
        self.brackets.append(_Open(name, token, len(self.waiting)))

    def run(self) -> None:
        self.value()
        while self.goes_on():
            self.value()
        if self.brackets:
            raise self.stop("missing-close-bracket", self.brackets[-1].token, self.infix.token)
        self.settle(0)

    def value(self) -> None:
        """Read signs and opening brackets up to and with a number or a variable."""
        infix = self.infix
        while True:
            token = infix.token
            infix.at += 1
            match token.kind:
                case "number":
                    return self.put("number", token, float(token.text.replace("EX", "E")))
                case "coded":
                    return self.put("number", token, _coded(token.text))
                case "string":
                    return self.put("number", token, math.nan)
                case "letter" if token.text == "R" and infix.token.kind == "number" and infix.token.text.isdigit():
                    self.put("number", token, FIRST_PARAMETER + _whole(infix.token.text))
                    self.put("#", Token("name", "R", token.start, infix.token.end))
                    infix.at += 1
                    return None
                case "letter" if token.text == "R" and infix.is_sign("["):
                    infix.at += 1
                    self.open("R", token)
                case "name" if token.text in ("NOT", "B_NOT"):
                    self.waiting.append((_PREFIX, token.text, token))
                case "name" if token.text in _FUNCTIONS and infix.is_sign("("):
                    infix.at += 1
                    self.open(token.text, token)
                case "name":
                    return self.variable(token)
                case "sign" if token.text == "(":
                    self.open("", token)
                case "sign" if token.text == "-":
                    self.waiting.append((_PREFIX, "NEGATE", token))
                case "sign" if token.text == "+":
                    pass
                case _:
                    infix.at -= 1
                    raise self.stop("format", token)

    def variable(self, token: Token) -> None:
        """A name: a constant, a variable, or what has a value that is not known here: an array, a system variable."""
        infix = self.infix
        if token.text in _CONSTANTS:
            return self.put("number", token, _CONSTANTS[token.text])
        has_more = infix.is_sign("(") or infix.is_sign("[")
        last = infix.skip_brackets() if has_more else token
        if has_more or token.text[0] == "$" or not infix.names.is_declared(token.text):
            infix.unknown.append(Token("name", token.text, token.start, last.end))
        if has_more or token.text[0] == "$":
            return self.put("number", token, math.nan)
        self.put("number", token, float(infix.names.variable(token.text)))
        return self.put("#", token)

    def goes_on(self) -> bool:
        """After a value take closing brackets, then what asks for another value; False where the expression ends."""
        infix = self.infix
        while True:
            token, bracket = infix.token, self.brackets[-1] if self.brackets else None
            if token.text in _OPERATORS and token.kind in ("sign", "name"):
                infix.at += 1
                order, name = _OPERATORS[token.text]
                self.settle(order)
                self.waiting.append((order, name, token))
                return True
            if bracket is None or token.kind != "sign":
                return False
            if token.text == ",":
                self.settle(0)
                bracket.arguments += 1
                infix.at += 1
                return True
            if token.text != ("]" if bracket.name == "R" else ")"):
                return False
            infix.at += 1
            self.close(token)

    def close(self, token: Token) -> None:
        self.settle(0)
        bracket = self.brackets.pop()
        names, count = _FUNCTIONS.get(bracket.name, ((), 1))
        if bracket.arguments != count:
            raise self.stop("missing-comma" if bracket.arguments < count else "format", bracket.token, token)
        place = Token("name", bracket.name, bracket.token.start, token.end)
        if bracket.name == "R":
            self.put("WHOLE", place)
            self.put("number", place, float(FIRST_PARAMETER))
            self.put("+", place)
            self.put("#", place)
        for name in names:
            self.put(name, place)


def _whole(digits: str) -> float:
    return float(digits) if len(digits) < 9 else 1e9


def _coded(text: str) -> float:
    """The value of 'H1F' or 'B101'; unknown where it is neither."""
    digits, base = text[2:].removesuffix("'"), _BASES.get(text[1:2])
    try:
        return float(int(digits, base)) if base else math.nan
    except (ValueError, OverflowError):
        return math.nan
