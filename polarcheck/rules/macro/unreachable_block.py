from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.rules.hit import Details, Hit


@rule(
    NOTE,
    "no run of the program comes to {unreached}: {reason}",
    over="faults",
)
def unreachable_block(faults: Faults) -> Hits:
    """
    Blocks that no run of the program comes to.

    The blocks stand behind a GOTO, M30 or M99, and no jump leads to them: they are left over, or a jump goes to the
    wrong place. Said once for each stretch of such blocks, and only where every condition of the program is known.

    A loop that counts from a number of the program to a number of its condition and never runs is a warning: what it
    cuts is missing. The comparison or a sign is wrong.

    Source: FANUC B-62754EN/01, chapter 16.

    Bad:

        O0001
        GOTO 20
        G0 X50.          (expect: unreachable-block)
        G0 X60.
        N20 G0 X#1       (expect: vacant-variable)
        M30

    Bad:

        O0001
        #1=1
        WHILE[#1 GE 4]DO1    (expect: unreachable-block)
        G0 X#1
        #1=#1+1
        END1
        M30

    Good:

        O0001
        #1=1
        IF[#1 EQ 1]GOTO 20
        G0 X50.
        N20 G0 X70.
        M30
    """
    unreached = faults.rule == "unreachable-block"
    idle_loop = unreached & (faults.kind == "loop-never-run")
    return graded(note=unreached, warning=idle_loop)


def details(hit: Hit, faults: Faults) -> Details:
    is_loop = faults.kind[hit.index] == "loop-never-run"
    return {
        "unreached": "the blocks of this loop" if is_loop else hit.text,
        "reason": faults.reason(hit.index),
    }
