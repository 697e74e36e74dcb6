from __future__ import annotations

from polarcheck.checking.rule import ERROR, Faults, Mask, rule


@rule(ERROR, "{what}", over="faults")
def jump_target_missing(faults: Faults) -> Mask:
    """
    Jump to a sequence number that is not there.

    GOTO, or M99 with P, names an N number that the program does not have: the control stops with an alarm. The N must
    stand in the same program, for M99 P in the program that called. The block is passed over here.

    Source: FANUC alarms 128 and 078.

    Bad:

        O0001
        #0=1             (expect: read-only-variable)
        GOTO 20          (expect: jump-target-missing)
        N10 G0 X50.
        M30

    Good:

        O0001
        GOTO 10
        N10 G0 X50.
        M30
    """
    return faults.rule == "jump-target-missing"
