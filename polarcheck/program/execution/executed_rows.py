"""The executed rows while they are being gathered: ranges of plain blocks, and blocks whose words were computed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Mask, Rows, different, folded, is_among, mask_at, stretch
from polarcheck.program.execution.arithmetic import FromVacant, Unknown
from polarcheck.program.execution.run import Assigned, FlowFault, Remark, Run, ValueSet, is_code
from polarcheck.program.execution.statement import Statement, Word
from polarcheck.program.execution.variable_names import ASSIGNED
from polarcheck.program.machines.axis_table import AXIS_LETTERS
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.words import Blocks, Text, Words

#: Rows kept of a program that was broken off, beside as many as the file has blocks: enough turns to judge its loop.
_KEPT_ROWS = 10_000
#: #[#101+1]= may set any variable.
_ASSIGNS_ANY = re.compile(rb"\][ \t]*+=")
Kind = TypeVar("Kind", Unknown, FromVacant)
#: Values of variables that are noted.
_MOST_VALUES = 20_000
#: No variable has a larger number, names included.
_LARGEST_NUMBER = 1e9


class _Range(msgspec.Struct, frozen=True):
    """Words of a range of plain blocks: their indices, the row of each within the range, and the block of each row."""

    words: Rows
    row: Rows
    block: Rows


class ExecutedRows:
    """
    What has been executed so far.

    skip: block skip is on, so that what follows a / is not read. inch: whether
    lengths are in inch at present; inch_at_first where a program has not said. broken_off: the last row of each program
    that a bound has ended.
    """

    def __init__(self, text: Text, machine: Machine, *, skip: bool, inch_at_first: bool) -> None:
        self.text, self.machine = text, machine
        self.inch = self._inch_at_first = inch_at_first
        words, ends = text.words, machine.m_codes.program_end
        inch, mm = machine.codes("inch"), machine.codes("mm")
        self._is_inch = {float(code[1:]): code in inch for code in (*inch, *mm)}
        self._is_end = {float(code[1:]) for code in ends}
        self.kept = _kept(words) if skip else np.ones(len(words), bool)
        self.ending = set(words.block[is_code(words, ends) & self.kept].tolist())
        self._units = np.flatnonzero(is_code(words, (*inch, *mm)) & self.kept)
        self.moving = different(words.block[np.isin(words.address, list(map(ord, machine.axis_words))) & self.kept])
        self.ranges: dict[tuple[int, int], _Range] = {}
        self.words: list[Rows] = []
        self.row: list[Rows] = []
        self.block: list[Rows] = []
        self.depth: list[tuple[int, int]] = []
        self.starts: list[int] = []
        self.unknown: list[int] = []
        self.broken_off: list[int] = []
        self.computed: list[tuple[int, Word, float]] = []
        self.assigned: dict[int, Assigned] = {}
        self.values: list[ValueSet] = []
        self.count = 0

    def __len__(self) -> int:
        return self.count

    def start_program(self) -> None:
        """The next row begins a program."""
        self.starts.append(self.count)
        self.inch = self._inch_at_first

    def add_unknown(self, block: int, depth: int) -> None:
        """A row without words that stands for what a block runs and a check does not."""
        self.add_computed(block, (), depth)
        self.mark_unknown()

    def mark_unknown(self) -> None:
        """The effect of the last row is not known."""
        self.unknown.append(self.count - 1)

    def moves(self, words: Sequence[tuple[Word, float]]) -> bool:
        """Return True if any of these words moves an axis."""
        letters = self.machine.axis_words
        return any(word.address[0] in AXIS_LETTERS if word.is_named else word.address in letters for word, _ in words)

    def ends(self, block: int) -> bool:
        """Return True if a plain block ends the program."""
        return block in self.ending

    def filled(self, first: int, end: int) -> list[int]:
        """The blocks of a range that have words or macro statements, in order."""
        words = self.text.words.block
        low, high = stretch(words, first, end)
        macro = np.flatnonzero(self.text.blocks.is_macro[first:end]) + first
        return [int(block) for block in different(np.append(words[low:high], macro))]

    def first_moving(self, first: int, end: int) -> int | None:
        """The first block of a range with words of an axis."""
        index, _ = stretch(self.moving, first, end)
        return int(self.moving[index]) if index < len(self.moving) and self.moving[index] < end else None

    def _add(self, words: Rows, row: Rows, block: Rows, depth: int) -> None:
        self.words.append(words)
        self.row.append(row + self.count)
        self.block.append(block)
        self.depth.append((depth, len(block)))
        self.count += len(block)

    def add_plain(self, first: int, end: int, depth: int) -> None:
        """Blocks as they stand."""
        key = (first, end)
        if key not in self.ranges:
            low, high = stretch(self.text.words.block, first, end)
            index = np.arange(low, high)[self.kept[low:high]]
            block, row = np.unique(self.text.words.block[index], return_inverse=True)
            self.ranges[key] = _Range(index, row, block)
        plain = self.ranges[key]
        self._add(plain.words, plain.row, plain.block, depth)
        self._set_units(plain.words)

    def _set_units(self, words: Rows) -> None:
        """The last code of units among words of the text is in force from here on."""
        if len(self._units):
            low, high = stretch(self._units, int(words[0]), int(words[-1]) + 1) if len(words) else (0, 0)
            if low < high:
                self.inch = self._is_inch[round(float(self.text.words.value[self._units[high - 1]]), 1)]

    def add_computed(self, block: int, words: Sequence[tuple[Word, float]], depth: int) -> bool:
        """A block whose words were computed; gives whether it ends the program."""
        first = len(self.text.words) + len(self.computed)
        self.computed += [(block, word, value) for word, value in words]
        index = np.arange(first, first + len(words))
        self._add(index, np.zeros(len(words), np.int64), np.array([block], np.int64), depth)
        for word, value in words:
            self.inch = self._is_inch.get(value, self.inch) if word.address == "G" else self.inch
        return any(word.address == "M" and value in self._is_end for word, value in words)

    def add_assigned(self, block: int, assigned: Assigned, depth: int) -> None:
        """A block that assigns a variable of an offset: a row without words."""
        self.assigned[self.count] = assigned
        self.add_computed(block, (), depth)

    def note_value(self, block: int, number: float, value: float | None, level: int) -> None:
        """Note a value that a variable has got, for what an editor shows; the first ones of a long run will do."""
        if len(self.values) < _MOST_VALUES and -1 < number < _LARGEST_NUMBER:
            self.values.append(ValueSet(self.count, block, round(number), value, level))

    def add_call(self, block: int, statement: Statement, depth: int, has_arguments: bool) -> None:
        """A block with a call: its words, but those that are arguments belong to the macro."""
        if self.text.blocks.is_macro[block]:
            kept = [w for w in statement.words if w.address in "NGM" and w.written is not None]
            self.add_computed(block, [(word, float(word.written or 0)) for word in kept], depth)
            return
        low, high = stretch(self.text.words.block, block, block + 1)
        index = np.arange(low, high)[self.kept[low:high]]
        if has_arguments:
            index = index[is_among(self.text.words.address[index], list(b"NG"))]
        self._add(index, np.zeros(len(index), np.int64), np.array([block], np.int64), depth)
        self._set_units(index)

    def break_off(self, block: int, depth: int) -> None:
        """End a program at a bound: a row without words, of unknown effect, stands for all that is not executed."""
        self.shorten()
        self.add_unknown(block, depth)
        self.broken_off.append(self.count - 1)

    def shorten(self) -> None:
        """Drop the later turns of a loop that was broken off; the programs before it keep all their rows."""
        most = self.starts[-1] + len(self.text.blocks) + _KEPT_ROWS
        while len(self.block) > 1 and self.count - len(self.block[-1]) > most:
            self.count -= len(self.block[-1])
            for pieces in (self.words, self.row, self.block, self.depth):
                pieces.pop()

    def run(
        self, faults: tuple[FlowFault, ...], remarks: tuple[Remark, ...], names: Mapping[int, str] | None = None
    ) -> Run:
        """All rows as a table; names: of tools, by the number that T has instead."""
        none = np.zeros(0, np.int64)
        index = np.concatenate((none, *self.words))
        table = _joined(self.text.words, self.text.blocks, self.computed, self.machine)
        starts, unknown, broken_off = (self._mask_of(rows) for rows in (self.starts, self.unknown, self.broken_off))
        return Run(
            self.text,
            table[index],
            np.concatenate((none, *self.row)),
            np.concatenate((none, *self.block)),
            starts,
            unknown,
            np.repeat([depth for depth, _ in self.depth], [rows for _, rows in self.depth]).astype(np.int64),
            faults,
            remarks,
            {row: assigned for row, assigned in self.assigned.items() if row < self.count},
            self._distance(index),
            names or {},
            broken_off if self.broken_off else None,
            self.values,
            {position: value.variable for position, value in self._values_of(index, Unknown)},
            self._never_set(index),
        )

    def _never_set(self, index: Rows) -> dict[int, int]:
        """The executed words that are calculated with a vacant variable to which no block of the file gives a value."""
        vacant = {position: value.variable for position, value in self._values_of(index, FromVacant)}
        if not vacant or self.machine.macro.language != "custom-macro":
            return {}
        code = self.text.source.code.tobytes()
        if _ASSIGNS_ANY.search(code):
            return {}
        assigned = {int(digits) for digits in ASSIGNED.findall(code)}
        return {position: variable for position, variable in vacant.items() if variable not in assigned}

    def _values_of(self, index: Rows, kind: type[Kind]) -> Iterator[tuple[int, Kind]]:
        """The computed values of a kind, each with the number of its executed word; index: as in _distance."""
        first, is_chosen = len(self.text.words), [isinstance(value, kind) for _, _, value in self.computed]
        if any(is_chosen):
            for position in np.flatnonzero(np.append(np.zeros(first, bool), is_chosen)[index]).tolist():
                value = self.computed[index[position] - first][2]
                if isinstance(value, kind):
                    yield position, value

    def _mask_of(self, rows: Sequence[int]) -> Mask:
        return mask_at(self.count, [row for row in rows if row < self.count])

    def _distance(self, index: Rows) -> NDArray[np.int16] | None:
        """Per executed word what it says of itself; index: among the words of the text and the computed ones."""
        if all(word.distance is None for _, word, _ in self.computed):
            return None
        computed = [word.distance or 0 for _, word, _ in self.computed]
        return np.concatenate((np.zeros(len(self.text.words), np.int16), np.array(computed, np.int16)))[index]


def _kept(words: Words) -> Mask:
    """Words that block skip leaves: those before the first / of their block."""
    slashes = np.flatnonzero(words.address == ord("/"))
    kept = np.ones(len(words), bool)
    if len(slashes):
        first = folded(np.minimum, words.block[slashes], slashes, int(words.block[-1]) + 1, np.iinfo(np.int64).max)
        kept = np.arange(len(words)) < first[words.block]
    return kept


def _joined(words: Words, blocks: Blocks, computed: Sequence[tuple[int, Word, float]], machine: Machine) -> Words:
    """The words of the file, and behind them those that were computed."""
    if not computed:
        return words
    count = len(computed)
    number = {address: machine.address_number(address) for address in {word.address for _, word, _ in computed}}
    begin = blocks.start[[block for block, _, _ in computed]]
    more: tuple[Any, ...] = (
        np.array([number[word.address] for _, word, _ in computed], np.uint8),
        np.array([value for _, _, value in computed], np.float64),
        np.zeros(count, np.int64),
        np.zeros(count, np.int64),
        np.array([word.has_point for _, word, _ in computed], bool),
        np.zeros(count, np.uint8),
        np.array([block for block, _, _ in computed], np.int64),
        begin + np.array([word.start for _, word, _ in computed], np.int64),
        begin + np.array([word.end for _, word, _ in computed], np.int64),
    )
    return Words(
        *(np.concatenate((getattr(words, name), new)) for name, new in zip(Words.__struct_fields__, more, strict=True))
    )
