"""What a program makes."""

from __future__ import annotations

from typing import Unpack

import msgspec

from polarcheck.api.keywords import PartKeywords, PathName, takes
from polarcheck.api.loaded_program import NAMELESS, Call, Program
from polarcheck.checking import check
from polarcheck.foundation.finding import Finding, MadeShape, NotEvaluated, PartComparison
from polarcheck.program.reading.files import LARGEST
from polarcheck.reports.made_parts.compared_contours import compared_in
from polarcheck.reports.made_parts.part_report import part_of
from polarcheck.rules.causes import READ_OTHERWISE

#: The rule that compares a part with its drawing. Rules whose findings make the part doubtful run beside it.
RULES = ("part-differs-from-drawing", *READ_OTHERWISE)
#: What adds the part, and its comparison, to a report.
EXTRAS = part_of, compared_in
_MORE = {"select": RULES, "gives_verdicts": False}


class MadePart(msgspec.Struct, frozen=True, kw_only=True):
    """
    What a program makes; an entry of `files` in `polarcheck part --format json`.

    path: as it is reported.
    machine: its id, the name of a built-in machine or that of a machine file without folder and ending.
    part: the shapes, in the order of the program.
    compared: its contours beside those asked for.
    findings: where it differs from them, or why nothing of this can be believed.
    not_evaluated: what could not be compared, and why.
    """

    path: str
    machine: str
    part: list[MadeShape]
    compared: list[PartComparison]
    findings: list[Finding]
    not_evaluated: list[NotEvaluated]


@takes(PartKeywords)
def part(path: PathName, *, max_size: int = LARGEST, **keywords: Unpack[PartKeywords]) -> MadePart:
    """
    Return what a program makes: of each polar section and depth the shape with its sizes [mm, deg].

    With `part` or `drawings` it is compared with them.

    max_size: a larger file is not read [bytes].

    Raises SourceError if the file cannot be read, UsageError, JobError or MachineError for a wrong setting,
    TooHardError if the program takes too long.
    """
    return _part(Call("polarcheck.part()", PartKeywords, keywords, _MORE).of_path(path, max_size))


@takes(PartKeywords)
def part_text(text: str | bytes, *, name: str = NAMELESS, **keywords: Unpack[PartKeywords]) -> MadePart:
    """
    Return what a text makes, as `part` does of a file.

    name: the path that it is reported as, and by which entries of a job file apply to it. No job file is read unless
        `config` names one, or use_config=True asks for the one nearest to this path.

    Raises as `part` does.
    """
    return _part(Call("polarcheck.part_text()", PartKeywords, keywords, _MORE).of_text(text, name))


def _part(program: Program) -> MadePart:
    settings = program.settings
    with program.runs() as runs:
        report = check.check_runs(runs, settings.rules, settings.severities, settings.inline)
        for extra in EXTRAS:
            report = extra(report, runs)
    return MadePart(
        path=report.path,
        machine=settings.machine_id,
        part=report.part or [],
        compared=report.compared or [],
        findings=report.findings,
        not_evaluated=report.not_evaluated,
    )
