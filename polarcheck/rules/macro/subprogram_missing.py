from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{text} {reason}",
    values=("program",),
    over="faults",
    subject="word",
)
def subprogram_missing(faults: Faults) -> Mask:
    """
    Called program that is not found.

    M98, G65 or G66 names a program that is neither in this file nor in a folder of the job. On the control it may be
    there; here its moves are not known, nor any position after it until it is programmed again. Name the folder in
    polarcheck.toml, `subprograms = ["folder"]`, or on the command line.

    Source: FANUC alarms 076 and 078.

    Bad:

        O0001
        #1=1234
        G0 X50.
        M98 P#1          (expect: subprogram-missing)
        M98 P2
        M30
        O0002
        GOTO 10          (expect: jump-target-missing)
        M99

    Bad:

        O0001
        M98              (expect: subprogram-missing)
        M98 P10000000000000000000   (expect: too-many-digits)
        M30

    Good:

        O0001
        M98 P1234
        M30
        O1234
        G0 X50.
        M99
    """
    return faults.rule == "subprogram-missing"


def details(hit: Hit, faults: Faults) -> Details:
    return {"program": str(faults.values(hit.index).get("program", "")), "reason": faults.reason(hit.index)}
