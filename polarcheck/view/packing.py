"""
The data of a page as text for its script: as JSON if there is little of it, else packed.

Packed, each long column of numbers is written as its steps in units of its last digit, and all is compressed; the
script `data.js` unpacks it. No digit is lost. A page of 20,000 blocks takes a quarter of its bytes so.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats

#: Data up to this length stays JSON [characters], and so do shorter columns [rows].
_LITTLE, _SHORT = 200_000, 32
#: Digits behind the point of a column at most.
_DIGITS = 7
#: Whole numbers below it are exact in a script.
_EXACT = 2**52
#: The fastest level of zlib that takes less than a tenth more than the best.
_LEVEL = 5
#: Characters that could end a script in HTML, or that a script must not contain.
_IN_SCRIPT = str.maketrans({mark: f"\\u{ord(mark):04x}" for mark in "<>&\u2028\u2029"})


def data_element(data: Any) -> str:
    """Return the element of HTML that holds the data; data: what msgspec writes as JSON."""
    whole = msgspec.json.encode(data)
    if len(whole) <= _LITTLE:
        return f'<script type="application/json" id="data">{whole.decode().translate(_IN_SCRIPT)}</script>'
    text = base64.b64encode(zlib.compress(msgspec.json.encode(packed(data)), _LEVEL)).decode()
    return f'<script type="text/plain" id="data">{text}</script>'


def packed(value: Any) -> Any:
    """
    Return the value with its long columns of numbers packed.

    A column of numbers and nulls becomes {"digits": d, "steps": [...]}: the first step leads from 0 to the first
    number, each later one to the next number, in units of 10 ** -d; a null stays. A column of points of two numbers
    each becomes {"columns": [...]}.
    """
    if isinstance(value, dict):
        return {name: packed(element) for name, element in value.items()}
    if not isinstance(value, list | tuple) or not value or isinstance(value[0], str | bool):
        return value
    if len(value) < _SHORT:
        return [packed(element) for element in value]
    try:
        array = np.array(value, np.float64)  # null becomes NaN
    except (TypeError, ValueError):  # rows of several lengths, or of more than numbers
        return [packed(element) for element in value]
    if array.ndim > 2 or not array.size:
        return [packed(element) for element in value]
    steps = [_steps(column) for column in array.reshape(len(value), -1).T]
    if None in steps:
        return value
    return steps[0] if array.ndim == 1 else {"columns": steps}


def _steps(column: Floats) -> dict[str, Any] | None:
    """Return a column packed; None if its numbers have more digits than `_DIGITS`, or are too large to be exact."""
    is_null = ~np.isfinite(column)  # as in JSON
    numbers = column[~is_null]
    for digits in range(_DIGITS + 1):
        units = np.rint(numbers * 10.0**digits)
        if (np.abs(units) > _EXACT).any():
            return None
        if (units / 10.0**digits == numbers).all():
            steps = np.zeros(len(column), object)
            steps[~is_null] = np.diff(units.astype(np.int64), prepend=0)
            steps[is_null] = None
            return {"digits": digits, "steps": steps.tolist()}
    return None
