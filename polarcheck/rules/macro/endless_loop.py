from __future__ import annotations

from polarcheck.checking.rule import ERROR, Faults, Hits, graded, rule


@rule(ERROR, "{shown} {reason}", over="faults")
def endless_loop(faults: Faults) -> Hits:
    """
    Program that never ends.

    A jump or loop that comes back again and again with nothing changed never ends; the machine repeats it until it is
    reset. A warning where a program is still running after the blocks or statements that a check may take beyond those
    of the file itself, or after its seconds (--max-blocks, --max-statements, --max-seconds): it may end later, but what
    comes after that is not checked, and the file is unverified.

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
