"""A statement of one block, with the place of each of its parts, the same for all languages."""

from __future__ import annotations

import enum
from typing import NamedTuple, TypeAlias

import msgspec

from polarcheck.execution.expression import Expression, Fault
from polarcheck.execution.programs import Search
from polarcheck.machines.modal import Distance

Place: TypeAlias = tuple[int, int]


class Kind(enum.Enum):
    """
    What a block does. OUTPUT is DPRNT and its like; NC is a block of NC words, CALL one that calls or returns.
    STRUCTURE is IF, ELSE, LOOP and their like; REPEAT runs again what stands between labels; PROCEDURE begins a program
    of a name.
    """

    ASSIGN = enum.auto()
    IF_GOTO = enum.auto()
    IF_THEN = enum.auto()
    WHILE_DO = enum.auto()
    DO = enum.auto()
    END = enum.auto()
    GOTO = enum.auto()
    CALL = enum.auto()
    OUTPUT = enum.auto()
    NC = enum.auto()
    STRUCTURE = enum.auto()
    REPEAT = enum.auto()
    PROCEDURE = enum.auto()


class Number(NamedTuple):
    """A whole number with its letters: of N, DO, END, or of a block skip (a bare / is 1)."""

    value: int
    start: int
    end: int


#: Digits of a number that no control has, so that all longer ones are as good as one.
_DIGITS = 18


def whole(digits: str) -> int:
    """The value of some digits, of which a hostile program may write any number."""
    return int(digits) if len(digits) <= _DIGITS else 10**_DIGITS


class Word(msgspec.Struct, frozen=True):
    """
    An address and its value.

    address: a letter, ",C" with its comma, "O" also for ":", "<" for a program's name, "C2" before an =. written: the
    number as it stands in the program, sign and point included, or the name; None where the value is a variable or an
    expression. distance: whether the value is a coordinate or a distance, where the word itself says it: X=AC(10).
    """

    address: str
    value: Expression
    written: str | None
    start: int
    end: int
    distance: Distance | None = None

    @property
    def code(self) -> str:
        """The word in the one spelling of a code: M098 is M98, G066.1 is G66.1; "" where the value is calculated."""
        return (
            ""
            if self.written is None or self.is_named
            else self.address + (self.written.lstrip("0").rstrip(".") or "0")
        )

    @property
    def is_named(self) -> bool:
        """True if the address is the name of an axis, as in C2=10."""
        return len(self.address) > 1 and self.address[0] != ","

    @property
    def has_point(self) -> bool:
        """True if the value is not in least increments: a number with a decimal point, or a calculated value."""
        return self.written is None or "." in self.written


class Parameter(NamedTuple):
    """
    What a call by name hands over, or a program takes.

    variable: the number of the variable that takes it, 0 in a call. value: what is given, or what is taken where
    nothing is; None where that is nothing.
    """

    variable: int
    value: Expression | None


class Unread(NamedTuple):
    """
    What a block says and this check does not simulate, by the name that a message gives it, and its characters.

    moves: nobody knows where the axes stand after it. matters: a finding may be missing for it.
    """

    name: str
    start: int
    end: int
    moves: bool = False
    matters: bool = True


class Statement(msgspec.Struct, frozen=True):
    """
    What one block says. All places are indices of characters within the block, end exclusive.

    start, end: the statement, without block skip and sequence number. skips: one within the block skips what follows.
    target: the number of the variable to assign, None for a variable by name. jump: the N to go to. then: what IF ..
    THEN does. call: the code that makes the block a call, "" in others. fault: the first one; what could not be read
    is None or not among the words, and with "bracket-levels" nothing is lost. label: the name to go to, where it is no
    number; search: where it is looked for. until: the label up to which REPEAT goes. structure: the keyword of a
    STRUCTURE. parameters: what a call by name hands over, or a program takes; None for other calls. more: what the
    block says beside it, in order. unread: what is not simulated. assigned: the variables that a call sets for its
    program, which have no value behind its return.
    """

    kind: Kind
    start: int
    end: int
    sequence_number: Number | None = None
    skips: tuple[Number, ...] = ()
    target: Expression | None = None
    value: Expression | None = None
    condition: Expression | None = None
    jump: Expression | None = None
    loop: Number | None = None
    then: Statement | None = None
    words: tuple[Word, ...] = ()
    call: str = ""
    fault: Fault | None = None
    label: str = ""
    search: Search = Search.ROUND
    until: str = ""
    structure: str = ""
    parameters: tuple[Parameter, ...] | None = None
    more: tuple[Statement, ...] = ()
    unread: tuple[Unread, ...] = ()
    assigned: tuple[int, ...] = ()
