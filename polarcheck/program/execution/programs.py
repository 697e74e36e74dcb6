"""
The programs of a file and of those that it calls: where each begins and ends, its N numbers, and the blocks at which
the flow can turn.
"""

import bisect
import enum
import itertools
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple, TypeVar

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Mask, cached_property, is_among, side_by_side, stretch
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.execution.run import begins_program, is_code
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.source import PRINTED_QUOTES, Source
from polarcheck.program.reading.translation import translated
from polarcheck.program.reading.words import Text, read_words

#: No control has a program or sequence number of so many digits; beyond it, values are only about right.
_NUMBER_LIMIT = 1e15
_DECIMAL_COMMA = lazy_pattern(r"(?<=[0-9]),(?=[0-9])")
#: Compiled where they are looked for, since most programs jump nowhere.
_SEQUENCE_NUMBER = r"[\s/]*(?:/\s*\d\s*)?(?:[O:]\s*\d+\s*)?N\s*(\d+)"
#: A label: ANF: at the head of a block or behind its number, or a sequence name, N with letters.
_LABEL = (
    r"[\s/]*(?:/\s*\d\s*)?(?:N\s*\d+\s*)?(?:([A-Z_][A-Z0-9_]+)\s*:(?!=)|(N(?!OEX\b)[A-Z][A-Z0-9]{0,3})(?![A-Z0-9=]))"
)


Key = TypeVar("Key", int, str)


class Search(enum.Enum):
    """
    Where a jump looks for its target: from the next N number or label on, then from the head of the program. IF_THERE
    does so, too, and without a target goes on.
    """

    ROUND = enum.auto()
    FORWARD = enum.auto()
    BACKWARD = enum.auto()
    IF_THERE = enum.auto()


class ProgramName(NamedTuple):
    """How a call names its program: by number or by name; both None where that is computed and not known."""

    number: int | None
    name: str | None

    def __str__(self) -> str:
        return f"O{self.number:04d}" if self.number is not None else f"<{self.name}>"

    @property
    def keys(self) -> tuple[int | str, ...]:
        """The names and numbers that it can mean, in capitals: <O0012> names O12, too."""
        if self.number is not None:
            return (self.number,)
        name = (self.name or "").upper()
        numbered = re.fullmatch(r"O0*(\d{1,15})", name)
        return (name, int(numbered[1])) if numbered else (name,)


class Program(msgspec.Struct, frozen=True):
    """
    One program: its number and name (None where it has none), the blocks from first to before end, and whether it has
    a head at all; what stands before the first head of a file is a program, too.

    file: 0 for the file itself, from 1 the called files behind it.
    """

    number: int | None
    name: str | None
    first: int
    end: int
    has_head: bool
    file: int = 0

    @property
    def keys(self) -> tuple[int | str, ...]:
        """Its number and its name in capitals, as in ProgramName.keys."""
        number = () if self.number is None else (self.number,)
        return number if self.name is None else (*number, self.name.upper())


