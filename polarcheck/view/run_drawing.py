"""Draws the runs of a file, in the process that checks the file."""

from __future__ import annotations

import cmath
import contextlib
import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from polarcheck.checking.channel_reports import first_runs
from polarcheck.checking.polar_sections import polar_sections
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import FileReport, MadeShape, PolarSection
from polarcheck.reports.made_parts.part_report import depths_of, made_by
from polarcheck.rules.tables import Tables
from polarcheck.view.drawn_moves import LENGTH, SectionMoves
from polarcheck.view.finding_views import Face, Spot, Spots, Wanted, with_followers
from polarcheck.view.picture_data import Drawn, FindingLocation, Key, Mark, PartPicture, SectionPicture, key_of

if TYPE_CHECKING:
    from polarcheck.columns.metal.bar import Bar
    from polarcheck.parts.made_depths import Depth
from collections.abc import Iterable

from polarcheck.program.reading.excerpt import shortened
from polarcheck.program.reading.source import Source

#: The most lines and characters of a page, and characters of a line.
_LINES, _CHARACTERS, _WIDE = 100_000, 4_000_000, 400
#: Lines shown before the first one that matters, if not all are shown.
_BEFORE = 200


def listing(source: Source, requested: Iterable[int]) -> tuple[list[str], int, int]:
    """
    Return lines of a file, the number of the first of them, and the number of all lines.

    requested: the lines with findings and sections; if not all lines are shown, these begin shortly before the first.
    """
    is_whole = len(source.code) <= _CHARACTERS
    text = source.text if is_whole else ""
    count = source.parts[0].first_line - 1 if source.parts else len(source.line_starts)
    first = 1
    if count > _LINES or not is_whole:
        first = max(1, min((line for line in requested if line > 0), default=1) - _BEFORE)
    lines: list[str] = []
    remaining = _CHARACTERS
    for line in range(first, min(first + _LINES, count + 1)):
        line_text = _line(source, line, text)
        remaining -= len(line_text)
        if remaining < 0:
            break
        lines.append(line_text)
    return lines, first, count


def _line(source: Source, line: int, text: str) -> str:
    """Return a line. text: all of the file, or nothing if it is long."""
    start = int(source.line_starts[line - 1])
    end = int(source.line_starts[line]) if line < len(source.line_starts) else len(source.code)
    end = min(end, start + 2 * _WIDE)
    return shortened((text[start:end] if text else source.excerpt(start, end)).rstrip("\r\n"), _WIDE)


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
    channels = [tables for _, tables in first_runs(runs)]
    remarks: list[str] = []
    spots = _spots(report, [Spots(tables) for tables in channels])
    lines = {key[1] for key in spots}
    also = {line for _, spot in spots.values() for line in spot.also}
    requested = Wanted(*(np.array(sorted(lines_of_kind), np.int64) for lines_of_kind in (lines, also)))
    sections: list[_Section] = []
    for run, tables in enumerate(channels):
        try:
            spots_of_run = [spot for of_run, spot in spots.values() if of_run == run]
            sections += _sections(run, tables, spots_of_run, requested, remarks)
        except TooHardError as error:
            remarks.append(f"not drawn: {error}")
    sections.sort(key=lambda section: section.picture.line)
    if len(sections) > _MOST:
        remarks.append(f"only the first {_MOST} of {len(sections)} polar sections are drawn")
        del sections[_MOST:]
    states = dict.fromkeys(state for state, _ in first_runs(runs) if state)
    first_lines = (section.picture.line for section in sections)
    source, source_line, source_lines = listing(channels[0]["text"].source, [*lines, *first_lines])
    drawing = Drawn(
        sections=[section.picture for section in sections],
        skip=next(iter(states), ""),
        remarks=list(dict.fromkeys(remarks)),
        places={key: _location(run, spot, sections) for key, (run, spot) in spots.items()},
        source=source,
        source_line=source_line,
        source_lines=source_lines,
    )
    fields = {name: getattr(report, name) for name in FileReport.__struct_fields__}
    return DrawnReport(**fields, drawn=drawing)


def split(report: FileReport) -> tuple[FileReport, Drawn | None]:
    """Return the report to write, and the drawing of its program, if one was requested."""
    if not isinstance(report, DrawnReport):
        return report, None
    return FileReport(**{name: getattr(report, name) for name in FileReport.__struct_fields__}), report.drawn


class _Section(NamedTuple):
    """
    The picture of a section.

    run: the number of its run. number: its number in that run. listed: the moves in its table, numbers of its run.
    face: where the tool stands.
    """

    run: int
    number: int
    picture: SectionPicture
    listed: Rows
    face: Face


def _spots(report: FileReport, runs: Sequence[Spots]) -> dict[Key, tuple[int, Spot]]:
    """Return for each finding the number of its run, and its place there."""
    by_key: dict[Key, tuple[int, Spot]] = {}
    for finding in with_followers([*report.findings, *report.silenced]):
        key = key_of(finding)
        of_channel = [number for number, spots in enumerate(runs) if key[3] in ("", spots.channel)]
        run = next((number for number in of_channel if runs[number].has(finding)), next(iter(of_channel), 0))
        by_key.setdefault(key, (run, runs[run].of(finding)))
    return by_key


