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
    "{text}: DO and END take the numbers 1 to {limit}; the control stops here",
    values=("limit",),
    over="faults",
    doubts=(("word", "block"),),
)
def loop_number_out_of_range(faults: Faults) -> Mask:
    """
    Loop number that DO and END do not take.

    DO and END take the numbers 1, 2 and 3; the control stops with an alarm at any other. The same number may be used
    again for loops that follow each other.

    Source: FANUC alarm 126.

    Bad:

        O0001
        #1=0
        WHILE[#1 LT 3]DO4   (expect: loop-number-out-of-range)
        #1=#1+1
        END4             (expect: loop-number-out-of-range)
        END3             (expect: loop-unbalanced)
        M30

    Good:

        O0001
        #1=0
        WHILE[#1 LT 3]DO3
        #1=#1+1
        END3
        WHILE[#1 LT 6]DO3
        #1=#1+1
        END3
        M30
    """
    return faults.rule == "loop-number-out-of-range"


def details(hit: Hit, machine: Machine) -> Details:
    return {"limit": machine.macro.loop_numbers}
