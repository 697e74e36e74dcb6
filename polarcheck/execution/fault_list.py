"""The faults of one run while they are being gathered, each kind once at each place."""

from __future__ import annotations

from typing import Protocol

from polarcheck.execution.expression import Fault
from polarcheck.execution.kinds import FaultKind
from polarcheck.execution.run import FlowFault
from polarcheck.reading.words import Text


class HasPlace(Protocol):
    """Characters of a block, end exclusive: a fault, an expression, a statement."""

    @property
    def start(self) -> int: ...

    @property
    def end(self) -> int: ...


class FaultList:
    """What was found in a text. row: that is about to be executed."""

    def __init__(self, text: Text) -> None:
        self._starts = text.blocks.start
        self._found: dict[tuple[FaultKind, int, int], FlowFault] = {}

    def add(self, kind: FaultKind, block: int, place: HasPlace, row: int, **values: str | int | float) -> None:
        """Keep a fault; not again what was found there before."""
        key = (kind, block, place.start)
        if key not in self._found:
            start = int(self._starts[block])
            end = max(place.end, place.start + 1)
            self._found[key] = FlowFault(kind, block, start + place.start, start + end, values, row)

    def add_found(self, fault: Fault | None, block: int, row: int) -> None:
        """Keep what reading or a calculation found wrong, if anything."""
        if fault is not None:
            values = {} if fault.number is None else {"number": fault.number}
            self.add(fault.kind, block, fault, row, **values)

    def all(self) -> tuple[FlowFault, ...]:
        """In the order in which they were found."""
        return tuple(self._found.values())
