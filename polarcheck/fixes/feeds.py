"""A program with the F of its feed table: an unsafe fix, since another feed cuts otherwise."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from polarcheck.checking.tables import Tables
from polarcheck.feed_table.rewriting import feed_words
from polarcheck.fixes.difference import difference
from polarcheck.fixes.edits import applied, origins
from polarcheck.reading import source


class WithFeeds(msgspec.Struct, frozen=True):
    """The bytes with the feeds and their unified diff; lines with the lowest F of several, and those left alone."""

    data: bytes
    difference: list[str]
    lowest: list[int]
    left: list[int]


def with_feeds(title: str, data: bytes, runs: Sequence[Tables], encoding: str | None) -> WithFeeds | None:
    """
    A program with the F of the feed tables of its runs, one for each channel.

    None where its encoding does not give the bytes back. Raises SourceError for bytes that are not of the encoding,
    TooHardError.
    """
    text = source.read(data, title, encoding)
    words = [feed_words(tables) for tables in runs]
    # A program that several channels call has the edits of the first that need some.
    edits = {edit[:2]: edit for one in reversed(words) for edit in one.edits}
    new = applied(text, edits.values())
    if new is None:
        return None
    origin = origins(text, source.read(new, title, encoding), edits.values()).tolist()
    lowest, left = (sorted({line for one in words for line in getattr(one, name)}) for name in ("lowest", "left"))
    return WithFeeds(new, difference(title, data, new, origin, encoding), lowest, left)
