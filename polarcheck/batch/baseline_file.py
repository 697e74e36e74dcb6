"""
The file of a baseline: one known finding on each line, for its readers and for tools that compare lines.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import msgspec

from polarcheck import bounded
from polarcheck.errors import BaselineError, suggestion
from polarcheck.finding import SEVERITIES
from polarcheck.reading.files import shown

SCHEMA = 1
#: Largest baseline file [bytes]; 100,000 findings take 20 MB.
_LARGEST = 200_000_000

_UNKNOWN = re.compile("unknown field `([^`]*)`")

#: Rule and fingerprint, by which findings are matched.
Key = tuple[str, str]


class Entry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """
    Known findings of a file with the same rule and fingerprint.

    file: relative to the folder of the baseline, with slashes.
    severity: the worst of them.
    count: how many there are.
    block: that of the first one, for the reader.
    follows: the rules of the findings that follow from them.
    reason: why they are accepted.
    """

    file: str
    rule: str
    fingerprint: str
    severity: str
    count: int = 1
    block: str = ""
    follows: list[str] = []
    reason: str = ""

    @property
    def key(self) -> Key:
        """Rule and fingerprint."""
        return self.rule, self.fingerprint


class _Head(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    schema: int
    findings: list[msgspec.Raw]


def read(path: Path) -> list[Entry]:
    """
    Read the entries of a baseline.

    Raises BaselineError, which names the file, the line, the key and what was expected.
    """
    try:
        data = bounded.read_file(path, _LARGEST, "no baseline is", pipes=True)
    except OSError as error:
        raise BaselineError(f"{shown(str(path))}: {error.strerror or error}") from None
    try:
        return _entries(_as_utf8(data))
    except ValueError as error:
        raise BaselineError(f"{shown(str(path))}: {error}") from None


def _as_utf8(data: bytes) -> bytes:
    """Decode what editors and shells of Windows write: UTF-16, or UTF-8 with a byte order mark."""
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    return data.decode("utf-16" if wide else "utf-8-sig").encode("utf-8")


def _entries(data: bytes) -> list[Entry]:
    try:
        head = msgspec.json.decode(data, type=_Head)
    except msgspec.ValidationError as error:
        raise ValueError(f"{error}; expected a file that `polarcheck baseline create` has written") from None
    except msgspec.DecodeError as error:
        raise ValueError(f"is no JSON: {error}{_line_in(str(error), data)}") from None
    if head.schema != SCHEMA:
        raise ValueError(f"schema: expected {SCHEMA}, found {head.schema}: it is of another version of polarcheck")
    entries, at = [], 0
    for number, raw in enumerate(head.findings, 1):
        text = bytes(raw)
        at = data.index(text, at)
        try:
            entries.append(_entry(text))
        except ValueError as error:
            raise ValueError(f"line {data.count(10, 0, at) + 1}, finding {number}: {error}") from None
        at += len(text)
    return entries


def _entry(text: bytes) -> Entry:
    try:
        entry = msgspec.json.decode(text, type=Entry)
    except msgspec.ValidationError as error:
        unknown = _UNKNOWN.search(str(error))
        near = suggestion(unknown[1], Entry.__struct_fields__) if unknown else ""
        raise ValueError(f"{error}{near}") from None
    if entry.severity not in SEVERITIES:
        raise ValueError(f"severity: expected one of {', '.join(SEVERITIES)}, found {entry.severity!r}")
    if entry.count < 1:
        raise ValueError(f"count: expected a number above 0, found {entry.count}")
    return entry


def _line_in(message: str, data: bytes) -> str:
    """The line of the byte that a message names."""
    digits = "".join(filter(str.isdigit, message.rpartition("byte ")[2]))
    return f" in line {data.count(10, 0, int(digits)) + 1}" if digits else ""


def text_of(entries: Iterable[Entry]) -> str:
    """The text of the file: an entry on each line, sorted by file, rule, block and fingerprint."""
    ordered = sorted(entries, key=lambda entry: (entry.file, entry.rule, entry.block, entry.fingerprint))
    lines = ",\n".join(f"    {msgspec.json.format(msgspec.json.encode(entry), indent=0).decode()}" for entry in ordered)
    findings = f"[\n{lines}\n  ]" if lines else "[]"
    return f'{{\n  "schema": {SCHEMA},\n  "findings": {findings}\n}}\n'
