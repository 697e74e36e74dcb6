"""Phrases of the rules about entering and leaving the mode, and what may stand between."""

from __future__ import annotations

from collections.abc import Iterator

from polarcheck.checking.phrases.common import executed_word, switch_off
from polarcheck.machines.codes import spelled
from polarcheck.machines.machine import Machine
from polarcheck.table.infeed import Infeed
from polarcheck.table.trace import Trace

#: What words of systems B and C mean in system A, and of A in B and C.
_IN_SYSTEM_A = {
    "G90": "a turning cycle in G-code system A, where X and C are absolute and U and H incremental",
    "G91": "no code of G-code system A, where U and H are incremental",
    "G94": "a facing cycle in G-code system A, where G98 is feed per minute",
    "G95": "no code of G-code system A, where G99 is feed per revolution",
}
#: Group and state of what must have ended at G12.1: the code, and what ends it.
_ENDS = {
    ("scaling", 51): ("G51", "G50"),
    ("rotation", 68): ("G68.1", "G69.1"),
    ("mirror", 68): ("G68", "G69"),
    ("mirror", 51): ("G51.1", "G50.1"),
    ("speed", 96): ("G96", "G97"),
}


def missing_before(trace: Trace, index: int) -> str:
    """Where the G13.1 of a section is missing."""
    sections = trace.sections
    row = int(sections.leave[index])
    off = switch_off(trace, int(sections.enter[index]))
    if row >= len(trace) or trace.starts[row]:
        return f"{off} is missing at the end of the program"
    block = int(trace.run.block[row])
    text = trace.text.source.excerpt(int(trace.text.blocks.start[block]), int(trace.text.blocks.end[block]))
    return f"{off} is missing before line {int(trace.line[row])}, {' '.join(text.split())[:60]}"


def others(trace: Trace, at: list[int]) -> str:
    """The words at fault as they are written."""
    return " ".join(executed_word(trace, index) for index in at)


def since(trace: Trace, row: int) -> int:
    """The line of the G12.1 of this row's section."""
    return int(trace.line[trace.sections.enter[trace.section[row]]])


def plane(trace: Trace, row: int) -> str:
    """The plane in force, as in G18."""
    return f"G{trace.state('plane')[row]}"


def wanted(machine: Machine) -> str:
    """The planes that the profile wants."""
    return " or ".join(machine.polar.plane_before)


def side(trace: Trace, row: int) -> str:
    """G41 or G42, whichever was in force before."""
    return f"G{trace.side_before[row]}"


def _states(trace: Trace, row: int) -> list[tuple[str, str]]:
    cycle = int(trace.drilling[row])
    found = [(spelled("G", cycle * 10), "G80")] if cycle else []
    return found + [ends for (group, state), ends in _ENDS.items() if trace.state(group)[row] == state]


def in_force(trace: Trace, row: int) -> str:
    """What should have ended before G12.1."""
    return ", ".join(name for name, _ in _states(trace, row))


def ends(trace: Trace, row: int) -> str:
    """What ends it."""
    return ", ".join(name for _, name in _states(trace, row))


def meaning(trace: Trace, at: list[int]) -> str:
    """The first word at fault and what it means in this G-code system."""
    address = chr(int(trace.run.words.address[at[0]]))
    system = trace.machine.control.g_code_system
    name = spelled("G", round(float(trace.run.words.value[at[0]]) * 10)) if address == "G" else address
    other = f"no incremental word of G-code system {system}, where G91 makes X and C incremental"
    return f"{name} is {_IN_SYSTEM_A.get(name, other)}"


def other_controls(machine: Machine) -> str:
    """Which controls take the address."""
    controls = machine.polar.other_virtual_axis_of
    return f"; {controls} would take it" if controls else ""


def not_simulated(trace: Trace, infeed: Infeed) -> Iterator[tuple[str, int]]:
    """What of the words beside G12.1 is not simulated, and in how many blocks."""
    mode = trace.machine.polar
    for word, number, axis in (("P", mode.linear_axis, "linear"), ("Q", mode.rotary_axis, "rotary")):
        if word in mode.switch_words:
            value = trace.word(word)
            other = trace.enters & ((value < number) | (value > number))
            yield f"{word} names another {axis} axis than {number}, which is not simulated", int(other.sum())
    for word in sorted({"X", mode.virtual_axis} & set(mode.switch_words)):
        shifts = trace.enters & (abs(trace.word(word)) > 0)
        yield f"the center of the C axis shifted by {word} is not simulated", int(shifts.sum())
    partly = int(infeed.is_simulated_in_part.sum())
    yield "of an infeed cycle only the passes next to the contour are simulated", partly
