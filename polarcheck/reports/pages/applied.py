"""`polarcheck config show`: the settings of a program, and where each value comes from."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import msgspec

from polarcheck.program.reading.excerpt import visible

#: A longer line does not widen the column of the values [characters].
_LONGEST = 48


class Row(NamedTuple):
    """
    A setting.

    key: its name.
    value: None or NaN if unknown.
    kind: what kind of source sets it.
    origin: the file or option that sets it.
    """

    key: str
    value: Any
    kind: str
    origin: str


def text(path: str, heads: Sequence[str], rows: Iterable[Row]) -> str:
    """Return the values in aligned lines as in TOML: `key = value  # origin`."""
    lines = [(f"{row.key} = {_toml(row.value)}", row.origin) for row in rows]
    width = max((len(line) for line, _ in lines if len(line) <= _LONGEST), default=0)
    aligned = [f"{line:<{width}}  # {origin}" for line, origin in lines]
    return "".join(f"{visible(line)}\n" for line in [f"# {path}", *(f"# {head}" for head in heads), "", *aligned])


def as_json(
    path: str,
    files: Sequence[str],
    entries: Sequence[str],
    excluded: bool,
    rows: Iterable[Row],
    left_behind: Mapping[str, Any] | None = None,
) -> str:
    """Return the same as JSON; null is unknown. left_behind: a job file above that does not apply, with its keys."""
    document = {
        "path": path,
        "files": list(files),
        "programs": list(entries),
        "excluded": excluded,
        "not_taken_over": left_behind,
        "values": [{**row._asdict(), "value": None if _is_unknown(row.value) else row.value} for row in rows],
    }
    return msgspec.json.format(msgspec.json.encode(document), indent=2).decode() + "\n"


def _is_unknown(value: Any) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _toml(value: Any) -> str:
    if value is None:
        return "not given"
    return "not known" if _is_unknown(value) else msgspec.json.encode(value).decode()
