from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.program.reading.words import Text
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{word}: letter {letter}; write {word_needed}{count:blocks}",
    values=("word", "word_needed", "count"),
    worse=("count",),
    over="words",
)
def letter_for_digit(written: Written) -> Hits:
    """
    Letter O or I where a digit is meant.

    `GO X60.` looks like `G0 X60.` on the screen. The control stops at it: G has no number, and O in a block is no
    program number. Typed programs and printed ones that were read in have such letters, O for 0 and I for 1; more than
    five are reported once. Here the word is read with the digit, so that the rest of the program is judged as it is
    meant. In macro statements (GOTO 10), and in blocks that would be none with the digit, either, letters are left as
    they are.

    Source: FANUC alarms 006 and 009.

    Bad:

        O0001
        T0101
        G98 GO X60. C0    (expect: letter-for-digit)
        G12.1
        G1 X4O. F2OO      (expect: letter-for-digit, letter-for-digit)
        C-O.5             (expect: letter-for-digit)
        XI0.              (expect: letter-for-digit)
        G13.1
        M3O               (expect: letter-for-digit)

    Good:

        %
        O0001
        T0101
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C5.
        G1 X38.I0C6.
        G1 X60. C0
        G13.1
        N10 GOTO 20
        N20 M30
        %
    """
    return Hits(written.letter_count > 0, values={"count": written.letter_count})


def details(hit: Hit, text: Text) -> Details:
    import numpy as np

    from polarcheck.rules.wording.written import with_digits

    at = int(text.letters[np.searchsorted(text.letters, hit.place.start)])
    return {
        "word_needed": with_digits(text, hit.place),
        "letter": "O for the digit 0" if text.source.excerpt(at, at + 1) in "oO" else "I for the digit 1",
    }
