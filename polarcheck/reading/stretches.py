"""
Parts of a large file, each read for itself: lines of it, and a choice of blocks of what was read before.

All positions and lines are those of the file, so that what is found needs no other place.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from polarcheck.arrays import Mask, stretch
from polarcheck.reading.source import CTRL_Z, LF, Source, line_starts_of
from polarcheck.reading.words import Blocks, Spans, Text, Words

#: Stands before lines that are not the first: what follows is a program, and no text before it.
_MARK = b"%\n"
#: The columns of a text that are places, each at a block.
_SPANS = ("comments", "names", "strays", "foreign", "prose", "dots", "outside", "labels")
#: Those with one element per comment.
_OF_COMMENTS = ("unclosed", "nested")
#: Those that are positions alone.
_POSITIONS = ("tape_marks", "letters")


def can_be_parted(source: Source) -> bool:
    """Whether lines of a file mean the same by themselves: they end with LF, nothing ends the file before its end."""
    return LF in source.data and CTRL_Z not in source.data


def read_stretch(source: Source, start: int, end: int, read: Callable[[Source], Text]) -> Text:
    """
    Some whole lines of a file, from start to end [characters]; read: makes a text of a source.

    Behind the head of the file a tape mark stands before them.
    """
    mark = _MARK if start else b""
    until = end if end >= len(source.code) else end - 1  # the line end belongs to the last block
    code = np.concatenate((np.frombuffer(mark, np.uint8), source.code[start:until]))
    data = mark.decode().encode(source.encoding) + source.excerpt(start, until).encode(source.encoding, "surrogatepass")
    text = read(replace(source, data=data, bom=b"", code=code, line_starts=line_starts_of(code)))
    if mark:
        text = between(text, 1, len(text.blocks))
    lines = int(np.searchsorted(source.line_starts, start, side="right")) - 1
    return _at_place(text, source, start - len(mark), lines - bool(mark))


def _at_place(text: Text, source: Source, by: int, lines: int) -> Text:
    """A text whose positions are moved by some characters and lines, as one of the source."""
    words = replace(text.words, start=text.words.start + by, end=text.words.end + by)
    blocks = text.blocks
    blocks = replace(blocks, start=blocks.start + by, end=blocks.end + by, line=blocks.line + lines)
    moved: dict[str, Any] = {name: getattr(text, name) for name in _SPANS}
    moved = {name: replace(spans, start=spans.start + by, end=spans.end + by) for name, spans in moved.items()}
    return replace(
        text,
        source=source,
        words=words,
        blocks=blocks,
        tape_marks=text.tape_marks + by,
        letters=text.letters + by,
        **moved,
    )


def only(text: Text, kept: Mask) -> Text:
    """Some of the blocks of a text, with all that stands in them."""
    number = np.cumsum(kept) - 1

    def some(table: Any) -> Any:
        chosen = kept[table.block]
        found = type(table)(*(column[chosen] for column in _columns(table)))
        return replace(found, block=number[found.block].astype(table.block.dtype))

    blocks = Blocks(*(column[kept] for column in _columns(text.blocks)))
    in_kept = kept[text.comments.block]
    parts: dict[str, Any] = {name: some(getattr(text, name)) for name in ("words", *_SPANS)}
    parts |= {name: getattr(text, name)[in_kept] for name in _OF_COMMENTS}
    parts |= {name: _within(getattr(text, name), blocks) for name in _POSITIONS}
    return replace(text, blocks=blocks, **parts)


def between(text: Text, first: int, end: int) -> Text:
    """The blocks of a text from `first` to before `end`, whose columns are those of the text: nothing is copied."""

    def some(table: Any) -> Any:
        low, high = stretch(table.block, first, end)
        found = type(table)(*(column[low:high] for column in _columns(table)))
        return replace(found, block=found.block - found.block.dtype.type(first)) if first else found

    blocks = Blocks(*(column[first:end] for column in _columns(text.blocks)))
    low, high = stretch(text.comments.block, first, end)
    parts: dict[str, Any] = {name: some(getattr(text, name)) for name in ("words", *_SPANS)}
    parts |= {name: getattr(text, name)[low:high] for name in _OF_COMMENTS}
    parts |= {name: _within(getattr(text, name), blocks) for name in _POSITIONS}
    return replace(text, blocks=blocks, **parts)


def joined(first: Text, second: Text) -> Text:
    """The blocks of two texts of one source, the second behind the first."""
    by = len(first.blocks)
    together: dict[str, Any] = {}
    for name in ("words", *_SPANS):
        other = getattr(second, name)
        other = replace(other, block=other.block + other.block.dtype.type(by))
        together[name] = _both(getattr(first, name), other)
    together["blocks"] = _both(first.blocks, second.blocks)
    for name in (*_OF_COMMENTS, *_POSITIONS):
        together[name] = np.concatenate((getattr(first, name), getattr(second, name)))
    return replace(first, **together)


def _both(one: Any, other: Any) -> Any:
    return type(one)(*map(np.concatenate, zip(_columns(one), _columns(other), strict=True)))


def _columns(table: Words | Blocks | Spans) -> tuple[NDArray[Any], ...]:
    return tuple(getattr(table, name) for name in table.__struct_fields__)


def _within(positions: NDArray[Any], blocks: Blocks) -> NDArray[Any]:
    """Those of some positions that stand in one of the blocks."""
    at = np.searchsorted(blocks.start, positions, side="right") - 1
    return positions[(at >= 0) & (positions <= np.append(blocks.end, 0)[at])]
