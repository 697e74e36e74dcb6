"""A document as its control reads it: words and statements, without execution, so that no answer waits for a check."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from lsprotocol import types

from polarcheck.editor.open_text import OpenText
from polarcheck.foundation.arrays import Mask, cached_property
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import read_text
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.channel_texts import channels
from polarcheck.program.reading.source import read_source
from polarcheck.program.reading.words import Text

Result = TypeVar("Result")

#: Statements that define names.
_DEFINES = re.compile(rb"DEF|PROC|FOR", re.IGNORECASE)


class Document:
    """
    A text and the machine that reads it.

    uri, path: of its file.
    text: the characters.
    machine: the control.
    folders: the folders of called programs.
    """

    def __init__(self, uri: str, path: Path, text: OpenText, machine: Machine, folders: Iterable[str] = ()) -> None:
        self.uri, self.path, self.text, self.machine = uri, path, text, machine
        self.folders = tuple(folders)
        self._cached: dict[str, Any] = {}

    @cached_property
    def listings(self) -> list[Listing]:
        """One listing for each channel; positions are those of the whole text."""
        control = self.machine.control
        source = read_source(self.text.data, self.path.name)
        parts = channels(source, control.channel_mark, control.line_comments)
        return [_listing(read_text(part, self.machine), self.machine) for part in parts]

    def cached(self, name: str, make: Callable[[], Result]) -> Result:
        """Return what is made of the document once; name: of it."""
        if name not in self._cached:
            self._cached[name] = make()
        result: Result = self._cached[name]
        return result

    def range(self, start: int, end: int) -> types.Range:
        """Return the range of the characters of a table from start to end."""
        return self.text.range(self.text.place_of(start), self.text.place_of(end))

    def location(self, start: int, end: int) -> types.Location:
        """Return the place of the characters of a table from start to end."""
        return types.Location(self.uri, self.range(start, end))

    def at(self, position: types.Position) -> Iterator[tuple[Listing, int]]:
        """Yield the block at a position, for each channel."""
        character = self.text.character_of(position)
        for listing in self.listings:
            yield listing, block_at(listing, character)


def _listing(text: Text, machine: Machine) -> Listing:
    """Return the listing of a text; the names that its programs define are known."""
    listing = Listing([text], machine)
    if machine.macro.language == "high-level" and _DEFINES.search(text.source.code.tobytes()):
        for program in listing.programs.programs:
            listing.macro_statements(program)
    return listing


def block_at(listing: Listing, character: int) -> int:
    """Return the block at a character; the first one before it."""
    return max(int(np.searchsorted(listing.text.blocks.start, character, side="right")) - 1, 0)


@functools.lru_cache(4)
def is_written(listing: Listing) -> Mask:
    """Return per block: it has words, statements, or a name."""
    text = listing.text
    mask = text.blocks.is_macro.copy()
    for table in (text.words, text.names, text.labels):
        mask[table.block] = True
    return mask
