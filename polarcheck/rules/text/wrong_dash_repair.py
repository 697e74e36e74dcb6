from __future__ import annotations

import numpy as np

from polarcheck.columns.words.written import Written
from polarcheck.program.reading.source import DASH
from polarcheck.program.reading.words import Text
from polarcheck.rules.repair import Mended, repair


@repair()
def wrong_dash(text: Text, written: Written, index: int) -> Mended:
    """
    The dash of print becomes a minus sign.

    Safe: the word is read as negative anyway. Where one finding stands for many words, all of them are mended.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C–10. (OUT – AND BACK)
        X60. C0
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C-10. (OUT – AND BACK)
        X60. C0
        G13.1
    """
    words = text.words
    mended = np.flatnonzero(words.has_wrong_dash) if written.wrong_dash_count[index] > 1 else np.array([index])
    edits = []
    for word in mended.tolist():
        start, end = int(words.start[word]), int(words.end[word])
        at = start + np.flatnonzero(text.source.code[start:end] == DASH)
        edits += [(place, place + 1, "-") for place in at.tolist()]
    return Mended("Write a minus sign", True, tuple(edits))
