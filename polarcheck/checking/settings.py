"""The settings with which a file is checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import msgspec

from polarcheck.foundation.finding import Decided, FileReport
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.rule import Rule
from polarcheck.rules.tables import Tables

#: A function that adds a requested section to the report of a file, from the tables of its runs (check.read).
Extra = Callable[[FileReport, Sequence[tuple[str, Tables]]], FileReport]


class Settings(msgspec.Struct, frozen=True):
    """
    The settings that apply to a program.

    name: of the machine, as given by the user.
    machine, job: the merged profile and the job.
    rules: the selected rules.
    severities: error, warning, note or off by rule, where they differ from the machine's.
    read: the files and folders that were read or looked for to make the settings.
    job_file: the nearest job file; None without one.
    fail_on: the lowest severity that fails a file, or never.
    strict: an unverified file fails, too.
    encoding: of the program; None to detect it.
    inline: allow comments of the program are respected.
    baseline: the file of known findings.
    baseline_named_by: the place in the job file that names it; empty if an option does.
    deselected: lines on what keeps rules of weight from running.
    decided: what of this the user has written, for reports.
    differs: the files of the run have different settings, so that its report says what decided for each.
    profile_sha256: of the machine.
    doubtful: keys of the machine whose values are in doubt.
    extras: module-level functions, since other processes import them by name; called in this order.
    """

    name: str
    machine: Machine
    job: Job
    rules: Sequence[Rule]
    severities: Mapping[str, str]
    read: Sequence[str] = ()
    job_file: Path | None = None
    fail_on: str = "warning"
    strict: bool = False
    encoding: str | None = None
    inline: bool = True
    baseline: Path | None = None
    baseline_named_by: str = ""
    deselected: Sequence[str] = ()
    decided: Decided = Decided()
    differs: bool = False
    profile_sha256: str = ""
    doubtful: Sequence[str] = ()
    extras: Sequence[Extra] = ()

    @property
    def machine_id(self) -> str:
        """The id of the machine: its name, or that of its file without folder and ending."""
        return profiles.machine_id(self.name)

    @property
    def machine_file(self) -> str:
        """The path of a machine file of the user's own, as given; empty for a built-in machine."""
        return "" if self.name in profiles.names() else self.name
