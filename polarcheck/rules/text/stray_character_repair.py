from __future__ import annotations

import numpy as np

from polarcheck.columns.words.written import Written
from polarcheck.foundation.arrays import is_among
from polarcheck.program.reading.source import PRINTED_QUOTES
from polarcheck.program.reading.words import Text
from polarcheck.rules.repair import Mended, repair

_COMMA, _ZERO, _NINE = b",09"


@repair()
def stray_character(text: Text, written: Written, index: int) -> Mended | None:
    """
    A decimal comma becomes a decimal point, and printed quotes plain ones.

    Safe: they are read so anyway. Where one finding stands for several of them, all are mended. For other characters
    there is no fix.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C8,660
        X60. C-8,660
        C0
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C8.660
        X60. C-8.660
        C0
        G13.1
    """
    code, starts = text.source.code, text.strays.start
    is_quote = text.blocks.is_macro[text.strays.block] & is_among(code[starts], list(PRINTED_QUOTES))
    if is_quote[index]:
        if written.stray_count[index] == 1:
            is_quote &= text.strays.block == text.strays.block[index]
        edits = tuple((at, at + 1, PRINTED_QUOTES[int(code[at])]) for at in starts[is_quote].tolist())
        return Mended("Write plain quotes", True, edits)
    # A character between two others: text does not begin or end with a comma of a number.
    inner = np.clip(starts, 1, max(len(code) - 2, 1))
    is_digit = (code >= _ZERO) & (code <= _NINE)
    is_decimal = (inner == starts) & (code[starts] == _COMMA)
    is_decimal &= ~text.blocks.is_macro[text.strays.block]
    is_decimal[is_decimal] = is_digit[starts[is_decimal] - 1] & is_digit[starts[is_decimal] + 1]
    if not is_decimal[index]:
        return None
    if written.stray_count[index] == 1:
        is_decimal &= text.strays.block == text.strays.block[index]
    return Mended("Write a decimal point", True, tuple((at, at + 1, ".") for at in starts[is_decimal].tolist()))
