"""The kinds of characters that the reader of words distinguishes."""

from __future__ import annotations

import enum

import numpy as np

from polarcheck.foundation.states import plain
from polarcheck.program.reading.source import DASH
from polarcheck.program.reading.surroundings import BLANKS


@plain
class Character(enum.IntEnum):
    """The kind of a character; those above COMMA are not part of a word."""

    BLANK = 0
    LETTER = 1
    BREAK = 2
    DIGIT = 3
    POINT = 4
    SIGN = 5
    COMMA = 6
    MACRO = 7
    STRAY = 8


def _kinds() -> bytes:
    table = np.full(256, Character.STRAY, np.uint8)
    table[list(BLANKS)] = Character.BLANK
    for kind, characters in (
        (Character.LETTER, b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz/"),
        (Character.DIGIT, b"0123456789"),
        (Character.POINT, b"."),
        (Character.SIGN, bytes([*b"+-", DASH])),
        (Character.BREAK, b"\n;"),
        (Character.MACRO, b"#[]=*"),
    ):
        table[list(characters)] = kind
    return table.tobytes()


#: The kind of each of 256 codes.
KINDS = _kinds()
