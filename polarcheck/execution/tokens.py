"""The tokens of a block of a high-level language: names, letters, numbers, strings and signs, each with its place."""

from __future__ import annotations

import itertools
import re
from typing import Final, NamedTuple

from polarcheck.execution.expression import in_capitals

#: A name has two letters at least, so that X10Y5 is no name; what else stands alone is a letter.
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


class Token(NamedTuple):
    """
    One token and its characters within the block.

    kind: string, coded ('H1F'), number, name, letter, sign, other, or end behind the last. text: in capitals; of a
    string without its quotes, as written.
    """

    kind: str
    text: str
    start: int
    end: int


def tokens(block: str, most: int) -> list[Token]:
    """The tokens of a block without comments, no more than so many, and one of the kind end behind them."""
    capitals = block.upper() if block.isascii() else in_capitals(block)
    found = []
    for match in itertools.islice(_TOKEN.finditer(capitals), most):
        kind = match.lastgroup or ""
        start, end = match.span()
        text = block[start + 1 : end].removesuffix('"') if kind == "string" else match[0]
        found.append(Token(kind, text, start, end))
    last = len(block.rstrip())
    return [*found, Token("end", "", max(last - 1, 0), last)]
