"""
Finds blocks with statements of a high-level or user-task language (`X=R1`, `STOPRE`, `IF [VC1 EQ 1] NEND`), and removes
them from the text that the reader of words sees. The statements are read when they are executed.

Works on one code per character with every line end as LF, before comments are found: a string may contain the
characters that begin a comment elsewhere, and parentheses behind a name contain arguments.
"""

from __future__ import annotations

import bisect
import re

import msgspec
import numpy as np

from polarcheck.foundation.arrays import side_by_side
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.reading.source import LF, PRINTED_QUOTES, Bytes, Positions
from polarcheck.program.reading.surroundings import Ranges


class _Signs(msgspec.Struct, frozen=True):
    """
    The marks by which statements of a language differ from blocks of words.

    alone: characters that no block of words contains.
    has_arguments: parentheses behind a name or a sign contain arguments; else all are comments.
    line_comment: pattern of a whole comment up to the end of the line.
    lines: pattern of further lines of the language: L100 P3 calls, G290 changes languages.
    has_heads: programs begin with lines such as %_N_SHAFT_MPF.
    has_names: N and O take names; $ is the head of a file or continues the block of the line above.
    """

    alone: bytes
    has_arguments: bool
    line_comment: bytes
    lines: bytes = b""
    has_heads: bool = False
    has_names: bool = False


class Extracted(msgspec.Struct, frozen=True):
    """
    What was removed from a text.

    statements: position of the first mark of each line with statements.
    labels: sequence names (NLAP1) at the heads of blocks of words.
    programs: names of programs (OFACE) alone in a block.
    heads: names in lines such as %_N_SHAFT_MPF, with one character on either side.
    is_joined: some line continues the block of the line above.
    commas: positions of commas in statements that stand for a decimal point.
    quotes: positions of printed quotes in statements, outside of strings in plain quotes.
    """

    statements: Positions
    labels: Ranges
    programs: Ranges
    heads: Ranges
    is_joined: bool
    commas: Positions
    quotes: Positions


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
#: A name has two letters at least; up to 20 letters O and I behind an address are mistyped digits.
_NAME = rb"(?![A-Z][OI]{1,20}+(?![A-Z0-9_]))[A-Z_$][A-Z_][A-Z0-9_$]*+"
#: No control has longer labels. Without a limit a long run would be scanned again from each of its letters.
_LABEL = rb"[A-Z_][A-Z0-9_]{1,60}+[ \t]*+:"
_BLANK = b" \t\r\0"
_HEAD_OF_FILE = lazy_pattern(rb"[ \t\r\0]*+\$[^%\n]*+%[ \t\r\0]*+")
_CONTINUATION = lazy_pattern(rb"\n[ \t\r\0]*+\$(?![^%\n]*+%)")
_PROGRAM = lazy_pattern(rb"[ \t\r\0]*+(O[A-Z][A-Z0-9]{0,15}+)[ \t\r\0]*+")
#: A sequence name: N and up to four letters and digits. NOEX runs a block without stopping at it.
SEQUENCE_NAME = r"(?<![A-Z0-9_$])N(?!OEX(?![A-Z0-9]))[A-Z][A-Z0-9]{0,3}+(?![A-Z0-9_.=\[])"
_SEQUENCE_NAME = lazy_pattern(SEQUENCE_NAME.encode())
_BEFORE_LABEL = lazy_pattern(rb"[ \t\r\0]*+(?:/[ \t]*+\d?+[ \t\r\0]*+)?+")
#: An opening parenthesis of arguments: behind a name or a sign. _NEAR: how far before it is looked [characters].
_BEFORE_ARGUMENTS = lazy_pattern(
    rb"(?:[=+\-*/,<>]|(?<![A-Z0-9_$])(?:PROC[ \t]++[A-Z]|(?>[A-Z0-9_$]*?[A-Z_$][A-Z_])[A-Z0-9_$]*+))[ \t]*+\(\Z"
)
_NEAR = 64
#: A comma between digits; and what decides whether it is a decimal point: a string, the value of AC(..), brackets.
_COMMA = lazy_pattern(rb"(?<=[0-9]),(?=[0-9])")
_OF_COMMAS = lazy_pattern(
    rb'"[^"\n]*+"?|(?<![A-Z_])(?:[AID]C|ACP|ACN)[ \t]*+\([-+ \t]*+[0-9]++(,)(?=[0-9]++[ \t]*+\))'
    rb"|[()\[\]]|(?<=[0-9]),(?=[0-9])"
)
_STRING = lazy_pattern(rb'"[^"\n]*+"?')
_PRINTED_QUOTE = lazy_pattern(b"[" + bytes(PRINTED_QUOTES) + b"]")
_DOUBLE = b"[" + bytes(code for code, plain in PRINTED_QUOTES.items() if plain == '"') + b"]"
_IN_PRINTED_QUOTES = _DOUBLE + rb"(?>[^\n]*?" + _DOUBLE + b")"
_FLAGS = re.IGNORECASE | re.MULTILINE
#: The line before a program of an archive: %_N_SHAFT_MPF. The character before the name is _ or %.
_HEAD = lazy_pattern(rb"[ \t\0]*+%[ \t]*+(?:_N_)?([A-Z0-9_]{1,32}?)_(?:MPF|SPF)[ \t\r\0]*+\Z")


