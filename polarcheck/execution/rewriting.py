"""A block of a control's own language, read as what custom macro writes for it; each character keeps its place."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from polarcheck.execution.macro_tokens import Characters
from polarcheck.execution.statement import Statement

#: Reads what a block is rewritten as, by the bounds of the control.
Read: TypeAlias = Callable[[str | Characters], Statement]


class Rewriting:
    """The characters that custom macro would have in the place of those of a block."""

    def __init__(self) -> None:
        self._text: list[str] = []
        self._places: list[int] = []

    def put(self, text: str, start: int, end: int) -> None:
        """Text that stands for the characters from start to end of the block."""
        shown = [place for place in range(len(text)) if not text[place].isspace()]
        self._text += [text[place].upper() for place in shown]
        self._places += [min(start + place, max(end - 1, start)) for place in shown]

    def before(self, other: Rewriting) -> Characters:
        """What has been put here and, behind it, there."""
        return Characters("".join((*self._text, *other._text)), [*self._places, *other._places])

    @property
    def characters(self) -> Characters:
        """What has been put, to be read."""
        return Characters("".join(self._text), list(self._places))
