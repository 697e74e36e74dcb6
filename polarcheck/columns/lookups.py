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

    def forget(self, kind: str) -> None:
        """Drop the columns of a kind, as `word` for each address: they are made again when they are asked for."""
        for name in [name for name in self.__dict__ if name.startswith(f"{kind} ")]:
            del self.__dict__[name]
