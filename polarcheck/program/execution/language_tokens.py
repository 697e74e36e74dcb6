"""The tokens of a block in a language with names, and the expressions among them."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from typing import NamedTuple

import msgspec

from polarcheck.program.execution.expression import Expression, Fault
from polarcheck.program.execution.expression_reader import Following, Operand, Unreadable, read_expression
from polarcheck.program.execution.grammar import Grammar
from polarcheck.program.execution.kinds import FaultKind
from polarcheck.program.execution.macro_tokens import in_capitals
from polarcheck.program.execution.variable_names import Names


class Token(NamedTuple):
    """
    A token and its characters within the block.

    kind: the name of its group in Language.pattern, such as name, letter, number or sign; end behind the last token.
    text: in capitals; of a string without its quotes, as written.
    start, end: its characters within the block, end exclusive.
    """

    kind: str
    text: str
    start: int
    end: int


class Language(msgspec.Struct, frozen=True):
    """
    A language with names.

    pattern: one token, in the group of its kind; a match without a group is no token.
    grammar: of its expressions.
    operand: the meaning of a token, just passed over, where a value is expected; None where no value begins.
    """

    pattern: re.Pattern[str]
    grammar: Grammar
    operand: Callable[[Tokens, Token], Operand | None]

    def tokens_of(self, block: str, limit: int) -> list[Token]:
        """The first tokens of a block without comments, up to a limit, and one of the kind end behind them."""
        capitals = block.upper() if block.isascii() else in_capitals(block)
        tokens = []
        for match in itertools.islice(self.pattern.finditer(capitals), limit):
            kind = match.lastgroup
            start, end = match.span()
            text = block[start + 1 : end].removesuffix('"') if kind == "string" else match[0]
            if kind is not None:
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
    levels: limit of the brackets within brackets of an expression.
    size: limit of the steps and of the open brackets of an expression.
    """

    def __init__(self, block: str, language: Language, names: Names, levels: int, size: int) -> None:
        self.language, self.names, self.levels, self.size = language, names, levels, size
        self.tokens = language.tokens_of(block, size)
        self.at = 0
        self.fault: Fault | None = None
        self.unknown: list[Token] = []

    def token_ahead(self, distance: int) -> Token:
        """The token at a distance behind the next one; the last one where there are not so many."""
        return self.tokens[min(self.at + distance, len(self.tokens) - 1)]

    @property
    def token(self) -> Token:
        """The next token; the last one where all have been passed over."""
        return self.tokens[min(self.at, len(self.tokens) - 1)]

    def take_token(self) -> Token:
        """Pass over the next token; return it."""
        token = self.token
        self.at += 1
        return token

    def is_sign(self, sign: str, ahead: int = 0) -> bool:
        """True where the next token, or the one at this distance behind it, is this sign."""
        token = self.token_ahead(ahead)
        return token.kind == "sign" and token.text == sign

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
            last = self.take_token()
            if last.kind == "sign":
                depth += (last.text in "([") - (last.text in ")]")
                if depth <= 0:
                    break
        return last

    @property
    def last_end(self) -> int:
        """The end of the token before the next one."""
        return self.tokens[max(self.at - 1, 0)].end

    def begins_value(self) -> bool:
        """True where the next token begins a value."""
        at = self.at
        self.at += 1
        operand = self.language.operand(self, self.tokens[at])
        self.at = at
        return operand is not None

    def expression(self) -> Expression | None:
        """Read an expression; None where it cannot be calculated, and then the rest of the block is passed over."""
        expression, fault = read_expression(self, self.language.grammar, levels=self.levels, size=self.size)
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
        at, token = self.at, self.token
        self.at += 1
        operand = self.language.operand(self, token)
        if operand is None:
            self.at = at
            raise Unreadable(Fault("format", *self.span(token.start, token.end)))
        return operand

    def following(self) -> Following:
        token = self.token
        return Following(token.text if token.kind in ("sign", "name") else "", token.start, token.end)

    def pass_over(self, token: Following) -> None:
        self.at += 1

    def take(self, text: str) -> int | None:
        return self.token.start if self.take_sign(text) else None

    def unclosed(self, start: int, token: Following) -> Fault:
        return Fault("missing-close-bracket", *self.span(start, self.last_end))
