"""Whether two programs have the same words: then they are the same but for block numbers and comments."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.trace import Trace
from polarcheck.program.reading.words import Blocks, Spans, Text


def has_same_words(old: Trace, new: Trace) -> bool:
    """
    Return True if the programs have the same words in the same blocks, but for N and comments.

    X10 is not X10., since controls read them differently, nor X1O. or X10. beside a stray character. Comments count
    where R is taken from them. Blocks with macro statements count by their characters. A word that the control cannot
    read is like no other.
    """
    first, second = old.text, new.text
    if first.words.is_unreadable.any() or second.words.is_unreadable.any():
        return False
    if spans_of(first, first.strays) != spans_of(second, second.strays) or len(first.letters) != len(second.letters):
        return False
    if old.job.radius_from_comments and spans_of(first, first.comments) != spans_of(second, second.comments):
        return False
    macros = [spans_of(text, text.blocks[text.blocks.is_macro]) for text in (first, second)]
    return macros[0] == macros[1] and all(
        np.array_equal(old_column, new_column)
        for old_column, new_column in zip(_columns(first), _columns(second), strict=True)
    )


def _columns(text: Text) -> Iterator[NDArray[np.generic]]:
    words = text.words[text.words.address != ord("N")]
    yield from (words.address, np.nan_to_num(words.value, nan=np.inf), words.has_point, words.fault)
    # Where blocks begin, and which of those with words or statements have statements.
    yield np.diff(words.block, prepend=-1) != 0
    is_macro = text.blocks.is_macro
    is_full = is_macro.copy()
    is_full[words.block] = True
    yield is_macro[is_full]


def spans_of(text: Text, spans: Blocks | Spans) -> list[bytes]:
    """Return the characters of spans without spaces, in upper case."""
    bounds = zip(spans.start.tolist(), spans.end.tolist(), strict=True)
    return [b"".join(text.source.code[start:end].tobytes().split()).upper() for start, end in bounds]
