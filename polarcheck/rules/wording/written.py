"""Words, blocks, codes and points as the program writes them."""

from __future__ import annotations

from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.code_tables import code_numbers, spelled
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.excerpt import shortened
from polarcheck.program.reading.words import Text
from polarcheck.rules.places import Place, block_in_line, squeezed
from polarcheck.rules.quantity import in_row

#: Of what is written [characters].
_LONGEST = 40


def short(written: str) -> str:
    """What is written, in one line and not too long."""
    return shortened(" ".join(written.split()), _LONGEST)


def comment_in_words(text: Text, number: int) -> str:
    """A comment by its number, as it is written."""
    comments = text.comments
    return short(text.written(comments, number))


def written(blocks: ExecutedBlocks, run: Run, row: int, address: str) -> str:
    """The last word of an address in a row as it is written, without blanks; the address where there is none."""
    indices = blocks.word_indices(address)
    at = indices[run.row[indices] == row]
    return executed_word(run, int(at[-1])) if len(at) else address


def block_in_short(run: Run, row: int) -> str:
    """The block of a row as it is written: `G0 C120.`"""
    return block_in_line(run, row, _LONGEST)


def block_and_line(trace: Trace, row: int) -> str:
    """A block with its line, as in `G10 P8 R4. in line 3`."""
    return f"{block_in_short(trace.run, row)} in line {int(trace.blocks.line[row])}"


def executed_word(run: Run, index: int) -> str:
    """An executed word as it is written, without blanks; `:` is O."""
    return short(squeezed(run.written(index)))


def code_of(machine: Machine, key: str) -> str:
    """The first code of a list of the machine; what it is for where the machine has none: `feed per minute`."""
    return next(iter(machine.codes(key)), key.replace("_", " "))


def move_code(machine: Machine, key: str) -> str:
    """The code of a move in the mode as the control has it: G1, or G101."""
    code = code_of(machine, key)
    return next((name for name, meant in machine.control.motion_codes.items() if meant == code), code)


def point(trace: Trace, place: complex, row: int) -> str:
    """A plane point as words of a row: X30 C15, or X30 Y15."""
    axis = trace.axes.virtual_axis_of(row)
    return f"{in_row(place, trace.lengths, row):point}".replace("C", f"{axis}=" if len(axis) > 1 else axis)


def switch(blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    """The code in this row that switches the polar mode on or off, as in G12.1 or G113."""
    return _shown(machine, _switch(blocks, machine, row))


def switch_off(blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    """The code that ends the mode which the code in this row begins: G113 for G112."""
    polar = machine.polar
    code = dict(zip(polar.on, polar.off, strict=False)).get(_switch(blocks, machine, row), polar.off[0])
    return _shown(machine, code)


def switch_on(blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    """The code that begins the mode which the code in this row ends: G112 for G113."""
    polar = machine.polar
    code = dict(zip(polar.off, polar.on, strict=False)).get(_switch(blocks, machine, row), polar.on[0])
    return _shown(machine, code)


def _shown(machine: Machine, code: str) -> str:
    from polarcheck.program.machines.own_language import shown  # asked for by messages alone

    return shown(machine.control.native_words, code)


def _switch(blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    polar = machine.polar
    return next((name for name in (*polar.on, *polar.off) if blocks.codes(name)[row]), polar.on[0])


def g_code(text: Text, index: int) -> str:
    """A G code of the file, as in G0; as it is written where it is none that a control could know."""
    words = text.words
    number = int(code_numbers(words.value[index : index + 1])[0])
    return spelled("G", number) if number >= 0 else short(text.written(words, index))


def with_digits(text: Text, place: Place) -> str:
    """A word with its digits in the place of letters."""
    first, end = stretch(text.letters, place.start, place.end)
    characters = list(text.source.excerpt(place.start, place.end))
    for at in (text.letters[first:end] - place.start).tolist():
        characters[at] = "0" if characters[at] in "oO" else "1"
    return short("".join(characters).upper())
