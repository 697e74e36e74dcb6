"""Tool offsets as messages name them, and what to give where one is not known."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.trace import Trace
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.wording.written import short

_BARE_KEY = lazy_pattern(r"[A-Za-z0-9_-]+")
_BARE_ARGUMENT = lazy_pattern(r"[A-Za-z0-9_./+-]+")


def called_tool(tools: CalledTools, row: int) -> str:
    """The tool and the offset in force, as the program calls them: T0808, or `T MILL_8 edge 1`."""
    if tools.is_unknown[row]:
        return "the tool called"
    number = int(tools.offset_number[row])
    tool = int(tools.tool[row])
    if not tools.has_edges[row]:
        return f"T{tool:02d}{number:02d}"
    found = tools.edge_of(number)
    return f"{_tool(tools.tool_name(tool) if tool else '')} edge {found[1] if found else 0}"


def _tool(name: str) -> str:
    return f"T{name}" if name.isdecimal() else f"T {short(name)}" if name else "the tool called before"


def offset(tools: CalledTools, row: int) -> int | str:
    """The offset in force, for `of offset 8`, `of offset MILL_8/1`."""
    return shown_offset(tools, int(tools.offset_number[row]))


def shown_offset(tools: CalledTools, number: int) -> int | str:
    """An offset number as it is called: 8, or MILL_8/1."""
    key = key_of(tools, number)
    return short(key) if isinstance(key, str) else number


def key_of(tools: CalledTools, number: int) -> int | str | None:
    """An offset as reports hold it: its number, `MILL_8/1`, or None for none."""
    found = tools.edge_of(number)
    return (number or None) if found is None else f"{found[0]}/{found[1]}"


def option(tools: CalledTools, row: int, key: str) -> str:
    """The option that gives a value of the offset in force: `--tool 8:radius=...`, as a shell takes it."""
    name = str(key_of(tools, int(tools.offset_number[row])))
    if _BARE_ARGUMENT.fullmatch(name):
        return f"--tool {name}:{key}=..."
    import shlex

    return f"--tool {shlex.quote(f'{name}:{key}=...')}"


def to_give(tools: CalledTools, machine: Machine, row: int, key: str) -> str:
    """What to give where a value of the offset in force is not known."""
    number = int(tools.offset_number[row])
    if tools.is_unknown[row]:
        return "give its number in the program, or its variable a value in [run.variables]"
    if not number or not tools.offset_key(number):
        return f"call {example(machine)} before it"
    name = str(key_of(tools, number))
    table = name if _BARE_KEY.fullmatch(name) else '"' + name.replace("\\", "\\\\") + '"'
    return f"give {option(tools, row, key)} or [tools.{table}] {key} in polarcheck.toml"


def example(machine: Machine) -> str:
    """How an offset is called, for a message: `T0808`, `T8 D1`, `T8 D8` or `T08 M6`."""
    return {"edge": "T8 D1", "tool-change": "T08 M6", "d-word": "T8 D8"}.get(machine.offsets.called_by, "T0808")


def job_scale(trace: Trace, row: int) -> float:
    """What lengths of the job count in a row [mm]."""
    return float(np.broadcast_to(trace.lengths.job_scale, len(trace))[row])
