from __future__ import annotations

from polarcheck.checking.rule import ERROR, Faults, Mask, rule


@rule(ERROR, "{shown} {reason}", over="faults")
def endless_loop(faults: Faults) -> Mask:
    """
    Program that never ends.

    A jump or loop that comes back again and again with nothing changed never ends; the machine repeats it until it is
    reset. Also reported where a program is still running after the blocks, statements or seconds that a check may take
    (--max-blocks, --max-statements, --max-seconds): what comes after that is not checked.

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
    return faults.rule == "endless-loop"
