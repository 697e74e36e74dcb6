from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{text} {reason}; the control stops here", over="faults", doubts=(("mode", "program"),))
def nesting_too_deep(faults: Faults) -> Mask:
    """
    Calls, loops or brackets nested too deep.

    A control knows a few levels only: of brackets in an expression, of loops, of subprograms and of macros that call
    each other; a program that calls itself passes them at once. It stops with an alarm. The call is not followed here.

    Source: FANUC alarms 077, 118 and 122; B-62754EN/01 p. 287; B-63684EN/01 p. 304.

    Bad:

        O0001
        M98 P2
        M98 P3           (expect: subprogram-missing)
        M30
        O0002
        M98 P2           (expect: nesting-too-deep)
        M99

    Bad:

        O0001
        #1=[[[[[[5]]]]]]   (expect: nesting-too-deep)
        M30

    Good:

        O0001
        M98 P2
        M30
        O0002
        #1=[[[[[5]]]]]
        M99
    """
    return faults.rule == "nesting-too-deep"


def details(hit: Hit, faults: Faults) -> Details:
    return {"reason": faults.reason(hit.index)}
