"""What is told as left standing: against what lies beside the part within R, less what the cutter sweeps."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]
from cases import looped
from contour_families import program_of
from programs import tables_of

from polarcheck.geometry.segments import Curves, segments
from polarcheck.reports.made_parts.part_report import made_by

#: What chords and rounding leave beside walls [mm]; how much of R squared is worth telling.
NEAR, WORTH = 0.004, 0.02


def lines(curves: Curves) -> Any:
    """Curves in shapely."""
    chords = segments(curves, NEAR)
    ends = [np.stack([points.real, points.imag], axis=-1) for points in (chords.start, chords.end)]
    return shapely.union_all(shapely.linestrings(np.stack(ends, axis=1)))


def not_reached(tables: Any) -> list[Any]:
    """The areas at the walls of the first depth that no move at that Z or deeper sweeps."""
    level, trace, moves = tables["finished"].levels[0], tables["trace"], tables["tool_center"].moves
    own = trace.path.cuts[moves.row] & (trace.path.z[moves.row] <= level.z + 1e-6) & ~np.isnan(moves.start + moves.end)
    columns = (moves.start[own], moves.end[own], moves.center[own], moves.kind[own])
    path = lines(Curves(*columns, np.zeros(own.sum(), int), moves.row[own]))
    one = level.outline
    walls = lines(Curves(one.start, one.end, one.center, one.kind, one.chain * 0, one.row))
    swept = path.buffer(level.radius + NEAR, quad_segs=64)
    left = walls.buffer(level.radius, quad_segs=64).difference(level.polygon.buffer(NEAR)).difference(swept)
    worth = WORTH * level.radius**2
    return [area for area in shapely.get_parts(left) if area.area > worth and area.distance(walls) < 3 * NEAR]


@looped(
    ("family", "seed", "ribs", "corners"),
    [
        ("polygons", 0, 0, 0),
        ("polygons", 2, 1, 0),
        ("crosses", 0, 0, 4),
        ("pockets", 3, 1, 0),
        ("islands", 1, 2, 0),
        ("cams", 1, 0, 0),
        ("eccentrics", 2, 0, 0),
    ],
    one_in=7,
)
def test_what_is_left_is_what_no_cutter_reaches(family: str, seed: int, ribs: int, corners: int) -> None:
    program = program_of(seed, family=family)
    inch = 25.4 if "G20" in program.text else 1.0
    tables = tables_of(program.text, "fanuc", f"1:radius={program.radius / inch}")
    told = [left for one in made_by(tables) for left in one.left_standing]
    areas = not_reached(tables)
    places = [left.place for left in told if left.kind == "rib"]
    assert (len(places), sum(left.count for left in told if left.kind == "corner")) == (ribs, corners)
    assert len(areas) == ribs + corners
    for place in places:
        assert min(area.distance(shapely.Point(place)) for area in areas) < 0.02
