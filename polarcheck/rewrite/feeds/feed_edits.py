"""Writes the F of the feed table into a program: an unsafe fix, since another feed changes the cut."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from polarcheck.checking.edits import applied, origins
from polarcheck.program.reading import source
from polarcheck.rewrite.feeds.feed_rewriting import feed_words
from polarcheck.rewrite.fixes.difference import difference
from polarcheck.rules.tables import Tables


class WithFeeds(msgspec.Struct, frozen=True):
    """
    A program with the feeds of its feed table.

    data: the bytes.
    difference: the lines of a unified diff.
    lowest: lines whose runs need different F; they have the lowest.
    left: lines that are unchanged, since their F cannot be edited.
    """

    data: bytes
    difference: list[str]
    lowest: list[int]
    left: list[int]


def with_feeds(title: str, data: bytes, runs: Sequence[Tables], encoding: str | None) -> WithFeeds | None:
    """
    Return a program with the F of the feed tables of its runs, one for each channel.

    None if its encoding does not reproduce the bytes. Raises SourceError for bytes that are not of the encoding,
    TooHardError.
    """
    text = source.read_source(data, title, encoding)
    words = [feed_words(tables) for tables in runs]
    # A program that several channels call has the edits of the first channel that needs any.
    edits = {edit[:2]: edit for table in reversed(words) for edit in table.edits}
    new = applied(text, edits.values())
    if new is None:
        return None
    origin = origins(text, source.read_source(new, title, encoding), edits.values()).tolist()
    lowest, unchanged = (
        sorted({line for table in words for line in getattr(table, name)}) for name in ("lowest", "left")
    )
    return WithFeeds(new, difference(title, data, new, origin, encoding), lowest, unchanged)
