from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{variable} cannot be assigned: {who_writes}; the control stops here", values=("variable",), over="faults")
def read_only_variable(faults: Faults) -> Mask:
    """
    Assignment to a variable that only the control writes.

    Inputs, modal states and present positions are system variables that can be read but not written; #0 is always
    vacant. The control stops with an alarm. Assign to a local or common variable instead.

    Source: FANUC alarm 116.

    Bad:

        O0001
        #100=#4001
        #4001=1          (expect: read-only-variable)
        #1000=1          (expect: read-only-variable)
        #[5000+21]=#100  (expect: read-only-variable)
        #0=1             (expect: read-only-variable)
        #50=1            (expect: variable-out-of-range)
        #1100=1
        M30

    Good:

        O0001
        #100=#5021
        #101=#1000
        #1100=1
        #3001=0
        M30
    """
    return faults.rule == "read-only-variable"


def details(hit: Hit, faults: Faults) -> Details:
    from polarcheck.rules.wording.macro import variable

    is_vacant = not round(float(faults.values(hit.index)["number"]))
    return {
        "variable": variable(hit, faults),
        "who_writes": "it is always vacant" if is_vacant else "only the control writes it, a program can read it",
    }
