"""
Finds prose outside of parentheses, beside or between the blocks, and blanks it like comments.

Examples are a description column copied with a program, a remark, a title. Works on one code per character with
comments, names and remarks blanked. Words of a control (macro statements, names of Siemens and Okuma) are not prose,
nor are addresses without numbers.
"""

from __future__ import annotations

import itertools
import re
from array import array
from collections.abc import Sequence
from typing import TypeAlias

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Mask, Rows, side_by_side
from polarcheck.program.reading.source import LF, Bytes, Source
from polarcheck.program.reading.surroundings import Ranges, blank

Match: TypeAlias = re.Match[bytes]

_TAB = b"\t"
_SEMICOLON, _OPEN = b";("
_BLANKS = bytes([*range(10), *range(11, 33), 0x7F, 0xA0])
#: How much of a block is examined [characters], and how many of its words: enough to classify it.
_EXAMINED = 4000
_WORDS_EXAMINED = 40
#: Most blocks with adjacent letters that are examined; a file with more is a text, or one of macro statements.
_BLOCK_LIMIT = 200_000

_B = rb"[\0-\x09\x0b-\x20\x7f\xa0]*+"
#: An O stands for a digit here, unless a word of the text begins with it, as in M8ON.
_DIGITS = rb"(?:[\d.]|O(?![A-Z](?![-+.\d])))*+"
_NUMBER = rb"[-+\x96]?+" + _B + rb"\.?+\d" + _DIGITS
#: What stands right behind a word; other signs make it a part of the text, as in `A 3/4" END MILL`.
_BEHIND = rb"(?=[\0-\x20\x7f\xa0-\xfeA-Z,|\-\x96:]|\Z)"
_WORD = rb",?+[A-Z:]" + _B + _NUMBER + _BEHIND
_G0 = rb"GO(?=" + _B + rb"[CHUVWXYZ]" + _B + _NUMBER + rb")"
_LINE_NUMBER = rb"(?:" + _B + rb"\d{1,6}+" + _B + rb"[:.)]?+(?=" + _B + rb"[A-Z][-+]?+\.?+\d))?+"
_CODE = re.compile(
    _LINE_NUMBER + rb"(?:" + _B + rb"/\d?+(?=[\0-\x20A-Z]))*+(?:" + _B + rb"(?:" + _WORD + rb"|" + _G0 + rb"))*+",
    re.IGNORECASE,
)
_SOUND = re.compile(rb"(?:" + _B + _WORD + rb")++[\s\0\xa0]*+", re.IGNORECASE)
_NUMBERING = re.compile(_B + rb"(?:[N:]?+" + _B + rb"\d++" + _B + rb"[:.)]?+)?+" + _B, re.IGNORECASE)
_SWITCHES_ALONE = re.compile(rb"(?:" + _B + rb"[GMN]" + _B + rb"[\d.]++)++" + _B, re.IGNORECASE)
_PROGRAM = re.compile(_B + rb"[O:]" + _B + rb"\d", re.IGNORECASE)
_RUN = re.compile(rb"[A-Z_\xa1-\xfe]{2,}+", re.IGNORECASE)
#: Between a description that stands first and its block.
_COLUMN = re.compile(rb"(?<![ \t])(?:[ ]*+\t[ \t]*+|[ ]{3,}+)(?=[GMNSTXZ]" + _B + _NUMBER + rb")")
#: What makes more of a line than the beginning of a description.
_SWITCH = re.compile(rb"[GMNTS]" + _B + rb"\d", re.IGNORECASE)
_ASCII = re.compile(rb"[A-Z]{2}", re.IGNORECASE)
_OTHER_SCRIPT = re.compile(r"[^\W\d_\uff00-\uffef]{2}")
_MACRO = re.compile(rb"#\s*+[\d\[<_]|[\[\]=]")

