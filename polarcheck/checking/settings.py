"""What the check of a file needs to know besides the file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import msgspec

from polarcheck.checking.rule import Rule
from polarcheck.checking.tables import Tables
from polarcheck.finding import FileReport
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine

#: What adds to the report of a file something that is asked for, from the tables of its runs (check.read).
Extra = Callable[[FileReport, Sequence[tuple[str, Tables]]], FileReport]


class Settings(msgspec.Struct, frozen=True):
    """
    What applies to a program.

    name: of the machine, as it was asked for. rules: those to run. severities: error, warning, note or off by rule,
    where they differ from the machine's. read: the files that all this was read from. fail_on: the least severity that
    fails, or never. strict: whether a file that is unverified fails, too. encoding: of the program; None where it is
    found out. inline: whether comments of the program that allow something are heeded. extras: functions of modules,
    so that other processes know them, in the order in which they are called.
    """

    name: str
    machine: Machine
    job: Job
    rules: Sequence[Rule]
    severities: Mapping[str, str]
    read: Sequence[Path] = ()
    fail_on: str = "warning"
    strict: bool = False
    encoding: str | None = None
    inline: bool = True
    extras: Sequence[Extra] = ()
