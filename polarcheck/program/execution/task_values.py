"""
Values in user tasks, read as the expressions of custom macro: VC1*2+DIA, MOD[V1,2], [VC1 EQ 1] AND [LX GT 0].

Sources: public notes on the manuals of OSP-P200L, 5238-E, and OSP-P300L (source 71138944758): V1, local
variables by name, VTOFX[5]; the operators and functions from help.icam.com, Okuma pre-processor.
"""

from __future__ import annotations

import itertools
import re
from typing import Final, TypeAlias

import msgspec

from polarcheck.program.execution.macro_tokens import in_capitals
from polarcheck.program.execution.statement import Unread
from polarcheck.program.execution.variable_names import Names
from polarcheck.program.reading.excerpt import shortened

#: Characters of custom macro, and the places in the block for which they stand.
Piece: TypeAlias = tuple[str, int, int]

#: V1 is the variable of this number more, so that it is another one than VC1.
_COMMON: Final = 100_000
#: The number of any variable of the system: none of their values is known.
UNKNOWN: Final = 200_000
#: More parts of a block than any control takes; and how much of one a message names [characters].
MOST: Final = 20_000
_NAMED: Final = 60

_TOKEN: Final = re.compile(
    r"(?P<number>[0-9]++\.?+[0-9]*+|\.[0-9]++)|(?P<name>VC[0-9]++|[A-Z][A-Z][A-Z0-9]*+)|(?P<letter>[A-Z])"
    r"|(?P<sign>[-+*/=,\[\]])|(?P<other>[^\s\0])"
)
_COMPARISONS: Final = frozenset(("EQ", "NE", "GT", "LT", "GE", "LE"))
_JOINS: Final = {"AND": "AND", "OR": "OR", "EOR": "XOR"}
_FUNCTIONS: Final = {
    **{name: name for name in ("SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "SQRT", "ABS", "FIX", "FUP", "BIN", "BCD")},
    "ATAN2": "ATAN",
    "ROUND": "@ROUND",
}
#: Functions whose value is not known: DROUND rounds to the unit of the machine, NOT depends on the bits of a number.
_NOT_CALCULATED: Final = frozenset(("NOT", "DROUND", "DFIX", "DFUP"))
#: Statements of the flow.
FLOW: Final = ("IF", "GOTO", "CALL", "MODIN", "MODOUT", "RTS")
#: Names that are neither variables nor functions.
NO_VALUES: Final = _COMPARISONS | {*_JOINS, "MOD", *FLOW, "NOEX"}
SEQUENCE_NAME: Final = re.compile(r"N[A-Z][A-Z0-9]{0,3}")
#: VZOFX, VTOFX[5]: a variable of the system.
SYSTEM: Final = re.compile(r"V(?!C[0-9])[A-Z][A-Z0-9]*+")


def is_function(name: str) -> bool:
    """Return True for the name of a function, also of one whose value is not calculated."""
    return name in _FUNCTIONS or name in _NOT_CALCULATED or name == "MOD"


class Token(msgspec.Struct, frozen=True):
    """
    A token and its characters within the block.

    kind: number, name, letter (alone), sign, other; "" behind the last token.
    text: in capitals.
    start, end: its characters within the block, end exclusive.
    """

    kind: str
    text: str
    start: int
    end: int

    @property
    def piece(self) -> Piece:
        """The token as it is written."""
        return self.text, self.start, self.end


class _Open:
    """
    A bracket of an expression.

    part: where its part between AND and OR begins. closing: what closes it. comma: what stands for the comma in it, if
    it takes one. compares, joins: whether that part compares, and whether AND or OR joins parts.
    """

    def __init__(self, closing: str = "", comma: str = "") -> None:
        self.part, self.closing, self.comma = 0, closing, comma
        self.compares = self.joins = False


class Values:
    """
    The tokens of a block while they are read, and the values among them; at: the index of the next token.

    unread: what is not simulated.
    """

    def __init__(self, block: str, names: Names) -> None:
        self.block, self.names = block, names
        found = itertools.islice(_TOKEN.finditer(_without_continuations(in_capitals(block))), MOST + 1)
        self.tokens = [Token(one.lastgroup or "", one[0], *one.span()) for one in found]
        self.at = 0
        self.unread: list[Unread] = []

    # ---- tokens ----

    def peek(self, ahead: int = 0) -> Token:
        """A token from here on; one of no kind behind the last."""
        at = self.at + ahead
        return self.tokens[at] if at < len(self.tokens) else Token("", "", len(self.block), len(self.block))

    def take(self) -> Token:
        self.at += 1
        return self.tokens[self.at - 1]

    def is_sign(self, sign: str, ahead: int = 0) -> bool:
        return self.peek(ahead).kind == "sign" and self.peek(ahead).text == sign

    def leave(self, first: int, *, moves: bool, matters: bool = True, name: str = "") -> None:
        """Name the tokens from the first to the next one as not simulated."""
        start, end = self.tokens[first].start, self.tokens[max(self.at - 1, first)].end
        told = name or " ".join(self.block[start:end].split())
        self.unread.append(Unread(shortened(told, _NAMED), start, end, moves, matters))

    @staticmethod
    def variable_number(name: str, number: Token | None = None) -> int | None:
        """The number that stands for VC5, or for V and a number; None for another name."""
        digits = number.text if number else name[2:]
        if not digits.isdecimal():
            return None
        value = int(digits[:12])
        return value + _COMMON if number else value or None

    # ---- expressions ----

    def expression(self, *, one: bool = False) -> list[Piece] | None:
        """
        The expression that comes next, in the characters of custom macro, with their places; None where there is none.

        one: of one pair of brackets. Comparisons bind more tightly than AND and OR here.
        """
        pieces: list[Piece] = []
        opens = [_Open()]
        self.begin_part(pieces, opens[-1])
        wants_value = True
        first = self.at
        while self.at < len(self.tokens):
            token = self.peek()
            if wants_value:
                step = self.value(pieces, opens)
                if step is None:
                    break
                wants_value = step
            elif token.kind == "sign" and token.text in "+-*/":
                pieces.append(self.take().piece)
                wants_value = True
            elif token.kind == "sign" and token.text == "]" and len(opens) > 1:
                self.end_part(pieces, opens[-1], token)
                pieces.append((opens.pop().closing, token.start, token.end))
                self.at += 1
                if one and len(opens) == 1:
                    break
            elif token.kind == "sign" and token.text == "," and opens[-1].comma:
                pieces.append((opens[-1].comma, token.start, token.end))
                opens[-1].comma = ""
                opens[-1].closing = opens[-1].closing.removeprefix("MOD")
                self.at += 1
                wants_value = True
            elif token.kind == "name" and (token.text in _COMPARISONS or token.text == "MOD"):
                opens[-1].compares |= token.text != "MOD"
                pieces.append(self.take().piece)
                wants_value = True
            elif token.kind == "name" and token.text in _JOINS:
                opens[-1].joins = True
                self.end_part(pieces, opens[-1], token)
                pieces.append((_JOINS[token.text], token.start, token.end))
                self.at += 1
                self.begin_part(pieces, opens[-1])
                wants_value = True
            else:
                break
        if self.at == first:
            return None
        self.end_part(pieces, opens[0], self.tokens[self.at - 1])
        return [piece for piece in pieces if piece[0]]

    @staticmethod
    def begin_part(pieces: list[Piece], bracket: _Open) -> None:
        bracket.part, bracket.compares = len(pieces), False
        pieces.append(("", 0, 0))

    @staticmethod
    def end_part(pieces: list[Piece], bracket: _Open, at: Token) -> None:
        """Put brackets round a comparison that AND or OR joins with another."""
        if bracket.joins and bracket.compares:
            _, start, _ = pieces[bracket.part + 1] if bracket.part + 1 < len(pieces) else ("", at.start, at.end)
            pieces[bracket.part] = ("[", start, start + 1)
            pieces.append(("]", at.start, at.end))

    def value(self, pieces: list[Piece], opens: list[_Open]) -> bool | None:
        """Take a sign, an opening bracket or a value; whether one is still wanted, None where none stands here."""
        token, following = self.peek(), self.peek(1)
        if token.kind == "sign" and token.text in "+-":
            pieces.append(self.take().piece)
            return True
        if self.is_sign("["):
            self.open(pieces, opens, "[", "]")
            return True
        if token.kind == "number":
            pieces.append(self.take().piece)
            return False
        if token.kind == "letter" and token.text == "V" and following.kind == "number":
            self.at += 2
            number = self.variable_number("V", following)
            pieces.append((f"#{number}" if number is not None else f"#{UNKNOWN}", token.start, following.end))
            return False
        if token.kind != "name":
            return None
        if token.text == "NOT" and not self.is_sign("[", 1):
            self.at += 1
            pieces.append((f"#{UNKNOWN}+0*", token.start, token.end))
            return True
        if self.is_sign("[", 1) and is_function(token.text):
            self.function(pieces, opens)
            return True
        if token.text in _FUNCTIONS or token.text in NO_VALUES:
            return None
        self.at += 1
        if SYSTEM.fullmatch(token.text):
            if self.is_sign("["):
                opening = (f"#[{UNKNOWN}+0*[", token.start, token.end)
                self.open(pieces, opens, *opening[:1], "]]")
                return True
            pieces.append((f"#{UNKNOWN}", token.start, token.end))
            return False
        number = self.variable_number(token.text) if token.text.startswith("VC") else None
        number = self.names.variable(token.text) if number is None else number
        pieces.append((f"#{number}", token.start, token.end))
        return False

    def open(self, pieces: list[Piece], opens: list[_Open], text: str, closing: str) -> None:
        token = self.take()
        pieces.append((text, token.start, token.end))
        opens.append(_Open(closing))
        self.begin_part(pieces, opens[-1])

    def function(self, pieces: list[Piece], opens: list[_Open]) -> None:
        """A name with its opening bracket. MOD[a,b] is a MOD b; what is not calculated has no known value."""
        first, name = self.at, self.take().text
        if name == "MOD":
            self.open(pieces, opens, "[[", "MOD]]")
            opens[-1].comma = "]MOD["
            return
        if name in _NOT_CALCULATED:
            self.open(pieces, opens, f"#[{UNKNOWN}+0*[", "]]")
            return
        pieces.append((_FUNCTIONS[name], self.tokens[first].start, self.tokens[first].end))
        self.open(pieces, opens, "[", "]")
        if name == "ATAN2":
            opens[-1].comma = ","


def _without_continuations(text: str) -> str:
    """The block without the $ with which its lines go on."""
    return re.sub(r"(?<=\n)([ \t\r\0]*+)\$", r"\1 ", text) if "\n" in text else text
