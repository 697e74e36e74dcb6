"""Go to definition: the program that a block calls, and the block of an N number or label."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from lsprotocol import types

from polarcheck.editor.analysis import Analysis
from polarcheck.editor.open_text import OpenText
from polarcheck.editor.words.at_cursor import block_of
from polarcheck.program.execution.called_programs import Library
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import Program, ProgramName, block_text, find_programs, read_text
from polarcheck.program.execution.statement import Kind, Statement
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading import source
from polarcheck.program.reading.words import Text

#: A reference to the sequence number of a block: GOTO 100, GOTO N100, M99 P100, G71 P10 Q20.
_NUMBER = re.compile(r"(?:\bGOTO[FBC]?\s*+(?:N\s*+)?|[PQ]\s*+)(\d{1,9})", re.IGNORECASE)
#: What a block is called by: its number, its label, the head of a program.
_HEAD = re.compile(r"\s*+(?:/\d?\s*+)?(?:[NO]\s*+\d{1,9}|[A-Z_]\w{0,60}+:)", re.IGNORECASE)
_JUMPS = (Kind.GOTO, Kind.IF_GOTO)


def definition(analysis: Analysis, uri: str, position: types.Position) -> list[types.Location]:
    """Return the places that the block at a position refers to; of several numbers the one under the cursor counts."""
    if analysis.settings is None:
        return []
    machine = analysis.settings.machine
    character = analysis.text.character_of(position)
    for text in analysis.texts:
        block = block_of(text, character)
        if block is None:
            continue
        # The listing of the document alone: called programs are located in their own files.
        listing = Listing([read_text(text.source, machine)] if text.source.parts else [text], machine)
        if block >= len(listing.text.blocks):
            continue
        offset_in_block = character - int(listing.text.blocks.start[block])
        head = _HEAD.match(block_text(listing.text, block))
        if head is not None and offset_in_block <= head.end():
            # An editor that is led to where it is shows the references.
            return [_at_block(analysis.text, uri, listing.text, block)]
        called = listing.called_in(block)
        if called is not None:
            return _of_program(called, listing, analysis, uri)
        targets = list(_targets(listing, block, offset_in_block))
        if targets:
            return [_at_block(analysis.text, uri, listing.text, target) for target in dict.fromkeys(targets)]
    return []


def _of_program(called: ProgramName, listing: Listing, analysis: Analysis, uri: str) -> list[types.Location]:
    programs = [program for program in listing.programs.named(called) if program.file == 0]
    if programs:
        return [_at_block(analysis.text, uri, listing.text, programs[0].first)]
    assert analysis.settings is not None
    places = Library(analysis.settings.job.run.subprograms, analysis.settings.machine).places(called)
    machine, units = analysis.settings.machine, analysis.text.units
    return [_in_file(file.path, file.data, called, machine, units) for file in places]


def _in_file(path: Path, data: bytes, called: ProgramName, machine: Machine, units: str) -> types.Location:
    """Return the place of a program in a file; the first line if the file does not name it."""
    decoded = source.read_source(data, path.name)
    text = OpenText("\ufeff" * bool(decoded.bom) + decoded.text, units)
    programs = find_programs(read_text(decoded, machine))
    named = programs.named(called)
    uri = path.absolute().as_uri()
    return _at_block(text, uri, programs.text, named[0].first) if named else types.Location(uri, text.line_range(1))


def _at_block(document: OpenText, uri: str, text: Text, block: int) -> types.Location:
    start, end = (document.place_of(int(places[block])) for places in (text.blocks.start, text.blocks.end))
    return types.Location(uri, document.range(start, end))


def _targets(listing: Listing, block: int, offset_in_block: int) -> Iterator[int]:
    """Yield the blocks that a block jumps to by number or label, the number under the cursor first."""
    program = listing.programs.around(block)
    statement = listing.statement(block)
    for jump in _jumps(statement):
        if jump.label:
            target = listing.programs.labelled(program, jump.label.upper(), block, jump.search)
            if target is not None:
                yield target
    written = block_text(listing.text, block)
    numbers = sorted(_NUMBER.finditer(written), key=lambda match: not match.start() <= offset_in_block <= match.end())
    if not numbers:
        return
    number = int(numbers[0][1])
    returns = statement.call in listing.macro.program_returns
    for searched in [*(_callers(listing, program) if returns else ()), program]:
        target = listing.programs.jump(searched, number, block if searched is program else searched.first - 1)
        if target is not None:
            yield target
            return


def _jumps(statement: Statement) -> Iterator[Statement]:
    for part in (statement, *([statement.then] if statement.then is not None else ()), *statement.more):
        if part.kind in _JUMPS or part.label:
            yield part


def _callers(listing: Listing, program: Program) -> Iterator[Program]:
    """Yield the programs of the document that call a program: M99 P returns to a block of the caller."""
    for caller in listing.programs.programs:
        if caller is not program:
            blocks = (block for block in listing.stops if caller.first <= block < caller.end)
            calls = (listing.called_in(block) for block in blocks)
            if any(called is not None and set(called.keys) & set(program.keys) for called in calls):
                yield caller
