"""`polarcheck trace --format json`: the moves of a path as one document, and what a golden file of them holds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec
from msgspec import UNSET, UnsetType

from polarcheck.foundation.version import __version__
from polarcheck.reports.json import encoded
from polarcheck.reports.pages.executed import Move, as_jsonl

SCHEMA = 1
#: Fields that change when a program is renumbered or commented.
OF_LINES = ("line",)
#: The units of the fields of a move; the others have none.
UNITS = {
    **dict.fromkeys(("start", "end", "center", "z", "radius", "x_axis", "nearest"), "mm"),
    "c_axis": "deg",
    **dict.fromkeys(("feed", "x_feed"), "mm/min"),
    "c_feed": "deg/min",
    "c_acceleration": "deg/s2",
    "x_acceleration": "mm/s2",
    "time": "s",
}


class TraceReport(msgspec.Struct, frozen=True, kw_only=True):
    """
    The moves of a path; a contract.

    schema: number of the contract.
    version: of polarcheck; absent in a golden document.
    path: of the program; absent in a golden document.
    machine: its id: the name of a built-in machine, or the file name of a machine file, without `.toml`.
    units: by the fields of a move that have one.
    requested: the path of the moves, tool or programmed; each move says which it is.
    moves: in the order in which they are run, channel by channel. A golden document leaves out their lines.
    """

    schema: int
    version: str | UnsetType = UNSET
    path: str | UnsetType = UNSET
    machine: str
    units: dict[str, str]
    requested: str
    moves: list[Move]


def as_json(moves: Iterator[Any], path: str, machine: str, requested: str, is_golden: bool) -> Iterator[str]:
    """Yield the document in pieces, the head first and then a move a line: a long program has millions of moves."""
    report = TraceReport(
        schema=SCHEMA,
        version=UNSET if is_golden else __version__,
        path=UNSET if is_golden else path,
        machine=machine,
        units=UNITS,
        requested=requested,
        moves=[],
    )
    yield encoded(report).removesuffix("]}") + "\n"
    separator = ""
    for line in as_jsonl(moves):
        yield separator + line.rstrip("\n")
        separator = ",\n"
    yield "\n]}\n" if separator else "]}\n"


def without_lines(items: Iterator[Any]) -> Iterator[dict[str, Any]]:
    """Yield moves, or executed blocks, without what renumbering and comments change: so golden files survive them."""
    for item in items:
        fields = msgspec.to_builtins(item)
        for name in OF_LINES:
            del fields[name]
        yield fields
