"""Phrases of the rules about the state of the lathe around the section."""

from __future__ import annotations

from polarcheck.checking.other_machine import OtherMachine
from polarcheck.table.entry import Entry
from polarcheck.table.trace import Trace


def name(entry: Entry, row: int) -> str:
    """What shifts the origin: work offset, G52, or both."""
    shifts = [str(entry.work_offset_name[row])] if entry.work_offset_shift[row] else []
    return " and ".join([*shifts, entry.trace.machine.codes("local_shift")[0]] if entry.local_shift[row] else shifts)


def comment(trace: Trace, row: int) -> str:
    """The comment that R was taken from."""
    return trace.radius_comments[int(trace.offset_number[row])].comment


def fit(other_machine: OtherMachine) -> str:
    """Which machines read the program well, and why."""
    return other_machine.text
