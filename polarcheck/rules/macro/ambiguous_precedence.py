from __future__ import annotations

from polarcheck.checking.rule import NOTE, Faults, Mask, rule


@rule(NOTE, "{what}", over="faults")
def ambiguous_precedence(faults: Faults) -> Mask:
    """
    Order of calculation that is taught in two ways.

    AND ranks with * and /, OR and XOR rank with + and -; but other pages put all three last. Where an expression mixes
    them without brackets, controls and readers may differ. Brackets say what is meant.

    Source: FANUC B-62754EN/01, chapter 16.3.

    Bad:

        O0001
        #0=1                 (expect: read-only-variable)
        #1=3+4 AND 6     (expect: ambiguous-precedence)
        M30

    Good:

        O0001
        #1=3+[4 AND 6]
        M30
    """
    return faults.rule == "ambiguous-precedence"
