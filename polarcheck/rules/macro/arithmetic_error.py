from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.reading.words import Text
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{block} {reason}: the control stops here, and the result is not known", over="faults")
def arithmetic_error(faults: Faults) -> Mask:
    """
    Calculation that has no result.

    Division by zero, the square root of a negative number, ASIN or ACOS beyond 1, LN of zero, a result too large: the
    control stops with an alarm. The result is taken as unknown. Test the value before with IF, and stop with a message
    of your own (`#3000=1(RADIUS TOO SMALL)`).

    Source: FANUC alarms 110, 111, 112 and 119.

    Bad:

        O0001
        #1=8.            (half of the flats)
        #2=6.            (radius of the corners)
        #3=SQRT[#2*#2-#1*#1]   (expect: arithmetic-error)
        #4=360/#5        (expect: arithmetic-error)
        #50=1            (expect: variable-out-of-range)
        M30

    Good:

        O0001
        #1=6.
        #2=8.
        #3=SQRT[#2*#2-#1*#1]
        #5=4
        #4=360/#5
        M30
    """
    return faults.rule == "arithmetic-error"


def details(hit: Hit, faults: Faults, text: Text) -> Details:
    from polarcheck.program.execution.programs import block_text
    from polarcheck.rules.wording.written import short

    return {"block": short(block_text(text, hit.place.block)), "reason": faults.reason(hit.index)}
