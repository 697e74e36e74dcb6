"""
Blocks that hold statements of a control's own language (`X=R1`, `STOPRE`, `IF [VC1 EQ 1] NEND`): found, and taken out
of the text that the reader of words sees. What they say is read when they are executed.

Works on one code per character with every line end as LF, before comments are looked for: a string may hold what
elsewhere begins a comment, and behind a name parentheses hold arguments.
"""

from __future__ import annotations

import bisect
import re
from typing import NamedTuple

import numpy as np

from polarcheck.reading.source import LF, Bytes, Positions
from polarcheck.reading.surroundings import Ranges


class _Signs(NamedTuple):
    """
    How blocks of a language are told from blocks of words.

    alone: characters that no block of words has. has_arguments: parentheses behind a name or a sign hold arguments,
    else they are comments everywhere. line_comment: begins a comment, as a pattern that matches it whole. lines: what
    makes a line one of the language though it has none of these, as a pattern: L100 P3 calls, G290 changes languages.
    has_heads: programs begin with lines such as %_N_SHAFT_MPF. has_names: N and O take names; $ heads a file or goes on
    with the block of the line above.
    """

    alone: bytes
    has_arguments: bool
    line_comment: bytes
    lines: bytes = b""
    has_heads: bool = False
    has_names: bool = False


class Taken(NamedTuple):
    """
    What was taken out of a text.

    statements: the place of the first sign of each line with statements. labels: sequence names (NLAP1) at the heads of
    blocks that are words otherwise. programs: the names of programs (OFACE) in blocks of their own. heads: those in
    lines such as %_N_SHAFT_MPF, with a character on either side. is_joined: lines go on with the block of the line
    above.
    """

    statements: Positions
    labels: Ranges
    programs: Ranges
    heads: Ranges
    is_joined: bool


