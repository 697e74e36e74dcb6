"""Statements of user tasks: VC1=5, X=VC1, CALL O1234, IF [VC1 EQ 1] NEND."""

from __future__ import annotations

from polarcheck.execution.names import Names
from polarcheck.execution.rewriting import Read
from polarcheck.execution.statement import Kind, Statement, Unread
from polarcheck.machines.machine import Machine


def read(block: str, machine: Machine, names: Names, read: Read) -> Statement:
    """
    A block with its statements.

    machine: whose codes and axes it names. names: of variables and tools, as they are met. read: reads custom macro.
    """
    written = block.strip()
    start = block.find(written)
    return Statement(Kind.NC, start, start + len(written), unread=(Unread(written, start, start + len(written), True),))
