"""The word at the cursor, as the control of the machine reads it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
from lsprotocol import types

from polarcheck.editor.analysis import Analysis
from polarcheck.editor.structure.lexing import Token, tokens
from polarcheck.program.execution.listing import Listing
from polarcheck.program.reading.words import Spans, Text

_NUMBER = re.compile(r"[-+]?\d{0,15}+\.?\d{0,15}+", re.ASCII)


class CursorWord(NamedTuple):
    """
    A word, a variable or a name.

    kind: word, variable or name.
    letter: the address of a word; the name of a variable or of anything else.
    value: the number behind the address as it is written; None where it is computed, or cannot be read.
    has_point: the number has a decimal point.
    block: index into the blocks of the text.
    start, end: its characters in the text, end exclusive.
    text: the text, as it was read.
    """

    kind: str
    letter: str
    value: float | None
    has_point: bool
    block: int
    start: int
    end: int
    text: Text

    @property
    def line(self) -> int:
        """Return the line of its block."""
        return int(self.text.blocks.line[self.block])


def word_at(analysis: Analysis, position: types.Position) -> CursorWord | None:
    """Return the word at a position; None in a comment, between words, and in other files."""
    character = analysis.text.character_of(position)
    for text in analysis.texts:
        block = block_of(text, character)
        if block is None or is_in(character, text.comments, block):
            continue
        words = list(_words(text, block, analysis))
        # Between two words without a blank the cursor stands before the second one.
        inside = [word for word in words if word.start <= character < word.end]
        touched = inside or [word for word in words if word.end == character]
        if touched:
            return touched[-1]
    return None


def block_of(text: Text, character: int) -> int | None:
    """Return the block at a character; None if it is not in the document itself."""
    block = int(np.searchsorted(text.blocks.start, character, side="right")) - 1
    if block < 0 or character > int(text.blocks.end[block]) + 1:
        return None
    parts = text.source.parts
    return None if parts and int(text.blocks.line[block]) >= parts[0].first_line else block


def is_in(character: int, spans: Spans, block: int) -> bool:
    """Return True for a character within one of the spans of a block."""
    low, high = np.searchsorted(spans.block, (block, block + 1)).tolist()
    return any(spans.start[index] < character < spans.end[index] for index in range(low, high))


def _words(text: Text, block: int, analysis: Analysis) -> Iterator[CursorWord]:
    """Yield the words of a block."""
    if text.blocks.is_macro[block]:
        assert analysis.settings is not None
        yield from _of_tokens(tokens(Listing([text], analysis.settings.machine), block), block, text)
        return
    words = text.words
    low, high = np.searchsorted(words.block, (block, block + 1)).tolist()
    for index in range(low, high):
        code = int(words.address[index])
        letter = chr(code) if code < ord("a") else f",{chr(code - 32)}"
        value = float(words.value[index])
        yield CursorWord(
            "word",
            letter if code else "",
            value if value == value else None,
            bool(words.has_point[index]),
            block,
            int(words.start[index]),
            int(words.end[index]),
            text,
        )


def _of_tokens(lexed: Iterable[Token], block: int, text: Text) -> Iterator[CursorWord]:
    """Yield the words, variables and names of a block with statements; a letter takes the number behind it."""
    letter: Token | None = None
    for token in lexed:
        if letter is not None:
            value = _value(token.text) if token.kind == "number" else None
            end = token.end if value is not None else letter.end
            has_point = value is not None and "." in token.text
            yield CursorWord("word", letter.text, value, has_point, block, letter.start, end, text)
        letter = token if token.kind == "address" else None
        if token.kind in ("variable", "system"):
            yield CursorWord("variable", token.text, None, False, block, token.start, token.end, text)
        elif token.kind in ("name", "keyword", "function"):
            yield CursorWord("name", token.text, None, False, block, token.start, token.end, text)
    if letter is not None:
        yield CursorWord("word", letter.text, None, False, block, letter.start, letter.end, text)


def _value(text: str) -> float | None:
    number = text.replace(" ", "")
    return float(number) if _NUMBER.fullmatch(number) and any(map(str.isdecimal, number)) else None
