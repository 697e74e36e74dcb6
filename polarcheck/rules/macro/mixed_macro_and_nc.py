from __future__ import annotations

from polarcheck.checking.rule import ERROR, Faults, Mask, rule


@rule(ERROR, "{what}", over="faults")
def mixed_macro_and_nc(faults: Faults) -> Mask:
    """
    NC words and a macro statement in one block.

    The control stops with an alarm: a macro statement stands in a block of its own.

    Source: FANUC alarm 127.

    Bad:

        O0001
        #0=1             (expect: read-only-variable)
        #1=5
        G0 X50. #1=6     (expect: mixed-macro-and-nc)
        M30

    Good:

        O0001
        #1=5
        G0 X50.
        #1=6
        M30
    """
    return faults.rule == "mixed-macro-and-nc"
