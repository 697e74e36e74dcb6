"""What the tests of plane geometry share: points along a move, from its definition, and a path from its rows."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from polarcheck.foundation.states import Corner, Motion
from polarcheck.geometry.cutter_compensation.offset_path import Path

#: In the order of the fields of Path, without the last.
PATH_TYPES = (np.int64, np.int16, np.bool_, *[complex] * 3, np.int16, np.bool_, np.float64, complex, np.bool_)


def path_of_rows(rows: Iterable[tuple[Any, ...]], corner: Corner = Corner.LINES) -> Path:
    """The columns of a path, each row as the fields of Path but the last, which all have."""
    columns = list(zip(*rows, strict=True)) or [()] * len(PATH_TYPES)
    arrays = [np.array(column, dtype=kind) for column, kind in zip(columns, PATH_TYPES, strict=True)]
    return Path(*arrays, np.full(len(arrays[0]), corner, np.int16))


def turn_of(start: complex, end: complex, center: complex, kind: int) -> float:
    """How far an arc turns [rad], clockwise below 0, all the way round where it ends at its start; 0 for a line."""
    if kind == Motion.LINE:
        return 0.0
    sense = 1 if kind == Motion.CCW else -1
    turn = float(np.angle((end - center) / (start - center))) * sense % math.tau
    return sense * (math.tau if start == end or turn == 0 else turn)


def points_along(start: complex, end: complex, center: complex, kind: int, count: int) -> np.ndarray:
    """Points at even ways along a move."""
    share = np.linspace(0, 1, count)
    if kind == Motion.LINE:
        return start + share * (end - start)
    return center + (start - center) * np.exp(1j * turn_of(start, end, center, kind) * share)
