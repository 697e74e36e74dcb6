"""The tokens of blocks with statements, by the language of the control, in the classes that editors tell apart."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from polarcheck.program.execution.custom_macro import KEYWORD
from polarcheck.program.execution.flow_keywords import KEYWORDS, SEARCHES, TYPES
from polarcheck.program.execution.high_level import is_custom_macro
from polarcheck.program.execution.high_level_tokens import GRAMMAR, HIGH_LEVEL
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.macro_tokens import TOKEN, Characters, is_operator
from polarcheck.program.execution.programs import block_text
from polarcheck.program.execution.task_tokens import FLOW, SEQUENCE_NAME, SYSTEM, USER_TASK
from polarcheck.program.execution.task_tokens import GRAMMAR as TASK_GRAMMAR

#: The most tokens of a block.
_MOST: Final = 5_000


class Token(NamedTuple):
    """
    A token and its characters in the text.

    kind: address (a letter), number, variable, system (a variable of the control), keyword, operator, function, string,
    label (where it stands), target (a label that a jump names), name (of a program or anything else), computed (the
    sign before the brackets of a variable whose number is computed).
    text: in capitals, without blanks.
    start, end: its characters within the text, end exclusive.
    """

    kind: str
    text: str
    start: int
    end: int


def tokens(listing: Listing, block: int, text: str | None = None) -> list[Token]:
    """Return the tokens of a block, without comments; text: of the block, if it is at hand (programs.block_text)."""
    written, language = block_text(listing.text, block) if text is None else text, listing.macro.language
    lexed: Iterable[Token]
    if language == "high-level" and not is_custom_macro(written):
        lexed = _high_level(written, listing)
    elif language == "user-task":
        lexed = _user_task(written, listing)
    else:
        lexed = _custom_macro(written)
    start = int(listing.text.blocks.start[block])
    return [Token(kind, name, begin + start, end + start) for kind, name, begin, end in lexed]


# ---- custom macro ----

#: What stands in a block besides expressions.
_WORD: Final = re.compile(rf"(?P<keyword>{KEYWORD.pattern})|(?P<address>,?[A-Z]|:)|(?P<name><[^>]*>)")
_VALUES: Final = ("variable", "number", "system", "]")


@functools.lru_cache(20_000)
def _custom_macro(block: str) -> tuple[Token, ...]:
    """Return the tokens of a block; remembered, since a key press changes one block of many."""
    return tuple(_custom_macro_tokens(block))


def _custom_macro_tokens(block: str) -> Iterator[Token]:
    characters = Characters.of_block(block)
    text, places, position, last, count = characters.text, characters.places, 0, "", 0
    while position < len(text) and count < _MOST:
        kind, end = _kind_in_custom_macro(text, position, last in _VALUES)
        if kind:
            if kind not in ("[", "]"):
                yield Token(kind, text[position:end], places[position], places[end - 1] + 1)
            last, count = kind, count + 1
        position = end


def _kind_in_custom_macro(text: str, start: int, follows_value: bool) -> tuple[str, int]:
    """Return the kind and the end of a token; a bracket is its own kind, and "" stands for no token."""
    match = TOKEN.match(text, start)
    kind, end = (match.lastgroup or "", match.end()) if match else ("", start)
    written = text[start:end]
    if kind == "name":
        # A word such as M0 begins like an operator where no value stands before it.
        kind = "function" if text.startswith("[", end) else "operator" if follows_value and is_operator(written) else ""
    elif kind == "sign":
        number = TOKEN.match(text, end) if written in "+-" and not follows_value else None
        if number is not None and number["number"]:
            return "number", number.end()
        kind = {"#": "computed", "[": "[", "]": "]", ",": ""}.get(written, "operator")
    if kind:
        return kind, end
    match = _WORD.match(text, start)
    return (match.lastgroup or "", match.end()) if match else ("", start + 1)


# ---- a high-level language ----


def _high_level(block: str, listing: Listing) -> Iterator[Token]:
    lexed = HIGH_LEVEL.tokens_of(block, _MOST)
    letter = listing.macro.parameter_letter
    skips = 0
    for index, token in enumerate(lexed[:-1]):
        if skips:
            skips -= 1
            continue
        last, following = lexed[index - 1] if index else None, lexed[index + 1]
        if token.kind == "name":
            kind = _kind_of_name(token.text, following.text, listing)
            is_led_to = last is not None and kind == "name" and last.text in SEARCHES
            yield Token("target" if is_led_to else kind, *token[1:])
        elif token.kind == "letter":
            is_value = last is not None and (
                (last.kind == "sign" and last.text not in ")]:") or (last.kind == "name" and last.end < token.start)
            )
            is_target = index + 2 < len(lexed) and lexed[index + 2].text == "="
            if token.text == letter and following.kind == "number" and (is_value or is_target):
                skips = 1
                yield Token("variable", f"{token.text}{following.text}", token.start, following.end)
            elif token.text == letter and following.text == "[":
                yield Token("computed", *token[1:])
            elif listing.names.is_declared(token.text):
                yield Token("variable", *token[1:])
            else:
                yield Token("address", *token[1:])
        elif token.kind in ("number", "coded"):
            yield Token("number", *token[1:])
        elif token.kind == "string":
            yield Token("string", *token[1:])
        elif token.kind == "sign" and token.text not in ("(", ")", "[", "]", ",", ":"):
            yield Token("operator", *token[1:])


def _kind_of_name(name: str, following: str, listing: Listing) -> str:
    if name[:1] == "$":
        return "system"
    if following == ":":
        return "label"
    if listing.names.is_declared(name):
        return "variable"
    if name in KEYWORDS or name in TYPES or name in ("TO", "OF", "DEFAULT"):
        return "keyword"
    if name in GRAMMAR.operators or name in GRAMMAR.prefixes:
        return "operator"
    if name in GRAMMAR.functions:
        return "function"
    return "name"


# ---- user tasks ----


def _user_task(block: str, listing: Listing) -> Iterator[Token]:
    lexed = USER_TASK.tokens_of(block, _MOST)
    skips = depth = 0
    is_head = True
    for index, token in enumerate(lexed[:-1]):
        if skips:
            skips -= 1
            continue
        last, following = lexed[index - 1] if index else None, lexed[index + 1]
        is_target = following.text == "="
        if token.kind == "sign":
            depth += {"[": 1, "]": -1}.get(token.text, 0)
            if token.text not in "[],":
                yield Token("operator", token.text, token.start, token.end)
        elif token.kind == "number":
            yield Token("number", token.text, token.start, token.end)
        elif token.kind == "letter" and token.text == "V" and following.kind == "number":
            skips = 1
            yield Token("variable", f"V{following.text}", token.start, following.end)
        elif token.kind == "letter":
            yield Token("address", token.text, token.start, token.end)
        elif token.kind == "name":
            in_value = depth > 0 or (last is not None and last.kind == "sign" and last.text in "=+-*/,[")
            kind = _kind_of_task(token.text, listing, is_target, in_value)
            yield Token("label" if kind == "target" and is_head else kind, token.text, token.start, token.end)
        is_head = is_head and token.text in "/123456789"


def _kind_of_task(name: str, listing: Listing, is_target: bool, in_value: bool) -> str:
    if name in FLOW:
        return "keyword"
    if SYSTEM.fullmatch(name):
        return "system"
    if name in TASK_GRAMMAR.operators:
        return "operator"
    if in_value and name in TASK_GRAMMAR.functions:
        return "function"
    if name.startswith("VC") and name[2:].isdigit():
        return "variable"
    if is_target:
        return "address" if name in listing.macro.named_words else "variable"
    if in_value:
        return "variable"
    return "target" if SEQUENCE_NAME.fullmatch(name) else "name"
