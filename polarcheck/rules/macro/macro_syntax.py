from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{text} {reason}; the control stops here", over="faults", once="name")
def macro_syntax(faults: Faults) -> Mask:
    """
    Macro statement that cannot be read.

    The control stops with an alarm at an expression or a statement that does not follow the rules of custom macro: a
    bracket too few, an operator without a value, IF without GOTO or THEN. What cannot be read is taken as unknown.

    Source: FANUC B-62754EN/01, chapter 16; alarms 114, 125, 1131 to 1138.

    Bad:

        O0001
        #1=[2+3          (expect: macro-syntax)
        #2=7*            (expect: macro-syntax)
        G0 X50. #3=1     (expect: mixed-macro-and-nc)
        M30

    Bad:

        O0001
        #1 5             (expect: macro-syntax)
        IF[#1 EQ 5]M8    (expect: macro-syntax)
        M30

    Good:

        O0001
        #1=[2+3]*2
        IF[#1 EQ 10]GOTO 10
        #1=10
        N10 M30
    """
    return faults.rule == "macro-syntax"


def details(hit: Hit, faults: Faults) -> Details:
    return {"reason": faults.reason(hit.index)}
