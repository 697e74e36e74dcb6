"""The statement of one block with the place of each of its parts, in any of the languages."""

from __future__ import annotations

import enum
from typing import TypeAlias

import msgspec

from polarcheck.foundation.states import Distance
from polarcheck.program.execution.expression import Expression, Fault
from polarcheck.program.execution.programs import Search

Place: TypeAlias = tuple[int, int]


class Kind(enum.Enum):
    """
    What a block does.

    OUTPUT: DPRNT and the like.
    NC: NC words without a call.
    CALL: a call or a return.
    STRUCTURE: IF, ELSE, LOOP and the like.
    REPEAT: the blocks between two labels are executed again.
    PROCEDURE: the head of a program with a name.
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


class Number(msgspec.Struct, frozen=True):
    """
    The number of N, DO, END, or of a block skip (a bare / is 1).

    value: the number.
    start, end: its characters with the letters before it, end exclusive.
    """

    value: int
    start: int
    end: int


#: More digits than a number has on any control: longer numbers count as the largest one.
_DIGITS = 18


def whole(digits: str) -> int:
    """The value of digits, of which a hostile program may write any number."""
    return int(digits) if len(digits) <= _DIGITS else 10**_DIGITS


class Word(msgspec.Struct, frozen=True):
    """
    An address and its value.

    address: a letter, ",C" with its comma, "O" also for ":", "<" for the name of a program, "C2" before an =.
    value: expression of the value.
    written: the number as it is written, sign and point included, or the name; None for a variable or an expression.
    start, end: its characters within the block, end exclusive.
    distance: coordinate or distance, where the word says so: X=AC(10); else None.
    """

    address: str
    value: Expression
    written: str | None
    start: int
    end: int
    distance: Distance | None = None

    @property
    def code(self) -> str:
        """The word as a code in its standard spelling: M098 is M98, G066.1 is G66.1; "" for a calculated value."""
        return (
            ""
            if self.written is None or self.is_named
            else self.address + (self.written.lstrip("0").rstrip(".") or "0")
        )

    @property
    def is_named(self) -> bool:
        """True for the name of an axis as address: C2=10."""
        return len(self.address) > 1 and self.address[0] != ","

    @property
    def has_point(self) -> bool:
        """True for a value that is not in least increments: a number with a point, or a calculated value."""
        return self.written is None or "." in self.written


class Parameter(msgspec.Struct, frozen=True):
    """
    An argument of a call by name, or a parameter of a program.

    variable: number of the variable that takes the value; 0 in a call.
    value: the argument, or the default of the parameter; None for none.
    """

    variable: int
    value: Expression | None


class Unread(msgspec.Struct, frozen=True):
    """
    A part of a block that is not simulated.

    name: as a message names it.
    start, end: its characters within the block, end exclusive.
    moves: the positions of the axes are unknown after it.
    matters: a finding may be missing because of it.
    is_cycle: only the positions are unknown after it, until they are programmed again.
    """

    name: str
    start: int
    end: int
    moves: bool = False
    matters: bool = True
    is_cycle: bool = False


class Statement(msgspec.Struct, frozen=True):
    """
    The statement of one block. All places are indices of characters within the block, end exclusive.

    start, end: the statement, without block skip and sequence number.
    skips: the block skips; one within the block skips what follows it.
    target: the number of the variable to assign; None for a variable by name.
    value: the assigned value, the repeats of REPEAT, or the first value of FOR.
    jump: the N number to go to.
    loop: the number of DO or END.
    then: the statement after IF .. THEN.
    words: NC words that could be read.
    call: the code that calls or returns; "" in other blocks.
    fault: the first one; what could not be read is None, but with "bracket-levels" everything could.
    label: the name to go to, if it is not a number.
    search: where the target of the jump is searched.
    until: the last label of REPEAT.
    structure: the keyword of a STRUCTURE.
    parameters: arguments of a call by name, or parameters of a program; None for other calls.
    more: further statements of the block, in order.
    unread: parts that are not simulated.
    assigned: variables that a call sets for its program; they have no value after the return.
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
