"""The result of an execution: the executed blocks in order, their words, faults and remarks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Mask, Points, Rows, States, is_among, repeated
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.execution.kinds import FaultKind, RemarkKind
from polarcheck.program.machines.code_tables import code_numbers, code_set
from polarcheck.program.reading.words import Text, Words

#: M2, M30, M99: the end of a program.
_ENDS = (2, 30, 99)
#: The name before = that is read as a letter, and how far before it begins at most [characters].
_NAME = lazy_pattern(r"(?<![A-Za-z])[A-Za-z]++(?:\[\w{1,8}\])?\Z")
_LONGEST = 40


class FlowFault(msgspec.Struct, frozen=True):
    """
    Something wrong in a macro statement or in the flow.

    block, start, end: its block and its characters in the text, end exclusive. values: for a message, by name, as the
    N number that a jump does not find. row: that was about to be executed when it was found, -1 where none was.
    """

    kind: FaultKind
    block: int
    start: int
    end: int
    values: dict[str, str | int | float] = {}
    row: int = -1


class Remark(msgspec.Struct, frozen=True):
    """
    Why a block was not executed, or not as the control would; values: for the reason, by name.

    row: that was about to be executed at an unknown condition, from which a main program runs down to its end
    (Listing.runs_down); else -1.
    """

    kind: RemarkKind
    block: int
    values: dict[str, str | int | float] = {}
    row: int = -1


#: The number of a variable where nobody knows which is assigned.
NO_VARIABLE = -1


class Assigned(msgspec.Struct, frozen=True):
    """
    A variable of an offset that a row assigns, or one that may be of an offset since its number is not known.

    value: in the units of the program; NaN where it is not known. is_step: it is added to what the variable held.
    """

    variable: int
    value: float
    is_step: bool = False

    @property
    def name(self) -> str:
        """As it is written: #2001."""
        return f"#{self.variable}"


class ValueSet(msgspec.Struct, frozen=True):
    """
    A variable that has got a value.

    row: how many rows had been executed before.
    block: that sets it; of an argument that of the call.
    number: of the variable.
    value: None for vacant, NaN for unknown.
    level: how many macro calls deep.
    """

    row: int
    block: int
    number: int
    value: float | None
    level: int


class Beside(msgspec.Struct, frozen=True):
    """
    The other channels of a file: their texts, whose programs can be called; and what they call, by numbers and names.
    """

    texts: Sequence[Text] = ()
    called: frozenset[int | str] = frozenset()


class MadeCorners(msgspec.Struct, frozen=True):
    """
    Corners that the control makes between two moves of the polar plane: a row without words behind the first of both.

    row, motion: int64[n], int16[n], the rows inserted and their Motion.
    following: int64[n], the row of the second move, whose F they run at.
    ended, end: int64[2n], complex128[2n], rows that end elsewhere than their words say, and where [mm].
    round, center: int64[m], complex128[m], arcs among all these rows, and their centers [mm].
    """

    row: Rows
    motion: States
    following: Rows
    ended: Rows
    end: Points
    round: Rows
    center: Points


