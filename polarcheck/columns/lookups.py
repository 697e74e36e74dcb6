"""Columns that are looked up by an address, a modal group or codes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from polarcheck.foundation.arrays import Columns

Column = TypeVar("Column")


class Lookups(Columns, frozen=True):
    """A table with columns that take an argument: each is computed once per argument."""

    def _column(self, name: str, make: Callable[[], Column]) -> Column:
        if name not in self.__dict__:
            self.__dict__[name] = make()
        column: Column = self.__dict__[name]
        return column
