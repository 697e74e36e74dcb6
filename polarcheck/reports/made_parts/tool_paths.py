"""The shapes of sections without cutter compensation, where the programmed path is that of the tool center."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from polarcheck.columns.contour.overcuts import level_of_rows
from polarcheck.columns.filling import last_row
from polarcheck.foundation.arrays import Floats, Mask, Rows, column_at, folded
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.segments import Curves
from polarcheck.geometry.shapes.shape import Shape
from polarcheck.geometry.tolerances import ZERO
from polarcheck.parts.depth_areas import within
from polarcheck.parts.made_depths import Depth, put_together
from polarcheck.rules.tables import Tables
from polarcheck.rules.wording.offsets import called_tool, to_give

if TYPE_CHECKING:
    from polarcheck.columns.metal.milled import Milled
    from polarcheck.columns.path.moves import Moves
    from polarcheck.columns.trace import Trace


#: R of an engraver, at most, and how deep it goes [mm].
_ENGRAVER, _ENGRAVED = 0.5, 1.0


def depths_of_paths(tables: Tables) -> Iterator[Depth]:
    """
    Each Z of sections that never use compensation, with what the cutter leaves and clears there.

    In the frame of the part, as the finished part is: sections at one Z with one R are put together.
    """
    trace: Trace = tables["trace"]
    moves: Moves = tables["tool_center"].moves
    plain = ~trace.mode.anywhere_in_section(trace.compensation.compensates)[moves.row] & trace.path.cuts[moves.row]
    plain &= ~(_changes_depth(trace) | above_the_face(tables["upright"]))[moves.row]
    chosen = np.flatnonzero(plain & ~np.isnan(moves.start + moves.end) & (moves.length > ZERO))
    if not len(chosen):
        return
    section = trace.mode.section[moves.row]
    radius = np.fmax(np.abs(trace.compensation.radius_of_move), trace.offsets.cutter_diameter / 2)[moves.row]
    milled: Milled = tables["milled"]
    z = trace.path.z[moves.row]
    is_known, frame = ~np.isnan(z), milled.frame_of_section[section]
    # Where Z is not known, depths of different sections cannot be compared.
    level = np.where(is_known, np.round(z, 6), level_of_rows(trace, moves.row))
    for of_level in _levels(np.where(is_known, frame, -1), level, radius, chosen):
        keep_time()
        # Sections without much more than a step aside, or what is left of a ramp, make nothing.
        parts = [of_level[section[of_level] == number] for number in dict.fromkeys(section[of_level].tolist())]
        parts = [part for part in parts if not float(moves.length[part].sum()) < 2 * float(radius[part[0]])]
        if not parts:
            continue
        single = [_depth(trace, moves, part, float(radius[of_level[0]])) for part in parts]
        if len(parts) == 1 or single[0].needs:
            yield from single
        else:
            yield from put_together(_depth(trace, moves, np.concatenate(parts), float(radius[of_level[0]])), single)


def _depth(trace: Trace, moves: Moves, chosen: Rows, cutter: float) -> Depth:
    """The shapes that these moves of a cutter at one Z make."""
    row = int(moves.row[chosen[0]])
    sections = tuple(dict.fromkeys(trace.mode.section[moves.row[chosen]].tolist()))
    z = float(trace.path.z[row])
    if np.isnan(cutter) or not cutter:
        return Depth(sections, z, np.nan, [], _needs_radius(trace, row))
    path = Curves(*moves.shape, np.zeros(len(moves), int), moves.row)[chosen]
    parts = [
        path[trace.mode.section[path.row] == number].turned_by(complex(trace.path.section_turn[number]))
        for number in sections
    ]
    bar = float(trace.lengths.stock_diameter[row])
    shapes, polygon, is_cleared, swept = _shapes_and_areas(Curves.concatenated(parts), cutter, bar)
    if cutter <= _ENGRAVER and -_ENGRAVED <= z * trace.path.z_sense < 0:
        # What stands within letters and frames is no shape of a drawing.
        shapes = [shape for shape in shapes if shape.name == "groove" or shape.is_open] or shapes
    return Depth(sections, z, cutter, shapes, polygon=polygon, is_cleared=is_cleared, swept=swept)


def _changes_depth(trace: Trace) -> Mask:
    """A ramp clears its way at the Z of its end at that end alone, where what follows begins."""
    return np.asarray(trace.path.moves_z & (np.abs(trace.path.z - trace.path.z_before) > ZERO))


def above_the_face(trace: Trace) -> Mask:
    """
    Rows in the air, one for each: where G0 is not allowed, G1 takes the tool to its place.

    They are no deeper than the tool came to the section, before the face of the part, at Z0, and their section goes on
    to Z0 or deeper; or a Z word alone has lifted the tool to above Z0. Where the whole section lies on one side of Z0
    the face is unknown, and there are no such rows.
    """
    inside = np.flatnonzero(trace.mode.section >= 0)
    deepest = folded(np.fmin, trace.mode.section[inside], trace.path.z[inside], len(trace.mode.sections), np.inf)
    section, z = trace.mode.section[inside], trace.path.z[inside]
    moved = last_row(trace.path.moves_z, trace.mode.enters)[inside]
    is_lifted = (trace.path.z[moved] > trace.path.z_before[moved]) & (trace.path.z_before[moved] < 0) & (moved >= 0)
    comes_from = trace.path.z[trace.mode.sections.enter[section]]
    is_above = (z > 0) & ((z >= comes_from) | is_lifted) & (deepest[section] <= 0)
    return column_at(len(trace), inside, is_above, False)


def _levels(frame: Rows, level: Floats, radius: Floats, chosen: Rows) -> Iterator[Rows]:
    """The moves of one cutter at one level in one frame, in the order in which the program comes to them."""
    columns = np.stack([frame[chosen], level[chosen], np.nan_to_num(radius[chosen], nan=-1)])
    _, first, number = np.unique(columns, axis=1, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))[number.ravel()]
    order = np.argsort(rank, kind="stable")
    yield from np.split(chosen[order], np.flatnonzero(np.diff(rank[order])) + 1)


def _shapes_and_areas(path: Curves, radius: float, bar: float) -> tuple[list[Shape], Any, bool, Any]:
    """
    The shapes that a path makes, and an area by which depths are compared: what stands within the path; else what it
    clears, True; None for a groove alone, whose ends are those of the ways in and out. At last what it clears.
    """
    from polarcheck.geometry.polygons.cleared import cleared
    from polarcheck.geometry.shapes.grooves import GROOVE, shapes_of_cleared

    area, outline, across = cleared(path, radius)
    shapes = shapes_of_cleared(outline, across, radius, bar)
    standing = within(area)
    if standing.is_empty:
        return shapes, area if across < GROOVE else None, True, area
    return shapes, standing, False, area


def _needs_radius(trace: Trace, row: int) -> str:
    missing = f"the path is that of the tool, and R of {called_tool(trace.tools, row)} is not known"
    return f"{missing}: {to_give(trace.tools, trace.machine, row, 'radius')}"
