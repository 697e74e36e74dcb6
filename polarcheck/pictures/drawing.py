"""From the runs of a file to what is drawn of it, in the process that checks the file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any, TypeVar

import numpy as np

from polarcheck.checking.channels import first_runs
from polarcheck.checking.polar_sections import polar_sections
from polarcheck.checking.tables import Tables
from polarcheck.errors import TooHardError
from polarcheck.finding import FileReport, Finding, MadeShape
from polarcheck.parts.part_report import made_by
from polarcheck.pictures.picture import Drawn, Mark, SectionPicture
from polarcheck.table.trace import Trace

#: Sections of a file that are drawn.
_MOST = 200

Made = TypeVar("Made")


class DrawnReport(FileReport, frozen=True, kw_only=True):
    """A report with what is drawn of its program; `apart` takes it off before the report is told."""

    drawn: Drawn


def drawn(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """The report with the pictures of the program; of the two runs with block skip those of the first."""
    channels = first_runs(runs)
    remarks: list[str] = []
    lines = np.array(sorted({found.line for found in _all([*report.findings, *report.silenced])}), np.int64)
    found: list[SectionPicture] = []
    for _, tables in channels:
        try:
            found += _sections(tables, lines, remarks)
        except TooHardError as error:
            remarks.append(f"not drawn: {error}")
    found.sort(key=lambda section: section.line)
    if len(found) > _MOST:
        remarks.append(f"only the first {_MOST} of {len(found)} polar sections are drawn")
    states = dict.fromkeys(state for state, _ in channels if state)
    shown = Drawn(sections=found[:_MOST], skip=next(iter(states), ""), remarks=list(dict.fromkeys(remarks)))
    fields = {name: getattr(report, name) for name in FileReport.__struct_fields__}
    return DrawnReport(**fields, drawn=shown)


def apart(report: FileReport) -> tuple[FileReport, Drawn | None]:
    """The report as it is told, and what is drawn of its program, where that was asked for."""
    if not isinstance(report, DrawnReport):
        return report, None
    return FileReport(**{name: getattr(report, name) for name in FileReport.__struct_fields__}), report.drawn


def _all(findings: Sequence[Finding]) -> list[Finding]:
    return [*findings, *chain.from_iterable(found.follows for found in findings)]


def _sections(tables: Tables, lines: Any, remarks: list[str]) -> list[SectionPicture]:
    """The pictures of one run. lines: those of findings. remarks: are given what is not drawn."""
    trace: Trace = tables["trace"]
    told = polar_sections(tables)
    if not told:
        return []
    from polarcheck.pictures.marks import left_marks, overcut_marks
    from polarcheck.pictures.moves import SectionMoves
    from polarcheck.pictures.sections import Beside, section_picture
    from polarcheck.table.moves import programmed_moves

    moves = SectionMoves(trace, tables["dynamics"])
    programmed = programmed_moves(trace)
    levels = _unless_too_hard(lambda: tables["finished"].levels, "the finished part", remarks)
    meant = _unless_too_hard(lambda: tables["finished"].meant, "the finished part", remarks)
    makes = _unless_too_hard(lambda: made_by(tables), "what the program makes", remarks)
    marks: list[tuple[int, Mark]] = [
        *_unless_too_hard(
            lambda: list(overcut_marks(trace, tables["moves"], tables["overcuts"], levels)), "what is overcut", remarks
        ),
        *_unless_too_hard(
            lambda: list(left_marks(trace, tables["coverage"], levels)), "what is left standing", remarks
        ),
    ]
    return [
        section_picture(
            trace,
            moves,
            programmed,
            one,
            number,
            lines,
            Beside(
                [level for level in (*levels, *meant) if level.section == number],
                [mark for section, mark in marks if section == number],
                list(dict.fromkeys(_in_words(made) for made in makes if made.line == one.line)),
            ),
        )
        for number, one in enumerate(told[:_MOST])
    ]


def _in_words(made: MadeShape) -> str:
    left = "".join(f"; left standing: {one.text}" for one in made.left_standing)
    needs = f"; {made.needs}" if made.needs and made.shape is not None else ""
    return f"{made.text}{left}{needs}"


def _unless_too_hard(make: Callable[[], list[Made]], what: str, remarks: list[str]) -> list[Made]:
    try:
        return make()
    except TooHardError as error:
        remarks.append(f"{what} is not drawn: {error}")
        return []
