"""Applies edits to the bytes of a file; all other bytes stay as they are."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import accumulate, pairwise

import numpy as np

from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.finding import Edit, Fix
from polarcheck.program.reading.source import Source
from polarcheck.rules.editing import Replace


def spans(source: Source, fix: Fix) -> list[Replace]:
    """Return the edits of a fix by character positions, in order."""
    return sorted((_position(source, edit, False), _position(source, edit, True), edit.text) for edit in fix.edits)


def _position(source: Source, edit: Edit, at_end: bool) -> int:
    line, column = (edit.end_line, edit.end_column) if at_end else (edit.line, edit.column)
    return int(source.line_starts[line - 1]) + column - 1


def overlap(spans: Iterable[Replace], rivals: Iterable[Replace]) -> bool:
    """Return True if edits touch the same characters or the same position; identical edits do not overlap."""
    accepted = set(rivals)
    return any(
        span not in accepted and any(span[0] <= second[1] and second[0] <= span[1] for second in accepted)
        for span in spans
    )


def applied(source: Source, spans: Iterable[Replace]) -> bytes | None:
    """
    Return the bytes with the edits, which must not overlap; all other bytes are those of the file.

    None if the encoding cannot write the new text, or does not reproduce the bytes of the file.
    """
    edits = sorted(set(spans))
    body = source.data[len(source.bom) :]
    places = edits if len(source.code) == len(body) else _in_bytes(source, edits)
    if places is None:
        return None
    pieces: list[bytes] = []
    offset = 0
    try:
        for (first, last, _), (_, _, new) in zip(places, edits, strict=True):
            pieces += [body[offset:first], _encoded(new, source.encoding)]
            offset = last
    except UnicodeEncodeError:
        return None
    return source.bom + b"".join(pieces) + body[offset:]


def _in_bytes(source: Source, edits: Sequence[Replace]) -> list[Replace] | None:
    """Return edits by byte positions, for an encoding with several bytes per character; None if that is impossible."""
    text, encoding = source.text, source.encoding
    ends = [offset for start, end, _ in edits for offset in (start, end)]
    try:
        whole = "".encode(encoding)
        pieces = [_encoded(text[first:last], encoding) for first, last in pairwise([0, *ends, len(text)])]
    except UnicodeEncodeError:
        return None
    # In some encodings a character has two spellings, or its bytes depend on the characters before it.
    if whole + b"".join(pieces) != source.data[len(source.bom) :]:
        return None
    places = list(accumulate(map(len, pieces[:-1]), initial=len(whole)))[1:]
    return [
        (first, last, text)
        for (first, last), (_, _, text) in zip(zip(places[::2], places[1::2], strict=True), edits, strict=True)
    ]


def _encoded(text: str, encoding: str) -> bytes:
    """Encode a text without the byte order mark that some encodings write first."""
    return text.encode(encoding)[len("".encode(encoding)) :]


def line_written(after: Source, spans: Iterable[Replace], span: Replace) -> int:
    """Return the line (from 1) in which the text of one of the edits stands after all of them."""
    grown = sum(len(text) - (end - start) for start, end, text in set(spans) if (start, end, text) < span)
    text = span[2]
    return after.line_of(span[0] + grown + len(text) - len(text.lstrip()))


def origins(before: Source, after: Source, spans: Iterable[Replace]) -> Rows:
    """Return for each line after the edits the line before the edits (from 1) that it comes from."""
    edits = sorted(set(spans))
    grown = np.cumsum([0, *(len(text) - (end - start) for start, end, text in edits)])
    # The end of each edit in the result. Inserted text belongs to the line where the edit begins.
    until = np.array([end for _, end, _ in edits], np.int64) + grown[1:]
    passed = np.searchsorted(until, after.line_starts, side="right")
    offset = after.line_starts - grown[passed]
    begin = np.array([start for start, _, _ in edits] + [len(before.code)], np.int64)[passed]
    return np.asarray(np.searchsorted(before.line_starts, np.minimum(offset, begin), side="right"))