class Programs:
    """All programs of a text, in order, and their N numbers."""

    def __init__(self, text: Text, programs: Sequence[Program]) -> None:
        self.text = text
        self.programs = list(programs)
        self._firsts = [program.first for program in programs]
        self._by_key: dict[int | str, list[Program]] = {}
        for program in programs:
            for key in program.keys:
                self._by_key.setdefault(key, []).append(program)

    def named(self, called: ProgramName) -> list[Program]:
        """The programs that a call can mean: those of that name, before those of that number, in order."""
        return [program for key in called.keys for program in self._by_key.get(key, [])]

    def jump(self, program: Program, number: int, block: int, search: Search = Search.ROUND) -> int | None:
        """
        The block of an N number: the first after the block, else the first from the head of the program.

        Source: B-62754EN/01, chapter 16 (the search runs forward, then from the head).
        """
        return _target(self.targets(program).get(number, []), block, search)

    def labelled(self, program: Program, label: str, block: int, search: Search) -> int | None:
        """The block of a label of a program, in capitals, from another block on; None where there is none."""
        return _target(self.labels(program).get(label, []), block, search)

    def labels(self, program: Program) -> dict[str, list[int]]:
        """The blocks of each label of a program, in capitals."""
        return self._labels.get(self.around(program.first).first, {})

    @cached_property
    def with_labels(self) -> frozenset[int]:
        """The blocks with a label: jumps that are not taken may lead there."""
        return frozenset(
            block for of_program in self._labels.values() for blocks in of_program.values() for block in blocks
        )

    @cached_property
    def _labels(self) -> dict[int, dict[str, list[int]]]:
        """The blocks of each label, by the first block of its program."""
        names = self.text.labels
        spans = side_by_side(names.block, names.start, names.end)
        places = [(block, self.text.source.excerpt(*span).upper()) for block, *span in spans]
        places += [(block, (match[1] or match[2]).upper()) for block, match in self._in_macro(label_in)]
        return self._by_program(places)

    def _in_macro(self, read: Callable[[str], re.Match[str] | None]) -> Iterator[tuple[int, re.Match[str]]]:
        """The blocks with statements at whose head something is found."""
        for block in np.flatnonzero(self.text.blocks.is_macro).tolist():
            if match := read(block_text(self.text, block)):
                yield block, match

    def _by_program(self, places: Iterable[tuple[int, Key]]) -> dict[int, dict[Key, list[int]]]:
        """The blocks of each label or number, by the first block of its program."""
        blocks: dict[int, dict[Key, list[int]]] = {}
        for block, key in sorted(places):
            blocks.setdefault(self.around(block).first, {}).setdefault(key, []).append(block)
        return blocks

    def around(self, block: int) -> Program:
        """The program in which a block stands."""
        return self.programs[max(bisect.bisect_right(self._firsts, block) - 1, 0)]

    def targets(self, program: Program) -> dict[int, list[int]]:
        """The blocks of each N number of a program, in order."""
        return self._targets.get(self.around(program.first).first, {})

    @cached_property
    def _targets(self) -> dict[int, dict[int, list[int]]]:
        """The same for each program, by its first block."""
        text = self.text
        numbered = text.words.address == ord("N")
        places = [
            (int(block), int(value))
            for block, value in zip(text.words.block[numbered], text.words.value[numbered], strict=True)
            if value < _NUMBER_LIMIT
        ]
        places += [(block, int(match[1])) for block, match in self._in_macro(sequence_number_in) if len(match[1]) < 10]
        return self._by_program(places)


def sequence_number_in(written: str) -> re.Match[str] | None:
    """Return the match of the N number at the head of a block (block_text), its digits in group 1."""
    return re.compile(_SEQUENCE_NUMBER, re.IGNORECASE).match(written)


def label_in(written: str) -> re.Match[str] | None:
    """Return the match of the label at the head of a block (block_text), its name in group 1 or 2."""
    return re.compile(_LABEL, re.IGNORECASE).match(written)


def _target(targets: Sequence[int], block: int, search: Search) -> int | None:
    """Which of some blocks, in order, a search from a block on comes to first; None where it comes to none."""
    index = bisect.bisect_right(targets, block)
    ahead = targets[index] if index < len(targets) else None
    if search is Search.FORWARD:
        return ahead
    if search is Search.BACKWARD:
        return targets[index - 1] if index else None
    return targets[0] if ahead is None and targets else ahead


def read_text(source: Source, machine: Machine) -> Text:
    """The words of a source as this control reads them."""
    control = machine.control
    translation = translated(source, control.native_words, machine.macro.language)
    marks = control.channel_mark, control.wait_mark
    return read_words(
        translation,
        control.line_comments,
        *marks,
        machine.macro.language,
        blanks_in_numbers=control.blanks_in_numbers,
    )


