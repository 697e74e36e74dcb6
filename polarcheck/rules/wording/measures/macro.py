"""Measures of the rules about custom macro and program flow."""

from __future__ import annotations

from polarcheck.columns.words.macro_faults import Faults


def missing_program(faults: Faults, index: int) -> str:
    """The program that is missing; empty where its name is not known."""
    return str(faults.values(index).get("program", ""))
