from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.reading.words import Text
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{block} finds no block: {reason}; the control stops here", over="faults")
def jump_target_missing(faults: Faults) -> Mask:
    """
    Jump to a sequence number that is not there.

    GOTO, or M99 with P, names an N number that the program does not have: the control stops with an alarm. The N must
    stand in the same program, for M99 P in the program that called. The block is passed over here. On controls with
    sequence names, a name that is longer than they take is no target either.

    Source: FANUC alarms 128 and 078.

    Bad:

        O0001
        #1=5.
        IF[#1 GT 2]GOTO 20   (expect: jump-target-missing)
        M98 P2
        GOTO #9          (expect: jump-target-missing)
        N10 G0 X[#1/#8]  (expect: arithmetic-error)
        M30
        O2
        N20 G0 X50.
        M99 P30          (expect: jump-target-missing)

    Bad, machine okuma-osp:

        O1
        GOTO NLOOP1      (expect: jump-target-missing)
        G0 X50
        NLOOP1 G0 X60
        M2

    Good:

        O0001
        #1=5.
        IF[#1 GT 2]GOTO 20
        G0 X60.
        N20 M98 P2
        G0 X70.
        N30 M30
        O2
        G0 X50.
        M99 P30
    """
    return faults.rule == "jump-target-missing"


def details(hit: Hit, faults: Faults, text: Text) -> Details:
    from polarcheck.program.execution.programs import block_text
    from polarcheck.rules.wording.written import short

    return {"block": short(block_text(text, hit.place.block)), "reason": faults.reason(hit.index)}
