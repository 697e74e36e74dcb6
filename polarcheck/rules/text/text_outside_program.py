from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.foundation.arrays import Mask


@rule(NOTE, "not stored by the control: it stands outside the program", over="outside")
def text_outside_program(written: Written) -> Mask:
    """
    Text before the program or after its end.

    A control stores what stands between the first % or program number and the last %. Titles of listings, notes and
    what is left of a transfer stand outside and are lost, harmless as such; but a % in the wrong place cuts the program
    in two. Lines without a letter or digit are not meant.

    Source: FANUC B-63524EN/01, p. 649; Mitsubishi M700V programming manual, p. 7.

    Bad:

        TWO FLATS, SECOND OPERATION   (expect: text-outside-program)
        %
        O0001
        T0101
        M30
        %

    Bad:

        %
        O0001
        T0101
        M30
        %
        CHECK THE CLAMP FIRST         (expect: text-outside-program)

    Good:

        ============
        %
        O0001 (TWO FLATS, SECOND OPERATION)
        T0101
        M30
        %
    """
    # Compares nothing: the table looks for letters and digits outside of comments.
    return written.is_text_outside
