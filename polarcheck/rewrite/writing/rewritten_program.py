"""A program read, judged, and rewritten by one of the functions of this package."""

from __future__ import annotations

from collections.abc import Callable

from polarcheck.checking import check
from polarcheck.checking.settings import Settings
from polarcheck.foundation.states import MM_PER_INCH, Units
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.rewrite.writing.original import Original, read
from polarcheck.rewrite.writing.outcome import Outcome, Refusal, RefusedError
from polarcheck.rules.causes import READ_OTHERWISE
from polarcheck.rules.rule import load_all

#: A function that rewrites a program.
Work = Callable[[Original], Outcome]

#: Reading the original, making the new program and reading that, each with the time of a check.
_CHECKS = 3


def rewritten(path: str, data: bytes, settings: Settings, work: Work) -> Outcome:
    """
    Return what comes of rewriting a program.

    path: as it is shown. data: its bytes. settings: its machine, job and encoding.

    Raises RefusedError, SourceError; TooHardError where it takes too long.
    """
    with time_limit(seconds_for(len(data), _CHECKS * settings.job.run.max_seconds)):
        original = read(path, data, settings)
        _refuse_other_control(original)
        return work(original)


def in_mm(original: Original, length: float) -> float:
    """Return a length [mm] that its user wrote in the units of the program: those in force at its end."""
    units = original.trace.lengths.units
    return length * MM_PER_INCH if len(units) and units[-1] == Units.INCH else length


def _refuse_other_control(original: Original) -> None:
    """Raise RefusedError for a program for another control: read for this one, its words mean something else."""
    rules = [rule for name, rule in load_all().items() if name in READ_OTHERWISE]
    findings = check.check_runs([("", original.tables)], rules, original.settings.severities).findings
    if findings:
        machine = original.settings.machine_id
        raise RefusedError(
            [
                Refusal(finding.line, f"read for {machine}, it means something else: {finding.message}")
                for finding in findings
            ]
        )
