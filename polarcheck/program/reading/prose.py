"""A cheap test for prose outside of parentheses; prose_in_blocks.py finds it."""

from __future__ import annotations

import numpy as np

from polarcheck.program.reading.source import Bytes, Source
from polarcheck.program.reading.surroundings import Ranges

_BAR = ord("|")
#: Letters of any language, including bytes of an unknown encoding; and the bars of tables.
_LETTERS = bytes([*b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz", *range(0xA1, 0xFF)])
_KINDS = bytes(1 if code in _LETTERS else 2 if code == _BAR else 0 for code in range(256))


def find_prose(source: Source, code: Bytes) -> Ranges:
    """
    Find the prose outside of parentheses, in order, and blank it in `code`, a copy of the codes of the source.

    code: one code per character with comments, names and remarks blanked. Only blocks with a bar or with two adjacent
    letters are examined; most programs have none.
    """
    kinds = code.tobytes().translate(_KINDS)
    if b"\1\1" not in kinds and b"\2" not in kinds:
        return Ranges(np.zeros(0, np.int64), np.zeros(0, np.int64))
    from polarcheck.program.reading.prose_in_blocks import prose_in_blocks  # late: its patterns take 10 ms to compile

    kind = np.frombuffer(kinds + b"\0\0", np.uint8)
    return prose_in_blocks(source, code, ((kind[1:] & kind[:-1] & 1) | (kind[:-1] >> 1)).view(bool))
