"""The offset table that a control punches out: G10 blocks with R and T of each tool offset."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from polarcheck import bounded
from polarcheck.errors import JobError
from polarcheck.machines.fitting import MisfitError, fitted
from polarcheck.machines.job import PunchedTool, Tool

#: A table of 10,000 offsets has half a megabyte [bytes].
_LARGEST = 16_000_000
# A block ends with its line, or where the next one begins; CR is a line end, too, where a transfer took the LF.
_BLANK = r"[^\S\r\n]*+"
_OFFSET = re.compile(rf"G10{_BLANK}P{_BLANK}(\d++)((?:{_BLANK}[A-FH-OQ-Z]{_BLANK}[-+]?\d*+\.?\d*+)*+)")
_VALUE = re.compile(rf"([RQX]){_BLANK}([-+]?(?:\d++\.?\d*+|\.\d++))")
#: P10001 is the geometry of offset 1, P1 its wear (B-63524EN/01 p. 285).
_GEOMETRY = 10000
#: X of no wear, whatever its unit.
_LARGEST_WEAR = 100.0
_DIGITS = 8
_SHOWN = 40


def read(path: Path, title: str, *, pipes: bool = False) -> dict[str, Tool]:
    """
    The offsets of a table (`G10 P10008 X.. Z.. R.. Q..`) by offset number; R of geometry and wear are added.

    X of the wear is kept by itself.

    Lengths are in the units of the table. pipes: whether it may be a pipe, as a shell hands over `<(...)`. Raises
    JobError, which names the title, for a file that cannot be read or holds no offset or one that cannot be.
    """
    try:
        text = bounded.read(path, _LARGEST, "no offset table is", pipes=pipes).decode("latin-1").upper()
    except OSError as error:
        raise JobError(f"{title}: {error.strerror}") from None
    radius: dict[int, float] = {}
    nose: dict[int, float] = {}
    x_wear: dict[int, float] = {}
    for match in _OFFSET.finditer(text):
        written = match[1].lstrip("0")
        if len(written) > _DIGITS:
            raise JobError(f"{title}: P{written[:_SHOWN]}... is no number of an offset")
        is_geometry, number = divmod(int(written or 0), _GEOMETRY)
        for value in _VALUE.finditer(match[2]):
            if value[1] == "R":
                radius[number] = radius.get(number, 0.0) + float(value[2])
            elif value[1] == "X":
                # Wear is small: what is not is where a tool has been touched off, be it in least increments.
                if not is_geometry and abs(float(value[2])) < _LARGEST_WEAR:
                    x_wear[number] = float(value[2])
            elif is_geometry or number not in nose:
                nose[number] = _whole(float(value[2]))
    if not radius and not nose:
        raise JobError(f"{title}: no offsets found; expected blocks such as G10 P10008 R0.375 Q0")
    values = {"radius": radius, "nose": nose, "x_wear": x_wear}
    return {str(number): _tool(number, values, title) for number in sorted(radius.keys() | nose.keys())}


def _whole(value: float) -> float:
    """T, which the control punches out with a point; what is too large for it stays as it is, for the message."""
    return int(value) if value < _GEOMETRY else value


def _tool(number: int, values: Mapping[str, Mapping[int, float]], title: str) -> Tool:
    given = {key: of_key[number] for key, of_key in values.items() if number in of_key}
    try:
        return fitted(given, PunchedTool)
    except MisfitError as misfit:
        raise JobError(f"{title}: offset {number}: {misfit}") from None
