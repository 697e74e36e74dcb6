"""The offset table that a control punches out: G10 blocks with R and T of each tool offset."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from polarcheck.errors import JobError
from polarcheck.machines.fitting import MisfitError, fitted
from polarcheck.machines.job import PunchedTool, Tool

_OFFSET = re.compile(r"G10\s*P\s*(\d+)((?:\s*[A-Z]\s*[-+]?\d*\.?\d*)*)")
_VALUE = re.compile(r"([RQ])\s*([-+]?\d*\.?\d+|[-+]?\d+\.)")
#: P10001 is the geometry of offset 1, P1 its wear (B-63524EN/01 p. 285).
_GEOMETRY = 10000


def read(path: Path, title: str) -> dict[int, Tool]:
    """
    The offsets of a table (`G10 P10008 X.. Z.. R.. Q..`) by offset number; R of geometry and wear are added.

    Lengths are in the units of the table. Raises JobError, which names the title, for a file that cannot be read or
    holds no offset or one that cannot be.
    """
    try:
        text = path.read_bytes().decode("latin-1").upper()
    except OSError as error:
        raise JobError(f"{title}: {error.strerror}") from None
    radius: dict[int, float] = {}
    nose: dict[int, int] = {}
    for match in _OFFSET.finditer(text):
        number = int(match[1]) % _GEOMETRY
        for address, value in _VALUE.findall(match[2]):
            if address == "R":
                radius[number] = radius.get(number, 0.0) + float(value)
            elif int(match[1]) >= _GEOMETRY or number not in nose:
                nose[number] = int(float(value))
    if not radius and not nose:
        raise JobError(f"{title}: no offsets found; expected blocks such as G10 P10008 R0.375 Q0")
    return {number: _tool(number, radius, nose, title) for number in sorted(radius.keys() | nose.keys())}


def _tool(number: int, radius: Mapping[int, float], nose: Mapping[int, int], title: str) -> Tool:
    given = {key: values[number] for key, values in (("radius", radius), ("nose", nose)) if number in values}
    try:
        return fitted(given, PunchedTool)
    except MisfitError as misfit:
        raise JobError(f"{title}: offset {number}: {misfit}") from None
