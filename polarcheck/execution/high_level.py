"""Statements of a high-level language: X=R1, STOPRE, IF R1==5 GOTOF NAME, calls by name."""

from __future__ import annotations

import re
from typing import Final

from polarcheck.execution.names import Names
from polarcheck.execution.rewriting import Read, Rewriting
from polarcheck.execution.statement import Kind, Statement, Unread
from polarcheck.machines.machine import Machine

#: A tool by its name, alone or beside plain words: N10 T="MILL_8" D1.
_TOOL: Final = re.compile(
    r'((?:[ \t]*[/N][0-9]*)*[ \t]*)(T[ \t]*=[ \t]*"([^"]*)")((?:[ \t]*[A-Z][ \t]*[-+.0-9]+)*)\s*', re.I
)


def read(block: str, machine: Machine, names: Names, read: Read) -> Statement:
    """
    A block with its statements.

    machine: whose codes and axes it names. names: of variables and tools, as they are met. read: reads custom macro.
    """
    if found := _TOOL.fullmatch(block):
        rewriting = Rewriting()
        rewriting.put(found[1], *found.span(1))
        rewriting.put(f"T{names.tool(found[3])}", *found.span(2))
        rewriting.put(found[4], *found.span(4))
        return read(rewriting.characters)
    written = block.strip()
    start = block.find(written)
    return Statement(Kind.NC, start, start + len(written), unread=(Unread(written, start, start + len(written), True),))
