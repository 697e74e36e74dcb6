"""
A polar section as a picture.

Import late: shapely takes its time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows, States
from polarcheck.arrays import Points as PlanePoints
from polarcheck.checking.quantity import rounded
from polarcheck.finding import PolarSection
from polarcheck.machines.modal import MM_PER_INCH
from polarcheck.pictures import paths, rates
from polarcheck.pictures.moves import LENGTH, POSITIONING, RATE, TIME, SectionMoves, numbers_of
from polarcheck.pictures.parts import parts
from polarcheck.pictures.paths import Chords
from polarcheck.pictures.picture import Mark, Points, Rates, SectionPicture
from polarcheck.pictures.unknown_radius import why_unknown
from polarcheck.table.finished import Level
from polarcheck.table.moves import Moves
from polarcheck.table.overcuts import curves_of
from polarcheck.table.trace import Trace

#: Of one section at most: points of each path and of each curve, and moves in the table. Those of findings come on top.
POINTS, MOVES = 20_000, 20_000
#: The same for all sections of a program together; but each has some.
_OF_PROGRAM, _LEAST = 60_000, 200
#: Of so many chords for each point that is left.
_CHORDS = 20
#: With this share of what nobody sees the thinning begins.
_FINEST = 1 / 16


class Beside:
    """What stands beside the moves of a section in its picture."""

    def __init__(self, levels: Sequence[Level], marks: Sequence[Mark], makes: Sequence[str]) -> None:
        self.levels = levels
        self.marks = marks
        self.makes = makes


def section_picture(
    trace: Trace, found: SectionMoves, programmed: Moves, told: PolarSection, section: int, lines: Rows, beside: Beside
) -> SectionPicture:
    """
    The picture of one section. told: what its verdict rests on. programmed: the programmed path of the program.
    lines: those of findings, whose moves are kept as they are.
    """
    chosen = found.of_section(section)
    moves = found.moves.chosen(_mask(chosen, len(found)))
    most = max(min(POINTS, _OF_PROGRAM // len(trace.sections)), _LEAST)
    role, known = found.role[chosen], found.is_known[chosen]
    kept = np.isin(trace.line_in_file[moves.row], lines)
    own = programmed.chosen(programmed.section == section)
    unseen = paths.unseen(_shown(moves, role))
    tool, off = _path(moves, known, kept, role, unseen, most)
    contour, off_contour = _path(own, own.known, np.isin(own.row, moves.row[kept]), own.phase, unseen, most)
    path = rates.ways(found, chosen)
    curves = rates.samples(replace(path, move=np.searchsorted(chosen, path.move)), found.dynamics.c_limit)
    curves = rates.fewer(curves, kept, most)
    # Of the moves of each block the first.
    first = _first_of(moves.row, own.row[contour.move])
    extremes = (found.c_feed[chosen], found.x_feed[chosen], -moves.nearest)
    listed = _listed(kept, [tool.move, first, curves.move, *map(_highest, extremes)], most)
    enter = int(trace.sections.enter[section])
    limits = trace.machine.limits
    return SectionPicture(
        title=_title(told),
        line=told.line,
        end_line=told.end_line,
        channel=trace.text.source.channel or "",
        units=told.units,
        scale=MM_PER_INCH if told.units == "inch" else 1.0,
        diameter=bool(trace.x_factor[enter] < 1),
        radius=told.radius,
        radius_source=told.radius_source,
        stock=rounded(trace.stock_diameter[enter]),
        keep_out=rounded(limits.keep_out),
        c_limit=rounded(limits.c_feed),
        x_limit=rounded(limits.x_feed),
        feed_limit=rounded(limits.polar_feed),
        needs_radius=why_unknown(trace, found.moves, chosen),
        thinned=round(max(off, off_contour), LENGTH),
        time=told.time,
        programmed=_points(contour, _place(listed, first)),
        tool=_points(tool, _place(listed, tool.move)),
        moves=found.table(chosen[listed]),
        move_count=len(chosen),
        rates=Rates(
            t=numbers_of(curves.t, TIME),
            c_feed=numbers_of(curves.c_feed, RATE),
            x_feed=numbers_of(curves.x_feed, RATE),
            feed=numbers_of(curves.feed, RATE),
            move=_place(listed, curves.move).tolist(),
        ),
        parts=list(parts(trace, beside.levels, unseen)),
        marks=list(beside.marks),
        makes=list(beside.makes),
        remarks=_remarks(len(chosen), len(listed)),
    )


def _mask(chosen: Rows, count: int) -> Mask:
    mask = np.zeros(count, bool)
    mask[chosen] = True
    return mask


def _shown(moves: Moves, role: States) -> PlanePoints:
    """The points by which the size of the picture goes: those of cuts, if there are any, and the center of C."""
    is_cut = role != POSITIONING
    chosen = is_cut if is_cut.any() else np.ones(len(moves), bool)
    return np.concatenate([moves.start[chosen], moves.end[chosen], np.zeros(1, complex)])


def _path(moves: Moves, known: Mask, kept: Mask, look: States, unseen: float, most: int) -> tuple[Chords, float]:
    """A path with the moves that are known, and how far it lies off them at most [mm]."""
    curves = curves_of(moves, np.zeros(len(moves), np.int64), known)
    path, off = paths.chords(curves, unseen / 2, _CHORDS * most)
    path = Chords(path.point, np.flatnonzero(known)[path.move], path.begins)
    path, more = paths.thinned(path, kept, look, _FINEST * unseen, most)
    return path, off + more


def _first_of(row: Rows, wanted: Rows) -> Rows:
    """The first of the moves of each wanted row; the moves of a row need not be neighbours."""
    rows, first = np.unique(row, return_index=True)
    return np.asarray(first[np.minimum(np.searchsorted(rows, wanted), len(rows) - 1)]) if len(rows) else wanted[:0]


def _listed(kept: Mask, shown: Sequence[Rows], most: int) -> Rows:
    """The moves that the table lists: all of them or, of very many, those that are drawn, or stand at an extreme."""
    if len(kept) <= most:
        return np.arange(len(kept))
    is_listed = kept.copy()
    is_listed[[0, -1]] = True
    for one in shown:
        is_listed[one] = True
    return np.flatnonzero(is_listed)


def _highest(values: Floats) -> Rows:
    """The place of the highest value; none of no values."""
    highest = np.where(np.isnan(values), -np.inf, values)
    return np.flatnonzero(highest == highest.max(initial=-np.inf))[:1]


def _place(listed: Rows, move: Rows) -> Rows:
    """Where moves stand in the table."""
    return np.asarray(np.searchsorted(listed, move))


def _points(path: Chords, move: Rows) -> Points:
    """The columns of a path, with a gap before each stretch but the first."""
    gap = np.flatnonzero(path.begins)[1:]
    point = np.insert(path.point, gap, complex(np.nan, np.nan))
    moves = np.insert(move.astype(float), gap, np.nan)
    numbers = numbers_of(moves, 0)
    return Points(
        x=numbers_of(point.real, LENGTH),
        c=numbers_of(point.imag, LENGTH),
        move=[None if number is None else int(number) for number in numbers],
    )


def _remarks(count: int, listed: int) -> list[str]:
    return [f"the table lists {listed} of {count} moves: those that are drawn"] if listed < count else []


def _title(told: PolarSection) -> str:
    """`lines 4 to 30, offset 8`."""
    lines = f"lines {told.line} to {told.end_line}"
    return lines if told.offset is None else f"{lines}, offset {told.offset}"
