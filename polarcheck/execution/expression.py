"""
Macro expressions: `#1*SIN[#2+30]` is read once into postfix steps, then calculated with the variables of the moment.

A value is a float, None where a variable is vacant (#0, or never assigned), NaN where it is unknown. Macro constants
are real numbers: 123 is 123.0. Reading and calculating go step by step, without recursion, in linear time.

Sources: FANUC B-62754EN/01, chapter 16.3 and p. 287 (five levels of brackets). That AND ranks with * and OR with + is
the manuals' order as remembered; another one is taught as well, hence `ambiguous`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final, NamedTuple, Protocol

from polarcheck.execution.arithmetic import UNKNOWN, Arithmetic, Value, calculate
from polarcheck.execution.kinds import FaultKind

DEFAULT: Final = Arithmetic()


class Fault(NamedTuple):
    """
    What is wrong, and the characters at fault within the block, end exclusive.

    number: what a function was asked of, or the number of a variable; None where that says nothing.
    """

    kind: FaultKind
    start: int
    end: int
    number: float | None = None


_CAPITALS: Final = {ord(letter): ord(letter) - 32 for letter in "abcdefghijklmnopqrstuvwxyz"}


def in_capitals(text: str) -> str:
    """The text with the letters a to z in capitals; it stays as long as it is, which upper() does not promise."""
    return text.translate(_CAPITALS)


class Characters:
    """The text of a block without blanks, in capitals, and the place in the block where each character stands."""

    __slots__ = ("places", "text")

    def __init__(self, block: str) -> None:
        self.places = [found.start() for found in re.finditer(r"[^\s\0]", block)]
        self.text = in_capitals("".join([block[place] for place in self.places]))

    @classmethod
    def read_as(cls, text: str, places: list[int]) -> Characters:
        """Characters that a block is read as, each with the place of the one in the block that it stands for."""
        characters = cls("")
        characters.text, characters.places = text, places
        return characters

    def span(self, start: int, end: int) -> tuple[int, int]:
        """Where the characters from start to end stand in the block; the last character where start is past the end."""
        if not self.places:
            return 0, 0
        start = min(start, len(self.places) - 1)
        end = min(max(end, start + 1), len(self.places))
        return self.places[start], self.places[end - 1] + 1

    def fault(self, kind: FaultKind, start: int, end: int = 0) -> Fault:
        """A fault of the characters from start to end, or of the one at start."""
        return Fault(kind, *self.span(start, end))


class Step(NamedTuple):
    """One step of a calculation: "number", "#" (read the variable of that number), a function or an operator."""

    name: str
    number: float
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Expression:
    """
    The steps of an expression in postfix order, and its characters within the block.

    condition: it gives true or false, not a number. mixed: where it mixes operators whose order is in doubt.
    """

    steps: tuple[Step, ...]
    start: int
    end: int
    condition: bool = False
    mixed: tuple[int, int] | None = None


class Reading(NamedTuple):
    """An expression, None where it cannot be calculated; the index of the character after it; the fault, if any."""

    expression: Expression | None
    at: int
    fault: Fault | None


def ambiguous(expression: Expression) -> tuple[int, int] | None:
    """Where AND meets * / MOD + -, or OR and XOR meet + -, with no brackets between them; None where they do not."""
    return expression.mixed


# Reading --------------------------------------------------------------------------------------------------------------

NUMBER: Final = r"[0-9]++\.?+[0-9]*+|\.[0-9]++"
_ANGLES: Final = ["SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN"]
#: No program writes @ROUND: what other languages than custom macro call ROUND, which rounds to whole numbers anywhere.
_WHOLE: Final = "@ROUND"
_FUNCTIONS: Final = [*_ANGLES, "SQRT", "ABS", "ROUND", "FIX", "FUP", "LN", "EXP", "BIN", "BCD", "POW", "ADP", _WHOLE]
_COMPARISONS: Final = ["EQ", "NE", "GT", "LT", "GE", "LE"]
_ORDER: Final = {
    **dict.fromkeys(_COMPARISONS, 1),
    **dict.fromkeys(["+", "-", "OR", "XOR"], 2),
    **dict.fromkeys(["*", "/", "AND", "MOD"], 3),
    "NEGATE": 4,
}
_LOGICAL: Final = {"AND": "BOTH", "OR": "EITHER", "XOR": "ONE"}
# The control takes the first two letters of a name for the whole; POW has no short form, since PO is POPEN.
_SHORT: Final = {name[:2]: name for name in [*_FUNCTIONS, "AND", "XOR"] if name not in ("POW", _WHOLE)}
_NAMES: Final = sorted([*_FUNCTIONS, *_COMPARISONS, "AND", "OR", "XOR", "MOD", *_SHORT], key=len, reverse=True)
_TOKEN: Final = re.compile(rf"({NUMBER})|#([0-9]+)|(#_[A-Z0-9_]+)|({'|'.join(_NAMES)})|([-+*/,#\[\]])")
_SUM, _PRODUCT, _OR, _AND = 1, 2, 4, 8
_FAMILY: Final = {**dict.fromkeys("+-", _SUM), "*": _PRODUCT, "/": _PRODUCT, "MOD": _PRODUCT, "OR": _OR, "XOR": _OR}
_FAMILY["AND"] = _AND
_MIXES: Final = {_AND | _PRODUCT, _AND | _SUM, _OR | _SUM}
_OF_TWO: Final = ["ATAN2", "POW", "DIV", "LEAST", "GREATEST", "JOIN"]
_OPERANDS: Final = {"number": 0, **dict.fromkeys([*_ORDER, *_LOGICAL.values(), *_OF_TWO], 2), "NEGATE": 1}


class _Stop(Exception):  # noqa: N818 - it ends the reading of one expression and never leaves read_expression
    """The fault at which reading ends."""


@dataclass(slots=True)
class _Bracket:
    """An open bracket: the function before it ("#" a variable, "" none), its place, the operators that wait outside."""

    name: str
    at: int
    outside: int
    values: int = 1
    families: int = 0


class _Reader:
    """Values go out at once, an operator waits for those that bind more tightly, a bracket keeps its own apart."""

    def __init__(self, characters: Characters, at: int, levels: int, size: int) -> None:
        self.characters, self.text, self.at = characters, characters.text, at
        self.levels, self.size = levels, size
        self.steps: list[Step] = []
        self.conditions: list[bool] = []  # of each value still to be used: is it a condition
        self.waiting: list[tuple[str, int, int]] = []
        self.brackets = [_Bracket("", at, 0)]
        self.too_deep: Fault | None = None
        self.mixed: tuple[int, int] | None = None

    def stop(self, kind: FaultKind, start: int, end: int = 0) -> _Stop:
        return _Stop(self.characters.fault(kind, start, end))

    def put(self, name: str, number: float, start: int, end: int) -> None:
        """Send a step out. A condition is no number, nor the reverse; AND, OR and XOR take two of either."""
        count = _OPERANDS.get(name, 1)
        used = [self.conditions.pop() for _ in range(count)]
        condition = name in _COMPARISONS
        if name in _LOGICAL and all(used):
            name, condition = _LOGICAL[name], True
        elif any(used):
            raise self.stop("format", start, end)
        if len(self.steps) >= self.size:
            raise self.stop("too-long", self.brackets[0].at, end)
        self.conditions.append(condition)
        self.steps.append(Step(name, number, *self.characters.span(start, end)))

    def settle(self, order: int) -> None:
        """Send out the operators waiting in this bracket that bind at least as tightly."""
        while len(self.waiting) > self.brackets[-1].outside and _ORDER[self.waiting[-1][0]] >= order:
            name, start, end = self.waiting.pop()
            self.put(name, 0.0, start, end)

    def open(self, name: str, at: int) -> None:
        if len(self.brackets) > self.levels and self.too_deep is None:
            self.too_deep = self.characters.fault("bracket-levels", at, self.at)
        if len(self.brackets) > self.size:
            raise self.stop("bracket-levels", at, self.at)
        self.brackets.append(_Bracket(name, at, len(self.waiting)))

    def close(self) -> bool:
        """Take a closing bracket; True where another one of the same function opens: ATAN[..]/[..] is no division."""
        self.settle(0)
        bracket = self.brackets.pop()
        self.at += 1
        name = bracket.name
        if name == "ATAN" and bracket.values == 1 and self.text.startswith("/[", self.at):
            self.at += 2
            self.open("ATAN", bracket.at)
            self.brackets[-1].values = 2
            return True
        if name == "ATAN" and bracket.values == 2:
            name = "ATAN2"
        if name == "POW" and bracket.values == 1:
            raise self.stop("missing-comma", bracket.at, self.at)
        if name:
            self.put(name, 0.0, bracket.at, self.at)
        return False

    def value(self) -> None:
        """Read signs and opening brackets up to and with a number or a variable."""
        signed = False
        while True:
            at, found = self.at, _TOKEN.match(self.text, self.at)
            number, variable, named, name, sign = found.groups() if found else (None,) * 5
            self.at = found.end() if found else at
            name = _SHORT.get(name or "", name)
            if number or variable:
                self.put("number", float(number or variable or 0), at, self.at)
                if variable:
                    self.put("#", 0.0, at, self.at)
                return
            if named:
                self.at = self.end_of_name(at)
                if not self.text.startswith("[", self.at):
                    self.put("number", UNKNOWN, at, self.at)
                    return
                name = "NAMED"
            if sign in ("+", "-") and not signed:
                signed = True
                if sign == "-":
                    self.waiting.append(("NEGATE", at, self.at))
                continue
            if name in _FUNCTIONS and not self.text.startswith("[", self.at):
                raise self.stop("missing-open-bracket", at, self.at)
            if name in _FUNCTIONS or name == "NAMED" or (sign == "#" and self.text.startswith("[", self.at)):
                self.at += 1
            elif sign != "[":
                raise self.stop("format", at, self.at + 1 if sign == "#" else self.at)
            self.open(name or ("#" if sign == "#" else ""), at)
            signed = False

    def end_of_name(self, at: int) -> int:
        """The end of the variable name that starts here: in the block, a blank ends it."""
        places = self.characters.places
        return next((i for i in range(at + 1, self.at) if places[i] != places[i - 1] + 1), self.at)

    def goes_on(self, whole: bool) -> bool:
        """After a value take closing brackets, then what asks for another value; False where the expression ends."""
        while True:
            inside = len(self.brackets) > 1
            if not inside and not whole:
                return False
            at, found = self.at, _TOKEN.match(self.text, self.at)
            name = _SHORT.get(found[0], found[0]) if found else ""
            end = found.end() if found else at
            bracket = self.brackets[-1]
            if name == "]" and inside:
                if self.close():
                    return True
            elif name in _ORDER:
                self.settle(_ORDER[name])
                self.waiting.append((name, at, end))
                bracket.families = bracket.families | _FAMILY[name] if name in _FAMILY else 0
                if self.mixed is None and any(bracket.families & mix == mix for mix in _MIXES):
                    self.mixed = self.characters.span(at, end)
                self.at = end
                return True
            elif name == "," and bracket.name in ("ATAN", "POW") and bracket.values == 1:
                self.settle(0)
                bracket.values, bracket.families, self.at = 2, 0, end
                return True
            elif not inside:
                return False
            elif not name and (at >= len(self.text) or self.text[at].isalpha()):
                raise self.stop("missing-close-bracket", bracket.at, at)
            else:
                raise self.stop("format", at, end)


def read_expression(characters: Characters, at: int, *, whole: bool, levels: int = 5, size: int = 20_000) -> Reading:
    """
    Read the expression that begins at an index of the characters.

    whole: up to where no operator follows, as after `=`; else one value alone, as after an address: a number, a
    variable, a function or a bracket, with or without a sign. levels: brackets within brackets, those of functions and
    of `#[` included; deeper is a fault, but can be calculated. size: bound of steps and of open brackets.
    """
    reader = _Reader(characters, at, levels, size)
    try:
        reader.value()
        while reader.goes_on(whole):
            reader.value()
        reader.settle(0)
    except _Stop as stop:
        return Reading(None, reader.at, stop.args[0])
    span = characters.span(at, reader.at)
    return Reading(
        Expression(tuple(reader.steps), *span, reader.conditions[-1], reader.mixed), reader.at, reader.too_deep
    )


# Calculating ----------------------------------------------------------------------------------------------------------


class Readable(Protocol):
    """Where the values of variables come from; `polarcheck.execution.macro.Variables` is one."""

    def exists(self, number: float) -> bool: ...

    def read(self, number: float) -> Value: ...


def evaluate(
    expression: Expression, variables: Readable, arithmetic: Arithmetic = DEFAULT, increment: float = 1.0
) -> tuple[Value, Fault | None]:
    """
    Calculate; give the value and the first fault. A step at fault gives an unknown value, and the rest goes on.

    increment: what ROUND rounds to: 1 in a macro statement, the least increment of the address in an NC word.
    A variable alone may give vacant; in a calculation vacant counts as 0.
    """
    stack: list[Value] = []
    fault: Fault | None = None
    for name, number, start, end in expression.steps:
        count = _OPERANDS.get(name, 1)
        operands = stack[len(stack) - count :]
        del stack[len(stack) - count :]
        result: Value | FaultKind
        if name == "number":
            result = "overflow" if abs(number) > arithmetic.largest else number
        elif name == "#":
            wanted = operands[0] or 0.0
            if wanted != wanted:
                result = UNKNOWN
            else:
                result = variables.read(wanted) if variables.exists(wanted) else "variable-number"
        else:
            result = calculate(name, operands, arithmetic, increment)
        if isinstance(result, str):
            fault = fault or Fault(result, start, end, (operands[0] or 0.0) if operands else None)
            result = UNKNOWN
        stack.append(result)
    return stack[-1], fault


def decide(
    condition: Expression, variables: Readable, arithmetic: Arithmetic = DEFAULT
) -> tuple[bool | None, Fault | None]:
    """Whether a condition holds: True, False, or None where that is unknown; and the first fault."""
    value, fault = evaluate(condition, variables, arithmetic)
    return (None if value is None or value != value else bool(value)), fault
