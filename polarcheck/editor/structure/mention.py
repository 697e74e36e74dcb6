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
    What a place does with it.

    DEFINES: it stands here. ASSIGNS: a variable takes a value. REFERS: it is used.
    """

    DEFINES = enum.auto()
    ASSIGNS = enum.auto()
    REFERS = enum.auto()


class Into(enum.Enum):
    """In which program the N number of a reference is looked for: its own, that of the caller, or the called one."""

    OWN = enum.auto()
    CALLER = enum.auto()
    CALLED = enum.auto()


class Mention(NamedTuple):
    """
    A place that names something.

    kind, role: what it names, and what it does.
    keys: number or name in capitals; of programs each key by which it can be called.
    written: as it is written.
    block: of the listing.
    start, end: the characters of the number or name, end exclusive.
    begin: where the word around it begins, for the cursor.
    into: the program of an N number.
    called: the program that the block calls, if the N number is in that.
    code: what calls a program: M98, G65.
    has_repeats: P has the repeats before the last four digits.
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
    """A block that names something by a value: which one is not known."""

    kind: Kind
    block: int
    into: Into = Into.OWN
