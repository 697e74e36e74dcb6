from __future__ import annotations

from polarcheck.checking.rule import ERROR, Faults, Mask, rule


@rule(ERROR, "{what}", over="faults")
def variable_out_of_range(faults: Faults) -> Mask:
    """
    Variable that does not exist.

    The control has local variables 1 to 33, common ones from 100 and 500, and system variables from 1000. It stops with
    an alarm at any other number.

    Source: FANUC alarm 115.

    Bad:

        O0001
        #0=1             (expect: read-only-variable)
        #50=1            (expect: variable-out-of-range)
        M30

    Good:

        O0001
        #33=1
        #100=2
        M30
    """
    return faults.rule == "variable-out-of-range"
