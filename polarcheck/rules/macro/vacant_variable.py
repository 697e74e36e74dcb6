from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "{text} has a vacant variable: the control drops this address; assign the variable before, or hand it"
    " over as an argument",
    over="faults",
    once="name",
    doubts=(("word", "block"),),
)
def vacant_variable(faults: Faults) -> Mask:
    """
    Address with a vacant variable.

    A variable that was never assigned is vacant, and the control drops the address that it stands at: X#1 moves nothing
    in X. A forgotten argument or a wrong number is seldom meant that way.

    Source: FANUC B-62754EN/01, chapter 16.

    Bad:

        O0001
        #101=50.
        G0 X#101 Z#102   (expect: vacant-variable)
        G65 P9001 A1.
        #[#103]=4.       (expect: read-only-variable)
        M30
        O9001
        G0 X#1 Z#2       (expect: vacant-variable)
        M99

    Good:

        O0001
        #101=50.
        G0 X#101 Z5.
        M30
    """
    return faults.rule == "vacant-variable"