_SIGNS = {
    "high-level": _Signs(
        b'="[$',
        True,
        rb";[^\n]*+",
        rb"^[ \t\0]*+(?:/[0-9]?[ \t]*+)?(?:[N:][ \t]*+[0-9]++[ \t]*+)?L[0-9]++[ \t]*+"
        rb"(?:P[ \t]*+[0-9]++)?(?=[ \t\r\0]*+(?:;|$))|(?<![A-Z_\"])G0*29[01](?![0-9.])",
        has_heads=True,
    ),
    "user-task": _Signs(b"=[$", False, rb"(?!)", has_names=True),
}
_NAME_CHARACTERS = np.isin(np.arange(256), list(b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_"))
#: A name has two letters at least; the letters O and I behind an address, up to 20, are digits that somebody mistyped.
_NAME = rb"(?![A-Z][OI]{1,20}+(?![A-Z0-9_]))[A-Z_$][A-Z_][A-Z0-9_$]*+"
#: No control has longer labels. Without a limit the rest of a long run would be read again from each of its letters.
_LABEL = rb"[A-Z_][A-Z0-9_]{1,60}+[ \t]*+:"
_BLANK = b" \t\r\0"
_HEAD_OF_FILE = re.compile(rb"[ \t\r\0]*+\$[^%\n]*+%[ \t\r\0]*+")
_GOES_ON = re.compile(rb"\n[ \t\r\0]*+\$(?![^%\n]*+%)")
_PROGRAM = re.compile(rb"[ \t\r\0]*+(O[A-Z][A-Z0-9]{0,15}+)[ \t\r\0]*+")
#: A sequence name: N and up to four letters and digits. NOEX runs a block without stopping at it.
_SEQUENCE_NAME = re.compile(rb"(?<![A-Z0-9_$])N(?!OEX(?![A-Z0-9]))[A-Z][A-Z0-9]{0,3}+(?![A-Z0-9_.=\[])")
_BEFORE_LABEL = re.compile(rb"[ \t\r\0]*+(?:/[ \t]*+\d?+[ \t\r\0]*+)?+")
#: A parenthesis that belongs to what stands before it: a name, a sign; so much before it is looked at [characters].
_BEFORE_ARGUMENTS = re.compile(rb"(?:[=+\-*/,<>]|(?<![A-Z0-9_$])(?>[A-Z0-9_$]*?[A-Z_$][A-Z_])[A-Z0-9_$]*+)[ \t]*+\(\Z")
_NEAR = 64
_FLAGS = re.IGNORECASE | re.MULTILINE
#: The line before a program of an archive: %_N_SHAFT_MPF. In front of its name stands _ or %.
_HEAD = re.compile(rb"[ \t\0]*+%[ \t]*+(?:_N_)?([A-Z0-9_]{1,32}?)_(?:MPF|SPF)[ \t\r\0]*+\Z")


def take_out(code: Bytes, language: str) -> Taken:
    """
    Find the lines with statements of a language, and its names; all of them but their comments is blanked.

    Lines that begin with % or O<NAME> hold none. A line is looked at only where two letters adjoin or such a sign
    stands.
    """
    signs = _SIGNS.get(language)
    none = np.zeros(0, np.int64)
    if signs is None or not len(code):
        nothing = Ranges(none, none)
        return Taken(none, nothing, nothing, nothing, False)
    is_joined = signs.has_names and _join(code)
    is_name = _NAME_CHARACTERS[code]
    alone = b":" + signs.alone
    suspects = np.isin(code, list(alone))
    suspects[1:] |= is_name[1:] & is_name[:-1]
    told = [match.end() - 1 for match in re.finditer(signs.lines, code.tobytes(), _FLAGS)] if signs.lines else []
    at = np.union1d(np.flatnonzero(suspects), np.array(told, np.int64))
    breaks = np.append(np.flatnonzero(code == LF), len(code))
    index = np.unique(np.searchsorted(breaks, at))
    starts = np.append(0, breaks + 1)[index]
    pattern = _pattern(signs)
    found: list[int] = []
    labels: list[tuple[int, int]] = []
    programs: list[tuple[int, int]] = []
    heads: list[tuple[int, int]] = []
    for start, end in zip(starts.tolist(), breaks[index].tolist(), strict=True):
        line = code[start:end].tobytes().upper()
        if line.lstrip(_BLANK)[:2] == b"O<":
            continue
        if line.lstrip(_BLANK)[:1] == b"%":
            if signs.has_heads and (head := _HEAD.match(line)):
                code[start:end] = _BLANK[0]
                heads.append((start + head.start(1) - 1, start + head.end(1) + 1))
            continue
        if signs.has_names and (head := _HEAD_OF_FILE.fullmatch(line)):
            code[start : start + line.rindex(b"%")] = _BLANK[0]
            continue
        comments, first = _parts(line, pattern, signs)
        if first < 0:
            first = _told_in(line, start, told, comments)
        if first < 0:
            continue
        if signs.has_names:
            bare = _without(line, comments)
            if head := _PROGRAM.fullmatch(bare):
                programs.append((start + head.start(1), start + head.end(1)))
                code[start + head.start(1) : start + head.end(1)] = _BLANK[0]
                continue
            names = [name.span() for name in _SEQUENCE_NAME.finditer(bare)]
            if names and _parts(_without(bare, names), pattern, signs)[1] < 0:
                lead = _BEFORE_LABEL.match(bare)
                labels += [(start + first, start + end) for first, end in names[:1] if lead and first == lead.end()]
                for first, end in names:
                    code[start + first : start + end] = _BLANK[0]
                continue
        found.append(start + first)
        begin = 0
        for comment, after in [*comments, (len(line), len(line))]:
            code[start + begin : start + comment] = _BLANK[0]
            begin = after
    return Taken(np.array(found, np.int64), _ranges(labels), _ranges(programs), _ranges(heads), is_joined)


def _ranges(places: list[tuple[int, int]]) -> Ranges:
    start, end = np.array(places, np.int64).reshape(-1, 2).T
    return Ranges(start, end)


def _join(code: Bytes) -> bool:
    """Blank the line end before each $ with which a line goes on with the block above, and the $; whether any does."""
    data = code.tobytes()
    found = [match.span() for match in _GOES_ON.finditer(data)] if b"$" in data else []
    for start, end in found:
        code[start] = code[end - 1] = _BLANK[0]
    return bool(found)


def _without(line: bytes, places: list[tuple[int, int]]) -> bytes:
    """A line with these places of it blanked."""
    bare = bytearray(line)
    for start, end in places:
        bare[start:end] = b" " * (end - start)
    return bytes(bare)


def _told_in(line: bytes, start: int, told: list[int], comments: list[tuple[int, int]]) -> int:
    """The first of some places in a text that lies in a line and in none of its comments; -1 where none does."""
    begins = [begin for begin, _ in comments]
    for place in told[bisect.bisect_left(told, start) : bisect.bisect_left(told, start + len(line))]:
        before = bisect.bisect_right(begins, place - start) - 1
        if before < 0 or place - start >= comments[before][1]:
            return place - start
    return -1


def _pattern(signs: _Signs) -> re.Pattern[bytes]:
    alone = rb"[" + re.escape(signs.alone) + rb"]"
    return re.compile(
        rb'"[^"\n]*+"?|(' + signs.line_comment + rb")|(\()|(\))|(" + _LABEL + b"|" + _NAME + b"|" + alone + b")"
    )


def _parts(line: bytes, pattern: re.Pattern[bytes], signs: _Signs) -> tuple[list[tuple[int, int]], int]:
    """The comments of a line, and the place of its first sign of the language; -1 where it has none."""
    comments: list[tuple[int, int]] = []
    first, depth, at = -1, 0, 0
    while match := pattern.search(line, at):
        at = match.end()
        remark, opens, closes, sign = match.groups()
        if remark is not None:
            comments.append(match.span())
        elif opens:
            if signs.has_arguments and (depth > 0 or _BEFORE_ARGUMENTS.search(line[max(at - _NEAR, 0) : at])):
                depth += 1
            else:
                end = line.find(b")", at)
                at = end + 1 if end >= 0 else len(line)
                comments.append((match.start(), at))
        elif closes:
            depth = max(depth - 1, 0)
        elif first < 0 and (sign is not None or match[0][:1] == b'"') and (signs.has_arguments or sign is not None):
            first = match.start()
    return comments, first
