"""The text of an open buffer; converts between positions of the editor and of reports."""

from __future__ import annotations

import bisect
import os
import re
import sys
from collections.abc import Iterable
from functools import cached_property
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote_to_bytes

from lsprotocol import types

if TYPE_CHECKING:
    from polarcheck.program.reading.source import Positions

#: The line ends of editors; those of controls are in `reading.source`.
_LINE_END = re.compile(r"\r\n|\n|\r")
_HALF_OF_A_PAIR = re.compile("[\ud800-\udfff]")
_BOM = "\ufeff"
_WIDTHS = {"utf-8": ("utf-8", 1), "utf-16": ("utf-16-le", 2), "utf-32": ("utf-32-le", 4)}
_DRIVE = re.compile(r"/[A-Za-z]:")

Change = types.TextDocumentContentChangePartial | types.TextDocumentContentChangeWholeDocument


class OpenText:
    """
    One state of a buffer; a change makes a new one.

    text: the characters.
    units: the units in which the editor counts the characters of a line: utf-8, utf-16 or utf-32.

    Lines and columns count from 1, columns in characters, as in reports. A position of the editor counts from 0, in
    its units. A position beyond the text is moved to the nearest one.
    """

    def __init__(self, text: str, units: str = "utf-16") -> None:
        # No encoding has an unpaired surrogate. It counts as one unit, as its replacement does.
        self.text = text if text.isascii() else _HALF_OF_A_PAIR.sub("\ufffd", text)
        self.units = units

    @cached_property
    def data(self) -> bytes:
        """Return the bytes that are checked."""
        return self.text.encode("utf-8")

    @property
    def _lead(self) -> int:
        """Return 1 if there is a byte order mark, which reports do not count."""
        return int(self.text.startswith(_BOM))

    @cached_property
    def _starts(self) -> list[int]:
        text = self.text
        if text.count("\r") == text.count("\r\n"):
            return _starts(text, "\n")
        return [0, *(match.end() for match in _LINE_END.finditer(text))]

    @cached_property
    def _report_starts(self) -> list[int]:
        """Return the offsets where lines of reports begin: after LF, or after CR if there is no LF (reading.source)."""
        return _starts(self.text, "\n" if "\n" in self.text else "\r")

    # ---- as the editor counts ----

    def position(self, offset: int) -> types.Position:
        """Return the position of the character at an offset from 0."""
        offset = min(max(offset, 0), len(self.text))
        line = bisect.bisect_right(self._starts, offset) - 1
        before = self.text[self._starts[line] : offset]
        name, width = _WIDTHS[self.units]
        return types.Position(line, len(before) if before.isascii() else len(before.encode(name)) // width)

    def offset(self, position: types.Position) -> int:
        """Return the offset of the character at a position."""
        if position.line >= len(self._starts):
            return len(self.text)
        start = self._starts[max(position.line, 0)]
        end = self._starts[position.line + 1] if position.line + 1 < len(self._starts) else len(self.text)
        line = self.text[start:end].rstrip("\r\n")
        count = max(position.character, 0)
        if line.isascii():
            return start + min(count, len(line))
        name, width = _WIDTHS[self.units]
        # A position within a character means the one before it.
        return start + len(line.encode(name)[: count * width].decode(name, "ignore"))

    def range(self, start: int, end: int) -> types.Range:
        """Return the range from an offset up to another one, exclusive."""
        return types.Range(self.position(start), self.position(max(start, end)))

    def columns(self, starts: Positions, ends: Positions) -> tuple[Positions, Positions, Positions]:
        """
        Return the lines of offsets from 0, their characters, and the lengths up to other offsets, as the editor counts.

        starts, ends: int[n]. What reaches over the end of its line ends there.
        """
        import numpy as np

        heads = np.array(self._starts, np.int64)
        lines = np.searchsorted(heads, starts, side="right") - 1
        limits = np.append(heads[1:], len(self.text) + 1)[lines] - 1
        ends = np.minimum(ends, np.maximum(limits, starts))
        characters, lengths = starts - heads[lines], ends - starts
        if not self.text.isascii():
            name, width = _WIDTHS[self.units]
            for index, (line, start, end) in enumerate(
                zip(lines.tolist(), starts.tolist(), ends.tolist(), strict=True)
            ):
                before, inside = self.text[self._starts[line] : start], self.text[start:end]
                if not (before.isascii() and inside.isascii()):
                    characters[index] = len(before.encode(name)) // width
                    lengths[index] = len(inside.encode(name)) // width
        return lines, characters, lengths

    def changed(self, changes: Iterable[Change]) -> OpenText:
        """Return the text after changes, each applied to the result of the one before."""
        text = self
        for change in changes:
            if isinstance(change, types.TextDocumentContentChangePartial):
                start, end = text.offset(change.range.start), text.offset(change.range.end)
                text = OpenText(text.text[:start] + change.text + text.text[max(start, end) :], self.units)
            else:
                text = OpenText(change.text, self.units)
        return text

    # ---- as reports count ----

    def offset_of(self, line: int, column: int = 1) -> int:
        """Return the offset of a line and column of a report."""
        line = min(max(line, 1), len(self._report_starts))
        start = self._report_starts[line - 1] + (self._lead if line == 1 else 0)
        return min(start + max(column, 1) - 1, self._end_of(line))

    def _end_of(self, line: int) -> int:
        """Return the offset after the last character of a line, before its line end."""
        starts = self._report_starts
        end = starts[line] if line < len(starts) else len(self.text)
        return starts[line - 1] + len(self.text[starts[line - 1] : end].rstrip("\r\n"))

    def range_of(self, line: int, column: int, end_line: int, end_column: int) -> types.Range:
        """Return the range of a span of a report."""
        return self.range(self.offset_of(line, column), self.offset_of(end_line, end_column))

    def line_range(self, line: int) -> types.Range:
        """Return the range of a line of a report, without its line end."""
        line = min(max(line, 1), len(self._report_starts))
        return self.range(self.offset_of(line), self._end_of(line))

    def line_of(self, position: types.Position) -> int:
        """Return the line of a report that contains a position."""
        return bisect.bisect_right(self._report_starts, self.offset(position))

    def line_text(self, line: int) -> str:
        """Return the text of a line of a report, without its line end."""
        return self.text[self.offset_of(line) : self._end_of(min(max(line, 1), len(self._report_starts)))]

    def place_of(self, character: int) -> int:
        """Return the offset of a character of the program's tables, which do not count a byte order mark."""
        return character + self._lead

    def character_of(self, position: types.Position) -> int:
        """Return the character at a position, as the program's tables count."""
        return max(self.offset(position) - self._lead, 0)


def _starts(text: str, end: str) -> list[int]:
    """Return where lines begin that end in one character; fast, since it runs at each key press."""
    return [0, *accumulate(len(line) + 1 for line in text.split(end)[:-1])]


def path_of(uri: str) -> Path | None:
    """Return the file of a document; None if it has none, such as `untitled:Untitled-1`."""
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
