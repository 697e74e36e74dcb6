"""Columns that are looked up by an address, a modal group or codes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Column = TypeVar("Column")


class Lookups:
    """A table with columns that take an argument: each is computed once per argument."""

    def __init__(self) -> None:
        self._columns: dict[str, Any] = {}

    def _column(self, name: str, make: Callable[[], Column]) -> Column:
        if name not in self._columns:
            self._columns[name] = make()
        column: Column = self._columns[name]
        return column
