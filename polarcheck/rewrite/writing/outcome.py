"""What comes of rewriting a program."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from polarcheck.foundation.errors import Refusal as Refusal
from polarcheck.foundation.errors import RefusedError as RefusedError

if TYPE_CHECKING:
    from polarcheck.columns.trace import Trace


def refusal_at(trace: Trace, row: int, text: str) -> Refusal:
    """A reason with the line of a row in the file."""
    return Refusal(trace.line(row), text)


def refused_at(trace: Trace, row: int, text: str) -> RefusedError:
    """The error to raise for one reason with the line of a row in the file."""
    return RefusedError([refusal_at(trace, row, text)])


def radius_not_known(trace: Trace, row: int) -> str:
    """The reason where R of the offset in force is not known, with what to give."""
    from polarcheck.rules.wording.offsets import called_tool, to_give  # late: it loads NumPy

    missing = to_give(trace.tools, trace.machine, row, "radius")
    return f"R of {called_tool(trace.tools, row)} is not known: {missing}"


class Decision(msgspec.Struct, frozen=True):
    """
    What somebody has to decide before the new program runs. A comment in it says so, too.

    line: in the original, from 1; 0 for the whole program. text: what is to be decided, and what was in the original.
    """

    line: int
    text: str


class Doubt(msgspec.Struct, frozen=True):
    """
    A value of a machine profile in doubt, on which numbers of the new program rest.

    line: the first in the original with such a number. key: of the profile, `control.x`.
    value, new_value: for the lathes of the original and of the new program; empty for tables.
    machines: the titles of those for which the value is in doubt.
    """

    line: int
    key: str
    value: str
    new_value: str
    machines: list[str]


class Figure(msgspec.Struct, frozen=True):
    """A measured value for the report, as the largest distance of two paths. unit: mm, deg/min, empty for counts."""

    name: str
    value: float
    unit: str = ""


class Measured(msgspec.Struct, frozen=True):
    """
    What was measured when a new program was read back.

    differences: why it must not be written. figures: for the user, in order. notes: warnings.
    """

    differences: list[Refusal]
    figures: list[Figure] = []
    notes: list[str] = []


class Outcome(msgspec.Struct, frozen=True):
    """
    A program that was rewritten, and read back.

    data: the new bytes.
    origin: for each line of the new program its line in the original (from 1), ascending.
    decisions: what is to be decided.
    figures: the measured values, in order.
    notes: lines on what was done where.
    doubts: values in doubt on which numbers of the new program rest, and which somebody has accepted.
    """

    data: bytes
    origin: list[int]
    decisions: list[Decision]
    figures: list[Figure]
    notes: list[str]
    doubts: list[Doubt] = []
