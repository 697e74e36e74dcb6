"""
Strips: material that remains between passes that are farther apart than the cutter is wide.

Floats in mm, plane points complex, x + 1j*c. Import late: shapely takes its time.

Material outside the part that no tool sweeps is left over. A strip is thinner than R, and lies behind a block of a pass
or goes round a pass. Thicker material is the wall of a groove or an island, and is intended. Material inside a single
pass, such as the middle of a pocket, was drilled before, or falls out.
"""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Mask, Rows
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.contour_ends import WITNESS
from polarcheck.geometry.material_left.ribs import Swept, first_tool
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID, coordinates, lines_through
from polarcheck.geometry.segments import Segments
from polarcheck.geometry.tolerances import ZERO

#: Two outlines touch if they are this near [mm]; larger than the error of chords.
_BESIDE = 0.01
#: Corners per quarter circle: at the ends of swept ways, and of areas that are widened only for a test.
_CORNERS, _COARSE = 32, 16
#: Tolerance [mm] to which paths are simplified, and the largest number of their points.
_STRAIGHT, _MOST_PIECES = 0.002, 20_000
#: Widened by this share of R, a ring that a tool has cut through once is closed again.
_CLOSING = 1.1
#: A strip that runs out into the surroundings is at least this many R long; least ratio of mean to largest thickness.
_LONG, _EVEN = 6, 0.75


class Strip(msgspec.Struct, frozen=True):
    """
    A strip.

    thickness: [mm].
    row: the programmed row of the pass in front of it.
    place: a point in it [mm].
    """

    thickness: float
    row: int
    place: complex


def strips(
    part: Any, walls: Segments, row: Rows, left: Mask, swept: Swept, radius: float, bar: float
) -> list[Strip] | None:
    """
    The strips of one level; None if the paths of its tools have too many points.

    part: the finished part of its loops, a polygon.
    walls: the blocks of the loops as straight pieces.
    row: int[walls], their rows. left: bool[walls], the tool runs left of the block.
    swept: the paths of all tools at that level.
    radius: R of the passes [mm].
    bar: diameter [mm], NaN if unknown.
    """
    removed = _swept_area(swept)
    if removed is None:
        return None
    around = shapely.box(*shapely.bounds(removed)).buffer(radius)
    left_over = areas.difference(around, areas.union(removed, part, grid_size=GRID), grid_size=GRID)
    if not np.isnan(bar):
        round_bar = shapely.Point(0, 0).buffer(bar / 2, quad_segs=4 * _CORNERS)
        left_over = areas.intersection(left_over, round_bar, grid_size=GRID)
    candidates = []
    for piece in shapely.get_parts(left_over):
        if shapely.distance(piece, around.exterior) > _BESIDE:
            candidates.append((piece, False))
        else:
            thick = areas.buffer(
                areas.buffer(piece, -radius / 2, quad_segs=_COARSE), radius / 2 + _BESIDE, quad_segs=_COARSE
            )
            candidates += [(thin, True) for thin in shapely.get_parts(areas.difference(piece, thick, grid_size=GRID))]
    result = []
    middles = shapely.STRtree(shapely.points(coordinates((walls.start + walls.end) / 2)))
    for piece, runs_out in candidates:
        keep_time()
        strip = _strip(piece, part, walls, middles, row, left, swept, radius, runs_out)
        if strip is not None:
            result.append(strip)
    return result


def _swept_area(swept: Swept) -> Any:
    """The area that the tools sweep; None if their paths have too many points."""
    joined = swept.end[:-1] == swept.start[1:]
    joined &= (swept.radius[1:] == swept.radius[:-1]) & (swept.z[1:] == swept.z[:-1])
    lines, last = lines_through(swept.start, swept.end, joined)
    radius = swept.radius[last]
    # A pass that is repeated deeper sweeps the same area.
    fresh = list(
        {key: index for index, key in enumerate(zip(shapely.to_wkb(lines), radius.tolist(), strict=True))}.values()
    )
    lines, radius = shapely.simplify(lines[fresh], _STRAIGHT), radius[fresh]
    if shapely.get_num_coordinates(lines).sum() > _MOST_PIECES:
        return None
    return areas.union_all(areas.buffer(lines, radius, quad_segs=_CORNERS), grid_size=GRID)


def _strip(
    piece: Any,
    part: Any,
    walls: Segments,
    middles: shapely.STRtree,
    row: Rows,
    left: Mask,
    swept: Swept,
    radius: float,
    runs_out: bool,
) -> Strip | None:
    """The strip that this piece of left-over material is; None if it is none."""
    length = max(piece.length / 2, ZERO)
    thickness = piece.area / length
    if not WITNESS < thickness < radius or shapely.distance(piece, part) < _BESIDE:
        return None
    middle = (walls.start + walls.end) / 2
    adjacent = np.sort(middles.query(piece, "dwithin", _BESIDE))
    wall_length = np.abs(walls.end - walls.start)[adjacent]
    if runs_out:
        widest = 2 * areas.maximum_inscribed_circle(piece).length
        if length < _LONG * radius or thickness < _EVEN * widest or wall_length.sum() < length / 2:
            return None
    if wall_length.sum() < radius:
        # A ramp or a link cuts through a ring, as wide as the cutter.
        if not shapely.get_num_interior_rings(areas.buffer(piece, _CLOSING * radius, quad_segs=_COARSE)):
            return None
        point = complex(*shapely.get_coordinates(piece.representative_point())[0])
        nearest = int(np.argmin(np.abs((swept.start + swept.end) / 2 - point)))
        return Strip(thickness, int(swept.row[nearest]), point)
    vector = (walls.end - walls.start)[adjacent]
    back = np.where(left[adjacent], -1j, 1j) * vector / np.abs(vector)
    begin = middle[adjacent] + _BESIDE * back
    across = first_tool(swept, swept.radius, begin, back) + _BESIDE
    order = np.argsort(across)
    median = order[np.searchsorted(np.cumsum(wall_length[order]), wall_length.sum() / 2)]
    location = complex(middle[adjacent][median] + back[median] * across[median] / 2)
    return Strip(float(across[median]), int(row[adjacent][median]), location) if across[median] < radius else None
