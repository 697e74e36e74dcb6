"""The programs of a file: where each begins and ends, its N numbers, and the blocks at which the flow can turn."""

from __future__ import annotations

import bisect
import re

import msgspec
import numpy as np

from polarcheck.machines.codes import code_numbers, code_set
from polarcheck.reading.words import Text

#: Codes that call, return, or end.
CALLS = ("G65", "G66", "G66.1", "G67", "M98", "M99", "M198")
_SEQUENCE_NUMBER = re.compile(r"[\s/]*(?:/\s*\d\s*)?(?:[O:]\s*\d+\s*)?N\s*(\d+)", re.IGNORECASE)


class Program(msgspec.Struct, frozen=True):
    """
    One program: its number and name (None where it has none), the blocks from first to before end, and whether it has
    a head at all; what stands before the first head is a program, too.
    """

    number: int | None
    name: str | None
    first: int
    end: int
    has_head: bool


class Programs(msgspec.Struct):
    """All programs of a file and its N numbers."""

    text: Text
    programs: list[Program]
    sequence: dict[int, list[tuple[int, int]]] = msgspec.field(default_factory=dict)

    def of_number(self, number: int) -> Program | None:
        """The first program of this O number."""
        return next((program for program in self.programs if program.number == number), None)

    def of_name(self, name: str) -> Program | None:
        """The first program of this <name>; O0012 is a name of O12, too."""
        wanted = name.upper()
        found = next((program for program in self.programs if program.name and program.name.upper() == wanted), None)
        numbered = re.fullmatch(r"O0*(\d+)", wanted)
        return found or (self.of_number(int(numbered[1])) if numbered else None)

    def jump(self, program: Program, number: int, block: int) -> int | None:
        """
        The block of an N number: the first after the block, else the first from the head of the program.

        Source: B-62754EN/01, chapter 16 (the search runs forward, then from the head).
        """
        targets = self.targets(program).get(number, [])
        at = bisect.bisect_right(targets, block)
        return targets[at] if at < len(targets) else targets[0] if targets else None

    def targets(self, program: Program) -> dict[int, list[int]]:
        """The blocks of each N number of a program, in order."""
        if not self.sequence:
            self.sequence.update({-1: []})
            self._read_sequence_numbers()
        found: dict[int, list[int]] = {}
        for number, block in self.sequence.get(program.first, []):
            found.setdefault(number, []).append(block)
        return found

    def _read_sequence_numbers(self) -> None:
        text = self.text
        numbered = text.words.address == ord("N")
        places = [
            (int(block), int(value))
            for block, value in zip(text.words.block[numbered], text.words.value[numbered], strict=True)
            if value == value
        ]
        for block in np.flatnonzero(text.blocks.is_macro).tolist():
            found = _SEQUENCE_NUMBER.match(block_text(text, block))
            if found and len(found[1]) < 10:
                places.append((block, int(found[1])))
        for block, number in sorted(places):
            program = self.program_of(block)
            self.sequence.setdefault(program.first, []).append((number, block))

    def program_of(self, block: int) -> Program:
        """The program that a block belongs to."""
        at = bisect.bisect_right([program.first for program in self.programs], block) - 1
        return self.programs[max(at, 0)]


def find_programs(text: Text) -> Programs:
    """The programs of a file, in order; a file without any O number is one program."""
    heads: dict[int, tuple[int | None, str | None]] = {}
    words = text.words
    numbered = np.flatnonzero((words.address == ord("O")) & ~np.isnan(words.value))
    for index in numbered.tolist():
        heads.setdefault(int(words.block[index]), (int(words.value[index]), None))
    has_words = set(words.block[np.isin(words.block, text.names.block) & (words.address != ord("O"))].tolist())
    for start, end, block in zip(text.names.start, text.names.end, text.names.block, strict=True):
        if int(block) not in has_words and int(block) not in heads and not text.blocks.is_macro[block]:
            heads[int(block)] = (None, text.source.excerpt(int(start) + 1, int(end) - 1).strip())
    firsts = sorted(heads)
    count = len(text.blocks)
    programs = []
    filled = np.concatenate((words.block, np.flatnonzero(text.blocks.is_macro)))
    if not firsts or np.any(filled < firsts[0]):
        programs.append(Program(None, None, 0, firsts[0] if firsts else count, False))
    for index, first in enumerate(firsts):
        end = firsts[index + 1] if index + 1 < len(firsts) else count
        programs.append(Program(*heads[first], first, end, True))
    return Programs(text, programs)


def turns(text: Text, ends: tuple[str, ...]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Per block: macro statements, calls, returns and program ends, at which the flow has to stop and look."""
    found = text.blocks.is_macro.copy()
    words = text.words
    for letter in "GM":
        index = np.flatnonzero(words.address == ord(letter))
        table = code_set([word for word in (*CALLS, *ends) if word[0] == letter])
        found[words.block[index[table[code_numbers(words.value[index])]]]] = True
    return found


def needs_flow(text: Text) -> bool:
    """Whether the blocks of a file are to be executed one after another, or can be taken as they stand."""
    return bool(np.any(turns(text, ())) or np.any(text.words.address == ord("/")) or len(text.names))


def block_text(text: Text, block: int) -> str:
    """A block with its comments blanked, so that places in it stay what they are."""
    start, end = int(text.blocks.start[block]), int(text.blocks.end[block])
    found = text.source.excerpt(start, end)
    low, high = np.searchsorted(text.comments.block, (block, block + 1))
    for index in range(low, high):
        first, last = int(text.comments.start[index]) - start, int(text.comments.end[index]) - start
        found = found[:first] + " " * (last - first) + found[last:]
    return found
