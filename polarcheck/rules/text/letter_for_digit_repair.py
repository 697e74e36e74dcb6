from __future__ import annotations

import numpy as np

from polarcheck.columns.words.written import Written
from polarcheck.foundation.arrays import stretch
from polarcheck.program.reading.words import Text
from polarcheck.rules.places import Place
from polarcheck.rules.repair import Mended, repair
from polarcheck.rules.wording.written import with_digits


@repair()
def letter_for_digit(text: Text, written: Written, place: Place, index: int) -> Mended:
    """
    The letter O becomes 0, the letter I becomes 1.

    Unsafe: nobody but the programmer knows that 0 was meant. Where one finding stands for many words, all of them are
    mended.

    Bad:

        N5 T0101
        N10 G98 GO X60. C0 (GO SLOWLY)
        N20 G12.1
        N30 G1 X4O. F2OO
        N40 C-O.5
        N50 G13.1
        N60 M30

    Good:

        N5 T0101
        N10 G98 G0 X60. C0 (GO SLOWLY)
        N20 G12.1
        N30 G1 X40. F200
        N40 C-0.5
        N50 G13.1
        N60 M30
    """
    words, letters = text.words, text.letters

    def of_word(word: int) -> list[int]:
        first, end = stretch(letters, int(words.start[word]), int(words.end[word]))
        found: list[int] = letters[first:end].tolist()
        return found

    def digit(at: int) -> str:
        return "0" if text.source.excerpt(at, at + 1) in "oO" else "1"

    places = of_word(index)
    if written.letter_count[index] > 1:
        kind = text.source.excerpt(places[0], places[0] + 1)
        others = np.unique(np.searchsorted(words.start, letters, side="right") - 1).tolist()
        of_others = [of_word(word) for word in others]
        places = [
            at for found in of_others if found and text.source.excerpt(found[0], found[0] + 1) == kind for at in found
        ]
    edits = tuple((at, at + 1, digit(at)) for at in places)
    return Mended(f"Write {with_digits(text, place)}", False, edits)
