"""Edits applied to the bytes of a file: nothing but what they name changes."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from polarcheck.arrays import Rows
from polarcheck.checking.finding import Edit, Fix
from polarcheck.reading.source import LF, Source

#: An edit by character positions: from, to (exclusive), text.
Span = tuple[int, int, str]


def spans(source: Source, fix: Fix) -> list[Span]:
    """The edits of a fix by character positions, in order."""
    return sorted((_position(source, edit, False), _position(source, edit, True), edit.text) for edit in fix.edits)


def _position(source: Source, edit: Edit, at_end: bool) -> int:
    line, column = (edit.end_line, edit.end_column) if at_end else (edit.line, edit.column)
    return int(source.line_starts[line - 1]) + column - 1


def overlap(spans: Iterable[Span], others: Iterable[Span]) -> bool:
    """Whether edits touch the same characters or the same place; two that are the same do not."""
    known = set(others)
    return any(
        span not in known and any(span[0] <= other[1] and other[0] <= span[1] for other in known) for span in spans
    )


def applied(source: Source, spans: Iterable[Span]) -> bytes | None:
    """
    The bytes with the edits, which do not overlap; all bytes that they do not name are those of the file.

    None where the encoding cannot say what is to be written, or does not give the bytes of a text back as they were.
    """
    pieces: list[bytes] = []
    at = 0
    body = source.data[len(source.bom) :]
    one_byte_each = len(source.code) == len(body)
    text = "" if one_byte_each else source.text
    try:
        if not one_byte_each and source.encode(text) != source.data:
            return None
        offset, counted = 0, 0
        for start, end, new in sorted(set(spans)):
            if one_byte_each:
                first, last = start, end
            else:
                offset += len(text[counted:start].encode(source.encoding))
                first, counted = offset, start
                last = first + len(text[start:end].encode(source.encoding))
            pieces += [body[at:first], new.encode(source.encoding)]
            at = last
    except UnicodeEncodeError:
        return None
    return source.bom + b"".join(pieces) + body[at:]


def shifted(source: Source, spans: Iterable[Span], line: int) -> int:
    """The line that a line (from 1) is after the edits; one that they take away is the next one."""
    before = [span for span in spans if source.line_of(span[0]) < line]
    new = sum(_breaks(source, text) for _, _, text in before)
    gone = sum(source.line_of(end) - source.line_of(start) for start, end, _ in before)
    return line + new - gone


def origins(before: Source, after: Source, spans: Iterable[Span]) -> Rows:
    """For each line of the result the line (from 1) of the text before the edits that it comes from."""
    made = sorted(set(spans))
    grown = np.cumsum([0, *(len(text) - (end - start) for start, end, text in made)])
    # Up to here, in the result, an edit reaches; what it puts in comes from where it begins.
    until = np.array([end for _, end, _ in made], np.int64) + grown[1:]
    passed = np.searchsorted(until, after.line_starts, side="right")
    place = after.line_starts - grown[passed]
    begin = np.array([start for start, _, _ in made] + [len(before.code)], np.int64)[passed]
    return np.asarray(np.searchsorted(before.line_starts, np.minimum(place, begin), side="right"))


def _breaks(source: Source, text: str) -> int:
    return text.count("\n") or (text.count("\r") if not (source.code == LF).any() else 0)
