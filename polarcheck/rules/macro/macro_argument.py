from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{text} {reason}; the control stops here", over="faults")
def macro_argument(faults: Faults) -> Mask:
    """
    Address that cannot hand over an argument.

    G, L, N, O and P are not arguments of a macro call, and I J K can be repeated ten times at most. The control stops
    with an alarm. Write other G codes in a block of their own, before the call.

    Source: FANUC alarms 129 and 1095; B-63684EN/01 p. 304.

    Bad:

        O0001
        G65 P9000 A1. G2   (expect: macro-argument)
        M30
        O9000
        G0 X#1 Z#2       (expect: vacant-variable)
        M99

    Good:

        O0001
        G65 P9000 A1. B2.
        M30
        O9000
        G0 X#1 Z#2
        M99
    """
    return faults.rule == "macro-argument"


def details(hit: Hit, faults: Faults) -> Details:
    return {"reason": faults.reason(hit.index)}