class Run(msgspec.Struct, frozen=True):
    """
    The executed blocks of one file in order.

    words: in order of execution. row: the row of each word, ascending. block: the index into text.blocks of each row.
    starts: rows at which a program begins, so that nothing before them counts. unknown: rows whose effect is not known.
    depth: of calls. faults: what macro and flow found. remarks: what was not evaluated. assigned: row -> the variable
    of an offset that it assigns, with its value. distance: per word what it says of itself (modal.Distance), 0 where it
    says nothing; None where no word does. names: of tools that T calls by name, by the number that stands for them.
    broken_off: rows at which a bound of the check has ended a program; None where it has ended none. values: the
    values that variables have got, in order, up to a bound. unknown_words: executed word of unknown value -> the
    variable without a value that it rests on, None where it is not known which. never_set: executed word -> the vacant
    variable that its value is calculated with, and that no block of the file sets. corners: those that the control
    makes; None where it makes none.
    """

    text: Text
    words: Words
    row: Rows
    block: Rows
    starts: Mask
    unknown: Mask
    depth: Rows
    faults: tuple[FlowFault, ...] = ()
    remarks: tuple[Remark, ...] = ()
    assigned: Mapping[int, Assigned] = {}
    distance: NDArray[np.int16] | None = None
    names: Mapping[int, str] = {}
    broken_off: Mask | None = None
    values: Sequence[ValueSet] = ()
    unknown_words: Mapping[int, int | None] = {}
    never_set: Mapping[int, int] = {}
    corners: MadeCorners | None = None

    def __len__(self) -> int:
        return len(self.block)

    @property
    def block_count(self) -> int:
        """Executed blocks; a corner that the control makes is none."""
        return len(self) - (0 if self.corners is None else len(self.corners.row))

    @property
    def blocks_run_once(self) -> set[int]:
        """The blocks whose calls are more than a check executes, so that they are run once."""
        return {fault.block for fault in self.faults if fault.kind == "too-many-repeats"}

    def written(self, index: int) -> str:
        """An executed word as it stands in the file, with the name that is read as its letter: `POS[C]=0`, `CR=5.`."""
        start, source = int(self.words.start[index]), self.text.source
        found = source.excerpt(start, int(self.words.end[index]))
        name = _NAME.search(source.excerpt(max(start - _LONGEST, 0), start)) if found.startswith("=") else None
        return found if name is None else name[0] + found


def with_rows_behind(run: Run, rows: Rows) -> Run:
    """The run with a row without words behind each of these rows, which rise; it belongs to the same block."""

    def moved(row: int) -> int:
        return row + int(np.searchsorted(rows, row)) if row > 0 else row

    behind = rows + 1
    return msgspec.structs.replace(
        run,
        row=run.row + np.searchsorted(rows, run.row),
        block=np.insert(run.block, behind, run.block[rows]),
        starts=np.insert(run.starts, behind, False),
        unknown=np.insert(run.unknown, behind, False),
        depth=np.insert(run.depth, behind, run.depth[rows]),
        faults=tuple(msgspec.structs.replace(fault, row=moved(fault.row)) for fault in run.faults),
        remarks=tuple(msgspec.structs.replace(remark, row=moved(remark.row)) for remark in run.remarks),
        assigned={moved(row): assigned for row, assigned in run.assigned.items()},
        broken_off=None if run.broken_off is None else np.insert(run.broken_off, behind, False),
        values=[msgspec.structs.replace(value, row=moved(value.row)) for value in run.values],
    )


def straight(text: Text, ends: Iterable[str]) -> Run:
    """
    The rows of programs that run from top to bottom: one per block that has words.

    ends: the M codes that end a program.
    """
    has_row = text.blocks.is_macro.copy()
    has_row[text.words.block] = True
    block = np.flatnonzero(has_row)
    row = (np.cumsum(has_row) - 1)[text.words.block]
    starts = np.zeros(len(block), bool)
    if len(block):
        starts[0] = True
        starts[row[begins_program(text.words)]] = True
        after = row[is_code(text.words, ends)] + 1
        starts[after[after < len(block)]] = True
    return Run(text, text.words, row, block, starts, text.blocks.is_macro[block], repeated(np.int64(0), len(block)))


def is_code(words: Words, codes: Iterable[str]) -> Mask:
    """Per word: whether it is one of some G or M codes."""
    mask = np.zeros(len(words), bool)
    for letter in "GM":
        index = np.flatnonzero(words.address == ord(letter))
        table = code_set([code for code in codes if code[0] == letter])
        mask[index] = table[code_numbers(words.value[index])]
    return mask


def begins_program(words: Words) -> Mask:
    """
    Per word: an O at the head of its block, be it behind a / or an N word; elsewhere it is no program number.

    But behind the M code that ends a program: what a control puts out may lack the line end there, as in M99O0810.
    """
    begins = words.address == ord("O")
    index = np.flatnonzero(begins)
    first = np.searchsorted(words.block, words.block[index])
    inside = index > first
    if np.any(inside):
        before = np.append(0, np.cumsum(is_among(words.address, list(b"N/"))))
        is_end = (words.address[index - 1] == ord("M")) & is_among(words.value[index - 1], _ENDS)
        begins[index] = (before[index] - before[first] == index - first) | (inside & is_end)
    return np.asarray(begins)
