"""Macro variables, as messages name them."""

from __future__ import annotations

from polarcheck.columns.words.macro_faults import Faults
from polarcheck.program.execution.variable_names import FIRST_PARAMETER, PARAMETERS
from polarcheck.rules.hit import Hit


def variable(hit: Hit, faults: Faults) -> str:
    """A variable as it is written, and its number where that is computed."""
    number = round(float(faults.values(hit.index)["number"]))
    is_parameter = number >= FIRST_PARAMETER - PARAMETERS
    name = f"R{number - FIRST_PARAMETER}" if is_parameter else f"#{number}"
    return hit.text if "".join(hit.text.split()) == name else f"{hit.text} ({name})"
