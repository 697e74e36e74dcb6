"""Edits applied to the bytes of a file: nothing but what they name changes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import accumulate, pairwise

import numpy as np

from polarcheck.arrays import Rows
from polarcheck.checking.editing import Replace
from polarcheck.finding import Edit, Fix
from polarcheck.reading.source import Source


def spans(source: Source, fix: Fix) -> list[Replace]:
    """The edits of a fix by character positions, in order."""
    return sorted((_position(source, edit, False), _position(source, edit, True), edit.text) for edit in fix.edits)


def _position(source: Source, edit: Edit, at_end: bool) -> int:
    line, column = (edit.end_line, edit.end_column) if at_end else (edit.line, edit.column)
    return int(source.line_starts[line - 1]) + column - 1


def overlap(spans: Iterable[Replace], others: Iterable[Replace]) -> bool:
    """Whether edits touch the same characters or the same place; two that are the same do not."""
    known = set(others)
    return any(
        span not in known and any(span[0] <= other[1] and other[0] <= span[1] for other in known) for span in spans
    )


def applied(source: Source, spans: Iterable[Replace]) -> bytes | None:
    """
    The bytes with the edits, which do not overlap; all bytes that they do not name are those of the file.

    None where the encoding cannot say what is to be written, or does not give the bytes of a text back as they were.
    """
    made = sorted(set(spans))
    body = source.data[len(source.bom) :]
    places = made if len(source.code) == len(body) else _in_bytes(source, made)
    if places is None:
        return None
    pieces: list[bytes] = []
    at = 0
    try:
        for (first, last, _), (_, _, new) in zip(places, made, strict=True):
            pieces += [body[at:first], _encoded(new, source.encoding)]
            at = last
    except UnicodeEncodeError:
        return None
    return source.bom + b"".join(pieces) + body[at:]


def _in_bytes(source: Source, made: Sequence[Replace]) -> list[Replace] | None:
    """Where edits stand in the bytes of a text of which characters take several; None where that cannot be said."""
    text, encoding = source.text, source.encoding
    ends = [place for start, end, _ in made for place in (start, end)]
    try:
        whole = "".encode(encoding)
        pieces = [_encoded(text[first:last], encoding) for first, last in pairwise([0, *ends, len(text)])]
    except UnicodeEncodeError:
        return None
    # Some encodings have two ways to write a character, or write one by what stands before it.
    if whole + b"".join(pieces) != source.data[len(source.bom) :]:
        return None
    places = list(accumulate(map(len, pieces[:-1]), initial=len(whole)))[1:]
    return [
        (first, last, text)
        for (first, last), (_, _, text) in zip(zip(places[::2], places[1::2], strict=True), made, strict=True)
    ]


def _encoded(text: str, encoding: str) -> bytes:
    """Without the mark that some encodings put at the head."""
    return text.encode(encoding)[len("".encode(encoding)) :]


def origins(before: Source, after: Source, spans: Iterable[Replace]) -> Rows:
    """For each line of the result the line (from 1) of the text before the edits that it comes from."""
    made = sorted(set(spans))
    grown = np.cumsum([0, *(len(text) - (end - start) for start, end, text in made)])
    # Up to here, in the result, an edit reaches; what it puts in comes from where it begins.
    until = np.array([end for _, end, _ in made], np.int64) + grown[1:]
    passed = np.searchsorted(until, after.line_starts, side="right")
    place = after.line_starts - grown[passed]
    begin = np.array([start for start, _, _ in made] + [len(before.code)], np.int64)[passed]
    return np.asarray(np.searchsorted(before.line_starts, np.minimum(place, begin), side="right"))
