"""
Formatting: blanks between words, and none at the ends of lines or inside words. No word is changed.

Between two words stands one blank, and one before a comment that stands close to a word; blanks that align comments
stay. Leading blanks stay in loops, where they show the nesting. Blocks with anything that is no word are left alone:
prose, strings, stray characters. The result is read again, and dropped unless all of its words are the same.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from lsprotocol import types

from polarcheck.editor.open_text import OpenText
from polarcheck.editor.structure import block_ranges
from polarcheck.editor.structure.document import Document, block_at
from polarcheck.foundation.arrays import side_by_side
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import block_text
from polarcheck.program.execution.run import begins_program
from polarcheck.program.reading.words import Text

#: An edit: first character, the one behind the last, new text.
Edit = tuple[int, int, str]

_BLANKS = re.compile(r"[ \t]+")
_OUTER = re.compile(r"\r*([ \t]*)")
#: A block with output, a string or the name of a message: its blanks are read.
_READS_BLANKS = re.compile(r"[\"']|DPRNT|BPRNT|SETVN|MSG|^\s*%", re.IGNORECASE)
_ENDS_LINE = ("", "\n", "\r")


def formatted(document: Document, selected: types.Range | None = None) -> list[types.TextEdit]:
    """Return the edits that format a document, or the lines of a range; empty if they would change any word."""
    edits = sorted({edit for listing in document.listings for edit in _of_listing(document, listing, selected)})
    if not edits or not _is_same(document, edits):
        return []
    return [types.TextEdit(document.range(start, end), text) for start, end, text in edits]


def _of_listing(document: Document, listing: Listing, selected: types.Range | None) -> Iterator[Edit]:
    text = listing.text
    low, high = 0, len(text.blocks)
    if selected is not None:
        low = block_at(listing, document.text.character_of(types.Position(selected.start.line, 0)))
        last = document.text.character_of(types.Position(selected.end.line + (selected.end.character > 0), 0))
        high = int(np.searchsorted(text.blocks.start, last, side="left"))
    kept, nested = _kept(listing), _nested(listing)
    content = text.source.text
    pieces = _pieces(listing, low, high)
    for block in range(low, high):
        start, end = int(text.blocks.start[block]), int(text.blocks.end[block])
        written = content[start:end]
        if kept[block] or "\n" in written:
            continue
        if not written.strip():
            yield from _without_blanks(start, written)
            continue
        if text.blocks.is_macro[block]:
            inner = _of_statement(listing, block)
        else:
            inner = _of_words(content, pieces.get(block, []))
        yield from _ends(content, start, end, nested=bool(nested[block]))
        yield from inner


def _changed(start: int, before: str, after: str) -> Iterator[Edit]:
    if before != after:
        yield start, start + len(before), after


def _without_blanks(start: int, written: str) -> Iterator[Edit]:
    """Yield the edits that take out blanks, and no line end."""
    return ((start + gap.start(), start + gap.end(), "") for gap in _BLANKS.finditer(written))


def _kept(listing: Listing) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return per block: it is left as it is."""
    text = listing.text
    kept = np.zeros(len(text.blocks), bool)
    for table in (text.strays, text.prose, text.dots, text.outside, text.names, text.labels):
        kept[table.block] = True
    kept[text.words.block[text.words.is_unreadable | (text.words.address == 0)]] = True
    kept[text.words.block[begins_program(text.words)]] = True
    kept[np.searchsorted(text.blocks.start, text.tape_marks, side="right") - 1] = True
    if text.source.channel or len(text.source.parts):
        kept[:] = True
    return kept