def _location(run: int, spot: Spot, sections: Sequence[_Section]) -> FindingLocation:
    """Return the place of a finding among the pictures of the program."""
    index_by_number = {section.number: index for index, section in enumerate(sections) if section.run == run}
    if not spot.rows or not index_by_number:
        return FindingLocation(section=None, move=None, places=[], span=None, also=spot.also, is_beside=True)
    face = sections[next(iter(index_by_number.values()))].face
    row = spot.rows[0]
    number = face.nearest_section(row)
    index_shown = index_by_number.get(
        number, index_by_number[min(index_by_number, key=lambda section_number: abs(section_number - number))]
    )
    picture, listed = sections[index_shown].picture, sections[index_shown].listed
    positions = [*spot.known, *(face.place(row, spot.where) for row in spot.rows[len(spot.known) :])]
    points = dict.fromkeys(
        (round(point.real, LENGTH), round(point.imag, LENGTH)) for point in positions if cmath.isfinite(point)
    )
    move = int(np.searchsorted(listed, face.move(row, spot.where)))
    wide = max(picture.frame[2] - picture.frame[0], picture.frame[3] - picture.frame[1])
    return FindingLocation(
        section=index_shown,
        move=min(move, len(listed) - 1) if len(listed) else None,
        places=list(points),
        span=None if spot.span is None else round(min(spot.span, wide), LENGTH),
        also=spot.also,
        is_beside=not len(face.moves_of(row)),
    )


def _sections(run: int, tables: Tables, spots: Sequence[Spot], requested: Wanted, remarks: list[str]) -> list[_Section]:
    """
    Return the pictures of one run.

    run: its number.
    spots: the places of its findings.
    requested: the lines with findings.
    remarks: takes a line for each thing that is not drawn.
    """
    trace: Trace = tables["trace"]
    sections = polar_sections(tables)
    if not sections:
        return []
    from polarcheck.columns.path.moves import programmed_moves
    from polarcheck.view.marks import left_marks, overcut_marks
    from polarcheck.view.nominal_positions import drawn_parts
    from polarcheck.view.part_rings import parts
    from polarcheck.view.section_pictures import Extras, section_picture
    from polarcheck.view.swept import swept_parts

    moves = SectionMoves(trace, tables["dynamics"])
    programmed = programmed_moves(trace)
    levels = _unless_too_hard(lambda: tables["finished"].levels, "the finished part", remarks)
    intended = _unless_too_hard(lambda: tables["finished"].meant, "the finished part", remarks)
    makes = _unless_too_hard(lambda: made_by(tables), "what the program makes", remarks)
    marks: list[tuple[int, Mark]] = [
        *_unless_too_hard(
            lambda: list(overcut_marks(trace, tables["moves"], tables["overcuts"], levels)), "what is overcut", remarks
        ),
        *_unless_too_hard(
            lambda: list(left_marks(trace, tables["coverage"], levels)), "what is left standing", remarks
        ),
    ]
    face = Face(moves)
    depths: list[Depth] = []
    with contextlib.suppress(TooHardError):  # `makes` says so
        depths = depths_of(tables)

    windows: dict[int, float] = {}
    for spot in spots:
        if spot.rows and spot.span is not None:
            number = int(trace.mode.section[spot.rows[0]])
            windows[number] = min(spot.span, windows.get(number, math.inf))

    def parts_of(section: PolarSection, number: int, tolerance: float) -> list[PartPicture]:
        section_levels = [level for level in (*levels, *intended) if level.section == number]
        shapes = [shape for shape in makes if _is_of(shape, section)]
        pictures = list(parts(trace, section_levels, tolerance))
        return pictures + _unless_too_hard(
            lambda: list(swept_parts(trace, depths, number, _bar(tables, number), tolerance, shapes)),
            "what the cutter leaves",
            remarks,
        )

    return [
        _Section(
            run,
            number,
            *section_picture(
                trace,
                moves,
                programmed,
                section,
                number,
                requested,
                Extras(
                    parts=partial(parts_of, section, number),
                    nominal=partial(drawn_parts, tables, number),
                    marks=[mark for of_section, mark in marks if of_section == number],
                    makes=list(dict.fromkeys(_in_words(shape) for shape in makes if _is_of(shape, section))),
                    bar=_bar(tables, number),
                    face=float(tables["bar"].face_as_written),
                    window=windows.get(number, math.inf),
                ),
            ),
            face,
        )
        for number, section in enumerate(sections[:_MOST])
    ]


def _bar(tables: Tables, number: int) -> tuple[float, float]:
    """
    Return the diameter of the bar that a section meets, and of its bore [mm].

    The largest between its deepest cut and the face, as turning has left it before the section; NaN if unknown.
    """
    bar: Bar = tables["bar"]
    mode = bar.trace.mode
    enter = mode.sections.enter[number : number + 1]
    z = bar.trace.path.z[mode.section == number]
    # Where Z is not known it is the largest of all.
    deepest = np.array([-np.inf if np.isnan(z).all() else np.nanmin(z)])
    inner, outer = bar.inner(enter, deepest), bar.outer(enter, deepest)
    return 2 * float(np.where(np.isnan(outer), inner, outer)[0]), float(bar.bore(enter)[0])


def _is_of(shape: MadeShape, section: PolarSection) -> bool:
    """True for a section that makes a shape, or some of it."""
    return any(polar_section.line == section.line for polar_section in shape.sections)


def _in_words(shape: MadeShape) -> str:
    remainders = "".join(f"; left standing: {rest.text}" for rest in shape.left_standing)
    needs = f"; {shape.needs}" if shape.needs and shape.shape is not None else ""
    return f"{shape.text}{remainders}{needs}"


def _unless_too_hard(make: Callable[[], list[Element]], what: str, remarks: list[str]) -> list[Element]:
    try:
        return make()
    except TooHardError as error:
        remarks.append(f"{what} is not drawn: {error}")
        return []
