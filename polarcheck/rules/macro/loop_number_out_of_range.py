from __future__ import annotations

from polarcheck.checking.rule import ERROR, Faults, Mask, rule


@rule(ERROR, "{what}", over="faults")
def loop_number_out_of_range(faults: Faults) -> Mask:
    """
    Loop number other than 1, 2 and 3.

    DO and END take the numbers 1, 2 and 3; the control stops with an alarm at any other.

    Source: FANUC alarm 126.

    Bad:

        O0001
        #0=1             (expect: read-only-variable)
        #1=0
        WHILE[#1 LT 3]DO4   (expect: loop-number-out-of-range)
        #1=#1+1
        END4             (expect: loop-number-out-of-range)
        M30

    Good:

        O0001
        #1=0
        WHILE[#1 LT 3]DO3
        #1=#1+1
        END3
        M30
    """
    return faults.rule == "loop-number-out-of-range"
