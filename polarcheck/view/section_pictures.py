"""
A polar section as a picture.

Import late: shapely is slow to import.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import msgspec
import numpy as np

from polarcheck.columns.contour.overcuts import curves_of
from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows, States, mask_at
from polarcheck.foundation.arrays import Points as PlanePoints
from polarcheck.foundation.finding import PolarSection
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.parts.as_meant import as_meant
from polarcheck.rules.quantity import rounded
from polarcheck.rules.wording.offsets import called_tool, to_give
from polarcheck.view import instants, path_points, rate_curves
from polarcheck.view.drawn_moves import LENGTH, POSITIONING, RATE, TIME, SectionMoves, numbers_of
from polarcheck.view.extent import bar_rings, frame
from polarcheck.view.finding_views import Wanted
from polarcheck.view.path_points import Chords
from polarcheck.view.picture_data import DrawnPart, Mark, PartPicture, Points, Rates, SectionPicture, Writing


def writing(trace: Trace, section: int) -> Writing:
    """Return how points are written in a section of a trace."""
    sections = trace.mode.sections
    enter, leave = int(sections.enter[section]), int(sections.leave[section])
    rows = np.arange(enter, max(leave, enter + 1))
    moving = rows[trace.path.travels[rows]]
    origin, turn = _origin(trace, moving if len(moving) else rows[:1])
    linear = int(trace.axes.linear_axis[enter])
    return Writing(
        linear=_address(chr(linear) if linear else trace.machine.polar.linear_address),
        virtual=_address(trace.axes.virtual_axis_of(enter)),
        virtual_diameter=trace.machine.polar.virtual_axis_programming == "diameter",
        origin=None if np.isnan(origin) else (round(origin.real, LENGTH) + 0.0, round(origin.imag, LENGTH) + 0.0),
        turn=round(turn, LENGTH),
    )


def _address(name: str) -> str:
    """Return what stands before the number: C, but C2= for a name of more than one character."""
    return f"{name}=" if len(name) > 1 else name


def _origin(trace: Trace, rows: Rows) -> tuple[complex, float]:
    """Return the zero of the program on the plane [mm] and the turn of its axes [deg]; NaN unless all rows agree."""
    path = trace.path
    shift, turn = -path.center_shift[rows], np.zeros(1)
    if path.frames is not None:
        shift, turn = shift + path.frames.shift[rows], path.frames.angle[rows]
    agrees = bool(np.all(shift == shift[0]) and np.all(turn == turn[0]))
    return (complex(shift[0]), float(turn[0])) if agrees else (complex(np.nan, np.nan), 0.0)


#: The most points of each path and curve of a section, not counting those with findings.
POINTS = 20_000
#: The same for all sections of a program together; each section has at least _LEAST.
_OF_PROGRAM, _LEAST = 60_000, 200
#: Chords computed for each point that may remain.
_CHORDS = 20
#: A chord lies no farther from its arc than this share of the narrowest window.
_OF_WINDOW = 400
#: The first tolerance of thinning, as a share of the largest invisible deviation.
_FINEST = 1 / 16


class Extras(msgspec.Struct, frozen=True):
    """
    The content of a section's picture besides its moves.

    parts: returns the part at each depth, within a tolerance [mm].
    nominal: returns the part of the job, likewise.
    marks: areas that are overcut or left standing.
    makes: the shapes that the section makes, in words.
    bar: the outside diameter of the bar that the section meets, and of its bore; NaN if unknown [mm].
    face: Z of the face of the bar; NaN if unknown [mm].
    window: the narrowest window in which a finding of it is shown; inf if none has one [mm].
    """

    parts: Callable[[float], list[PartPicture]]
    nominal: Callable[[float], list[DrawnPart]]
    marks: Sequence[Mark]
    makes: Sequence[str]
    bar: tuple[float, float]
    face: float
    window: float


def section_picture(
    trace: Trace,
    table: SectionMoves,
    programmed: Moves,
    summary: PolarSection,
    section: int,
    requested: Wanted,
    extras: Extras,
) -> tuple[SectionPicture, Rows]:
    """
    Return the picture of one section, and the moves in its table as numbers of the moves of the program.

    table: the moves of the program.
    programmed: the programmed path of the program.
    summary: the section in the report.
    section: its number.
    requested: the lines with findings, whose moves stay.
    extras: its other content.
    """
    chosen = table.of_section(section)
    moves = table.moves[_mask(chosen, len(table))]
    most = max(min(POINTS, _OF_PROGRAM // len(trace.mode.sections)), _LEAST)
    role, is_known = table.role[chosen], table.is_known[chosen]
    line = trace.blocks.line_in_file[moves.row]
    keep = np.isin(line, requested.findings)
    path_moves = programmed[programmed.section == section]
    unseen = path_points.unseen(_plane_points(moves, role))
    chord = min(unseen / 2, extras.window / _OF_WINDOW)
    tool, off = _path(moves, is_known, keep, role, chord, unseen, most)
    contour, off_contour = _path(
        path_moves, path_moves.known, np.isin(path_moves.row, moves.row[keep]), path_moves.phase, chord, unseen, most
    )
    path = rate_curves.path_segments(table, chosen)
    path = msgspec.structs.replace(path, move=np.searchsorted(chosen, path.move))
    c_axis = trace.path.c_axis
    every = instants.samples(path, table.dynamics.c_limit, c_axis.sense, most)
    curves, off_time = rate_curves.thinned(every, keep, most)
    # The first of the moves of each block.
    first = _first_of(moves.row, path_moves.row[contour.move])
    extremes = (table.c_feed[chosen], table.x_feed[chosen], -moves.nearest)
    listed = _listed(
        keep | np.isin(line, requested.also), [tool.move, first, curves.move, *map(_highest, extremes)], most
    )
    enter = int(trace.mode.sections.enter[section])
    limits = trace.machine.limits
    picture = SectionPicture(
        title=_title(summary),
        line=summary.line,
        end_line=summary.end_line,
        channel=trace.text.source.channel or "",
        units=summary.units,
        scale=MM_PER_INCH if summary.units == "inch" else 1.0,
        diameter=bool(trace.lengths.x_factor[enter] < 1),
        radius=summary.radius,
        radius_source=summary.radius_source,
        stock=rounded(trace.lengths.stock_diameter[enter]),
        keep_out=rounded(limits.keep_out),
        c_limit=rounded(limits.c_feed),
        x_limit=rounded(limits.x_feed),
        feed_limit=rounded(limits.polar_feed),
        needs_radius=_why_unknown(trace, table.moves, chosen),
        thinned=round(max(off, off_contour), LENGTH),
        played=round(off_time, LENGTH),
        time=summary.time,
        programmed=_points(contour, _index_of(listed, first)),
        tool=_points(tool, _index_of(listed, tool.move)),
        moves=table.table(chosen[listed]),
        move_count=len(chosen),
        rates=Rates(
            t=numbers_of(curves.t, TIME),
            c_feed=numbers_of(curves.c_feed, RATE),
            x_feed=numbers_of(curves.x_feed, RATE),
            feed=numbers_of(curves.feed, RATE),
            move=_index_of(listed, curves.move).tolist(),
            x=numbers_of(curves.point.real, LENGTH),
            c=numbers_of(curves.point.imag, LENGTH),
            z=numbers_of(curves.z, LENGTH),
            angle=numbers_of(curves.angle, RATE),
            machine_x=numbers_of(_side_of_x(moves, c_axis.is_fixed) * np.abs(curves.point), LENGTH),
        ),
        parts=extras.parts(unseen),
        marks=list(extras.marks),
        makes=list(extras.makes),
        remarks=_remarks(len(chosen), len(listed), as_meant(trace, section)),
        writing=writing(trace, section),
        entry=round(float(trace.path.section_entry[section]), RATE),
        entry_known=bool(trace.path.knows_section_entry[section]),
        sense=c_axis.sense,
        frame=frame(np.concatenate([tool.point, contour.point]), summary.radius, extras.bar[0]),
        bar=bar_rings(*extras.bar),
        face=rounded(extras.face),
        drawing=extras.nominal(unseen),
    )
    return picture, chosen[listed]


def _side_of_x(moves: Moves, is_fixed: bool) -> int:
    """Return -1 for a section that begins on the negative side of X, where the machine stays then; else 1."""
    first = complex(moves.start[0]) if len(moves) else 0.0
    return -1 if first.imag == 0 and first.real < 0 and not is_fixed else 1


def _mask(chosen: Rows, count: int) -> Mask:
    return mask_at(count, chosen)


def _plane_points(moves: Moves, role: States) -> PlanePoints:
    """Return the points that decide the size of the picture: those of cuts, if there are any, and the center of C."""
    is_cut = role != POSITIONING
    chosen = is_cut if is_cut.any() else np.ones(len(moves), bool)
    return np.concatenate([moves.start[chosen], moves.end[chosen], np.zeros(1, complex)])


def _path(
    moves: Moves, is_known: Mask, keep: Mask, look: States, chord: float, unseen: float, most: int
) -> tuple[Chords, float]:
    """Return the path of the known moves, and its largest deviation [mm]."""
    curves = curves_of(moves, np.zeros(len(moves), np.int64), is_known)
    path, off = path_points.chords(curves, chord, _CHORDS * most)
    path = Chords(path.point, np.flatnonzero(is_known)[path.move], path.begins)
    path, more = path_points.thinned(path, keep, look, _FINEST * unseen, most)
    return path, off + more


def _first_of(row: Rows, requested: Rows) -> Rows:
    """Return the first move of each wanted row; the moves of a row need not be adjacent."""
    rows, first = np.unique(row, return_index=True)
    return (
        np.asarray(first[np.minimum(np.searchsorted(rows, requested), len(rows) - 1)]) if len(rows) else requested[:0]
    )


def _listed(keep: Mask, drawn: Sequence[Rows], most: int) -> Rows:
    """Return the moves in the table: all moves or, if there are too many, those that are drawn or have an extreme."""
    if len(keep) <= most:
        return np.arange(len(keep))
    is_listed = keep.copy()
    is_listed[[0, -1]] = True
    for moves in drawn:
        is_listed[moves] = True
    return np.flatnonzero(is_listed)


def _highest(values: Floats) -> Rows:
    """Return the index of the highest value as an array; empty if there are no values."""
    highest = np.where(np.isnan(values), -np.inf, values)
    return np.flatnonzero(highest == highest.max(initial=-np.inf))[:1]


def _index_of(listed: Rows, move: Rows) -> Rows:
    """Return the row of moves in the table."""
    return np.asarray(np.searchsorted(listed, move))


def _points(path: Chords, move: Rows) -> Points:
    """Return the columns of a path, with a gap before each connected piece but the first."""
    gap = np.flatnonzero(path.begins)[1:]
    point = np.insert(path.point, gap, complex(np.nan, np.nan))
    moves = np.insert(move.astype(float), gap, np.nan)
    numbers = numbers_of(moves, 0)
    return Points(
        x=numbers_of(point.real, LENGTH),
        c=numbers_of(point.imag, LENGTH),
        move=[None if number is None else int(number) for number in numbers],
    )


def _remarks(count: int, listed: int, intended: str) -> list[str]:
    remarks = [intended] if intended else []
    return [*remarks, f"the table lists {listed} of {count} moves: those that are drawn"] if listed < count else remarks


def _title(summary: PolarSection) -> str:
    """`lines 4 to 30, offset 8`."""
    lines = f"lines {summary.line} to {summary.end_line}"
    return lines if summary.offset is None else f"{lines}, offset {summary.offset}"


def _why_unknown(trace: Trace, moves: Moves, chosen: Rows) -> str:
    """Return why the tool path of chosen moves is unknown, and what to give; empty if it is known."""
    unknown = moves.row[chosen[~moves.is_of_tool[chosen]]]
    if not len(unknown):
        return ""
    lacking = unknown[np.isnan(trace.compensation.radius_of_move[unknown])]
    _, first = np.unique(trace.tools.offset_number[lacking], return_index=True)
    rows = lacking[np.sort(first)].tolist()
    if not rows:
        line = int(trace.blocks.line_in_file[unknown[0]])
        return f"the path of the tool is not known from line {line} on: a position there is not known"
    missing = ", ".join(f"R of {called_tool(trace.tools, row)}" for row in rows if trace.tools.offset_number[row])
    remedies = "; ".join(to_give(trace.tools, trace.machine, row, "radius") for row in rows)
    return f"what is run with G41 or G42 is drawn as programmed: {missing or 'R'} is not known; {remedies}"
