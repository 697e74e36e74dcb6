"""What sections without cutter compensation make: there the programmed path is that of the tool center."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows
from polarcheck.checking.phrases.offsets import called_tool, to_give
from polarcheck.checking.tables import Tables
from polarcheck.columns.filling import before
from polarcheck.geometry.segments import Curves
from polarcheck.geometry.shapes.shape import Shape
from polarcheck.geometry.tolerances import ZERO
from polarcheck.table.overcuts import level_of_rows
from polarcheck.time_limit import keep_time

if TYPE_CHECKING:
    from polarcheck.columns.trace import Trace
    from polarcheck.table.moves import Moves

#: Number of the section, Z and R [mm], the shapes, and what is to be given.
_Depth = tuple[int, float, float, list[Shape], str | None]


def depths_of_paths(tables: Tables) -> Iterator[_Depth]:
    """Each Z of a section that never uses compensation, with what the cutter leaves and clears there."""
    trace: Trace = tables["trace"]
    moves: Moves = tables["tool_center"].moves
    plain = ~trace.mode.anywhere_in_section(trace.compensation.compensates)[moves.row] & trace.path.cuts[moves.row]
    plain &= ~(_changes_depth(trace) | above_the_face(trace))[moves.row]
    chosen = np.flatnonzero(plain & ~np.isnan(moves.start + moves.end) & (moves.length > ZERO))
    radius = np.fmax(np.abs(trace.compensation.radius_of_move), trace.offsets.cutter_diameter / 2)[moves.row]
    for own in _levels(level_of_rows(trace, moves.row), radius, chosen):
        keep_time()
        row = int(moves.row[own[0]])
        section, z, cutter = int(trace.mode.section[row]), float(trace.path.z[row]), float(radius[own[0]])
        if np.isnan(cutter) or not cutter:
            yield section, z, np.nan, [], _needs_radius(trace, row)
        elif float(moves.length[own].sum()) >= 2 * cutter:  # less is a step aside, or what is left of a ramp
            yield section, z, cutter, _left(moves, own, cutter, float(trace.lengths.stock_diameter[row])), None


def _changes_depth(trace: Trace) -> Mask:
    """A ramp clears its way at the Z of its end at that end alone, where what follows begins."""
    return np.asarray(
        trace.path.moves_z & (np.abs(trace.path.z - before(trace.path.z, trace.blocks.starts, np.nan)) > ZERO)
    )


def above_the_face(trace: Trace) -> Mask:
    """
    Rows in the air, one for each: where G0 is not allowed, G1 takes the tool to its place.

    They are no deeper than the tool came to the section, before the face of the part, at Z0, and their section goes on
    to Z0 or deeper. Where the whole section lies on one side of Z0 nobody knows where the face is, and none is.
    """
    inside = np.flatnonzero(trace.mode.section >= 0)
    deepest = np.full(len(trace.mode.sections), np.inf)
    np.fmin.at(deepest, trace.mode.section[inside], trace.path.z[inside])
    above = np.zeros(len(trace), bool)
    section, z = trace.mode.section[inside], trace.path.z[inside]
    above[inside] = (z > 0) & (z >= trace.path.z[trace.mode.sections.enter[section]]) & (deepest[section] <= 0)
    return above


def _levels(level: Rows, radius: Floats, chosen: Rows) -> Iterator[Rows]:
    """The moves of one cutter at one level, in the order in which the program comes to them."""
    if not len(chosen):
        return
    columns = np.stack([level[chosen], np.nan_to_num(radius[chosen], nan=-1)])
    _, first, level = np.unique(columns, axis=1, return_index=True, return_inverse=True)
    place = np.argsort(np.argsort(first))[level.ravel()]
    order = np.argsort(place, kind="stable")
    yield from np.split(chosen[order], np.flatnonzero(np.diff(place[order])) + 1)


def _left(moves: Moves, own: Rows, radius: float, bar: float) -> list[Shape]:
    from polarcheck.geometry.polygons.cleared import cleared
    from polarcheck.geometry.shapes.grooves import shapes_of_cleared

    path = Curves(
        moves.start[own], moves.end[own], moves.center[own], moves.kind[own], np.zeros(len(own), int), moves.row[own]
    )
    _, outline, across = cleared(path, radius)
    return shapes_of_cleared(outline, across, radius, bar)


def _needs_radius(trace: Trace, row: int) -> str:
    missing = f"the path is that of the tool, and R of {called_tool(trace.tools, row)} is not known"
    return f"{missing}: {to_give(trace.tools, trace.machine, row, 'radius')}"
