"""Phrases that rules of several groups use."""

from __future__ import annotations

from polarcheck.checking.places import Place, block_in_line, squeezed
from polarcheck.machines.codes import code_numbers, spelled
from polarcheck.machines.machine import Machine
from polarcheck.machines.own_language import shown
from polarcheck.reading.excerpt import shortened
from polarcheck.reading.words import Text
from polarcheck.table.trace import Trace

#: Of what is written [characters].
_LONGEST = 40


def short(written: str) -> str:
    """What is written, in one line and not too long."""
    return shortened(" ".join(written.split()), _LONGEST)


def text(text: Text, place: Place) -> str:
    """What stands at the place."""
    return short(text.source.excerpt(place.start, place.end))


def written(trace: Trace, row: int, address: str) -> str:
    """The last word of an address in a row as it is written, without blanks; the address where there is none."""
    indices = trace.word_indices(address)
    at = indices[trace.run.row[indices] == row]
    return executed_word(trace, int(at[-1])) if len(at) else address


def block_and_line(trace: Trace, row: int) -> str:
    """A block with its line, as in `G10 P8 R4. in line 3`."""
    return f"{block_in_line(trace, row, _LONGEST)} in line {int(trace.line[row])}"


def word(trace: Trace, at: list[int]) -> str:
    """The first word at fault as it is written, without blanks."""
    return executed_word(trace, at[0])


def executed_word(trace: Trace, index: int) -> str:
    """An executed word as it is written, without blanks; `:` is O."""
    table = trace.run.words
    return short(squeezed(trace.text.source.excerpt(int(table.start[index]), int(table.end[index]))))


def codes(trace: Trace, at: list[int]) -> str:
    """The codes at fault, each once, as in `G17, M5`."""
    table = trace.run.words
    numbers = code_numbers(table.value[at])
    named = [spelled(chr(int(table.address[index])), int(number)) for index, number in zip(at, numbers, strict=True)]
    return ", ".join(dict.fromkeys(named))


def code_of(machine: Machine, key: str) -> str:
    """The first code of a list of the machine; what it is for where the machine has none: `feed per minute`."""
    return next(iter(machine.codes(key)), key.replace("_", " "))


def centers(trace: Trace, row: int) -> str:
    """The addresses of arc centers: I or J."""
    return " or ".join(trace.center_words(row))


def linear(trace: Trace, row: int) -> str:
    """The address of the linear axis: X."""
    return chr(trace.linear_axis[row])


def virtual(trace: Trace, row: int) -> str:
    """The address of the virtual axis: C."""
    return trace.virtual_axis_of(row)


def rotary(machine: Machine) -> str:
    """The address of the rotary axis: C."""
    return machine.polar.rotary_address


def switch(trace: Trace, row: int) -> str:
    """The code in this row that switches the polar mode on or off, as in G12.1 or G113."""
    return shown(trace.machine.control.native_words, _switch(trace, row))


def switch_off(trace: Trace, row: int) -> str:
    """The code that ends the mode which the code in this row begins: G113 for G112."""
    polar = trace.machine.polar
    code = dict(zip(polar.on, polar.off, strict=False)).get(_switch(trace, row), polar.off[0])
    return shown(trace.machine.control.native_words, code)


def switch_on(trace: Trace, row: int) -> str:
    """The code that begins the mode which the code in this row ends: G112 for G113."""
    polar = trace.machine.polar
    code = dict(zip(polar.off, polar.on, strict=False)).get(_switch(trace, row), polar.on[0])
    return shown(trace.machine.control.native_words, code)


def _switch(trace: Trace, row: int) -> str:
    polar = trace.machine.polar
    return next((name for name in (*polar.on, *polar.off) if trace.codes(name)[row]), polar.on[0])


def outside(trace: Trace, row: int) -> str:
    """Where it belongs, with the codes of this section: before G112 or after G113."""
    enter = int(trace.sections.enter[trace.section[row]])
    return f"before {switch(trace, enter)} or after {switch_off(trace, enter)}"
