"""
The tokens of custom macro: `#1*SIN[#2+30]`, and the grammar of its expressions.

Sources: FANUC B-62754EN/01, chapter 16.3 and p. 287 (five levels of brackets). That AND ranks with * and OR with + is
the manuals' order as remembered; another order is taught as well, hence Grammar.doubtful.
"""

from __future__ import annotations

import re
from typing import Final

from polarcheck.program.execution.arithmetic import UNKNOWN
from polarcheck.program.execution.expression import Fault
from polarcheck.program.execution.expression_reader import Following, Operand, Unreadable
from polarcheck.program.execution.grammar import AND, DOUBTFUL, OR, PRODUCT, SUM, Function, Grammar, Operator
from polarcheck.program.execution.kinds import FaultKind

NUMBER: Final = r"[0-9]++\.?+[0-9]*+|\.[0-9]++"
_FUNCTION_NAMES: Final = (
    *("SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "SQRT", "ABS", "ROUND", "FIX", "FUP", "LN", "EXP", "BIN", "BCD"),
    *("POW", "ADP"),
)
GRAMMAR: Final = Grammar(
    operators={
        **{name: Operator(1, name) for name in ("EQ", "NE", "GT", "LT", "GE", "LE")},
        **{sign: Operator(2, sign, SUM) for sign in "+-"},
        **{name: Operator(2, name, OR) for name in ("OR", "XOR")},
        **{name: Operator(3, name, PRODUCT) for name in ("*", "/", "MOD")},
        "AND": Operator(3, "AND", AND),
    },
    prefixes={"+": None, "-": Operator(4, "NEGATE")},
    functions={
        **{name: Function({1: (name,)}, "]") for name in _FUNCTION_NAMES},
        "ATAN": Function({1: ("ATAN",), 2: ("ATAN2",)}, "]", again="/["),
        "POW": Function({2: ("POW",)}, "]"),
        "#": Function({1: ("#",)}, "]"),
        "#_": Function({1: ("NAMED",)}, "]"),
        "": Function({1: ()}, "]"),
    },
    doubtful=DOUBTFUL,
    checks_conditions=True,
)
# The control takes the first two letters of a name for the whole; POW has no short form, since PO is POPEN.
_SHORT: Final = {name[:2]: name for name in [*_FUNCTION_NAMES, "AND", "XOR"] if name != "POW"}
# Functions and operators of letters, also in their short forms, the longer first.
_NAMES: Final = sorted(
    [*_FUNCTION_NAMES, *(name for name in GRAMMAR.operators if name.isalpha()), *_SHORT], key=len, reverse=True
)
#: A token of an expression; name: a function or an operator of letters.
TOKEN: Final = re.compile(
    rf"(?P<number>{NUMBER})|(?P<variable>#[0-9]+)|(?P<system>#_[A-Z0-9_]+)|(?P<name>{'|'.join(_NAMES)})"
    r"|(?P<sign>[-+*/,=#\[\]])"
)

_CAPITALS: Final = {ord(letter): ord(letter) - 32 for letter in "abcdefghijklmnopqrstuvwxyz"}


def in_capitals(text: str) -> str:
    """The text with the letters a to z in capitals; its length does not change, which upper() does not promise."""
    return text.translate(_CAPITALS)


def is_operator(name: str) -> bool:
    """Return True for the characters of an operator, also in a short form: `AN` is AND."""
    return _SHORT.get(name, name) in GRAMMAR.operators


class Characters:
    """
    The characters of a block without blanks.

    text: in capitals.
    places: the index within the block of each character.
    """

    __slots__ = ("places", "text")

    def __init__(self, text: str, places: list[int]) -> None:
        self.text, self.places = text, places

    @classmethod
    def of_block(cls, block: str) -> Characters:
        """The characters of a block as it is written."""
        places = [match.start() for match in re.finditer(r"[^\s\0]", block)]
        return cls(in_capitals("".join([block[index] for index in places])), places)

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


class MacroLexer:
    """
    The tokens of an expression of custom macro.

    at: the index within the characters of the next one; positions are such indices.
    """

    def __init__(self, characters: Characters, start: int) -> None:
        self.characters, self.text, self.at = characters, characters.text, start

    @property
    def start(self) -> int:
        return self.at

    def span(self, start: int, end: int) -> tuple[int, int]:
        return self.characters.span(start, end)

    def operand(self) -> Operand:
        start, match = self.at, TOKEN.match(self.text, self.at)
        number, variable, system_variable, name, sign = match.groups() if match else (None,) * 5
        self.at = match.end() if match else start
        function = _SHORT.get(name or "", name)
        if number or variable:
            kind = "variable" if variable else "number"
            return Operand(kind, "", float(number or (variable or "")[1:] or 0), start, self.at)
        if sign in ("+", "-"):
            return Operand("prefix", sign, 0.0, start, self.at)
        if system_variable:
            self.at = self._end_of_name(start)
            if self.take("[") is None:
                return Operand("number", "", UNKNOWN, start, self.at)
            function = "#_"
        elif function in GRAMMAR.functions:
            if self.take("[") is None:
                raise Unreadable(self.characters.fault("missing-open-bracket", start, self.at))
        elif sign == "#" and self.take("[") is not None:
            function = "#"
        elif sign == "[":
            function = ""
        else:
            raise Unreadable(self.characters.fault("format", start, self.at + 1 if sign == "#" else self.at))
        return Operand("open", function or "", 0.0, start, self.at)

    def _end_of_name(self, start: int) -> int:
        """The end of the variable name that starts at an index: a blank in the block ends it."""
        places = self.characters.places
        return next((i for i in range(start + 1, self.at) if places[i] != places[i - 1] + 1), self.at)

    def following(self) -> Following:
        match = TOKEN.match(self.text, self.at)
        if match is None:
            return Following("", self.at, self.at)
        return Following(_SHORT.get(match[0], match[0]), self.at, match.end())

    def pass_over(self, token: Following) -> None:
        self.at = token.end

    def take(self, text: str) -> int | None:
        if not self.text.startswith(text, self.at):
            return None
        self.at += len(text)
        return self.at

    def unclosed(self, start: int, token: Following) -> Fault:
        end = token.start
        if not token.text and (end >= len(self.text) or self.text[end].isalpha()):
            return self.characters.fault("missing-close-bracket", start, end)
        return self.characters.fault("format", end, token.end)