def find_programs(text: Text) -> Programs:
    """The programs of a text, in order; a file without any O number is one program."""
    heads: dict[int, tuple[int | None, str | None]] = {}
    words = text.words
    numbered = np.flatnonzero(begins_program(words) & ~np.isnan(words.value))
    for index in numbered.tolist():
        value = float(words.value[index])
        heads.setdefault(int(words.block[index]), (int(value) if value < _NUMBER_LIMIT else None, None))
    has_words = set(words.block[is_among(words.block, text.names.block) & (words.address != ord("O"))].tolist())
    for start, end, block in zip(text.names.start, text.names.end, text.names.block, strict=True):
        if int(block) not in has_words and int(block) not in heads and not text.blocks.is_macro[block]:
            heads[int(block)] = (None, name_at_head(text.source.excerpt(int(start), int(end))).strip("<>").strip())
    filled = np.concatenate((words.block, np.flatnonzero(text.blocks.is_macro)))
    programs: list[Program] = []
    for file, (begin, limit) in enumerate(itertools.pairwise([*first_blocks(text), len(text.blocks)])):
        firsts = sorted(first for first in heads if begin <= first < limit)
        until = firsts[0] if firsts else limit
        if not firsts or np.any((filled >= begin) & (filled < until)):
            programs.append(Program(None, None, begin, until, False, file))
        for first, end in itertools.pairwise([*firsts, limit]):
            programs.append(Program(*heads[first], first, end, True, file))
    return Programs(text, programs)


def name_at_head(written: str) -> str:
    """A name as a call writes it: of %NAME_MPF and %_N_NAME_MPF, found with a character on either side, NAME."""
    return written[1:-1] if written[:1] in ("_", "%") else written


def first_blocks(text: Text) -> list[int]:
    """The first block of the file itself and of each called file behind it."""
    lines = [part.first_line for part in text.source.parts]
    return [0, *np.searchsorted(text.blocks.line, lines).tolist()]


def turns(text: Text, codes: Iterable[str]) -> Mask:
    """Per block: macro statements, or some codes (calls, returns, program ends), at which the flow stops and looks."""
    mask = text.blocks.is_macro.copy()
    mask[text.words.block[is_code(text.words, codes)]] = True
    return mask


def needs_flow(text: Text, codes: Iterable[str]) -> bool:
    """Return True if the blocks of a file must be executed one by one; else they run from top to bottom."""
    return bool(np.any(turns(text, codes)) or np.any(text.words.address == ord("/")) or len(text.names))


def block_text(text: Text, block: int) -> str:
    """
    A block as the control would read it: comments, other text, stray characters and the label before words blanked,
    digits for letters, points for decimal commas, plain quotes for printed ones.
    """
    start, end = int(text.blocks.start[block]), int(text.blocks.end[block])
    written = text.source.excerpt(start, end)
    strays = text.strays.start[slice(*stretch(text.strays.block, block, block + 1))].tolist()
    letters = text.letters[slice(*stretch(text.letters, start, end))].tolist()
    spans: list[tuple[int, int]] = []
    for table in (text.comments, text.prose, text.labels):
        chosen = slice(*stretch(table.block, block, block + 1))
        spans += side_by_side(table.start[chosen], table.end[chosen])
    if not (strays or letters or spans):
        return written
    characters = list(written)  # a text would be copied for each of them
    for index in strays:
        if written[index - start] == "," and _DECIMAL_COMMA.match(written, index - start):
            characters[index - start] = "."
        elif quote := PRINTED_QUOTES.get(int(text.source.code[index])):
            characters[index - start] = quote
        elif written[index - start] != "%":  # ends what is read
            characters[index - start] = " "
    for index in letters:
        characters[index - start] = "0" if written[index - start] in "oO" else "1"
    for first, last in spans:
        characters[first - start : last - start] = " " * (last - first)
    return "".join(characters)
