"""
Areas that are overcut or left standing, with the lines of their blocks.

Import late: shapely is slow to import.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.columns.contour.overcuts import CutsOfRows, Overcuts, curves_of
from polarcheck.columns.metal.coverage import Coverage, Left
from polarcheck.columns.metal.finished import Level
from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Points, Rows, first_in_run, mask_at, side_by_side
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID
from polarcheck.geometry.segments import segments
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.quantity import in_row
from polarcheck.view.drawn_moves import LENGTH
from polarcheck.view.part_rings import Ring, polygons_of, rings
from polarcheck.view.picture_data import Mark

#: The most marks of a kind in a section; the deepest are chosen.
MOST = 300
#: Corners per quarter circle of the cutter.
_CORNERS = 32
#: How far around its place a rib or strip is shown, in multiples of its height, width or thickness.
_AROUND_RIB, _AROUND_STRIP = 1.5, 10.0


def overcut_marks(
    trace: Trace, moves: Moves, overcuts: Overcuts, levels: Sequence[Level]
) -> Iterator[tuple[int, Mark]]:
    """Yield the section and the mark of each cut into a contour, ramps included."""
    for cuts, depth, verb in (
        (overcuts.cuts, overcuts.depth, "cuts"),
        (overcuts.sweeps, overcuts.sweep_depth, "sweeps"),
    ):
        chosen = _deepest(trace, cuts[depth[cuts.row] > 0])
        for row, into, deep, point in side_by_side(chosen.row, chosen.into, chosen.depth, chosen.place):
            keep_time()
            lines = [int(trace.blocks.line_in_file[marked]) for marked in (row, into)]
            size = f"{in_row(deep, trace.lengths, row):length}"
            text = f"line {lines[0]} {verb} {size} deep into the contour of line {lines[1]}"
            yield (
                int(trace.mode.section[row]),
                Mark(
                    kind="overcut",
                    text=text,
                    lines=lines,
                    place=_pair(point),
                    depth=round(deep, LENGTH),
                    rings=_taken(trace, moves, row, into, levels, point),
                ),
            )


def left_marks(trace: Trace, coverage: Coverage, levels: Sequence[Level]) -> Iterator[tuple[int, Mark]]:
    """Yield the section and the mark of each rib and strip that no tool removes, at the block that leaves it."""
    ribs, strips = (coverage.ribs, "a rib", "high", _AROUND_RIB), (coverage.strips, "a strip", "thick", _AROUND_STRIP)
    for material_left, noun, measure, around in (ribs, strips):
        for row in _largest(trace, material_left).tolist():
            keep_time()
            line, height = int(trace.blocks.line_in_file[row]), float(material_left.height[row])
            wide = (
                f" and {in_row(material_left.width[row], trace.lengths, row):length} wide"
                if material_left.width[row] > 0
                else ""
            )
            reach = around * max(height, float(np.nan_to_num(material_left.width[row])))
            yield (
                int(trace.mode.section[row]),
                Mark(
                    kind="left",
                    text=f"{noun} {in_row(height, trace.lengths, row):length} {measure}{wide} stays behind line {line}",
                    lines=[line],
                    place=_pair(complex(material_left.place[row])),
                    depth=round(height, LENGTH),
                    rings=_untouched(trace, coverage, row, levels, complex(material_left.place[row]), reach),
                ),
            )


def _deepest(trace: Trace, cuts: CutsOfRows) -> CutsOfRows:
    """Return the deepest cut of each line into each other line, at most MOST per section."""
    line, section = trace.blocks.line_in_file, trace.mode.section[cuts.row]
    order = np.lexsort((-cuts.depth, line[cuts.into], line[cuts.row], section))
    order = order[first_in_run(section[order], line[cuts.row[order]], line[cuts.into[order]])]
    order = order[np.lexsort((-cuts.depth[order], section[order]))]
    section = section[order]
    is_chosen = mask_at(len(cuts.row), order[np.arange(len(order)) - np.searchsorted(section, section) < MOST])
    return cuts[is_chosen]


def _largest(trace: Trace, material_left: Left) -> Rows:
    """Return the rows that leave something standing, the largest of each section."""
    rows = np.flatnonzero(material_left.height > 0)
    rows = rows[np.lexsort((-material_left.height[rows], trace.mode.section[rows]))]
    section = trace.mode.section[rows]
    return np.sort(rows[np.arange(len(rows)) - np.searchsorted(section, section) < MOST])


def _taken(trace: Trace, moves: Moves, row: int, into: int, levels: Sequence[Level], location: complex) -> list[Ring]:
    """Return the area that the cutter takes off the part in the moves of a row, around this place."""
    part = _level_of(trace, into, levels)
    radius = abs(float(trace.compensation.radius_of_move[row]))
    if part is None or np.isnan(radius):
        return []
    of_row = moves.row == row
    tolerance = trace.machine.compensation.overcut_tolerance
    pieces = segments(curves_of(moves, np.zeros(len(moves), np.int64), of_row), tolerance)
    if not len(pieces):
        return []
    ends = np.stack([pieces.start, pieces.end], axis=1)
    lines = shapely.multilinestrings(shapely.linestrings(np.stack([ends.real, ends.imag], axis=2)))
    swept = areas.buffer(lines, radius, quad_segs=_CORNERS)
    taken = areas.intersection(part.polygon, swept, grid_size=GRID)
    # The cutter also touches the walls that it should touch, which gives slivers between chords.
    cut = [polygon for polygon in polygons_of(shapely.buffer(taken, -tolerance / 2)) if not polygon.is_empty]
    point = shapely.Point(location.real, location.imag)
    near = min(cut, key=point.distance, default=None)
    return [] if near is None else rings(shapely.simplify(shapely.buffer(near, tolerance / 2), tolerance / 2))


def _untouched(
    trace: Trace, coverage: Coverage, row: int, levels: Sequence[Level], location: complex, reach: float
) -> list[Ring]:
    """Return the area that is neither part nor removed by any tool, within `reach` [mm] around a place."""
    part = _level_of(trace, row, levels)
    if part is None:
        return []
    swept = coverage.swept
    near = swept[swept.at_depth(trace.path.z[row], trace.blocks.program[row])]
    near = near[_distance(location, near.start, near.end) < near.radius + reach]
    ends = np.stack([near.start, near.end], axis=1)
    lines = shapely.linestrings(np.stack([ends.real, ends.imag], axis=2))
    taken = areas.union_all(areas.buffer(lines, near.radius, quad_segs=_CORNERS), grid_size=GRID)
    point = shapely.Point(location.real, location.imag)
    about = shapely.buffer(point, reach, quad_segs=_CORNERS)
    material_left = areas.difference(areas.difference(about, part.polygon, grid_size=GRID), taken, grid_size=GRID)
    nearest = min(polygons_of(material_left), key=point.distance, default=None)
    return [] if nearest is None else rings(nearest)


def _distance(point: complex, start: Points, end: Points) -> Floats:
    """Return the distance from a point to each straight line [mm]."""
    vector = end - start
    share = ((point - start) * vector.conj()).real / np.maximum(np.abs(vector) ** 2, ROUNDING**2)
    return np.asarray(np.abs(point - start - np.clip(share, 0, 1) * vector))


def _level_of(trace: Trace, row: int, levels: Sequence[Level]) -> Level | None:
    """Return the finished part that the wall of a row belongs to."""
    z = float(trace.path.z[row])
    for level in levels:
        is_same = abs(level.z - z) <= ROUNDING or (np.isnan(z) and np.isnan(level.z))
        if level.section == trace.mode.section[row] and is_same:
            return level
    return None


def _pair(point: complex) -> tuple[float, float]:
    return round(point.real, LENGTH), round(point.imag, LENGTH)
