from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.program.machines.machine import Machine
    from polarcheck.program.reading.words import Words


@rule(
    WARNING,
    "{count} M codes in a block; this control takes {limit}",
    values=("count", "limit"),
    worse=("count",),
    over="words",
)
def too_many_m_codes(words: Words, written: Written, machine: Machine) -> Hits:
    """
    More M codes in a block than the control takes.

    Depending on a parameter a block may have one M code or up to three, on newer controls up to five. What is too much
    raises an alarm or is lost, and it may be the coolant or the clamp. Put them into blocks of their own. Nothing is
    said where the machine profile does not know the limit.

    Source: FANUC parameter 3404#7; alarm 5016.

    Bad, set control.m_code_limit=3:

        T0101
        M5 M8 M10 M46     (expect: too-many-m-codes)

    Good, machine okuma-osp:

        T0101
        M5 M8 M10 M46

    Good, set control.m_code_limit=3:

        T0101
        M5 M8 M10
        M46
    """
    import numpy as np

    limit = machine.control.m_code_limit
    counted = words.address == ord("M")
    beyond = written.first_beyond(counted, limit) if limit else np.zeros(len(words), bool)
    return Hits(beyond, values={"count": written.in_block(counted, beyond), "limit": limit})
