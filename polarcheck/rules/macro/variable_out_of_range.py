from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.macro_faults import Faults
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{variable} does not exist; this control has {ranges}", values=("variable",), over="faults")
def variable_out_of_range(faults: Faults) -> Mask:
    """
    Variable that does not exist.

    The control has local variables 1 to 33, common ones from 100 and 500, and system variables from 1000. It stops with
    an alarm at any other number.

    Source: FANUC alarm 115.

    Bad:

        O0001
        #50=1            (expect: variable-out-of-range)
        #1=#200+1        (expect: variable-out-of-range)
        #2=180
        #[#2+20]=1       (expect: variable-out-of-range)
        #3=#2/0          (expect: arithmetic-error)
        M30

    Good:

        O0001
        #33=1
        #100=2
        #[#100+98]=3
        M30
    """
    return faults.rule == "variable-out-of-range"


def details(hit: Hit, faults: Faults) -> Details:
    from polarcheck.rules.wording.macro import variable

    return {"variable": variable(hit, faults), "ranges": _ranges(hit.trace.machine)}


def _ranges(machine: Machine) -> str:
    """The variables that there are."""
    macro = machine.macro
    if macro.language == "high-level":
        return "parameters from R0 on"
    kinds = {
        "local": macro.local_variables,
        "common": [*macro.common_variables, *macro.retained_variables],
        "system": macro.system_variables,
    }
    parts = (
        f"{name} {' and '.join(f'#{first}-#{last}' for first, last in numbers)}"
        for name, numbers in kinds.items()
        if numbers
    )
    return ", ".join(parts)
