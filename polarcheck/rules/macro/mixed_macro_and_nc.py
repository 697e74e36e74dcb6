from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "{text} needs a block of its own: NC words and a macro statement do not stand in one block; the control stops here",
    over="faults",
)
def mixed_macro_and_nc(faults: Faults) -> Mask:
    """
    NC words and a macro statement in one block.

    The control stops with an alarm: a macro statement stands in a block of its own. An IF with THEN takes one macro
    statement, no NC words: jump past the block instead.

    Source: FANUC alarm 127.

    Bad:

        O0001
        #1=5
        G0 X50. #1=6     (expect: mixed-macro-and-nc)
        IF[#1 EQ 5]THEN G0 X60.   (expect: mixed-macro-and-nc)
        IF[#1 EQ 5]G0 X60.   (expect: macro-syntax)
        M30

    Good:

        O0001
        #1=5
        G0 X50.
        #1=6
        IF[#1 NE 5]GOTO 10
        G0 X60.
        N10 M30
    """
    return faults.rule == "mixed-macro-and-nc"
