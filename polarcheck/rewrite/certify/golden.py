"""Golden traces: the moves of the tool center as `trace --path tool --format jsonl --golden` writes them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import msgspec

from polarcheck.foundation import bounded
from polarcheck.foundation.decoding import json_decoder
from polarcheck.foundation.errors import CertificateError
from polarcheck.program.reading import files
from polarcheck.reports.pages import executed
from polarcheck.reports.pages.executed import Move
from polarcheck.reports.pages.trace_report import without_lines

#: Of a golden trace [bytes]: 200,000 moves take 90 MB.
_LARGEST = 100_000_000
_Pair = tuple[float | None, float | None]


class GoldenMove(msgspec.Struct, frozen=True):
    """The fields of a move that are compared; they are those of executed.Move."""

    section: int
    kind: str
    start: _Pair
    end: _Pair
    center: _Pair | None
    z: _Pair
    path: str
    feed: float | None
    c_axis: _Pair
    channel: str = ""


def lines(moves: Iterable[Move]) -> Iterator[str]:
    """Yield a line for each move, without the line of its block, which renumbering and comments change."""
    return executed.as_jsonl(without_lines(iter(moves)))


def read(path: Path) -> list[GoldenMove]:
    """Read a golden trace. Raises CertificateError, which names file and line."""
    title = files.display_path(str(path))
    try:
        data = bounded.read_file(path, _LARGEST, "no golden trace is")
    except OSError as error:
        raise CertificateError(f"{title}: {error.strerror or error}") from None
    decoder = json_decoder(GoldenMove)
    moves: list[GoldenMove] = []
    for number, line in enumerate(data.splitlines(), 1):
        try:
            moves.append(decoder.decode(line))
        except (msgspec.DecodeError, UnicodeDecodeError) as error:
            raise CertificateError(f"{title}:{number}: expected a move of a golden trace: {error}") from None
    return moves


def is_golden(path: Path) -> bool:
    """Return True for a file that may be rewritten: it holds a golden trace, or nothing."""
    try:
        read(path)
    except CertificateError:
        return False
    return True
