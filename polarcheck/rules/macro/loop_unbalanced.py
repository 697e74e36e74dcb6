from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{reason}; the control stops here: {closing_loops}",
    over="faults",
    once="structure",
    subject="word",
    # A program that has lost its end has lost that of the loop with it.
    follows={"program": ("program-end-missing",)},
)
def loop_unbalanced(faults: Faults) -> Mask:
    """
    Loop that does not close.

    Each DO 1, 2 or 3 needs an END of the same number behind it; loops lie one inside the other and do not cross, and
    a loop does not hold another of its own number. The control stops with an alarm.

    Source: FANUC B-62754EN/01, chapter 16; alarms 124 and 1124.

    Bad:

        O0001
        #1=0
        WHILE[#1 LT 3]DO1   (expect: loop-unbalanced)
        #1=#1+1
        DO4              (expect: loop-number-out-of-range)
        M30

    Bad:

        O0001
        #1=0
        WHILE[#1 LT 3]DO1
        #1=#1+1
        #2=0
        WHILE[#2 LT 3]DO2   (expect: loop-unbalanced)
        #2=#2+1
        END1
        END2             (expect: loop-unbalanced)
        M30

    Good:

        O0001
        #1=0
        WHILE[#1 LT 3]DO1
        #1=#1+1
        #2=0
        WHILE[#2 LT 3]DO2
        #2=#2+1
        END2
        END1
        M30
    """
    return faults.rule == "loop-unbalanced"


def details(hit: Hit, faults: Faults, machine: Machine) -> Details:
    close = "close each IF, WHILE, FOR and LOOP with its own word, the inner one first"
    if machine.macro.language == "custom-macro":
        close = "close each loop with an END of its own number, the inner loop first"
    return {"reason": faults.reason(hit.index), "closing_loops": close}
