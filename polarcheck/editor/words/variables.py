"""What a variable is on a machine, and what it holds at a block, as the program has run."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.editor.analysis import Analysis
from polarcheck.editor.words.at_cursor import CursorWord
from polarcheck.program.execution.macro import VariableKind, Variables
from polarcheck.program.execution.run import ValueSet
from polarcheck.program.machines.machine import Machine

_NUMBERED = re.compile(r"(?:#|R|VC)(\d{1,9})", re.ASCII)
_KINDS = {
    VariableKind.NONE: "this control has no such variable",
    VariableKind.VACANT: "always vacant",
    VariableKind.LOCAL: "local variable: each macro call has its own",
    VariableKind.COMMON: "common variable, vacant at power-on",
    VariableKind.RETAINED: "common variable that outlives the power-off",
    VariableKind.SYSTEM: "system variable",
    VariableKind.CLOCK: "system variable that counts on by itself",
    VariableKind.READ_ONLY: "system variable that a program cannot assign",
}
#: Ranges of system variables, in words for people.
_RANGES = {
    "tool_offset_variables": "tool offset",
    "work_offset_variables": "work offset",
    "alarm_variables": "ends the program with an alarm",
    "stop_variables": "stops the program with a message",
}


def kind_of(number: int, machine: Machine) -> str:
    """Return what a numbered variable is, in words for people."""
    kind = _KINDS[Variables(machine.macro).kind(number)]
    special = [title for key, title in _RANGES.items() if _is_in(number, getattr(machine.macro, key))]
    return ": ".join([kind, *special])


def _is_in(number: int, ranges: object) -> bool:
    spans = ranges if isinstance(ranges, list) else []
    return any(number == span if isinstance(span, int) else span[0] <= number <= span[1] for span in spans)


def number_of(name: str) -> int | None:
    """Return the number of a variable as it is written, `#101`; None for one with a name."""
    match = _NUMBERED.fullmatch(name)
    return int(match[1]) if match else None


def facts_of(word: CursorWord, analysis: Analysis, row: int | None, trace: Trace | None) -> Iterator[tuple[str, str]]:
    """
    Yield what a variable is, and what it holds behind the first run of its block.

    row: the first row of the block; None if it has none.
    """
    assert analysis.settings is not None
    machine = analysis.settings.machine
    number = number_of(word.letter)
    if number is None or (word.letter[0] != "#" and machine.macro.language == "custom-macro"):
        yield "variable", f"{word.letter}, known by its name"
        return
    yield "variable", kind_of(number, machine) if word.letter[0] == "#" else "parameter"
    given: Mapping[int, float] = {**machine.macro.given, **analysis.settings.job.run.variables}
    if number in given:
        yield "given by the settings", _text_of(given[number])
    if trace is not None and word.letter[0] == "#":
        yield from _held(number, word, row, trace)


def _held(number: int, word: CursorWord, row: int | None, trace: Trace) -> Iterator[tuple[str, str]]:
    """Yield the value behind the first run of the block, and the line that has set it."""
    values = trace.run.values
    last, when = _last_behind(word.block, row, number, values), "at its first run"
    for block in range(word.block - 1, max(word.block - _MOST_BEFORE, 0) - 1, -1) if last is None else ():
        # A jump or the head of a loop has no row: what the block before it left is known.
        rows = np.flatnonzero(trace.run.block == block)
        last = _last_behind(block, int(rows[0]) if len(rows) else None, None, values)
        if last is not None:
            when = f"behind the first run of line {int(trace.run.text.blocks.line[block])}"
            break
    if last is None or last < 0:
        return
    level = values[last].level
    for index in range(last, -1, -1):
        held = values[index]
        is_local = number < _FIRST_COMMON
        if is_local and held.level < level:
            return
        if held.number == number and (not is_local or held.level == level):
            line = int(trace.run.text.blocks.line[held.block]) if held.block >= 0 else 0
            suffix = f", set in line {line}" if line and held.block != word.block else ", set here" if line else ""
            yield f"value {when}", f"{_text_of(held.value)}{suffix}"
            return


def _last_behind(block: int, row: int | None, number: int | None, values: Sequence[ValueSet]) -> int | None:
    """Return the last value set in the first run of a block, or of a variable in it; None if it is not known."""
    index_of_block = next((index for index, value in enumerate(values) if value.block == block), None)
    if index_of_block is None:
        return None if row is None else next((i for i, value in enumerate(values) if value.row > row), len(values)) - 1
    # What the block assigns itself, in its first run.
    last = index_of_block
    while last + 1 < len(values) and values[last + 1].block == block and values[last].number != number:
        if number is None and values[last + 1].number == values[index_of_block].number:
            break
        last += 1
    return last


#: How many blocks before a jump are looked at for the last one that was executed.
_MOST_BEFORE = 20
#: Lower numbers are local variables on any control.
_FIRST_COMMON = 100


def _text_of(value: float | None) -> str:
    return "vacant" if value is None else "not known" if value != value else f"{value:.6g}"
