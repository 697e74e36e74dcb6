"""
Blocks that hold statements of a control's own language (`X=R1`, `STOPRE`, `IF [VC1 EQ 1] NEND`): found, and taken out
of the text that the reader of words sees. What they say is read when they are executed.

Works on one code per character with every line end as LF, before comments are looked for: a string may hold what
elsewhere begins a comment, and behind a name parentheses hold arguments.
"""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from polarcheck.reading.source import LF, Bytes, Positions


class _Signs(NamedTuple):
    """
    How blocks of a language are told from blocks of words.

    alone: characters that no block of words has. has_arguments: parentheses behind a name or a sign hold arguments,
    else they are comments everywhere. line_comment: begins a comment, as a pattern that matches it whole.
    """

    alone: bytes
    has_arguments: bool
    line_comment: bytes


_SIGNS = {
    "high-level": _Signs(b'="[$', True, rb";[^\n]*+"),
    "user-task": _Signs(b"=[", False, rb"(?!)"),
}
_NAME_CHARACTERS = np.isin(np.arange(256), list(b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_"))
#: A name has two letters at least; the letters O and I behind an address are digits that somebody mistyped.
_NAME = rb"(?![A-Z][OI]++(?![A-Z0-9_]))[A-Z_$][A-Z_][A-Z0-9_$]*+"
_LABEL = rb"[A-Z_][A-Z0-9_]++[ \t]*+:"
_BLANK = b" \t\r\0"
#: A parenthesis that belongs to what stands before it: a name, a sign; so much before it is looked at [characters].
_BEFORE_ARGUMENTS = re.compile(rb"(?:[=+\-*/,<>]|[A-Z_$][A-Z_][A-Z0-9_$]*+)[ \t]*+\(\Z")
_NEAR = 64


def take_out(code: Bytes, language: str) -> Positions:
    """
    The place of the first sign of each line with statements of a language; all of the line but its comments is blanked.

    Lines that begin with % hold none. A line is looked at only where two letters adjoin or such a sign stands.
    """
    signs = _SIGNS.get(language)
    if signs is None or not len(code):
        return np.zeros(0, np.int64)
    is_name = _NAME_CHARACTERS[code]
    alone = b":" + signs.alone
    suspects = np.isin(code, list(alone))
    suspects[1:] |= is_name[1:] & is_name[:-1]
    at = np.flatnonzero(suspects)
    breaks = np.append(np.flatnonzero(code == LF), len(code))
    index = np.unique(np.searchsorted(breaks, at))
    starts = np.append(0, breaks + 1)[index]
    pattern = _pattern(signs)
    found = []
    for start, end in zip(starts.tolist(), breaks[index].tolist(), strict=True):
        line = code[start:end].tobytes().upper()
        if line.lstrip(_BLANK)[:1] == b"%":
            continue
        comments, first = _parts(line, pattern, signs)
        if first < 0:
            continue
        found.append(start + first)
        begin = 0
        for comment, after in [*comments, (len(line), len(line))]:
            code[start + begin : start + comment] = _BLANK[0]
            begin = after
    return np.array(found, np.int64)


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
            if signs.has_arguments and (depth > 0 or _BEFORE_ARGUMENTS.search(line, max(at - _NEAR, 0), at)):
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
