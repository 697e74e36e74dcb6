from __future__ import annotations

from polarcheck.checking.rule import ERROR, Faults, Mask, rule


@rule(ERROR, "{what}", over="faults")
def read_only_variable(faults: Faults) -> Mask:
    """
    Assignment to a variable that only the control writes.

    Inputs, modal states and present positions are system variables that can be read but not written; #0 is always
    vacant. The control stops with an alarm.

    Source: FANUC alarm 116.

    Bad:

        O0001
        #50=1            (expect: variable-out-of-range)
        #0=1             (expect: read-only-variable)
        #5021=1          (expect: read-only-variable)
        M30

    Good:

        O0001
        #100=#5021
        M30
    """
    return faults.rule == "read-only-variable"