def extract_statements(code: Bytes, language: str) -> Extracted:
    """
    Find the lines with statements of a language and its names, and blank them in `code`, except for their comments.

    Lines that begin with % or O<NAME> contain none. Only lines with two adjacent letters or one of the marks are
    examined.
    """
    signs = _SIGNS.get(language)
    none = np.zeros(0, np.int64)
    if signs is None or not len(code):
        nothing = Ranges(none, none)
        return Extracted(none, nothing, nothing, nothing, False, none, none)
    is_joined = signs.has_names and _join(code)
    is_name = _NAME_CHARACTERS[code]
    alone = b":" + signs.alone
    suspects = np.isin(code, list(alone))
    suspects[1:] |= is_name[1:] & is_name[:-1]
    marks = [match.end() - 1 for match in re.finditer(signs.lines, code.tobytes(), _FLAGS)] if signs.lines else []
    suspected = np.union1d(np.flatnonzero(suspects), np.array(marks, np.int64))
    breaks = np.append(np.flatnonzero(code == LF), len(code))
    index = np.unique(np.searchsorted(breaks, suspected))
    starts = np.append(0, breaks + 1)[index]
    pattern = _pattern(signs)
    statements: list[int] = []
    labels: list[tuple[int, int]] = []
    programs: list[tuple[int, int]] = []
    heads: list[tuple[int, int]] = []
    commas: list[int] = []
    quotes: list[int] = []
    for start, end in side_by_side(starts, breaks[index]):
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
            first = _first_outside(line, start, marks, comments)
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
        statements.append(start + first)
        if _COMMA.search(line):
            commas += [start + suspected for suspected in _decimal_commas(_without(line, comments))]
        if _PRINTED_QUOTE.search(line):
            bare = _without(line, [*comments, *(string.span() for string in _STRING.finditer(line))])
            quotes += [start + quote.start() for quote in _PRINTED_QUOTE.finditer(bare)]
        begin = 0
        for comment, after in [*comments, (len(line), len(line))]:
            code[start + begin : start + comment] = _BLANK[0]
            begin = after
    return Extracted(
        np.array(statements, np.int64),
        Ranges.of(labels),
        Ranges.of(programs),
        Ranges.of(heads),
        is_joined,
        np.array(commas, np.int64),
        np.array(quotes, np.int64),
    )


def _decimal_commas(line: bytes) -> list[int]:
    """
    The commas between two digits of a line without comments that are decimal points: in brackets and parentheses commas
    separate arguments, but behind AC and its like one value stands.
    """
    commas, depth = [], 0
    for match in _OF_COMMAS.finditer(line):
        if match[0] == b"," and depth == 0:
            commas.append(match.start())
        elif match[0] in (b"(", b"["):
            depth += 1
        elif match[0] in (b")", b"]"):
            depth = max(depth - 1, 0)
        elif match[1] is not None:
            commas.append(match.start(1))
            depth += 1
    return commas


def _join(code: Bytes) -> bool:
    """Blank each $ that continues the block of the line above, and the line end before it; True if there is one."""
    data = code.tobytes()
    spans = [match.span() for match in _CONTINUATION.finditer(data)] if b"$" in data else []
    for start, end in spans:
        code[start] = code[end - 1] = _BLANK[0]
    return bool(spans)


def _without(line: bytes, places: list[tuple[int, int]]) -> bytes:
    """A line with these spans blanked."""
    bare = bytearray(line)
    for start, end in places:
        bare[start:end] = b" " * (end - start)
    return bytes(bare)


def _first_outside(line: bytes, start: int, marks: list[int], comments: list[tuple[int, int]]) -> int:
    """The first mark in a line outside its comments, as an index of the line; -1 for none. start: of the line."""
    begins = [begin for begin, _ in comments]
    for mark in marks[bisect.bisect_left(marks, start) : bisect.bisect_left(marks, start + len(line))]:
        before = bisect.bisect_right(begins, mark - start) - 1
        if before < 0 or mark - start >= comments[before][1]:
            return mark - start
    return -1


def _pattern(signs: _Signs) -> re.Pattern[bytes]:
    alone = rb"[" + re.escape(signs.alone) + rb"]"
    strings = rb'"[^"\n]*+"?|' + _IN_PRINTED_QUOTES
    sign = b"|".join((_LABEL, _NAME, alone))
    return re.compile(strings + rb"|(" + signs.line_comment + rb")|(\()|(\))|(" + sign + b")")


def _parts(line: bytes, pattern: re.Pattern[bytes], signs: _Signs) -> tuple[list[tuple[int, int]], int]:
    """The comments of a line, and the index of its first mark of the language; -1 for none."""
    comments: list[tuple[int, int]] = []
    first, depth, searched = -1, 0, 0
    while match := pattern.search(line, searched):
        searched = match.end()
        comment, opens, closes, sign = match.groups()
        if comment is not None:
            comments.append(match.span())
        elif opens:
            if signs.has_arguments and (
                depth > 0 or _BEFORE_ARGUMENTS.search(line[max(searched - _NEAR, 0) : searched])
            ):
                depth += 1
            else:
                end = line.find(b")", searched)
                searched = end + 1 if end >= 0 else len(line)
                comments.append((match.start(), searched))
        elif closes:
            depth = max(depth - 1, 0)
        elif first < 0 and (sign is not None or match[0][:1] == b'"') and (signs.has_arguments or sign is not None):
            first = match.start()
    return comments, first
