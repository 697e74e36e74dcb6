from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{text} {reason}", over="faults", doubts=(("mode", "program"),))
def endless_loop(faults: Faults) -> Hits:
    """
    Program that never ends.

    A jump or loop that comes back with nothing changed is an error, since the machine repeats it until it is reset; one
    that only outlasts the bounds of this check is a warning: it may be sound, and end later.

    The check stops after so many blocks or statements beyond those of the file itself, and after so many seconds
    (--max-blocks, --max-statements, --max-seconds). What comes behind that is not checked, and the file is unverified,
    not failed, if nothing else is wrong.
    Of a program that is called more often than --max-blocks, one run is checked; positions and variables after it are
    not known.

    Source: FANUC B-62754EN/01, chapter 16.

    Bad:

        O0001
        N10 G0 X#7       (expect: vacant-variable)
        Z5.
        GOTO 10          (expect: endless-loop)
        M30

    Bad:

        O0001
        #1=0
        WHILE[#1 LT 3]DO1
        G0 X50.
        END1             (expect: endless-loop)
        M30

    Bad, set job.run.max_blocks=100:

        O0001
        #1=0
        WHILE[#1 LT 300]DO1
        #1=#1+1
        G0 X#1
        END1             (expect: endless-loop)
        M30

    Good:

        O0001
        #1=0
        WHILE[#1 LT 3]DO1
        #1=#1+1
        END1
        M30
    """
    found = faults.rule == "endless-loop"
    bounded = found & faults.is_bound
    return graded(error=found & ~bounded, warning=bounded, undecided=bounded)


def details(hit: Hit, faults: Faults) -> Details:
    return {"reason": faults.reason(hit.index)}
