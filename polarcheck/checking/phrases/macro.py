"""Phrases of the rules about custom macro and program flow."""

from __future__ import annotations

from polarcheck.checking.macro_faults import Faults


def what(faults: Faults, index: int) -> str:
    """What is wrong, in words."""
    return faults.run.faults[index].text
