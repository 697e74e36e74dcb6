from __future__ import annotations

from polarcheck.checking.rule import WARNING, Faults, Mask, rule


@rule(WARNING, "{what}", over="faults")
def vacant_variable(faults: Faults) -> Mask:
    """
    Address with a vacant variable.

    A variable that was never assigned is vacant, and the control drops the address that it stands at: X#1 moves nothing
    in X. A forgotten argument or a wrong number is seldom meant that way.

    Source: FANUC B-62754EN/01, chapter 16.

    Bad:

        O0001
        #0=1             (expect: read-only-variable)
        G0 X#101 Z5.     (expect: vacant-variable)
        M30

    Good:

        O0001
        #101=50.
        G0 X#101 Z5.
        M30
    """
    return faults.rule == "vacant-variable"
