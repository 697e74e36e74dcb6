from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "N{number} stands {count} times in this program: the control takes the next one behind the jump, or the "
    "first one where none follows; give the target of a jump a number of its own",
    values=("number", "count"),
    worse=("count",),
    over="faults",
)
def duplicate_sequence_number(faults: Faults) -> Mask:
    """
    Jump to a sequence number that stands there twice.

    The control searches forward from the jump and then from the head of the program, and takes the first N of that
    number that it meets: which one depends on where the jump stands. Number the targets of jumps once only.

    Source: FANUC B-62754EN/01, chapter 16.

    Bad:

        O0001
        #1=1
        IF[#1 EQ 1]GOTO 10   (expect: duplicate-sequence-number)
        N10 G0 X50.
        N10 G0 X60.
        IF[#1 EQ 2]GOTO 30
        #1=1/0               (expect: arithmetic-error)
        N30 M30

    Good:

        O0001
        #1=1
        IF[#1 EQ 1]GOTO 10
        N10 G0 X50.
        N20 G0 X60.
        N20 G0 X70.
        M30
    """
    return faults.rule == "duplicate-sequence-number"


def details(hit: Hit, faults: Faults) -> Details:
    values = faults.values(hit.index)
    return {"number": round(float(values["number"])), "count": int(values["count"])}
