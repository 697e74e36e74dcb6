"""Where the elements of a mask stand in the file: block, row and span of each, and the words at fault in it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows, side_by_side, stretch
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.code_lists import numbers
from polarcheck.program.machines.code_tables import code_numbers
from polarcheck.program.reading.excerpt import shortened
from polarcheck.program.reading.words import Text
from polarcheck.rules.tables import SPANS, Tables

#: A % with what else stands on its line, and blanks.
_MARK = lazy_pattern(r"(?:%[^\r\n]*)?[\0-\x20\x7f\xa0]*")


#: A name of two letters or more, or a variable by its number, behind an address and = or for itself.
_NAME = lazy_pattern(r"(?:[A-Z]=?(?=#)|[A-Z]=)?([A-Z][A-Z_][A-Z0-9_]*|#\d+)")
#: Of a name [characters].
_NAME_LENGTH = 40
#: Faults that stand at the name of which something is not known.
_OF_NAMES = frozenset({"format", "word-vacant"})
#: Of a block that is shown [characters].
_BLOCK_LENGTH = 200


class Place(msgspec.Struct, frozen=True):
    """
    One element of a mask: its characters in the file, from start to end (exclusive), and its block.

    row: of the trace; -1 where no row runs it. index: the element itself, as of a section or a word.
    """

    start: int
    end: int
    block: int
    row: int
    index: int


def blocks(over: str, tables: Tables) -> Rows:
    """The block of each element of what a rule is over."""
    trace: Trace = tables["trace"]
    if over == "rows":
        return trace.run.block
    if over == "sections":
        return trace.run.block[trace.mode.sections.enter]
    if over == "programs":
        return trace.run.block[_last_rows(trace)]
    if over == "faults":
        return np.array([fault.block for fault in trace.run.faults], np.int64)
    if over == "files":
        return np.zeros(1, np.int64)
    if over == "allows":
        return np.asarray(tables["allows"].block)
    found: Rows = getattr(trace.text, over).block
    return found


def rows(over: str, tables: Tables) -> Rows:
    """The row of each element of what a rule is over, the first that runs it; -1 where none does."""
    trace: Trace = tables["trace"]
    if over == "rows":
        return np.arange(len(trace))
    if over == "sections":
        return trace.mode.sections.enter
    if over == "programs":
        return _last_rows(trace)
    if over == "files":
        return np.full(1, -1)
    if over == "faults":
        return np.array([min(fault.row, len(trace) - 1) for fault in trace.run.faults], np.int64)
    return trace.blocks.row_of_block[blocks(over, tables)]


def span_of(name: str, over: str, tables: Tables) -> Rows:
    """For each element of what a rule is over which block, section or the like (SPANS) it belongs to, -1 for none."""
    if name == "block":
        return blocks(over, tables)
    if name == "structure":
        structure: Rows = tables["since"].structure_of_block
        return structure[blocks(over, tables)]
    if name == "name":
        return _names(over, tables)
    at, of_rows = rows(over, tables), SPANS[name]
    if of_rows is None:  # the whole file
        return np.zeros(len(at), np.int64)
    column = of_rows(tables)
    return np.where(at >= 0, column[at], -1) if len(column) else np.full(len(at), -1)


def _names(over: str, tables: Tables) -> Rows:
    """The same number for elements at which the same name of macro stands, or the same variable; -1 for others."""
    trace: Trace = tables["trace"]
    source, words = trace.text.source, trace.text.words
    numbers: dict[str, int] = {}
    column = np.full(len(blocks(over, tables)), -1)
    if over == "words":
        at = np.flatnonzero(words.is_unreadable)
        starts = words.start[at]
    else:
        faults = trace.run.faults
        at = np.flatnonzero([fault.kind in _OF_NAMES for fault in faults])
        starts = np.array([faults[index].start for index in at], np.int64)
    for index, start in side_by_side(at, starts):
        if name := _NAME.match(source.excerpt(start, start + _NAME_LENGTH)):
            column[index] = numbers.setdefault(name[1], len(numbers))
    return column


def of_row(tables: Tables, index: int) -> Place:
    """The words of a row; of a row without words its block without the blanks around it."""
    trace: Trace = tables["trace"]
    block = int(trace.run.block[index])
    start, end = int(trace.text.blocks.start[block]), int(trace.text.blocks.end[block])
    table, run = trace.run.words, trace.run
    low, high = stretch(run.row, index, index + 1)
    if low < high:
        start, end = int(table.start[low:high].min()), int(table.end[low:high].max())
    else:
        text = trace.text.source.excerpt(start, end)
        start += len(text) - len(text.lstrip())
        end -= len(text) - len(text.rstrip())
    return Place(start, max(end, start + 1), block, index, index)


def of_word(tables: Tables, index: int) -> Place:
    """A word of the file."""
    return _placed(tables, tables["trace"].text.words, index)


def of_section(tables: Tables, index: int) -> Place:
    """The G12.1 of a section."""
    place = of_row(tables, int(tables["trace"].mode.sections.enter[index]))
    return msgspec.structs.replace(place, index=index)


def of_program(tables: Tables, index: int) -> Place:
    """The last row of the program, where its end is missing."""
    place = of_row(tables, int(_last_rows(tables["trace"])[index]))
    return msgspec.structs.replace(place, index=index)


def _last_rows(trace: Trace) -> Rows:
    return np.append(np.flatnonzero(trace.blocks.starts)[1:], len(trace)) - 1


def of_file(tables: Tables, index: int) -> Place:
    """The first line of the file; of an empty one where it would stand."""
    trace: Trace = tables["trace"]
    return Place(0, max(len(trace.text.source.line_text(1).rstrip()), 1), 0, -1, index)


def of_fault(tables: Tables, index: int) -> Place:
    """What macro or flow found wrong."""
    trace: Trace = tables["trace"]
    fault = trace.run.faults[index]
    row = min(fault.row, len(trace) - 1)
    return Place(fault.start, fault.end, fault.block, row if fault.row >= 0 else -1, index)


def of_allow(tables: Tables, index: int) -> Place:
    """An allow comment."""
    return _placed(tables, tables["allows"], index)


def _placed(tables: Tables, spans: Any, index: int) -> Place:
    """An element of a table with the columns block, start and end."""
    block = int(spans.block[index])
    row = int(tables["trace"].blocks.row_of_block[block])
    return Place(int(spans.start[index]), int(spans.end[index]), block, row, index)


def of_outside(tables: Tables, index: int) -> Place:
    """What stands behind the % that ends the program, which is no part of the text; in its first block."""
    trace: Trace = tables["trace"]
    spans, blocks = trace.text.outside, trace.text.blocks
    start, end = int(spans.start[index]), int(spans.end[index])
    mark = _MARK.match(trace.text.source.excerpt(start, end))
    start = min(start + (mark.end() if mark else 0), end - 1)
    block = int(np.searchsorted(blocks.start, start, side="right")) - 1
    end = min(end, max(int(blocks.end[block]), start + 1))
    return Place(start, end, block, int(trace.blocks.row_of_block[block]), index)


def _of_span(name: str) -> Callable[[Tables, int], Place]:
    return lambda tables, index: _placed(tables, getattr(tables["trace"].text, name), index)


PLACES: dict[str, Callable[[Tables, int], Place]] = {
    "rows": of_row,
    "words": of_word,
    "sections": of_section,
    "programs": of_program,
    "faults": of_fault,
    "files": of_file,
    "allows": of_allow,
    "outside": of_outside,
    **{name: _of_span(name) for name in ("comments", "strays", "foreign", "prose", "dots")},
}


def words_at_fault(tables: Tables, row: int, names: tuple[str, ...], at: Mask | None) -> list[int]:
    """
    The executed words of a row that are at fault: those of the mask, or those of the names; empty where there are none.

    names: addresses (X, `,R`; C is the virtual and the rotary axis, whatever their addresses), lists of G codes of the
    machine (rapid), "on" and "off" for the codes of the mode.
    """
    if row < 0:
        return []
    trace: Trace = tables["trace"]
    low, high = stretch(trace.run.row, row, row + 1)
    if at is not None:
        return [index for index in range(low, high) if at[index]]
    return [index for index in range(low, high) if _is_named(trace, index, names)]


def span(tables: Tables, place: Place, at: list[int]) -> tuple[int, int]:
    """From the first to the last word at fault, or the whole place where none is named."""
    table = tables["trace"].run.words
    if not at:
        return place.start, place.end
    return int(table.start[at].min()), int(table.end[at].max())


def block_text(text: Text, block: int) -> str:
    """A block as it is written, comments included, without the blanks around it; of a very long one its beginning."""
    start, end = int(text.blocks.start[block]), int(text.blocks.end[block])
    # Beyond the blanks around it only so much is looked at as is shown.
    return shortened(text.source.excerpt(start, min(end, start + 2 * _BLOCK_LENGTH)).strip(), _BLOCK_LENGTH)


def block_in_line(run: Run, row: int, length: int) -> str:
    """The block of a row in one line, as messages name it, shortened to a length."""
    return shortened(" ".join(block_text(run.text, int(run.block[row])).split()), length)


def squeezed(text: str) -> str:
    """Without blanks; `:` is O."""
    return "".join(text.split()).replace(":", "O")


def _is_named(trace: Trace, index: int, names: tuple[str, ...]) -> bool:
    number = int(trace.run.words.address[index])
    address = chr(number)
    if "C" in names:
        own = (*trace.axes.virtual_addresses(int(trace.run.row[index])), *trace.machine.polar.rotary_words)
        if number in map(trace.machine.address_number, filter(None, own)):
            return True
        names = tuple(name for name in names if name not in "CH")
    if address in names or (address.islower() and f",{address.upper()}" in names):
        return True
    lists = [name for name in names if name.islower()] if address in "GM" else []
    code = int(code_numbers(trace.run.words.value[index : index + 1])[0]) if lists else -1
    return code >= 0 and any(code in _codes(trace, name) for name in lists)


def _codes(trace: Trace, name: str) -> list[int]:
    """The code numbers of what a rule names: the switches of the mode, or a list of the machine."""
    polar = trace.machine.polar
    return numbers({"on": polar.on, "off": polar.off}.get(name) or trace.machine.codes(name))
