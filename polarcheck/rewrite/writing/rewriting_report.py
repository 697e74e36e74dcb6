"""What comes of rewriting a program, as JSON has it."""

from __future__ import annotations

import msgspec

from polarcheck.rewrite.writing.outcome import Decision, Doubt, Figure

#: The commands that rewrite programs.
COMMANDS = CONVERT, UNROLL, COMPENSATE, ROLL = "convert", "unroll", "compensate", "roll"


class Reason(msgspec.Struct, frozen=True):
    """Why a program is not rewritten. line: from 1, null for the whole program."""

    line: int | None
    text: str


class Rewriting(msgspec.Struct, frozen=True):
    """
    What comes of rewriting a program.

    path, machine: the original and its lathe.
    new_machine: the lathe of the new program.
    refusals: why there is no new program; empty if there is one.
    written: its file; null if it was not written into one.
    lines, new_lines: of the original and of the new program; null without one.
    decisions: what somebody has to decide before it runs, line 0 for the whole program.
    figures: what was measured; null for what is not known.
    notes: what was done where.
    doubts: of convert, values of the two profiles in doubt on which changed numbers rest.
    """

    path: str
    machine: str
    new_machine: str
    refusals: list[Reason]
    written: str | None
    lines: int
    new_lines: int | None
    decisions: list[Decision]
    figures: list[Figure]
    notes: list[str]
    doubts: list[Doubt]


class RewritingReport(msgspec.Struct, frozen=True):
    """What comes of a run. command: convert, unroll, compensate or roll. files: an entry for each program, in order."""

    schema: int
    command: str
    files: list[Rewriting]
