from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.foundation.arrays import Mask


@rule(WARNING, "the program ends here without M30, M02 or M99", over="words")
def program_end_missing(written: Written) -> Mask:
    """
    Program without an end.

    A main program ends with M30 or M02, a subprogram with M99. Without it the control runs on to the % and stops with
    an alarm, or goes on with what it stores next. So it does where a part that M98 Q100 calls has no M99 behind it.
    Often the rest of the file was lost on the way. Nothing is said of excerpts, which have neither a program number
    nor %.

    Source: FANUC alarm 5010; B-62754EN/01, configuration of a program.

    Bad:

        O0001
        T0101
        G0 X60.
        M9                (expect: program-end-missing)

    Bad:

        %
        T0101
        G0 X60.
        M9                (expect: program-end-missing)
        %

    Good:

        %
        O0001
        M98 P1000
        M30
        O1000
        G0 X60.
        M99
        %

    Good:

        G0 X60.
        M9
    """
    # Compares nothing: the table searches the words and macro statements of each program for its end.
    return written.lacks_end
