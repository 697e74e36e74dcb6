from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    NOTE,
    "{expression} mixes {text} with other operators: this control takes AND with * and /, OR and XOR with +"
    " and -, others take them last; write the brackets",
    values=("expression",),
    over="faults",
)
def ambiguous_precedence(faults: Faults) -> Mask:
    """
    Order of calculation that is taught in two ways.

    Some pages of manuals rank AND with * and /, and OR and XOR with + and -; other pages rank all three last. Where an
    expression mixes them without brackets, controls and readers may differ. Brackets say what is meant.

    Source: FANUC B-62754EN/01, chapter 16.3.

    Bad:

        O0001
        #1=#1012 AND 15      (two decades of inputs, the lower one)
        #2=#1 AND 7+8        (expect: ambiguous-precedence)
        #4001=#2             (expect: read-only-variable)
        M30

    Good:

        O0001
        #1=#1012 AND 15
        #2=#1 AND [7+8]
        #3=[#1 AND 7]+8
        M30
    """
    return faults.rule == "ambiguous-precedence"


def details(hit: Hit, faults: Faults) -> Details:
    from polarcheck.rules.wording.written import short

    return {"expression": short(str(faults.values(hit.index)["expression"]))}