#: Words of macro statements and of controls' own languages that are no words of a description.
_STATEMENTS = frozenset(
    b"GOTO GOTOF GOTOB GOTOC GOTOS ENDIF ENDW ENDWHILE ENDFOR ENDLOOP XOR MOD SIN COS TAN ASIN ACOS ATAN SQRT ABS"
    b" BIN BCD FUP POW ADP POPEN PCLOS DPRNT BPRNT SETVN PRM EQ NE GT LT GE LE NOEX RTS MODIN MODOUT MSG NMSG"
    b" LPRINT TRANSMIT TRACYL TRAFOOF TRAFOON TRAOOF TRAANG TRAORI TRACON TRAILON TRAILOF SETMS SPOS SPOSA LIMS"
    b" ATRANS AROT AROTS ROT ROTS AMIRROR ASCALE DIAMON DIAMOF DIAM DIAMCYCOF STOPRE STOPREOF WAITM WAITE WAITS"
    b" WAITMC EXTERN EXTCALL MCALL PCALL PROC DEF DEFINE RET DISPLOF DISPLON SBLOF SBLON SUPA KONT KONTT KONTC CFC"
    b" CFTCP CFIN FFWON FFWOF COMPON COMPOF COMPCAD COMPCURV ORIWKS ORIMKS OFFN RND RNDM CHF CHR CIP FGROUP"
    b" WALIMON WALIMOF REPEATB MASLON COUPON COUPOF COUPDEF SYNFCT POLF LFON LFOF CYCLE POCKET HOLES LONGHOLE"
    b" WHENEVER IDS ACP ACN GETT ASPLINE BSPLINE CSPLINE POLY CDON CDOF STARTFIFO STOPFIFO NEWCONF WALCS GEOAX"
    b" MEAS MEAW TOROT PAROT TCARR TOFRAME INVFRAME SOFT BRISK DRIVE NORM TRANS MIRROR SCALE AC DC IC CT CC DR"
    b" FMAX LBL CYCL BLK PGM MEND NLAP NAT NEND".split()
)
#: The same that are also words of every day: alone they say nothing, beside others they are prose. The first of them
#: stand before names: CALL OFACE.
_CALLS = frozenset(
    b"IF THEN ELSE GO DO CALL DRAW GET PUT READ WRITE CLEAR SAVE CASE DEFAULT LOOP FOR WHILE REPEAT UNTIL WHEN EVERY"
    b" ENABLE DISABLE CANCEL STRING CHAR BOOL REAL INT SLOT SUB".split()
)
_AMBIGUOUS = _CALLS | frozenset(b"END AND OR FIX ROUND EXP LN OF TO TURN AXIS FRAME FROM NOT TRUE FALSE ID".split())
#: What of a macro statement may stand behind its last variable.
_OF_MACRO = frozenset(b"GOTO GO DO END THEN IF WHILE AND OR XOR MOD EQ NE GT LT GE LE".split())
_ADDRESSES = frozenset(b"XYZUVWABCGMTSNFIJKRHPQD")
_LINEAR, _ROTARY = frozenset(b"XYZUVW"), frozenset(b"CH")
#: Short for words, without a vowel.
_OF_THE_SHOP = frozenset(b"RPM CW CCW".split())
_VOWELS = frozenset(b"AEIOU")
#: From this number of blocks with prose on, their layout says where the prose of each begins, and doubtful words count.
_MANY = 3
#: From this number of words on, a sentence may begin with a word of a control.
_SENTENCE = 4
#: Bytes above 127 from which on a text counts as prose, where the encoding is not known.
_FEW_BYTES = 4


class _Prose(msgspec.Struct, frozen=True):
    """
    Prose in a block, by indices of its characters.

    start, end: the prose, end exclusive.
    code_end: end of the words before it.
    is_certain: it is prose even if nothing else in the file is.
    """

    start: int
    end: int
    code_end: int
    is_certain: bool


