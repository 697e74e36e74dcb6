"""The text of an open buffer, and its places: as the editor counts them, and as reports do."""

from __future__ import annotations

import bisect
import os
import re
import sys
from collections.abc import Iterable
from functools import cached_property
from itertools import accumulate
from pathlib import Path
from urllib.parse import unquote_to_bytes

from lsprotocol import types

#: Lines end there for every editor; where they end for a control, `reading.source` knows.
_LINE_END = re.compile(r"\r\n|\n|\r")
_HALF_OF_A_PAIR = re.compile("[\ud800-\udfff]")
_BOM = "\ufeff"
_WIDTHS = {"utf-8": ("utf-8", 1), "utf-16": ("utf-16-le", 2), "utf-32": ("utf-32-le", 4)}
_DRIVE = re.compile(r"/[A-Za-z]:")

Change = types.TextDocumentContentChangePartial | types.TextDocumentContentChangeWholeDocument


class OpenText:
    """
    One state of a buffer; a change makes another one.

    units: in which the editor counts the characters of a line: utf-8, utf-16 or utf-32. Lines and columns count from 1,
    columns in characters, as in reports; what the editor calls a position counts from 0, in its units. Places that
    there are not become the nearest one.
    """

    def __init__(self, text: str, units: str = "utf-16") -> None:
        # Half of a pair is no character that any encoding has. It counts as one unit, as its stand-in does.
        self.text = text if text.isascii() else _HALF_OF_A_PAIR.sub("\ufffd", text)
        self.units = units

    @cached_property
    def data(self) -> bytes:
        """The bytes that are checked."""
        return self.text.encode("utf-8")

    @property
    def _lead(self) -> int:
        """Reports do not count a byte order mark."""
        return int(self.text.startswith(_BOM))

    @cached_property
    def _starts(self) -> list[int]:
        text = self.text
        if text.count("\r") == text.count("\r\n"):
            return _starts(text, "\n")
        return [0, *(found.end() for found in _LINE_END.finditer(text))]

    @cached_property
    def _report_starts(self) -> list[int]:
        """Where the lines of reports begin: behind LF, or behind CR where there is no LF (reading.source)."""
        return _starts(self.text, "\n" if "\n" in self.text else "\r")

    # ---- as the editor counts ----

    def position(self, offset: int) -> types.Position:
        """The place of a character, the first being 0."""
        offset = min(max(offset, 0), len(self.text))
        line = bisect.bisect_right(self._starts, offset) - 1
        before = self.text[self._starts[line] : offset]
        name, width = _WIDTHS[self.units]
        return types.Position(line, len(before) if before.isascii() else len(before.encode(name)) // width)

    def offset(self, position: types.Position) -> int:
        """The character at a place."""
        if position.line >= len(self._starts):
            return len(self.text)
        start = self._starts[max(position.line, 0)]
        end = self._starts[position.line + 1] if position.line + 1 < len(self._starts) else len(self.text)
        line = self.text[start:end].rstrip("\r\n")
        count = max(position.character, 0)
        if line.isascii():
            return start + min(count, len(line))
        name, width = _WIDTHS[self.units]
        # A place within a character is before it.
        return start + len(line.encode(name)[: count * width].decode(name, "ignore"))

    def range(self, start: int, end: int) -> types.Range:
        """From a character to another one, exclusive."""
        return types.Range(self.position(start), self.position(max(start, end)))

    def changed(self, changes: Iterable[Change]) -> OpenText:
        """The text after some changes, each made to what the one before has left."""
        found = self
        for change in changes:
            if isinstance(change, types.TextDocumentContentChangePartial):
                start, end = found.offset(change.range.start), found.offset(change.range.end)
                found = OpenText(found.text[:start] + change.text + found.text[max(start, end) :], self.units)
            else:
                found = OpenText(change.text, self.units)
        return found

    # ---- as reports count ----

    def offset_of(self, line: int, column: int = 1) -> int:
        """The character at a line and column of a report."""
        line = min(max(line, 1), len(self._report_starts))
        start = self._report_starts[line - 1] + (self._lead if line == 1 else 0)
        return min(start + max(column, 1) - 1, self._end_of(line))

    def _end_of(self, line: int) -> int:
        """Behind the last character of a line, its line end excluded."""
        starts = self._report_starts
        end = starts[line] if line < len(starts) else len(self.text)
        return starts[line - 1] + len(self.text[starts[line - 1] : end].rstrip("\r\n"))

    def range_of(self, line: int, column: int, end_line: int, end_column: int) -> types.Range:
        """A span of a report."""
        return self.range(self.offset_of(line, column), self.offset_of(end_line, end_column))

    def line_range(self, line: int) -> types.Range:
        """A line of a report, without its line end."""
        line = min(max(line, 1), len(self._report_starts))
        return self.range(self.offset_of(line), self._end_of(line))

    def line_of(self, position: types.Position) -> int:
        """The line of a report in which a place stands."""
        return bisect.bisect_right(self._report_starts, self.offset(position))

    def line_text(self, line: int) -> str:
        """A line of a report, without its line end."""
        return self.text[self.offset_of(line) : self._end_of(min(max(line, 1), len(self._report_starts)))]

    def place_of(self, character: int) -> int:
        """The offset of a character as tables of a program count them."""
        return character + self._lead

    def character_of(self, position: types.Position) -> int:
        """The character at a place, as tables of a program count them."""
        return max(self.offset(position) - self._lead, 0)


def _starts(text: str, end: str) -> list[int]:
    """Where lines begin that end in one character: with each key that is pressed it is asked anew."""
    return [0, *accumulate(len(line) + 1 for line in text.split(end)[:-1])]


def path_of(uri: str) -> Path | None:
    """The file of a document; None for one that lies in none, such as `untitled:Untitled-1`."""
    scheme, colon, rest = uri.partition(":")
    if not colon or scheme.lower() != "file":
        return None
    host, path = "", rest
    if rest.startswith("//"):
        host, slash, path = rest[2:].partition("/")
        path = slash + path
    name = os.fsdecode(unquote_to_bytes(path))
    if sys.platform == "win32" and _DRIVE.match(name):
        name = name[1:]
    elif host not in ("", "localhost"):
        name = f"//{host}{name}"
    return Path(name) if name and "\0" not in name else None
