from __future__ import annotations

from polarcheck.checking.rule import ERROR, Faults, Mask, rule


@rule(ERROR, "{what}", over="faults")
def arithmetic_error(faults: Faults) -> Mask:
    """
    Calculation that has no result.

    Division by zero, the square root of a negative number, ASIN or ACOS beyond 1, LN of zero, a result too large: the
    control stops with an alarm. The result is taken as unknown.

    Source: FANUC alarms 110, 111, 112 and 119.

    Bad:

        O0001
        #0=1             (expect: read-only-variable)
        #1=0
        #2=5/#1          (expect: arithmetic-error)
        #3=SQRT[-4]      (expect: arithmetic-error)
        M30

    Good:

        O0001
        #1=4
        #2=5/#1
        #3=SQRT[4]
        M30
    """
    return faults.rule == "arithmetic-error"
