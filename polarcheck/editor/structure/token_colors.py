"""Semantic colors: what each word of a program is, as the control of the machine reads it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from lsprotocol import types
from numpy.typing import NDArray

from polarcheck.editor.color_names import KINDS
from polarcheck.editor.structure.document import Document, block_at
from polarcheck.editor.structure.lexing import Token, tokens
from polarcheck.program.execution.listing import Listing
from polarcheck.program.reading.words import Spans, Text

Positions = NDArray[np.signedinteger[Any]]

_KIND = {name: number for number, name in enumerate(KINDS)}
_DECLARATION, _SKIPPED, _READONLY = 1, 2, 4
#: The kind of a word by its address: codes are one token, of other words the letter and the number are two.
_WHOLE = {ord("G"): "function", ord("M"): "method", ord("N"): "label", ord("O"): "namespace"}
_LETTERS = {**dict.fromkeys(b"FS", "parameter"), ord("T"): "enumMember", ord("/"): "keyword"}
_OF_LEXING = {
    "address": "property",
    "system": "variable",
    "computed": "variable",
    "target": "label",
    "name": "namespace",
    **{name: name for name in ("number", "variable", "keyword", "operator", "function", "string", "label")},
}
#: A function of an expression is colored as a keyword: the kind "function" is that of G codes.
_OF_LEXING["function"] = "keyword"


def full(document: Document) -> list[int]:
    """Return the tokens of the whole text, as the protocol encodes them."""
    return _encoded(document, 0, len(document.text.text))


def within(document: Document, visible: types.Range) -> list[int]:
    """Return the tokens of the lines of a range."""
    first = document.text.offset(types.Position(visible.start.line, 0))
    last = document.text.offset(types.Position(visible.end.line + 1, 0))
    return _encoded(document, first, last)


def difference(before: Sequence[int], after: Sequence[int]) -> list[types.SemanticTokensEdit]:
    """Return the edit that turns the numbers of one answer into those of the next one; empty where they are equal."""
    old, new = np.array(before, np.int64), np.array(after, np.int64)
    shorter = min(len(old), len(new))
    differs = np.flatnonzero(old[:shorter] != new[:shorter])
    begin = int(differs[0]) if len(differs) else shorter
    if begin == len(old) == len(new):
        return []
    remaining = shorter - begin
    differs = np.flatnonzero(old[len(old) - remaining :][::-1] != new[len(new) - remaining :][::-1])
    same = int(differs[0]) if len(differs) else remaining
    return [types.SemanticTokensEdit(begin, len(old) - same - begin, list(after[begin : len(after) - same]))]


def _encoded(document: Document, first: int, last: int) -> list[int]:
    """Return the tokens from one offset to another one: five numbers each, relative to the token before."""
    lead = document.text.place_of(0)
    columns = [_of_listing(listing, first - lead, last - lead) for listing in document.listings]
    starts, ends, kinds, modifiers = (np.concatenate(parts) for parts in zip(*columns, strict=True))
    order = np.lexsort((ends, starts))
    starts, ends, kinds, modifiers = starts[order] + lead, ends[order] + lead, kinds[order], modifiers[order]
    # Channels share what stands before the first of them; and no token reaches into the next one.
    fresh = np.append(True, starts[1:] > starts[:-1]) if len(starts) else np.zeros(0, bool)
    starts, ends, kinds, modifiers = starts[fresh], ends[fresh], kinds[fresh], modifiers[fresh]
    ends[:-1] = np.minimum(ends[:-1], starts[1:])
    lines, characters, lengths = document.text.columns(starts, ends)
    wide = lengths > 0
    lines, characters, lengths = lines[wide], characters[wide], lengths[wide]
    after = np.diff(lines, prepend=0)
    relative = np.where(after == 0, np.diff(characters, prepend=0), characters)
    table = np.stack((after, relative, lengths, kinds[wide], modifiers[wide]), axis=1)
    return [int(number) for number in table.ravel().tolist()]


def _of_listing(listing: Listing, first: int, last: int) -> tuple[Positions, Positions, Positions, Positions]:
    """Return starts, ends, kinds and modifiers of the tokens of a channel, for the blocks between two characters."""
    text = listing.text
    low = block_at(listing, first)
    high = int(np.searchsorted(text.blocks.start, last, side="left"))
    rows = [_words(text, low, high)]
    for spans, kind in ((text.comments, "comment"), (text.prose, "comment"), (text.names, "namespace")):
        rows.append(_of_spans(spans, low, high, _KIND[kind], _DECLARATION if kind == "namespace" else 0))
    rows.append(_of_spans(text.labels, low, high, _KIND["label"], _DECLARATION))
    macro = np.flatnonzero(text.blocks.is_macro[low:high]) + low
    rows.append(_rows(_of_statement(tokens(listing, int(block))) for block in macro))
    starts, ends, kinds, modifiers = (np.concatenate(parts) for parts in zip(*rows, strict=True))
    return starts, ends, kinds, modifiers | _skipped(listing, starts, low, high)


def _words(text: Text, low: int, high: int) -> tuple[Positions, ...]:
    words = text.words
    begin, end = np.searchsorted(words.block, (low, high)).tolist()
    address, start, stop = words.address[begin:end], words.start[begin:end], words.end[begin:end]
    is_corner = address >= ord("a")
    letter = np.full(256, _KIND["property"])
    letter[0] = _KIND["number"]
    for table in (_WHOLE, _LETTERS):
        for code, kind in table.items():
            letter[code] = _KIND[kind]
    is_whole = np.isin(address, [0, *_WHOLE])
    kinds = letter[address]
    after = np.where(is_whole, stop, start + 1 + is_corner)
    declared = np.where(np.isin(address, list(b"NO")), _DECLARATION, 0)
    has_number = ~is_whole & (stop > after)
    return (
        np.concatenate((start, after[has_number])),
        np.concatenate((after, stop[has_number])),
        np.concatenate((kinds, np.full(int(has_number.sum()), _KIND["number"]))),
        np.concatenate((declared, np.zeros(int(has_number.sum()), np.int64))),
    )


def _of_spans(spans: Spans, low: int, high: int, kind: int, modifiers: int) -> tuple[Positions, ...]:
    begin, end = np.searchsorted(spans.block, (low, high)).tolist()
    count = end - begin
    return spans.start[begin:end], spans.end[begin:end], np.full(count, kind), np.full(count, modifiers)


def _of_statement(tokens: Sequence[Token]) -> Iterable[tuple[int, int, int, int]]:
    """Yield the tokens of a block with statements; G, M, N and O and the number behind them are one."""
    skips = False
    for token, following in itertools.zip_longest(tokens, tokens[1:]):
        if skips:
            skips = False
            continue
        code = ord(token.text[0]) if token.kind == "address" and len(token.text) == 1 else 0
        if code in _WHOLE and following is not None and following.kind == "number":
            skips = True
            is_head = code in b"NO" and all(digit.text in "/123456789" for digit in tokens[: tokens.index(token)])
            yield token.start, following.end, _KIND[_WHOLE[code]], _DECLARATION if is_head else 0
        else:
            kind = _LETTERS.get(code, _OF_LEXING[token.kind])
            modifiers = _READONLY if token.kind == "system" else _DECLARATION if token.kind == "label" else 0
            yield token.start, token.end, _KIND[kind], modifiers


def _rows(groups: Iterable[Iterable[tuple[int, int, int, int]]]) -> tuple[Positions, ...]:
    table = np.array([row for group in groups for row in group], np.int64).reshape(-1, 4)
    return tuple(table.T)


def _skipped(listing: Listing, starts: Positions, low: int, high: int) -> Positions:
    """Return the modifier of tokens in blocks that block skip leaves out."""
    words = listing.text.words
    slashes = words.block[words.address == ord("/")]
    skipped = {int(block) for block in slashes[(slashes >= low) & (slashes < high)]}
    for block in np.flatnonzero(listing.text.blocks.is_macro[low:high]) + low:
        if listing.text.source.code[int(listing.text.blocks.start[block])] == ord("/"):
            skipped.add(int(block))
    if not skipped:
        return np.zeros(len(starts), np.int64)
    blocks = np.searchsorted(listing.text.blocks.start, starts, side="right") - 1
    return np.where(np.isin(blocks, sorted(skipped)), _SKIPPED, 0)
