"""What sections without cutter compensation make: there the programmed path is that of the tool center."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.arrays import Rows
from polarcheck.checking.phrases.offsets import called_tool, to_give
from polarcheck.checking.tables import Tables
from polarcheck.geometry.outline import Outline
from polarcheck.geometry.shapes.shape import Shape

if TYPE_CHECKING:
    from polarcheck.table.moves import Moves
    from polarcheck.table.trace import Trace

#: Ends of moves that are nearer to each other are one point [mm].
_SAME = 1e-6

#: Number of the section, Z and R [mm], the shapes, and what is to be given.
_Depth = tuple[int, float, float, list[Shape], str | None]


def depths_of_paths(tables: Tables) -> Iterator[_Depth]:
    """Each way of a tool at one Z of a section that never uses compensation, with what it leaves."""
    trace: Trace = tables["trace"]
    moves: Moves = tables["tool_center"].moves
    plain = ~trace.anywhere_in_section(trace.compensates)[moves.row] & trace.cuts[moves.row]
    rows = np.flatnonzero(plain & ~np.isnan(moves.start + moves.end) & (moves.length > _SAME))
    radius = np.fmax(np.abs(trace.radius_of_move), trace.cutter_diameter / 2)
    for way in _ways(trace, moves, rows):
        row = int(moves.row[way[0]])
        path = _outline(moves, way)
        section, z = int(trace.section[row]), float(trace.z[row])
        if np.isnan(radius[row]) or not radius[row]:
            yield section, z, np.nan, [], _needs_radius(trace, row)
            continue
        if float(moves.length[way].sum()) < 2 * radius[row]:
            continue  # a step aside, or what is left of a ramp
        shapes = _left(path, float(radius[row]))
        begin, end = (int(trace.line_in_file[moves.row[at]]) for at in (way[0], way[-1]))
        why = f"the path of lines {begin} to {end} goes round nothing and is not straight: what it leaves is not told"
        yield section, z, float(radius[row]), shapes, None if shapes else why


def _needs_radius(trace: Trace, row: int) -> str:
    if not trace.offset_number[row]:
        return "the path is that of the tool, whose R is not known: no tool offset is in force"
    missing = f"the path is that of the tool, and R of {called_tool(trace, row)} is not known"
    return f"{missing}: {to_give(trace, row, 'radius')}"


def _ways(trace: Trace, moves: Moves, rows: Rows) -> Iterator[Rows]:
    """The moves of each way at one Z of one section, which nothing interrupts."""
    z, section = trace.z[moves.row[rows]], moves.section[rows]
    begins = np.ones(len(rows), bool)
    begins[1:] = (np.abs(moves.start[rows][1:] - moves.end[rows][:-1]) > _SAME) | (np.diff(section) != 0)
    begins[1:] |= (z[1:] != z[:-1]) & ~(np.isnan(z[1:]) & np.isnan(z[:-1]))
    for way in np.split(rows, np.flatnonzero(begins)[1:]):
        if len(way):
            yield way


def _outline(moves: Moves, way: Rows) -> Outline:
    count = len(way)
    return Outline(
        moves.start[way],
        moves.end[way],
        moves.center[way],
        moves.kind[way],
        moves.row[way],
        np.zeros(count, np.int64),
        np.array([False]),
    )


def _left(path: Outline, radius: float) -> list[Shape]:
    from polarcheck.geometry.shapes import grooves

    loop = grooves.closed_part(path)
    if loop is None:
        slot = grooves.slot_along(path, radius)
        return [slot] if slot else []
    found = grooves.left_inside(loop, radius) or grooves.cleared(loop, radius)
    return [found] if found else []
