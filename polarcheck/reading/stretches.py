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

from polarcheck.arrays import Mask
from polarcheck.reading.source import CTRL_Z, LF, Source, line_starts_of
from polarcheck.reading.words import Blocks, Spans, Text, Words

#: Stands before lines that are not the first: what follows is a program, and no text before it.
_MARK = b"%\n"
#: The columns of a text that are places, each at a block.
_SPANS = ("comments", "names", "strays", "foreign", "prose", "dots", "outside", "labels")
#: Those with one element per comment.
_OF_COMMENTS = ("unclosed", "nested")


def can_be_parted(source: Source) -> bool:
    """Whether lines of a file mean the same by themselves: they end with LF, nothing ends the file before its end."""
    data = source.code.tobytes()
    return LF in data and CTRL_Z not in data


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
        text = only(text, np.arange(len(text.blocks)) > 0)
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
    block = text.words.block
    chosen = kept[block]
    words = Words(*(column[chosen] for column in _columns(text.words)))
    words = replace(words, block=number[words.block].astype(block.dtype))
    blocks = Blocks(*(column[kept] for column in _columns(text.blocks)))
    spans: dict[str, Any] = {}
    for name in _SPANS:
        own: Spans = getattr(text, name)
        in_kept = kept[own.block]
        spans[name] = Spans(own.start[in_kept], own.end[in_kept], number[own.block[in_kept]])
    in_kept = kept[text.comments.block]
    spans |= {name: getattr(text, name)[in_kept] for name in _OF_COMMENTS}
    spans |= {name: _within(getattr(text, name), blocks) for name in ("tape_marks", "letters")}
    return replace(text, words=words, blocks=blocks, **spans)


def joined(first: Text, second: Text) -> Text:
    """The blocks of two texts of one source, the second behind the first."""
    by = len(first.blocks)
    together: dict[str, Any] = {}
    for name in ("words", *_SPANS):
        other = getattr(second, name)
        other = replace(other, block=other.block + other.block.dtype.type(by))
        together[name] = _both(getattr(first, name), other)
    together["blocks"] = _both(first.blocks, second.blocks)
    for name in (*_OF_COMMENTS, "tape_marks", "letters"):
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
