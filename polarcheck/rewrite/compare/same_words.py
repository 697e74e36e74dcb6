"""Tells whether two programs have the same words, whatever the numbers, spaces and comments of their blocks."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.trace import Trace
from polarcheck.program.reading.words import Blocks, Spans, Text


def has_same_words(old: Trace, new: Trace) -> bool:
    """
    Return True if the programs have the same words in the same blocks, but for N and comments.

    X10 is not X10., since controls read them differently. Comments count where R is taken from them. Blocks with macro
    statements count by their characters. A word that the control cannot read is like no other.
    """
    first, second = old.text, new.text
    if first.words.is_unreadable.any() or second.words.is_unreadable.any():
        return False
    if old.job.radius_from_comments and _spans(first, first.comments) != _spans(second, second.comments):
        return False
    macros = [_spans(text, text.blocks[text.blocks.is_macro]) for text in (first, second)]
    return macros[0] == macros[1] and all(
        np.array_equal(one, other) for one, other in zip(_columns(first), _columns(second), strict=True)
    )


def _columns(text: Text) -> Iterator[NDArray[np.generic]]:
    words = text.words[text.words.address != ord("N")]
    yield from (words.address, np.nan_to_num(words.value, nan=np.inf), words.has_point)
    # Where blocks begin.
    yield np.diff(words.block, prepend=-1) != 0


def _spans(text: Text, spans: Blocks | Spans) -> list[bytes]:
    """The characters of spans without spaces, in upper case."""
    bounds = zip(spans.start.tolist(), spans.end.tolist(), strict=True)
    return [b"".join(text.source.code[start:end].tobytes().split()).upper() for start, end in bounds]
