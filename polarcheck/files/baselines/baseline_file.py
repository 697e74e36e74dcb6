"""
The file of a baseline, in lines for its readers and for tools that compare lines.

The line of a program has its blocks in short, that of an entry the known findings of a rule in the same block.
"""

from __future__ import annotations

import base64
import binascii
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TypeVar

import msgspec

from polarcheck.foundation import bounded
from polarcheck.foundation.decoding import json_decoder
from polarcheck.foundation.errors import BaselineError, suggestion
from polarcheck.foundation.finding import SEVERITIES
from polarcheck.program.reading.files import display_path

SCHEMA = 2
#: Schemas that can be read: in the first one entries have no places.
_READABLE = (1, SCHEMA)
#: Largest baseline file [bytes]; 100,000 findings take 30 MB.
_LARGEST = 200_000_000
#: Bytes and characters of a hash of a block.
_BYTES, _CHARACTERS = 3, 4

_UNKNOWN = re.compile("unknown field `([^`]*)`")

#: Rule and fingerprint, by which findings are matched.
Key = tuple[str, str]
_Line = TypeVar("_Line", bound=msgspec.Struct)


class Location(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """
    Where a known finding stands, and how bad it is.

    at: index of its block among the blocks of the program; null for one that stands in no block.
    also: those of all its blocks, of a finding that its program has once and that stands for several.
    section: index of the block that begins its section, where one finding stands for all blocks of a section.
    blocks: how many blocks it stands for; 0 if that does not count.
    values: the numbers that can grow worse [mm, deg, min]; those of findings that follow behind their rule (rule.name).
    """

    at: int | None = None
    also: list[int] = []
    section: int | None = None
    blocks: int = 0
    values: dict[str, float] = {}

    @property
    def all_at(self) -> list[int]:
        """The indices of all its blocks; empty for one that stands in no block."""
        return self.also or ([] if self.at is None else [self.at])


class Entry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """
    Known findings of a file with the same rule and fingerprint.

    file: relative to the folder of the baseline, with slashes.
    severity: the worst of them.
    count: how many there are.
    block: that of the first one, for the reader.
    follows: the rules of the findings that follow from them.
    reason: why they are accepted.
    places: one for each of them; empty in an entry of the first schema.
    """

    file: str
    rule: str
    fingerprint: str
    severity: str
    count: int = 1
    block: str = ""
    follows: list[str] = []
    reason: str = ""
    places: list[Location] = []

    @property
    def key(self) -> Key:
        """Rule and fingerprint."""
        return self.rule, self.fingerprint


class Program(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """
    The blocks of a program in short.

    file: as in its entries.
    of: only hashes that are a multiple of this are listed.
    blocks: their hashes in base 64, four characters each.
    """

    file: str
    of: int = 1
    blocks: str = ""

    @property
    def hashes(self) -> list[int]:
        """The hashes of the blocks, in their order. Raises ValueError for blocks that are no base 64."""
        data = base64.b64decode(self.blocks, validate=True)
        if len(self.blocks) % _CHARACTERS or len(data) % _BYTES:
            raise ValueError("incomplete")
        return [int.from_bytes(data[start : start + _BYTES], "big") for start in range(0, len(data), _BYTES)]


def program_of(file: str, hashes: Iterable[int], of: int) -> Program:
    """Return the line of a program."""
    data = b"".join(value.to_bytes(_BYTES, "big") for value in hashes)
    return Program(file=file, of=of, blocks=base64.b64encode(data).decode())


class Contents(msgspec.Struct, frozen=True):
    """
    What a baseline file says.

    entries: the known findings.
    programs: the blocks of the programs that have entries.
    lines: of each entry the line in the file, from 1; empty for contents that were not read.
    schema: of the file.
    """

    entries: Sequence[Entry] = ()
    programs: Sequence[Program] = ()
    lines: Sequence[int] = ()
    schema: int = SCHEMA


class _Head(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    schema: int
    findings: list[msgspec.Raw]
    programs: list[msgspec.Raw] = []


def read(path: Path) -> Contents:
    """
    Read a baseline.

    Raises BaselineError, which names the file, the line, the key and what was expected.
    """
    try:
        data = bounded.read_file(path, _LARGEST, "no baseline is", pipes=True)
    except OSError as error:
        raise BaselineError(f"{display_path(path)}: {error.strerror or error}") from None
    try:
        return _contents(_as_utf8(data))
    except ValueError as error:
        raise BaselineError(f"{display_path(path)}: {error}") from None


def _as_utf8(data: bytes) -> bytes:
    """Decode what editors and shells of Windows write: UTF-16, or UTF-8 with a byte order mark."""
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    return data.decode("utf-16" if wide else "utf-8-sig").encode("utf-8")


def _contents(data: bytes) -> Contents:
    try:
        head = json_decoder(_Head).decode(data)
    except msgspec.ValidationError as error:
        raise ValueError(f"{error}; expected a file that `polarcheck baseline create` has written") from None
    except msgspec.DecodeError as error:
        raise ValueError(f"is no JSON: {error}{_line_in(str(error), data)}") from None
    if head.schema not in _READABLE:
        expected = " or ".join(map(str, _READABLE))
        raise ValueError(f"schema: expected {expected}, found {head.schema}: it is of another version of polarcheck")
    programs, _ = _lines(data, head.programs, Program, "program")
    entries, lines = _lines(data, head.findings, Entry, "finding")
    return Contents(entries, programs, lines, head.schema)


def _lines(data: bytes, raws: Sequence[msgspec.Raw], kind: type[_Line], noun: str) -> tuple[list[_Line], list[int]]:
    """Return the lines of one kind, and their numbers in the file."""
    decoded: list[_Line] = []
    numbers: list[int] = []
    start, number = 0, 1
    for count, raw in enumerate(raws, 1):
        text = bytes(raw)
        end = data.index(text, start)
        number += data.count(10, start, end)
        start = end
        try:
            decoded.append(_checked(_decoded(text, kind)))
        except ValueError as error:
            raise ValueError(f"line {number}, {noun} {count}: {error}") from None
        numbers.append(number)
    return decoded, numbers


def _decoded(text: bytes, kind: type[_Line]) -> _Line:
    try:
        return json_decoder(kind).decode(text)
    except msgspec.ValidationError as error:
        unknown = _UNKNOWN.search(str(error))
        near = suggestion(unknown[1], kind.__struct_fields__) if unknown else ""
        raise ValueError(f"{error}{near}") from None


def _checked(line: _Line) -> _Line:
    """Return the line. Raises ValueError for values that cannot be."""
    if isinstance(line, Program):
        try:
            line.hashes  # noqa: B018
        except (binascii.Error, ValueError):
            raise ValueError("blocks: expected hashes in base 64, four characters each") from None
        if line.of < 1:
            raise ValueError(f"of: expected a number above 0, found {line.of}")
    elif isinstance(line, Entry):
        if line.severity not in SEVERITIES:
            raise ValueError(f"severity: expected one of {', '.join(SEVERITIES)}, found {line.severity!r}")
        if line.count < 1:
            raise ValueError(f"count: expected a number above 0, found {line.count}")
        if line.places and len(line.places) != line.count:
            raise ValueError(f"places: expected {line.count}, as many as count says, found {len(line.places)}")
    return line


def _line_in(message: str, data: bytes) -> str:
    """The line of the byte that a message names."""
    digits = "".join(filter(str.isdigit, message.rpartition("byte ")[2]))
    return f" in line {data.count(10, 0, int(digits)) + 1}" if digits else ""


def text_of(contents: Contents) -> str:
    """The text of the file: programs by file, entries by file, rule, block and fingerprint, each on a line."""
    entries = sorted(contents.entries, key=lambda entry: (entry.file, entry.rule, entry.block, entry.fingerprint))
    programs = sorted(contents.programs, key=lambda program: program.file)
    shown_programs = f'  "programs": {_list_of(programs)},\n' if contents.schema > 1 else ""
    return f'{{\n  "schema": {contents.schema},\n{shown_programs}  "findings": {_list_of(entries)}\n}}\n'


def _list_of(lines: Iterable[msgspec.Struct]) -> str:
    text = ",\n".join(f"    {msgspec.json.format(msgspec.json.encode(line), indent=0).decode()}" for line in lines)
    return f"[\n{text}\n  ]" if text else "[]"