def prose_in_blocks(source: Source, code: Bytes, is_suspect: Mask) -> Ranges:
    """
    Find the prose outside of parentheses, in order, and blank it in `code`, a copy of the codes of the source.

    is_suspect: per character, True where its block is to be examined; one more for an empty block at the end.
    """
    data = code.tobytes()
    breaks = np.append(np.flatnonzero((code == LF) | (code == _SEMICOLON)), len(code))
    starts = np.append(0, breaks[:-1] + 1)
    index = np.flatnonzero(np.logical_or.reduceat(is_suspect, starts))[:_BLOCK_LIMIT]
    places = side_by_side(starts[index], breaks[index])
    rows = array("q")
    for begin, end in places:
        block = data[begin : min(end, begin + _EXAMINED)]
        for prose in _in_block(block, source.code[begin : begin + len(block)]):
            if _has_letters(source, block[prose.start : prose.end], begin + prose.start):
                stop_of_prose = end if prose.end == len(block) else begin + prose.end
                stop = begin + _end_of(source.code[begin:stop_of_prose])
                rows.extend((begin, begin + prose.start, stop, begin + prose.code_end, prose.is_certain))
    ranges = _of_the_file(data, np.frombuffer(rows, np.int64).reshape(-1, 5))
    blank(code, ranges)
    return ranges


def _end_of(written: Bytes) -> int:
    """The end of a block without trailing blanks; comments behind prose belong to it."""
    return len(written.tobytes().rstrip(_BLANKS))


def _has_letters(source: Source, text: bytes, start: int) -> bool:
    """True for text with letters of ASCII or of another script; full-width letters and stray bytes do not count."""
    if _ASCII.search(text) or text[:1] == b"|":
        return True
    high = sum(character >= 0x80 for character in text)
    written = source.excerpt(start, start + len(text))
    return _OTHER_SCRIPT.search(written) is not None and (source.encoding != "latin-1" or high >= _FEW_BYTES)


def _of_the_file(data: bytes, rows: Rows) -> Ranges:
    """
    The prose of a file, judged by all its blocks.

    If enough of it is certain, the doubtful counts as well. In a table with tabs, words behind the tab that read like a
    block belong to the description, as in `X2.15<TAB>X50 is the start`; so do the words that begin a wrapped line.

    rows: per prose its block, start, end, end of the words before it, and 1 if it is certain.
    """
    certain = rows[:, 4] > 0
    if np.count_nonzero(certain) < _MANY:
        return Ranges(rows[certain, 1], rows[certain, 2])
    block, start, end, code_end, _ = rows.T
    with_code = np.flatnonzero(code_end > block)
    tabbed = np.array(
        [_TAB in data[line_start:first] for line_start, first in rows[with_code][:, [3, 1]].tolist()], bool
    )
    if np.count_nonzero(tabbed) >= max(_MANY, len(tabbed) / 2):
        start = start.copy()
        for row in with_code[~tabbed].tolist():
            before = data[block[row] : start[row]]
            words, tab, _ = before.rpartition(_TAB)
            if tab and words.strip():
                start[row] = block[row] + len(words) + 1
            elif not tab and not _SWITCH.search(before):
                start[row] = block[row]
    return Ranges(start, end)


def _in_block(block: bytes, written: Bytes) -> list[_Prose]:
    """
    The prose in a block. written: the block before comments were blanked.

    It begins behind the words of the block. Of two or more words one must be pronounceable; a single word may be a name
    and is examined more closely.
    """
    if block.lstrip(_BLANKS)[:1] == b"|" and block.count(b"|") > 1:
        return _in_table_row(block)
    match = _CODE.match(block)
    code_end = match.end() if match else 0
    runs = list(itertools.islice(_RUN.finditer(block, code_end), _WORDS_EXAMINED))
    words = [run for run in runs if _is_word(run[0])]
    if not runs:
        return []
    begin = len(block) - len(block[code_end:].lstrip(_BLANKS))
    end = len(block)
    if _MACRO.search(block):
        start = _beside_macro(block, runs, words, begin)
        return [] if start is None else [_Prose(start, end, code_end, True)]
    if len(words) < 2 and (len(runs) < _SENTENCE - 1 or not words or runs[0][0].upper() in _CALLS):
        return _single(block, written, runs, words, _Prose(begin, end, code_end, False))
    if _is_statement(runs[0]) and len(words) < _SENTENCE:
        return []
    if _NUMBERING.fullmatch(block, 0, code_end):
        column = _COLUMN.search(block, runs[-1].end())
        if column and _SOUND.fullmatch(block, column.end()):
            end = column.end()
    return [_Prose(begin, end, code_end, any(_is_long(word) for word in words))]


