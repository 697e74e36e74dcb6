"""Text for people in no parentheses: whether there can be any, which is cheap; prose_in_blocks.py finds it."""

from __future__ import annotations

import numpy as np

from polarcheck.reading.source import Bytes, Source
from polarcheck.reading.surroundings import Ranges

_BAR = ord("|")
#: Letters of any language, bytes of an encoding that nobody named among them; and the lines of tables.
_LETTERS = bytes([*b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz", *range(0xA1, 0xFF)])
_KINDS = bytes(1 if code in _LETTERS else 2 if code == _BAR else 0 for code in range(256))


def find_prose(source: Source, code: Bytes) -> Ranges:
    """
    The text in no parentheses, in order, blanked in `code`, a copy of the codes of the source or of their beginning.

    code: one code per character with comments, names and remarks blanked. Only a block with a bar or with two letters
    that adjoin is looked at; most programs have none.
    """
    kinds = code.tobytes().translate(_KINDS)
    if b"\1\1" not in kinds and b"\2" not in kinds:
        return Ranges(np.zeros(0, np.int64), np.zeros(0, np.int64))
    from polarcheck.reading.prose_in_blocks import prose_in_blocks  # late: its patterns take 10 ms to compile

    kind = np.frombuffer(kinds + b"\0\0", np.uint8)
    return prose_in_blocks(source, code, ((kind[1:] & kind[:-1] & 1) | (kind[:-1] >> 1)).view(bool))
