"""The languages of statements that controls have beside custom macro, and what reads a block of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from polarcheck.execution import high_level, user_task
from polarcheck.execution.names import Names
from polarcheck.execution.rewriting import Read
from polarcheck.execution.statement import Statement
from polarcheck.machines.machine import Machine

#: By `macro.language`: a block without comments, the machine, the names met so far, and what reads custom macro.
READERS: Final[Mapping[str, Callable[[str, Machine, Names, Read], Statement]]] = {
    "high-level": high_level.read,
    "user-task": user_task.read,
}
