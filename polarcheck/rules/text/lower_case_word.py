from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.foundation.arrays import Mask


@rule(NOTE, "words in lower case from here on; older controls do not read them", over="words")
def lower_case_word(written: Written) -> Mask:
    """
    Words in lower case.

    The ISO code of older controls has no lower case letters: they raise an alarm or are lost on the way. Newer controls
    read them only in comments. Write the program in upper case. The first place in a file is reported.

    Source: FANUC B-63524EN/01, tape code list.

    Bad:

        g98 g0 x60. c0    (expect: lower-case-word)
        g12.1
        g1 x40. f200
        c10.
        x60.
        g13.1

    Good:

        G98 G0 X60. C0 (approach)
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    # Compares nothing: the table looks for the first word with a small letter.
    return written.is_first_lower_case
