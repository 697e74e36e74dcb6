"""Draws the runs of a file, in the process that checks the file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from polarcheck.checking.channels import first_runs
from polarcheck.checking.polar_sections import polar_sections
from polarcheck.checking.tables import Tables
from polarcheck.columns.trace import Trace
from polarcheck.errors import TooHardError
from polarcheck.finding import FileReport, Finding, MadeShape, PolarSection
from polarcheck.parts.part_report import made_by
from polarcheck.pictures.listing import listing
from polarcheck.pictures.picture import Drawn, Mark, SectionPicture

if TYPE_CHECKING:
    from polarcheck.table.bar import Known

#: The most sections of a file that are drawn.
_MOST = 200

Element = TypeVar("Element")


class DrawnReport(FileReport, frozen=True, kw_only=True):
    """
    A report with the drawing of its program; `split` takes the drawing off before the report is written.

    drawn: the drawing.
    """

    drawn: Drawn


def drawn(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """Return the report with the pictures of the program; of two runs with block skip the first is drawn."""
    channels = first_runs(runs)
    remarks: list[str] = []
    lines = np.array(sorted({finding.line for finding in _all([*report.findings, *report.silenced])}), np.int64)
    sections: list[SectionPicture] = []
    for _, tables in channels:
        try:
            sections += _sections(tables, lines, remarks)
        except TooHardError as error:
            remarks.append(f"not drawn: {error}")
    sections.sort(key=lambda section: section.line)
    if len(sections) > _MOST:
        remarks.append(f"only the first {_MOST} of {len(sections)} polar sections are drawn")
    states = dict.fromkeys(state for state, _ in channels if state)
    source, source_line, source_lines = listing(
        channels[0][1]["text"].source, [*lines.tolist(), *(section.line for section in sections)]
    )
    shown = Drawn(
        sections=sections[:_MOST],
        skip=next(iter(states), ""),
        remarks=list(dict.fromkeys(remarks)),
        source=source,
        source_line=source_line,
        source_lines=source_lines,
    )
    fields = {name: getattr(report, name) for name in FileReport.__struct_fields__}
    return DrawnReport(**fields, drawn=shown)


def split(report: FileReport) -> tuple[FileReport, Drawn | None]:
    """Return the report to write, and the drawing of its program, if one was requested."""
    if not isinstance(report, DrawnReport):
        return report, None
    return FileReport(**{name: getattr(report, name) for name in FileReport.__struct_fields__}), report.drawn


def _all(findings: Sequence[Finding]) -> list[Finding]:
    return [*findings, *chain.from_iterable(finding.follows for finding in findings)]


def _sections(tables: Tables, lines: Any, remarks: list[str]) -> list[SectionPicture]:
    """
    Return the pictures of one run.

    lines: the lines with findings.
    remarks: takes a line for each thing that is not drawn.
    """
    trace: Trace = tables["trace"]
    sections = polar_sections(tables)
    if not sections:
        return []
    from polarcheck.pictures.marks import left_marks, overcut_marks
    from polarcheck.pictures.moves import SectionMoves
    from polarcheck.pictures.sections import Extras, section_picture
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
    bar = _bar(tables)
    return [
        section_picture(
            trace,
            moves,
            programmed,
            section,
            number,
            lines,
            Extras(
                [level for level in (*levels, *meant) if level.section == number],
                [mark for of_section, mark in marks if of_section == number],
                list(dict.fromkeys(_in_words(shape) for shape in makes if _is_of(shape, section))),
                bar,
            ),
        )
        for number, section in enumerate(sections[:_MOST])
    ]


def _bar(tables: Tables) -> tuple[float, float]:
    """Return the diameter of the bar before milling, its largest where there are two, and of its bore [mm]."""
    known: Known = tables["bar"].known
    return known.smallest if np.isnan(known.largest) else known.largest, known.bore


def _is_of(shape: MadeShape, section: PolarSection) -> bool:
    """True for a section that makes a shape, or some of it."""
    return any(one.line == section.line for one in shape.sections)


def _in_words(shape: MadeShape) -> str:
    left = "".join(f"; left standing: {rest.text}" for rest in shape.left_standing)
    needs = f"; {shape.needs}" if shape.needs and shape.shape is not None else ""
    return f"{shape.text}{left}{needs}"


def _unless_too_hard(make: Callable[[], list[Element]], what: str, remarks: list[str]) -> list[Element]:
    try:
        return make()
    except TooHardError as error:
        remarks.append(f"{what} is not drawn: {error}")
        return []
