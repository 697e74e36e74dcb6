"""
Finds letters that were typed for digits, O for 0 and I for 1, and replaces them.

Works on one code per character with comments, names and remarks blanked. Prose and macro statements (GOTO 10, DO1) do
not change.
"""

from __future__ import annotations

import re

import numpy as np

from polarcheck.foundation.arrays import different, side_by_side
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.reading.source import DASH, LF, Bytes, Positions

_SEMICOLON, _SMALL = ord(";"), 0x20
_O, _I = b"oi"
_POINT = ord(".")
_TWO_BREAKS = np.full(2, LF, np.uint8)
#: Behind these characters an O is part of a word or number; behind others, as a blank, it begins a word.
_JOINS = np.isin(
    np.arange(256), list(bytes([*b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.+-", DASH]))
)
_IS_LETTER = np.isin(np.arange(256), list(b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"))
_BEGINS_WORD = _IS_LETTER | np.isin(np.arange(256), [*b"+-", DASH])
#: Before these characters, or a point and these, an I is an address with a number.
_BEGINS_NUMBER = np.isin(np.arange(256), list(bytes([*b"0123456789+-#[=", DASH])))

#: A longer block was not typed by hand [characters].
_LONGEST = 1000
_SIGN = rb"[-+\x96]"
_NUMBER = rb"[-+\x96.\s]*+\d[-+\x96.\d\s]*+"
_HEAD = rb"\s*+(?:/\s*+\d?+\s*+)*+(?:N\s*+\d++\s*+(?:/\s*+\d?+\s*+)*+)?+"
#: An address with a number in which letters stand; an I with a number of its own is an address.
_WORD = lazy_pattern(
    rb"([A-Z:])(" + _SIGN + rb"?(?:[OI]++|[\d.])(?:[\d.O]|I(?!\s*+(?:" + _SIGN + rb"|\.?[\dO])))*+)", re.IGNORECASE
)
#: A block in which every address has digits.
_BLOCK = lazy_pattern(rb"\s*+(?:/\s*+\d?+\s*+|(?:,?[A-Z]|:)" + _NUMBER + rb")*+[*$!&\s]*+", re.IGNORECASE)
#: Macro statements.
_OTHER = lazy_pattern(
    rb".*?(?:[#\[\]=]|G\s*+O\s*+T\s*+O)|" + _HEAD + rb"(?:D\s*+O\s*+\d|G\s*+O\s*+\d++\s*+\Z)",
    re.IGNORECASE | re.DOTALL,
)
_PROGRAM_AFTER_NUMBER = lazy_pattern(_HEAD + rb"[O:]\d++\s*+", re.IGNORECASE)
_NUMBERED_WORD = lazy_pattern(rb"[A-Z]\s*+" + _SIGN + rb"?+(?:\d|\.\d)", re.IGNORECASE)
#: A program number behind the end of the program before it, and the offset number of old mills, T1O1.
_OTHER_O = lazy_pattern(rb"M0*+(?:2|30|99)O\d{4,8}|T\d++O\d++", re.IGNORECASE)
#: Addresses of which a word may be letters alone, as XO; the second where another word of the block has digits; the
#: third with a letter right behind, as in G1 XOZ5., which POS1 and LOT5 are not.
_OF_ZERO, _OF_ZERO_BESIDE, _OF_ZERO_BEFORE_LETTER = b"MXYZCUW", b"MXYZABCUVWIJKRFSHDPQE", b"XYZCUW"
#: Addresses of which IO is 10, as in ZIO.; I0 behind a letter without a number would mean nothing.
_OF_TEN = b"XYZCUVW"


def read_as_digits(code: Bytes) -> Positions:
    """Replace letters O and I that were typed for digits; return their positions."""
    suspects = _suspects(code)
    if not len(suspects):
        return suspects
    breaks = np.append(np.flatnonzero((code == LF) | (code == _SEMICOLON)), len(code))
    index = different(np.searchsorted(breaks, suspects))
    starts = np.append(0, breaks + 1)[index]
    places = [
        start + offset
        for start, end in side_by_side(starts, breaks[index])
        for offset in _in_block(code[start:end].tobytes())
    ]
    positions = np.array(places, np.int64)
    code[positions] = np.where(code[positions] | _SMALL == _O, ord("0"), ord("1"))
    return positions


def _suspects(code: Bytes) -> Positions:
    """Letters O inside a word or number, and letters I behind an address, or without a number."""
    small = code | np.uint8(_SMALL)
    index = np.flatnonzero((small == _O) | (small == _I))
    index = index[index > 0]
    before = code[index - 1]
    longer = np.append(code, _TWO_BREAKS)
    follower = longer[index + 1]
    follower = np.where(follower == _POINT, longer[index + 2], follower)
    is_o = small[index] == _O
    return np.asarray(index[_JOINS[before] & (is_o | _BEGINS_WORD[before] | ~_BEGINS_NUMBER[follower])])


def _in_block(block: bytes) -> list[int]:
    """The indices of such letters in a block; none if the block would be faulty with the digits, too."""
    if len(block) > _LONGEST or _OTHER.match(block) or _PROGRAM_AFTER_NUMBER.fullmatch(block):
        return []
    digits = bytearray(block)
    places: list[int] = []
    numbered = _NUMBERED_WORD.search(block)
    first_numbered = numbered.start() if numbered else len(block)
    end_before = 0
    for word in _WORD.finditer(block):
        letters = [index for index in range(word.start(2), word.end(2)) if block[index] | _SMALL in (_O, _I)]
        if not letters:
            continue
        stands_alone = word.start() in (0, end_before) or not _IS_LETTER[block[word.start() - 1]]
        if not (stands_alone and _may_be_number(block, word, first_numbered)):
            return []
        end_before = word.end()
        for index in letters:
            digits[index] = ord("0") if block[index] | _SMALL == _O else ord("1")
        places += letters
    return places if _BLOCK.fullmatch(digits) else []


def _may_be_number(block: bytes, word: re.Match[bytes], first_numbered: int) -> bool:
    """True where letters in the number of a word can be digits, and not a word of prose."""
    address, number = word[1].upper(), word[2].upper().lstrip(b"+-\x96")
    if number.count(b".") > 1 or _OTHER_O.fullmatch(word[0]):
        return False
    if any(48 <= character < 58 for character in number):
        return address != b"N" or b"." not in number
    if address == b"G":
        return len(number) < 3
    digits = number.rstrip(b".")
    if len(digits) > 2 or (b"I" in digits and not (digits == b"IO" and address in _OF_TEN)):
        return False
    if word.end() < len(block) and _IS_LETTER[block[word.end()]]:
        return address in _OF_ZERO_BEFORE_LETTER and first_numbered < word.start()
    return address in _OF_ZERO or (address in _OF_ZERO_BESIDE and first_numbered < len(block))
