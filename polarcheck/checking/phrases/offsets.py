"""Tool offsets as messages name them, and what to give where one is not known."""

from __future__ import annotations

import re

from polarcheck.checking.phrases.common import short
from polarcheck.machines.machine import Machine
from polarcheck.table.trace import Trace

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_BARE_ARGUMENT = re.compile(r"[A-Za-z0-9_./+-]+")


def called_tool(trace: Trace, row: int) -> str:
    """The tool and the offset in force, as the program calls them: T0808, or `T MILL_8 edge 1`."""
    number = int(trace.offset_number[row])
    tool = int(trace.tool[row])
    if not trace.has_edges[row]:
        return f"T{tool:02d}{number:02d}"
    found = trace.edge_of(number)
    return f"{_tool(trace, trace.tool_name(tool) if tool else '')} edge {found[1] if found else 0}"


def _tool(trace: Trace, name: str) -> str:
    return f"T{name}" if name.isdecimal() else f"T {short(name)}" if name else "the tool called before"


def offset(trace: Trace, row: int) -> int | str:
    """The offset in force, for `of offset 8`, `of offset MILL_8/1`."""
    return shown_offset(trace, int(trace.offset_number[row]))


def shown_offset(trace: Trace, number: int) -> int | str:
    """An offset number as it is called: 8, or MILL_8/1."""
    key = key_of(trace, number)
    return short(key) if isinstance(key, str) else number


def key_of(trace: Trace, number: int) -> int | str | None:
    """An offset as reports hold it: its number, `MILL_8/1`, or None for none."""
    found = trace.edge_of(number)
    return (number or None) if found is None else f"{found[0]}/{found[1]}"


def option(trace: Trace, row: int, key: str) -> str:
    """The option that gives a value of the offset in force: `--tool 8:radius=...`, as a shell takes it."""
    name = str(key_of(trace, int(trace.offset_number[row])))
    if _BARE_ARGUMENT.fullmatch(name):
        return f"--tool {name}:{key}=..."
    import shlex

    return f"--tool {shlex.quote(f'{name}:{key}=...')}"


def to_give(trace: Trace, row: int, key: str) -> str:
    """What to give where a value of the offset in force is not known."""
    number = int(trace.offset_number[row])
    if not number or not trace.offset_key(number):
        return f"call {example(trace.machine)} before it"
    name = str(key_of(trace, number))
    table = name if _BARE_KEY.fullmatch(name) else '"' + name.replace("\\", "\\\\") + '"'
    return f"give {option(trace, row, key)} or [tools.{table}] {key} in polarcheck.toml"


def example(machine: Machine) -> str:
    """How an offset is called, for a message: `T0808`, or `T8 D1`."""
    return "T8 D1" if machine.offsets.called_by == "edge" else "T0808"
