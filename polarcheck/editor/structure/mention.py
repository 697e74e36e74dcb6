"""A place of a text that names something: an N number, a label, a variable or a program."""

from __future__ import annotations

import enum
from typing import NamedTuple

from polarcheck.program.execution.programs import ProgramName


class Kind(enum.Enum):
    """What is named."""

    SEQUENCE = "N number"
    LABEL = "label"
    VARIABLE = "variable"
    PROGRAM = "program"


class Role(enum.Enum):
    """
    What a mention does with the name.

    DEFINES: the N number, label or program stands here. ASSIGNS: a variable takes a value. REFERS: it is used.
    """

    DEFINES = enum.auto()
    ASSIGNS = enum.auto()
    REFERS = enum.auto()


class Into(enum.Enum):
    """The program in which a referred N number stands: the one of the reference, its caller, or the one it calls."""

    OWN = enum.auto()
    CALLER = enum.auto()
    CALLED = enum.auto()


class Mention(NamedTuple):
    """
    A place that names something.

    kind, role: what it names, and what it does with the name.
    keys: the number, or the name in capitals; of a program all keys by which it can be called.
    written: the text as written.
    block: the number of the block in the listing.
    start, end: the characters of the number or name, end exclusive.
    begin: where the word around it begins, for the cursor.
    into: the program in which an N number stands.
    called: the program that the block calls, if the N number stands in that one.
    code: the code that calls a program: M98, G65.
    has_repeats: the digits of P before the last four are the number of repeats.
    """

    kind: Kind
    role: Role
    keys: tuple[int | str, ...]
    written: str
    block: int
    start: int
    end: int
    begin: int
    into: Into = Into.OWN
    called: ProgramName | None = None
    code: str = ""
    has_repeats: bool = False

    @property
    def name(self) -> int | str:
        """The number or name; of a program that has both the number."""
        if len(self.keys) == 1:
            return self.keys[0]
        return next((key for key in self.keys if isinstance(key, int)), self.keys[0])

    @property
    def shown(self) -> str:
        """The name as messages have it: N100, O0002, #100, END."""
        if self.kind is Kind.SEQUENCE:
            return f"N{self.name}"
        if self.kind is Kind.PROGRAM:
            return f"O{self.name:04d}" if isinstance(self.name, int) else self.name
        return f"#{self.name}" if isinstance(self.name, int) else self.name


class Computed(NamedTuple):
    """A block that names something by a computed value, so that the name is not known."""

    kind: Kind
    block: int
    into: Into = Into.OWN
