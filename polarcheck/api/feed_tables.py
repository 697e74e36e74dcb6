"""The highest F of each block."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import msgspec

from polarcheck.api.keywords import ExecutionKeywords, PathName, takes
from polarcheck.api.loaded_program import NAMELESS, Call, Program
from polarcheck.checking import check
from polarcheck.foundation.finding import Finding
from polarcheck.program.reading.files import LARGEST
from polarcheck.reports.pages.executed import without_radius
from polarcheck.rewrite.feeds.table import FeedTable, feed_table
from polarcheck.rules.causes import READ_OTHERWISE
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables


class Feeds(msgspec.Struct, frozen=True, kw_only=True):
    """
    The highest F of each block of a program.

    path: as it is reported.
    machine: its id, the name of a built-in machine or that of a machine file without folder and ending.
    tables: one for each channel, with its rows, sections and limits.
    findings: why nothing of this can be believed, if the program is for another control.
    missing: in one line, which moves are computed as programmed for want of R, and what to give; else empty.
    """

    path: str
    machine: str
    tables: list[FeedTable]
    findings: list[Finding]
    missing: str


@takes(ExecutionKeywords)
def feeds(path: PathName, *, max_size: int = LARGEST, **keywords: Unpack[ExecutionKeywords]) -> Feeds:
    """
    Return for each cutting block of the polar sections the highest F that keeps the limits of the machine [mm/min].

    max_size: a larger file is not read [bytes].

    Raises SourceError if the file cannot be read, UsageError, JobError or MachineError for a wrong setting,
    TooHardError if the program takes too long.
    """
    call = Call("polarcheck.feeds()", ExecutionKeywords, keywords).with_one_state()
    return _feeds(call.of_path(path, max_size))


@takes(ExecutionKeywords)
def feeds_text(text: str | bytes, *, name: str = NAMELESS, **keywords: Unpack[ExecutionKeywords]) -> Feeds:
    """
    Return the highest F of each block of a text, as `feeds` does of a file.

    name: the path that it is reported as, and by which entries of a job file apply to it. No job file is read unless
        `config` names one, or use_config=True asks for the one nearest to this path.

    Raises as `feeds` does.
    """
    call = Call("polarcheck.feeds_text()", ExecutionKeywords, keywords).with_one_state()
    return _feeds(call.of_text(text, name))


def _feeds(program: Program) -> Feeds:
    with program.runs() as runs:
        findings, missing = doubts(program, runs)
        return Feeds(
            path=program.path,
            machine=program.settings.machine_id,
            tables=[feed_table(tables) for _, tables in runs],
            findings=findings,
            missing="; ".join(missing),
        )


def doubts(program: Program, runs: Sequence[tuple[str, Tables]]) -> tuple[list[Finding], list[str]]:
    """
    Return what makes the feeds of a program doubtful.

    These are findings that it is for another control, and a line for each channel with moves whose R is not known.
    """
    rules = [rule for name, rule in load_all().items() if name in READ_OTHERWISE]
    missing = [without_radius(tables["trace"], tables["tool_center"]) for _, tables in runs]
    return check.check_runs(runs, rules, program.settings.severities).findings, [line for line in missing if line]
