"""What comes of rewriting a program."""

from __future__ import annotations

import msgspec

from polarcheck.errors import Refusal as Refusal
from polarcheck.errors import RefusedError as RefusedError


class Decision(msgspec.Struct, frozen=True):
    """
    What somebody has to decide before the new program runs. A comment in it says so, too.

    line: in the original, from 1; 0 for the whole program. text: what is to be decided, and what was in the original.
    """

    line: int
    text: str


class Figure(msgspec.Struct, frozen=True):
    """A measured value for the report, as the largest distance of two paths. unit: mm, deg/min, empty for counts."""

    name: str
    value: float
    unit: str = ""


class Outcome(msgspec.Struct, frozen=True):
    """
    A program that was rewritten, and read back.

    data: the new bytes.
    origin: for each line of the new program its line in the original (from 1), ascending.
    decisions: what is to be decided.
    figures: the measured values, in order.
    notes: lines on what was done where.
    """

    data: bytes
    origin: list[int]
    decisions: list[Decision]
    figures: list[Figure]
    notes: list[str]
