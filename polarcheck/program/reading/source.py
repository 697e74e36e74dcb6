"""Bytes to text: encodings, lines, positions. Every byte survives a round trip."""

from __future__ import annotations

import codecs
from functools import cached_property
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.errors import SourceError, UsageError

Bytes = NDArray[np.uint8]
Positions = NDArray[np.signedinteger[Any]]

#: One code per character. Minus look-alikes share the code that Windows gives to the en dash, printed quotes those that
#: it gives to them, all else above 255 OTHER.
DASH = 0x96
OTHER = 0xFE
MINUS_LOOK_ALIKES = "\u2013\u2014\u2212"
_DASHES = (*map(ord, MINUS_LOOK_ALIKES), 0x97)

#: Printed quotes, by the codes that Windows gives to them, with the plain quote that is meant.
PRINTED_QUOTES = {0x91: "'", 0x92: "'", 0x82: "'", 0x93: '"', 0x94: '"', 0x84: '"'}
_QUOTES = {ord(bytes([code]).decode("cp1252")): code for code in PRINTED_QUOTES}

LF, CR, CTRL_Z = 10, 13, 26

_BOMS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))


class Part(msgspec.Struct, frozen=True):
    """
    A called program whose text follows that of the file.

    first_line: its first line in the joined text.
    name: of its file.
    added_lines: lines that were added at its head.
    """

    first_line: int
    name: str
    added_lines: int = 0


class Source(msgspec.Struct, frozen=True, dict=True):
    """
    One file: its bytes, its encoding, and one code per character.

    path: of the file.
    data: its bytes.
    encoding: its name.
    bom: the byte order mark, or empty.
    code: uint8[n], Latin-1 where the character has one.
    line_starts: int64[lines], character positions.
    parts: called programs behind the text of the file.
    added_lines: lines at the head that the file does not have.
    channel: the channel whose programs `code` contains, as `$2`; empty where a file has one channel.
    """

    path: str
    data: bytes
    encoding: str
    bom: bytes
    code: Bytes
    line_starts: Positions
    parts: tuple[Part, ...] = ()
    added_lines: int = 0
    channel: str = ""

    @cached_property
    def text(self) -> str:
        """The characters, without a byte order mark."""
        return self.data[len(self.bom) :].decode(self.encoding)

    def encode(self, text: str) -> bytes:
        """The bytes of an edited text, in the encoding of this file."""
        return self.bom + text.encode(self.encoding)

    def excerpt(self, start: int, end: int) -> str:
        """The characters from start to end."""
        if len(self.code) == len(self.data) - len(self.bom):
            return self.data[len(self.bom) + start : len(self.bom) + end].decode(self.encoding)
        return self.text[start:end]

    def line_of(self, position: int) -> int:
        """Line (from 1) of a character position."""
        return int(np.searchsorted(self.line_starts, position, side="right"))

    def part_of(self, line: int) -> tuple[str, int] | None:
        """The called program that contains a line, and the line there; None for lines of the file itself."""
        part = next((part for part in reversed(self.parts) if line >= part.first_line), None)
        return None if part is None else (part.name, max(line - part.first_line + 1 - part.added_lines, 1))

    def is_own(self, part: tuple[str, int]) -> bool:
        """True where the result of part_of is a line of the file itself, in another channel."""
        return bool(self.channel) and part[0] == self.path

    def line_text(self, line: int) -> str:
        """A line (from 1) without its line end."""
        start = int(self.line_starts[line - 1])
        end = int(self.line_starts[line]) if line < len(self.line_starts) else len(self.code)
        return self.excerpt(start, end).rstrip("\r\n")


def read_source(data: bytes, path: str = "-", encoding: str | None = None) -> Source:
    """
    Decode any bytes: as UTF-8, UTF-16 with BOM, or the encoding if one is set, else as Latin-1; it never guesses.

    Raises UsageError for an unknown encoding, SourceError where the encoding does not fit the bytes.
    """
    bom, name = _recognised(data, path, encoding)
    code = _codes(data, bom, name)
    return Source(path, data, name, bom, code, line_starts_of(code))


def is_encoding(name: str) -> bool:
    """True for the name of a text encoding; rot13 and base64 are codecs of Python, but no text encodings."""
    try:
        "O".encode(name)
    except (LookupError, ValueError):
        return False
    return True


def _recognised(data: bytes, path: str, encoding: str | None) -> tuple[bytes, str]:
    if encoding is not None:
        try:
            data.decode(encoding)
        except LookupError:
            raise UsageError(f"--encoding: unknown encoding {encoding!r}") from None
        except UnicodeDecodeError as error:
            raise SourceError(f"{path}: byte {error.start} is not {encoding}") from None
        except UnicodeError:
            raise SourceError(f"{path}: is not {encoding}") from None
        return b"", encoding
    for bom, name in _BOMS:
        if data.startswith(bom) and _decodes(data[len(bom) :], name):
            return bom, name
    return b"", "ascii" if data.isascii() else "utf-8" if _decodes(data, "utf-8") else "latin-1"


def _decodes(data: bytes, encoding: str) -> bool:
    try:
        data.decode(encoding)
    except UnicodeDecodeError:
        return False
    return True


def _codes(data: bytes, bom: bytes, encoding: str) -> Bytes:
    if encoding in ("ascii", "latin-1"):
        code = np.frombuffer(data, np.uint8)
        return np.where(code == 0x97, np.uint8(DASH), code) if encoding == "latin-1" else code
    wide = np.frombuffer(data[len(bom) :].decode(encoding).encode("utf-32-le", "surrogatepass"), np.uint32)
    code = np.where(wide < 256, wide, OTHER).astype(np.uint8)
    code[np.isin(wide, _DASHES)] = DASH
    for character, quote in _QUOTES.items() if (code == OTHER).any() else ():
        code[wide == character] = quote
    return code


def line_starts_of(code: Bytes) -> Positions:
    """
    Lines end at LF; CR is ignored, unless the file has no LF at all.

    FANUC writes LF CR CR, Windows CR LF, broken transfers CR CR LF: one rule reads all of them, and keeps the line
    numbers of git and editors (B-63524EN/01 p. 649).
    """
    ends = np.flatnonzero(code == LF)
    if not len(ends):
        ends = np.flatnonzero(code == CR)
    starts = np.concatenate((np.zeros(1, np.int64), ends + 1))
    return starts[:-1] if len(starts) > 1 and starts[-1] == len(code) else starts