def _in_table_row(block: bytes) -> list[_Prose]:
    """The prose in a line of a table, | M5 | Stop the spindle |: all but the first cell that reads as a block."""
    before, begin, edge = [], 0, 0
    for cell in block.split(b"|"):
        code = cell.strip(_BLANKS + b"`*")
        if _SOUND.fullmatch(code):
            start = edge + cell.index(code)
            before = [_Prose(begin, start, begin, True)]
            begin = start + len(code)
            break
        edge += len(cell) + 1
    return [*before, _Prose(begin, len(block), begin, True)]


def _single(block: bytes, written: Bytes, runs: Sequence[Match], words: Sequence[Match], prose: _Prose) -> list[_Prose]:
    """The prose of a single word: a title or remark, not a statement or a name that a control would call."""
    is_alone = _NUMBERING.fullmatch(block, 0, prose.code_end) is not None
    if any(map(_is_statement, runs)) or not (words or len(runs) == 1):
        return []
    if is_alone and _is_known(runs[0]) and (not words or runs[0][0].upper() in _CALLS):
        return []
    word = words[0] if words else runs[0]
    following = block[word.end() : word.end() + 1]
    is_call = word.end() < len(written) and written[word.end()] == _OPEN
    is_name = following.isdigit() or following == b":" or (is_alone and word[0][:1] in b"Oo")
    if (is_alone and (is_call or is_name)) or (is_name and word[0][:1] in b"Nn"):
        return []
    is_certain = bool(words) and _is_long(word) and not (is_alone and _is_known(runs[0]))
    is_certain &= not is_name or _PROGRAM.match(block) is not None
    if _SWITCHES_ALONE.fullmatch(block, 0, prose.code_end) and _SOUND.fullmatch(block, word.end()):
        return [_Prose(prose.start, word.end(), prose.code_end, is_certain)]
    return [_Prose(prose.start, prose.end, prose.code_end, is_certain)]


def _beside_macro(block: bytes, runs: Sequence[Match], words: Sequence[Match], begin: int) -> int | None:
    """Where prose begins in a block with signs of macro: before them, if they are part of it, or behind them."""
    signs = [sign.span() for sign in _MACRO.finditer(block)]
    before = [word for word in words if word.end() <= signs[0][0]]
    needed = _SENTENCE if _is_statement(runs[0]) else 3 if _is_known(runs[0]) else 2
    if len(before) >= needed and any(map(_is_long, before)):
        return begin
    following = [word for word in words if word.start() >= signs[-1][1]]
    needed = _SENTENCE if _is_statement(runs[0]) else 2
    if (
        len(following) == 1
        and runs[-1] is following[0]
        and b"#" in block
        and block[following[0].start()] not in b"NOno"
    ):
        needed = 1
    if len(following) < needed or not any(map(_is_long, following)):
        return None
    first = runs.index(following[0])
    while first and runs[first - 1].start() >= signs[-1][1] and runs[first - 1][0].upper() not in _OF_MACRO:
        first -= 1
    start = runs[first].start()
    between = block[signs[-1][1] : start]
    is_value = block[signs[-1][0]] in b"[=" and not between.strip()
    return None if is_value or between[-1:] not in (b" ", b"\t") or b'"' in between else start


def _is_word(run: bytes) -> bool:
    """True for letters that are a word, not a name or addresses without numbers."""
    run = run.upper()
    if b"_" in run or run in _STATEMENTS or run in _AMBIGUOUS:
        return False
    letters = set(run)
    if not run.isascii() or run in _OF_THE_SHOP:
        return True
    if len(letters) == 1:
        return False  # in manuals XX means any number
    if len(letters) < len(run) or not letters <= _ADDRESSES:
        return True
    return len(letters & _LINEAR) < 2 and not (letters & set(b"XZ") and letters & _ROTARY)


def _is_long(run: Match) -> bool:
    word = run[0].upper()
    return not word.isascii() or word in _OF_THE_SHOP or (len(word) > 2 and bool(set(word) & _VOWELS))


def _is_statement(run: Match) -> bool:
    return run[0].upper() in _STATEMENTS or b"GOTO" in run[0].upper()


def _is_known(run: Match) -> bool:
    return _is_statement(run) or run[0].upper() in _AMBIGUOUS