def _nested(listing: Listing) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return per block: it stands inside a loop or structure."""
    nested = np.zeros(len(listing.text.blocks), bool)
    for program in listing.programs.programs:
        if program.first < program.end:
            for loop in block_ranges.loops(listing, program):
                nested[loop.first : loop.last + 1] = True
    return nested


def _pieces(listing: Listing, low: int, high: int) -> dict[int, list[tuple[int, int, str]]]:
    """Return the words and comments of each block: first character, the one behind the last, kind."""
    text = listing.text
    pieces: dict[int, list[tuple[int, int, str]]] = {}
    words = text.words
    begin, end = np.searchsorted(words.block, (low, high)).tolist()
    columns = (words.block, words.start, words.end, words.address)
    for block, start, stop, address in side_by_side(*(column[begin:end] for column in columns)):
        kind = "/" if address == ord("/") else "," if address >= ord("a") else "word"
        pieces.setdefault(block, []).append((start, stop, kind))
    begin, end = np.searchsorted(text.comments.block, (low, high)).tolist()
    spans = (text.comments.block, text.comments.start, text.comments.end)
    for block, start, stop in side_by_side(*(column[begin:end] for column in spans)):
        pieces.setdefault(block, []).append((start, stop, "comment"))
        pieces[block].sort()
    return pieces


def _of_words(content: str, pieces: list[tuple[int, int, str]]) -> Iterator[Edit]:
    """Yield the edits within words and between them; comments stay as they are."""
    for index, (start, end, kind) in enumerate(pieces):
        written = content[start:end]
        if kind != "comment":
            # Not the whole word: no two edits begin at one place.
            yield from _without_blanks(start, written)
        if index + 1 == len(pieces):
            continue
        after, _, next_kind = pieces[index + 1]
        gap = content[end:after]
        if gap.strip(" \t"):
            continue
        space = " "
        if next_kind == "comment":
            space = gap or " "
        elif not gap and (kind == "/" or next_kind in "/,"):
            space = ""
        yield from _changed(end, gap, space)


def _of_statement(listing: Listing, block: int) -> Iterator[Edit]:
    """Yield the edits of a block with statements: runs of blanks become one, outside comments and strings."""
    text = listing.text
    start, end = int(text.blocks.start[block]), int(text.blocks.end[block])
    written = text.source.excerpt(start, end)
    if _READS_BLANKS.search(written):
        return
    low, high = np.searchsorted(text.comments.block, (block, block + 1)).tolist()
    spans = list(side_by_side(text.comments.start[low:high], text.comments.end[low:high]))
    bare, lead = len(written.rstrip()), len(written) - len(written.lstrip())
    for gap in _BLANKS.finditer(written):
        span = start + gap.start(), start + gap.end()
        is_inside = any(first <= span[0] < last for first, last in spans)
        aligns = any(first == span[1] for first, _ in spans)
        if not is_inside and not aligns and lead <= gap.start() < bare and gap[0] != " ":
            yield (*span, " ")


def _ends(content: str, start: int, end: int, *, nested: bool) -> Iterator[Edit]:
    """Yield the edits at the ends of a block that are ends of a line."""
    written = content[start:end]
    lead = _OUTER.match(written)
    if lead and lead[1] and not nested and content[start - 1 : start] in _ENDS_LINE:
        yield start + lead.start(1), start + lead.end(1), ""
    bare = written.rstrip(" \t\r")
    if content[end : end + 1] in _ENDS_LINE:
        yield from _without_blanks(start + len(bare), written[len(bare) :])


# ---- the proof ----


def _is_same(document: Document, edits: list[Edit]) -> bool:
    """Return True if a text with edits has the same words, statements, comments and names in the same blocks."""
    text = document.text
    lead = text.place_of(0)
    parts: list[str] = []
    end_of_last = 0
    for start, end, new in edits:
        if start + lead < end_of_last:
            return False
        parts += [text.text[end_of_last : start + lead], new]
        end_of_last = end + lead
    after = Document(
        document.uri, document.path, OpenText("".join([*parts, text.text[end_of_last:]]), text.units), document.machine
    )
    if len(after.listings) != len(document.listings):
        return False
    return all(_facts(old) == _facts(new) for old, new in zip(document.listings, after.listings, strict=True))


def _facts(listing: Listing) -> tuple[object, ...]:
    """Return all that a control reads of a text, without where it stands."""
    text = listing.text
    words = text.words
    columns = (words.address, words.value, words.decimals, words.digits, words.has_point, words.fault, words.block)
    macro = np.flatnonzero(text.blocks.is_macro).tolist()
    statements = ["".join(block_text(text, block).split()) for block in macro]
    spans = [_written(text, table) for table in ("comments", "names", "strays", "prose", "dots", "outside", "labels")]
    lines = text.blocks.line.tobytes()
    return (*(column.tobytes() for column in columns), macro, statements, *spans, lines)


def _written(text: Text, table: str) -> list[tuple[int, str]]:
    spans = getattr(text, table)
    content = text.source.text
    return [(block, content[start:end]) for block, start, end in side_by_side(spans.block, spans.start, spans.end)]
