"""The parts of a program: tools, polar sections, loops, runs of comments, each from its first block to its last one."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from polarcheck.editor.structure.document import is_written
from polarcheck.editor.structure.lexing import tokens
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import Program
from polarcheck.program.execution.run import is_code
from polarcheck.program.execution.structures import find_loops, find_structures

#: The words of loops and structures, WHILE also as WH and END as EN; only blocks with one of them are read.
_KEYWORD = re.compile(rb"WH|DO|EN|LOOP|FOR|IF|ELSE|REPEAT|UNTIL", re.IGNORECASE)


class Stretch(NamedTuple):
    """The blocks from first to last of a part of a program."""

    first: int
    last: int


def last_written(listing: Listing, program: Program) -> int:
    """Return the last block of a program that is not empty."""
    written = np.flatnonzero(is_written(listing)[program.first : program.end])
    return program.first + int(written[-1]) if len(written) else program.first


def tools(listing: Listing, program: Program) -> list[Stretch]:
    """Return the stretches of a program from each tool change up to the next one."""
    end = last_written(listing, program)
    changes: list[int] = []
    last = ""
    for block, tool in sorted(_tool_words(listing, program)):
        if tool not in ("0", last):
            last = tool
            changes.append(block)
    return [Stretch(first, max(after - 1, first)) for first, after in itertools.pairwise([*changes, end + 1])]


def _tool_words(listing: Listing, program: Program) -> Iterator[tuple[int, str]]:
    """Yield the blocks with T and the tool that each calls, as one text."""
    words, machine = listing.text.words, listing.machine
    low, high = np.searchsorted(words.block, (program.first, program.end)).tolist()
    digits = machine.control.offset_digits if machine.offsets.called_by == "last-digits" else 0
    for index in (np.flatnonzero(words.address[low:high] == ord("T")) + low).tolist():
        yield int(words.block[index]), _tool(float(words.value[index]), digits)
    for block in (np.flatnonzero(listing.text.blocks.is_macro[program.first : program.end]) + program.first).tolist():
        if "T" not in listing.text.written(listing.text.blocks, block).upper():
            continue
        lexed = tokens(listing, block)
        for token, following in itertools.pairwise(lexed):
            if token.text != "T" or token.kind != "address":
                continue
            named = next(
                (candidate for candidate in lexed if candidate.start > token.start and candidate.kind == "string"), None
            )
            if following.kind == "number":
                number = float(following.text) if following.text.isdecimal() and len(following.text) < 10 else math.nan
                yield block, _tool(number, digits)
            elif following.text == "=" and named is not None:
                yield block, named.text.upper()


def _tool(value: float, digits: int) -> str:
    if not math.isfinite(value):
        return "?"
    tool, offset = divmod(int(value), 10**digits)
    return str(tool or offset) if digits else str(int(value))


def polar_sections(listing: Listing, program: Program) -> list[Stretch]:
    """Return the stretches of a program from each code that begins the polar mode to the one that ends it."""
    polar, words = listing.machine.polar, listing.text.words
    low, high = np.searchsorted(words.block, (program.first, program.end)).tolist()
    part = words[low:high]
    on = part.block[is_code(part, polar.on)].tolist()
    off = part.block[is_code(part, [*polar.off, *polar.ended_by])].tolist()
    begin: int | None = None
    sections = []
    for block, begins in sorted([*((block, True) for block in on), *((block, False) for block in off)]):
        if begins and begin is None:
            begin = block
        elif not begins and begin is not None:
            sections.append(Stretch(begin, block))
            begin = None
    return sections if begin is None else [*sections, Stretch(begin, last_written(listing, program))]


def loops(listing: Listing, program: Program) -> list[Stretch]:
    """Return the loops and the structures IF .. ELSE .. ENDIF, FOR, REPEAT .. UNTIL of a program."""
    text = listing.text
    first, end = int(text.blocks.start[program.first]), int(text.blocks.end[program.end - 1])
    hits = [match.start() + first for match in _KEYWORD.finditer(text.source.code[first:end].tobytes())]
    blocks = np.unique(np.searchsorted(text.blocks.start, hits, side="right") - 1)
    statements = [(block, listing.statement(block)) for block in blocks[text.blocks.is_macro[blocks]].tolist()]
    stretches = [Stretch(*pair) for pair in find_loops(statements, listing.macro.loop_levels).end.items()]
    structures = find_structures(statements)
    for head, last in structures.end.items():
        between = structures.other.get(head)
        stretches.append(Stretch(head, last if between is None else max(between - 1, head)))
    return stretches


def comments(listing: Listing) -> list[Stretch]:
    """Return the runs of two blocks or more that have comments alone."""
    text = listing.text
    alone = np.zeros(len(text.blocks), bool)
    for table in (text.comments, text.prose):
        alone[table.block] = True
    alone &= ~is_written(listing)
    edges = np.flatnonzero(np.diff(np.concatenate(([False], alone, [False])).astype(np.int8)))
    return [Stretch(int(first), int(end) - 1) for first, end in zip(edges[::2], edges[1::2], strict=True)]
