from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask


@rule(
    NOTE,
    "no run of the program comes to {text}: the block before it goes elsewhere, and no jump leads here",
    over="faults",
)
def unreachable_block(faults: Faults) -> Mask:
    """
    Blocks that no run of the program comes to.

    Behind a GOTO, M30 or M99 and without an N number that anything jumps to: left over, or a jump goes to the wrong
    place. Said once for each stretch of such blocks, and only where every condition of the program is known.

    Source: FANUC B-62754EN/01, chapter 16.

    Bad:

        O0001
        GOTO 20
        G0 X50.          (expect: unreachable-block)
        G0 X60.
        N20 G0 X#1       (expect: vacant-variable)
        M30

    Good:

        O0001
        #1=1
        IF[#1 EQ 1]GOTO 20
        G0 X50.
        N20 G0 X70.
        M30
    """
    return faults.rule == "unreachable-block"
