"""Columns of a large program that hold one value throughout: they take the memory of one."""

from __future__ import annotations

from itertools import islice
from typing import Any

import numpy as np

from polarcheck.arrays import Mask, is_one, repeated
from polarcheck.checking.tables import Tables


class Settling:
    """Gives back the memory of such columns: most of what is asked of a program is so nowhere in it, or everywhere."""

    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        self._looked_at: dict[str, int] = {}
        self._masks: dict[tuple[int, bool], Mask] = {}

    def settle(self) -> None:
        """Look at the columns that were made since the last time."""
        for name, table in self.tables.made():
            columns: dict[str, Any] = getattr(table, "__dict__", {})
            first = self._looked_at.get(name, 0)
            self._looked_at[name] = len(columns)
            for column in list(islice(columns, first, None)):
                columns[column] = self._in_little(columns[column])

    def _in_little(self, column: Any) -> Any:
        if not isinstance(column, np.ndarray) or column.ndim != 1 or not column.size or column.dtype.hasobject:
            return column
        if not is_one(column):
            return column
        if column.dtype == np.bool_:
            return self._masks.setdefault((len(column), bool(column[0])), column)
        return repeated(column[0], len(column))
