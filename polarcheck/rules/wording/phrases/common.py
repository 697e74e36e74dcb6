"""Phrases that rules of several groups use."""

from __future__ import annotations

import re

from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.lengths import Lengths
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.codes import code_numbers, spelled
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.own_language import shown
from polarcheck.program.reading.excerpt import shortened
from polarcheck.program.reading.words import Text
from polarcheck.rules.places import Place, block_in_line, squeezed
from polarcheck.rules.quantity import in_row

#: Of what is written [characters].
_LONGEST = 40
#: The name before = that is read as a letter: POS[C]=0 as C.
_NAME = re.compile(r"(?<![A-Za-z])[A-Za-z]++(?:\[\w{1,8}\])?\Z")


def short(written: str) -> str:
    """What is written, in one line and not too long."""
    return shortened(" ".join(written.split()), _LONGEST)


def text(text: Text, place: Place) -> str:
    """What stands at the place."""
    return short(text.source.excerpt(place.start, place.end))


def written(blocks: ExecutedBlocks, run: Run, row: int, address: str) -> str:
    """The last word of an address in a row as it is written, without blanks; the address where there is none."""
    indices = blocks.word_indices(address)
    at = indices[run.row[indices] == row]
    return executed_word(run, int(at[-1])) if len(at) else address


def block_and_line(blocks: ExecutedBlocks, run: Run, row: int) -> str:
    """A block with its line, as in `G10 P8 R4. in line 3`."""
    return f"{block_in_line(run, row, _LONGEST)} in line {int(blocks.line[row])}"


def word(run: Run, at: list[int]) -> str:
    """The first word at fault as it is written, without blanks."""
    return executed_word(run, at[0])


def executed_word(run: Run, index: int) -> str:
    """An executed word as it is written, without blanks; `:` is O."""
    table = run.words
    start, source = int(table.start[index]), run.text.source
    found = source.excerpt(start, int(table.end[index]))
    if found.startswith("=") and (name := _NAME.search(source.excerpt(max(start - _LONGEST, 0), start))):
        found = name[0] + found
    return short(squeezed(found))


def codes(run: Run, at: list[int]) -> str:
    """The codes at fault, each once, as in `G17, M5`."""
    table = run.words
    numbers = code_numbers(table.value[at])
    named = [spelled(chr(int(table.address[index])), int(number)) for index, number in zip(at, numbers, strict=True)]
    return ", ".join(dict.fromkeys(named))


def code_of(machine: Machine, key: str) -> str:
    """The first code of a list of the machine; what it is for where the machine has none: `feed per minute`."""
    return next(iter(machine.codes(key)), key.replace("_", " "))


def move_code(machine: Machine, key: str) -> str:
    """The code of a move in the mode as the control has it: G1, or G101."""
    code = code_of(machine, key)
    return next((name for name, meant in machine.control.motion_codes.items() if meant == code), code)


def line_code(machine: Machine) -> str:
    """The code of a straight move at feed in the mode."""
    return move_code(machine, "line")


def centers(axes: PlaneAxes, row: int) -> str:
    """The addresses of arc centers: I or J."""
    return " or ".join(axes.center_words(row))


def linear(axes: PlaneAxes, row: int) -> str:
    """The address of the linear axis: X."""
    return chr(axes.linear_axis[row])


def virtual(axes: PlaneAxes, row: int) -> str:
    """The address of the virtual axis: C."""
    return axes.virtual_axis_of(row)


def point(axes: PlaneAxes, lengths: Lengths, place: complex, row: int) -> str:
    """A plane point as words of a row: X30 C15, or X30 Y15."""
    axis = axes.virtual_axis_of(row)
    return f"{in_row(place, lengths, row):point}".replace("C", f"{axis}=" if len(axis) > 1 else axis)


def rotary(machine: Machine) -> str:
    """The address of the rotary axis: C."""
    return machine.polar.rotary_address


def switch(blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    """The code in this row that switches the polar mode on or off, as in G12.1 or G113."""
    return shown(machine.control.native_words, _switch(blocks, machine, row))


def switch_off(blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    """The code that ends the mode which the code in this row begins: G113 for G112."""
    polar = machine.polar
    code = dict(zip(polar.on, polar.off, strict=False)).get(_switch(blocks, machine, row), polar.off[0])
    return shown(machine.control.native_words, code)


def switch_on(blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    """The code that begins the mode which the code in this row ends: G112 for G113."""
    polar = machine.polar
    code = dict(zip(polar.off, polar.on, strict=False)).get(_switch(blocks, machine, row), polar.on[0])
    return shown(machine.control.native_words, code)


def _switch(blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    polar = machine.polar
    return next((name for name in (*polar.on, *polar.off) if blocks.codes(name)[row]), polar.on[0])


def outside(blocks: ExecutedBlocks, mode: PolarMode, machine: Machine, row: int) -> str:
    """Where it belongs, with the codes of this section: before G112 or after G113."""
    enter = int(mode.sections.enter[mode.section[row]])
    return f"before {switch(blocks, machine, enter)} or after {switch_off(blocks, machine, enter)}"
