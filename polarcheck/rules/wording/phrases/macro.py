"""Phrases of the rules about custom macro and program flow."""

from __future__ import annotations

from polarcheck.columns.words.macro_faults import Faults
from polarcheck.program.execution.names import FIRST_PARAMETER, PARAMETERS
from polarcheck.program.execution.programs import block_text
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.words import Text
from polarcheck.rules.places import Place
from polarcheck.rules.wording.phrases.common import short


def shown(text: Text, place: Place) -> str:
    """What stands at the place, in one line and not too long."""
    return short(text.source.excerpt(place.start, place.end))


def block(text: Text, place: Place) -> str:
    """The whole block without its comments, likewise."""
    return short(block_text(text, place.block))


def reason(faults: Faults, index: int) -> str:
    """What is wrong, in words."""
    return faults.reason(index)


def closing_loops(machine: Machine) -> str:
    """How loops are closed in the language of the control."""
    if machine.macro.language == "custom-macro":
        return "close each loop with an END of its own number, the inner loop first"
    return "close each IF, WHILE, FOR and LOOP with its own word, the inner one first"


def number(faults: Faults, index: int) -> int:
    """The N number or the variable of a fault."""
    return round(float(faults.values(index)["number"]))


def count(faults: Faults, index: int) -> int:
    """How often the N number stands in the program."""
    return int(faults.values(index)["count"])


def expression(faults: Faults, index: int) -> str:
    """The expression at fault."""
    return short(str(faults.values(index)["expression"]))


def variable(faults: Faults, text: Text, place: Place, index: int) -> str:
    """A variable as it is written, and its number where that is computed."""
    which = number(faults, index)
    is_parameter = which >= FIRST_PARAMETER - PARAMETERS
    written, named = shown(text, place), f"R{which - FIRST_PARAMETER}" if is_parameter else f"#{which}"
    return written if "".join(written.split()) == named else f"{written} ({named})"


def who_writes(faults: Faults, index: int) -> str:
    """Why a variable cannot be assigned."""
    return "only the control writes it, a program can read it" if number(faults, index) else "it is always vacant"


def ranges(machine: Machine) -> str:
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
