"""The machines that a program is written for, where nobody has said which lathe it is for."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.modes.other_mode import OtherMode
from polarcheck.program.machines.profiles import Profile
from polarcheck.rules.other_machine import OtherMachine
from polarcheck.rules.remedies import is_chosen
from polarcheck.rules.tables import Tables

#: The rule that says so, and names them.
_OF_SWITCH = "polar-code-of-another-control"
#: Those that name machines which read a program well that this one cannot read.
_OF_WORDS = ("wrong-axis-address-in-polar", "bad-number")


def stated_by(tables: Tables) -> tuple[str, ...]:
    """Return the rules that say which machine a program is written for; none where it is not known."""
    if written_for(tables):
        return (_OF_SWITCH,)
    other_machine: OtherMachine = tables.setdefault("other_machine", OtherMachine(tables))
    return _OF_WORDS if other_machine.is_in_its_language else ()


def written_for(tables: Tables) -> tuple[Profile, ...]:
    """
    Return the machines whose polar mode a program certainly begins, in the language of their control, where only the
    default machine reads it; none where somebody has chosen the machine, or it knows the mode.
    """
    if is_chosen(tables["machine"], tables["job"]):
        return ()
    other_mode: OtherMode = tables["other_mode"]
    rows = np.flatnonzero(other_mode.is_meant)
    return other_mode.machines(int(rows[0])) if len(rows) else ()
