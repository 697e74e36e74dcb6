"""Two revisions of a program compared by what they do at the lathe."""

from __future__ import annotations

import sys
from typing import Unpack

from polarcheck.api.keywords import ExecutionKeywords, PathName, takes
from polarcheck.api.loaded_program import NAMELESS, Call, Program
from polarcheck.api.values import length, short
from polarcheck.checking import check
from polarcheck.foundation.errors import UsageError
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.program.reading.files import LARGEST
from polarcheck.rewrite.compare.comparison_report import Comparison
from polarcheck.rewrite.compare.revision_comparison import Revision, compared, default_tolerance
from polarcheck.rewrite.compare.terms import Terms

#: As for the command [mm].
_LARGEST_TOLERANCE = 10.0


@takes(ExecutionKeywords)
def compare(
    old: PathName,
    new: PathName,
    *,
    tolerance: float | None = None,
    old_machine: PathName | None = None,
    new_machine: PathName | None = None,
    max_size: int = LARGEST,
    **keywords: Unpack[ExecutionKeywords],
) -> Comparison:
    """
    Compare two revisions of a program: whether they make the same metal, and where they differ.

    old, new: the files.
    tolerance: up to this, lengths are the same [mm]; None for the least increment of the control.
    old_machine, new_machine: the lathe of one of them, in place of `machine`.
    max_size: a larger file is not read [bytes].

    Raises SourceError if a file cannot be read, UsageError, JobError or MachineError for a wrong setting,
    TooHardError if a program takes too long.
    """
    calls = (_call("polarcheck.compare()", keywords, machine_of_side) for machine_of_side in (old_machine, new_machine))
    programs = [call.of_path(path, max_size) for call, path in zip(calls, (old, new), strict=True)]
    return _compared("polarcheck.compare()", programs[0], programs[1], tolerance)


@takes(ExecutionKeywords)
def compare_text(
    old: str | bytes,
    new: str | bytes,
    *,
    tolerance: float | None = None,
    old_machine: PathName | None = None,
    new_machine: PathName | None = None,
    name: str = NAMELESS,
    **keywords: Unpack[ExecutionKeywords],
) -> Comparison:
    """
    Compare two texts, as `compare` does two files.

    old, new: the programs.
    tolerance: up to this, lengths are the same [mm]; None for the least increment of the control.
    old_machine, new_machine: the lathe of one of them, in place of `machine`.
    name: the path by which entries of a job file apply to both. No job file is read unless `config` names one, or
        use_config=True asks for the one nearest to this path.

    Raises as `compare` does.
    """
    calls = (
        _call("polarcheck.compare_text()", keywords, machine_of_side) for machine_of_side in (old_machine, new_machine)
    )
    programs = [call.of_text(text, name) for call, text in zip(calls, (old, new), strict=True)]
    return _compared("polarcheck.compare_text()", programs[0], programs[1], tolerance)


def _call(function: str, keywords: ExecutionKeywords, machine: PathName | None) -> Call:
    return Call(function, ExecutionKeywords, keywords if machine is None else {**keywords, "machine": machine})


def _compared(function: str, old: Program, new: Program, tolerance: float | None) -> Comparison:
    argument = f"{function}: tolerance"
    same = None if tolerance is None else length(argument, tolerance, sys.float_info.max, "a length above 0 [mm]")
    if same is not None and same > _LARGEST_TOLERANCE:
        raise UsageError(f"{argument}: expected {_LARGEST_TOLERANCE:g} mm at most, found {short(tolerance)}")
    seconds = sum(program.settings.job.run.max_seconds for program in (old, new))
    with time_limit(seconds_for(len(old.data) + len(new.data), seconds)):
        first, second = (
            Revision(
                program.path,
                program.settings.name,
                check.read(
                    program.data,
                    program.settings.machine,
                    program.settings.job,
                    program.path,
                    program.settings.encoding,
                ),
            )
            for program in (old, new)
        )
        return compared(first, second, Terms(same or default_tolerance(first, second)))
