"""
Finds everything around the words of a program (tape marks, comments, remarks, names) and blanks it.

Works on one code per character (source.Source.code) with every line end as LF.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Sequence
from typing import Any, Self

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Mask, Table, first_in_run, is_among, mask_at, side_by_side
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.reading.source import CR, LF, Bytes, Positions

BLANKS = bytes(character for character in (*range(33), 0x7F, 0xA0) if character != LF)
_SPACE, _OPEN, _CLOSE, _PERCENT, _SEMICOLON, _LESS, _GREATER = b" ()%;<>"
#: Characters outside the ISO set of controls: NUL and other control characters, and those above 125.
_IS_FOREIGN = bytes((code < 32 and code not in (9, LF, CR)) or code >= 126 for code in range(256))
_IS_BLANK = is_among(np.arange(256), [*BLANKS, LF])
#: The longest name of a program (30i family).
_NAME_LENGTH = 32
#: A file with more tape marks is read as one program: no control could store so many.
_MARK_LIMIT = 10_000

_BLANK = rb"[\0-\x09\x0b-\x20\x7f]*+"
_PROGRAM_HEAD = lazy_pattern(rb"\n" + _BLANK + rb"(?:[O:]" + _BLANK + rb"\d|O?<)", re.IGNORECASE)
_BLOCK_HEAD = lazy_pattern(
    rb"\n" + _BLANK + rb"(?:N[\d ]++)?+(?:/\d?)?+" + _BLANK + rb"[GMTXZ][ \t]*+[-+.]?\d", re.IGNORECASE
)
_READS_AS_BLOCKS = lazy_pattern(
    rb"(?:[\s;/]*+[A-Z]\s*+[-+]?(?:\d++\.?+\d*+|\.\d++|[#\[][-+*/#\[\]\w.]*+))*+[\s;]*+", re.IGNORECASE
)


#: Tags of HTML from a copied page; behind O or P such a name is the name of a program.
_TAG = (
    rb"(?i)(?<![OP])(?<![OP] )</?(?:b|i|p|u|a|em|strong|td|tr|th|br|hr|table|thead|tbody|span|div|code|pre|html|head"
    rb"|title|body|li|ul|ol|sup|sub|h\d)(?:[ \t][^<>\n]{0,200})?/?>"
)


#: The number of a channel; no lathe has more than nine.
_CHANNEL = rb"[ \t]*+[1-9](?![\d.])"
#: What may stand before the mark of a channel in its block: the head of a program, a sequence number.
_HEAD = rb"(?:(?:[O:]" + _BLANK + rb"\d++|O?<[^<>\n]{1,%d}>|N" % _NAME_LENGTH + _BLANK + rb"\d++)" + _BLANK + rb")?+"
#: A wait for other channels: their numbers, the number of the wait, or both.
_WAIT = rb"[ \t]*+(?:\d++[ \t]*+(?:L[ \t]*+\d++)?+|L[ \t]*+\d++)"


#: Text before a % that means a percentage: FEED AT 20%. _SHARE_LENGTH: how much of it is examined [characters].
_SHARE = rb"(?i)(?<![A-Z])[A-Z]{2,}+[ \t]++\d++\Z"
_SHARE_LENGTH = 100


class Ranges(Table, frozen=True):
    """Spans of a text from start to end (exclusive), in order."""

    start: Positions
    end: Positions

    @classmethod
    def of(cls, spans: Sequence[tuple[int, int]]) -> Self:
        """The table of spans, each with its start and its end."""
        return cls(*np.array(spans, np.int64).reshape(-1, 2).T)


class Surroundings(msgspec.Struct, frozen=True):
    """
    Everything around the words of a file.

    tape_marks: positions of % at the head or the end of a line.
    outside: text that a control does not store.
    comments: in parentheses, or up to the end of the line.
    unclosed, nested: per comment, True where it lacks its end or contains another opening parenthesis.
    names: of programs, <...>.
    strays: positions of % inside a block.
    tags: of HTML.
    """

    tape_marks: Positions
    outside: Ranges
    comments: Ranges
    unclosed: Mask
    nested: Mask
    names: Ranges
    strays: Positions
    tags: Ranges


def narrow(size: int) -> type[np.signedinteger[Any]]:
    """The integer type for every position of a file: half the memory takes half the time."""
    return np.int32 if size < 2**31 - 8 else np.int64


def read_surroundings(
    code: Bytes, line_comments: str = "", channel_mark: str = "", wait_mark: str = ""
) -> Surroundings:
    """
    Find everything that is not a word, and blank it in `code`.

    line_comments: characters that begin a comment up to the end of the line. channel_mark, wait_mark: characters before
    the number of a channel, and before a wait for another channel.
    """
    lines = np.append(np.flatnonzero(code == LF), len(code))
    remarks = _line_comments(code, lines, line_comments)
    comments, unclosed, nested = _comments(code)
    remarks += _marks_of_channels(code, channel_mark, wait_mark)
    tags = _tags(code)
    marks, strays = _percents(code, lines)
    outside = _outside(code, marks)
    names = _names(code)
    remarks += [_semicolon_remarks(code, lines)]
    is_stored = ~_within(comments, outside)
    tables = [comments[is_stored], *(remark[~_within(remark, outside)] for remark in remarks if len(remark))]
    every = Ranges.concatenated(tables)
    no = np.zeros(len(every) - len(tables[0]), bool)
    order = np.argsort(every.start, kind="stable")
    return Surroundings(
        tape_marks=marks,
        outside=outside,
        comments=every[order],
        unclosed=np.append(unclosed[is_stored], no)[order],
        nested=np.append(nested[is_stored], no)[order],
        names=names,
        strays=strays,
        tags=tags[~_within(tags, outside)],
    )


def without_comments(code: Bytes, line_comments: str = "") -> Bytes:
    """A copy of the codes of a text with its comments blanked; all line ends are LF."""
    blanked = code.copy()
    _line_comments(blanked, np.append(np.flatnonzero(code == LF), len(code)), line_comments)
    _comments(blanked)
    return blanked


def find_channel_marks(code: Bytes, mark: str) -> list[tuple[int, int]]:
    """
    The marks of channels in a text without comments: the start of the block, and the number of the channel.

    A mark stands at the head of a line, or behind the number of a program there, or alone in a block behind `;`.
    """
    return [(match.start(), int(match[match.lastgroup or 0][-1:])) for match in _find_channel_marks(code, mark)]


def _find_channel_marks(code: Bytes, mark: str) -> Iterator[re.Match[bytes]]:
    sign = re.escape(mark.encode("latin-1"))
    at_head = rb"^" + _BLANK + _HEAD + rb"(?P<mark>" + sign + _CHANNEL + rb")"
    alone = rb"(?<=;)" + _BLANK + rb"(?P<alone>" + sign + _CHANNEL + rb")(?=" + _BLANK + rb"(?:;|$))"
    return re.finditer(at_head + rb"|" + alone, code.tobytes(), re.MULTILINE | re.IGNORECASE)


def _marks_of_channels(code: Bytes, channel_mark: str, wait_mark: str) -> list[Ranges]:
    """Find and blank the marks of channels and the waits; none where the characters do not occur."""
    spans: list[tuple[int, int]] = []
    if channel_mark and np.any(code == ord(channel_mark)):
        spans += [match.span(match.lastgroup or 0) for match in _find_channel_marks(code, channel_mark)]
    if wait_mark and np.any(code == ord(wait_mark)):
        wait = re.compile(re.escape(wait_mark.encode("latin-1")) + _WAIT, re.IGNORECASE)
        spans += [match.span() for match in wait.finditer(code.tobytes())]
    if not spans:
        return []
    marks = Ranges.of(sorted(spans))
    blank(code, marks)
    return [marks]


def united(first: Ranges, second: Ranges) -> Ranges:
    """The union of two tables, each without overlaps, in order; ranges that overlap or touch are merged."""
    if not len(second):
        return first
    both = Ranges.concatenated([first, second])
    order = np.argsort(both.start, kind="stable")
    start, end = both.start[order], np.maximum.accumulate(both.end[order])
    begins = np.append(True, start[1:] > end[:-1])
    return Ranges(start[begins], end[np.append(begins[1:], True)])


def _characters(ranges: Ranges, size: int) -> tuple[Positions, Positions]:
    """Every position in the ranges, and the index of its range."""
    length = (ranges.end - ranges.start).astype(narrow(size))
    before = np.cumsum(length, dtype=length.dtype) - length
    owner = np.repeat(np.arange(len(length), dtype=length.dtype), length)
    positions = np.arange(len(owner), dtype=length.dtype)
    positions += (ranges.start - before).astype(length.dtype)[owner]
    return positions, owner


def blank(code: Bytes, ranges: Ranges) -> None:
    """Blank the ranges, which contain no line end."""
    code[_characters(ranges, len(code))[0]] = _SPACE


def _has_text(code: Bytes, start: Positions, end: Positions) -> Mask:
    """True where there is anything but blanks between the positions."""
    positions, owner = _characters(Ranges(start, end), len(code))
    return mask_at(len(start), owner[~_IS_BLANK[code[positions]]])


def _within(inner: Ranges, outer: Ranges) -> Mask:
    """True for inner ranges that begin inside one of the outer ranges."""
    if not len(outer):
        return np.zeros(len(inner), bool)
    owner = np.searchsorted(outer.start, inner.start, side="right") - 1
    return np.asarray((owner >= 0) & (inner.start < outer.end[owner]))


def _first_of_line(positions: Positions, lines: Positions) -> Ranges:
    """From the first position on each line to the end of the line."""
    line = np.searchsorted(lines, positions)
    first = first_in_run(line)
    return Ranges(positions[first], lines[line[first]])


def _line_comments(code: Bytes, lines: Positions, characters: str) -> list[Ranges]:
    """Find and blank comments from a character to the end of its line; not inside parentheses."""
    if not characters:
        return []
    marks = np.flatnonzero(is_among(code, list(characters.encode("latin-1"))))
    brackets = np.flatnonzero((code == _OPEN) | (code == _CLOSE) | (code == LF))
    inside = np.append(LF, code[brackets])[np.searchsorted(brackets, marks)] == _OPEN
    remarks = _first_of_line(marks[~inside], lines)
    blank(code, remarks)
    return [remarks]


def _comments(code: Bytes) -> tuple[Ranges, Mask, Mask]:
    """Find and blank comments: from ( outside of a comment to the first ) or, faulty, to the line end."""
    is_open = code == _OPEN
    if not is_open.any():
        none = np.zeros(0, np.int64)
        return Ranges(none, none), np.zeros(0, bool), np.zeros(0, bool)
    marks = np.flatnonzero(is_open | (code == _CLOSE) | (code == LF))
    opens = np.append(is_open[marks], False)
    marks = np.append(marks, len(code))
    inside = np.append(False, opens[:-1])
    first = opens & ~inside
    last = inside & ~opens
    end = marks[last]
    closed = end < len(code)
    closed[closed] = code[end[closed]] == _CLOSE
    comments = Ranges(marks[first], end + closed)
    blank(code, comments)
    return comments, ~closed, opens[np.flatnonzero(first) + 1]


def _percents(code: Bytes, lines: Positions) -> tuple[Positions, Positions]:
    """
    Find tape marks, and % signs inside a block; both are blanked up to the end of the line, which is not read.

    Source: B-63524EN/01 p. 649 (text from % to the first LF is skipped); alarm 5010 for a % inside a block.
    """
    tails = _first_of_line(np.flatnonzero(code == _PERCENT), lines)
    percents = tails.start
    if not len(percents):
        return percents, percents
    line_start = np.append(0, lines + 1)[np.searchsorted(lines, percents)]
    is_mark = ~_has_text(code, line_start, percents) | ~_has_text(code, percents + 1, tails.end)
    for index in np.flatnonzero(is_mark & is_among(code[percents - 1], list(b"0123456789"))).tolist():
        begin = max(int(line_start[index]), int(percents[index]) - _SHARE_LENGTH)
        is_mark[index] = re.search(_SHARE, code[begin : percents[index]].tobytes()) is None
    blank(code, tails)
    return percents[is_mark], percents[~is_mark]


def _outside(code: Bytes, marks: Positions) -> Ranges:
    """
    Find and blank text that a control does not store: before the first % or O number, and after the last %.

    Source: B-63524EN/01 p. 649; M700V programming manual p. 7.
    """
    starts: list[int] = []
    ends: list[int] = []
    # One line end before the text, so that every line head follows one: positions in `data` are one higher.
    data = b"\n" + code.tobytes()
    edges = [0, *marks.tolist(), len(code)] if len(marks) <= _MARK_LIMIT else [0, len(code)]
    regions = list(itertools.pairwise(edges))
    heads = [_PROGRAM_HEAD.search(data, begin, end + 1) for begin, end in regions]
    limits = [head.start() + 1 if head else end + 1 for head, (_, end) in zip(heads, regions, strict=True)]
    has_blocks = [
        _BLOCK_HEAD.search(data, begin, limit) is not None for (begin, _), limit in zip(regions, limits, strict=True)
    ]
    is_program = [head is not None or blocks for head, blocks in zip(heads, has_blocks, strict=True)]
    is_program[-1] &= heads[-1] is not None or not any(is_program[:-1])
    if not any(is_program):
        is_program[min(1, len(regions) - 1)] = True
    for index, (begin, end) in enumerate(regions):
        stop = limits[index] - 1 if is_program[index] and heads[index] and not has_blocks[index] else end
        if is_program[index] and stop == end:
            continue
        if data[begin + 1 : stop + 1].translate(None, BLANKS + b"\n"):
            starts.append(begin)
            ends.append(stop)
            part = code[begin:stop]
            part[part != LF] = _SPACE
    return Ranges(np.array(starts, np.int64), np.array(ends, np.int64))


def _tags(code: Bytes) -> Ranges:
    """Find and blank tags of HTML, in a file with closing tags: `<b>` alone would be the name of a program."""
    data = code.tobytes()
    spans = [tag.span() for tag in re.finditer(_TAG, data)] if b"</" in data else []
    tags = Ranges.of(spans)
    blank(code, tags)
    return tags


def _names(code: Bytes) -> Ranges:
    """Find and blank program names <...> of the 30i family, as in O<HEX> or M98 <HEX>."""
    signs = np.flatnonzero(code == _LESS)
    if len(signs):
        signs = np.flatnonzero((code == _LESS) | (code == _GREATER) | (code == LF))
    start, end = signs[:-1], signs[1:]
    length = end - start - 1
    named = (code[start] == _LESS) & (code[end] == _GREATER) & (length > 0) & (length <= _NAME_LENGTH)
    names = Ranges(start[named], end[named] + 1)
    blank(code, names)
    return names


def _semicolon_remarks(code: Bytes, lines: Positions) -> Ranges:
    """
    Find and blank remarks: text behind `;` up to the end of the line, unless it reads as a block.

    Manuals print `;` for the end of block; other dialects and copied notes begin a remark with it.
    """
    tails = _first_of_line(np.flatnonzero(code == _SEMICOLON), lines)
    if not len(tails):
        return tails
    tails = tails[_has_text(code, tails.start + 1, tails.end)]
    data = code.tobytes()
    places = side_by_side(tails.start, tails.end)
    is_remark = [_READS_AS_BLOCKS.fullmatch(data, start + 1, end) is None for start, end in places]
    remarks = tails[np.array(is_remark, bool)]
    blank(code, remarks)
    return remarks


def foreign(text: bytes) -> Ranges:
    """Runs of characters that are not in the ISO set of controls."""
    flags = text.translate(_IS_FOREIGN)
    none = np.zeros(0, np.int64)
    if flags.find(1) < 0:
        return Ranges(none, none)
    edges = np.flatnonzero(np.diff(np.frombuffer(b"\0" + flags + b"\0", np.int8)))
    return Ranges(edges[::2], edges[1::2])
