"""
Strips: what stays between passes that are farther apart than the cutter is wide.

Floats in mm, plane points complex, x + 1j*c. Import late: shapely takes its time.

What no tool sweeps and is no part is left. It is a strip where it is thinner than R, and lies behind a block of a pass
or goes round a pass. What is thicker is a groove's wall or an island, which is meant. What only a single pass goes
round, as the middle of a pocket, has been drilled, or falls out.
"""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Mask, Rows
from polarcheck.geometry.contour_ends import WITNESS
from polarcheck.geometry.material_left.ribs import Swept, first_tool
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import GRID, coordinates, lines_through
from polarcheck.geometry.segments import Segments
from polarcheck.geometry.tolerances import ZERO
from polarcheck.time_limit import keep_time

#: How near two outlines are one [mm]; more than arcs in chords.
_BESIDE = 0.01
#: Corners of a quarter of the end of a swept way, and of what is only widened to look at it.
_CORNERS, _COARSE = 32, 16
#: What a path may be straightened by [mm], and how many pieces of it are looked at.
_STRAIGHT, _MOST_PIECES = 0.002, 20_000
#: How far from a ring the cut of one way of the tool through it is no more open, as a share of R.
_CLOSING = 1.1
#: A strip that runs out into what lies round all passes is so many R long, and as thick everywhere as this share.
_LONG, _EVEN = 6, 0.75


class Strip(msgspec.Struct, frozen=True):
    """A strip: how thick it is, the row of the pass behind which it stands, and where."""

    thickness: float
    row: int
    place: complex


def strips(
    part: Any, walls: Segments, row: Rows, left: Mask, swept: Swept, radius: float, bar: float
) -> list[Strip] | None:
    """
    The strips of one level; None where the paths of its tools are too long to be looked at.

    part: what its loops leave, a polygon. walls: their blocks as straight pieces, `row` and `left` those of each.
    swept: all that tools run through there. radius: R of the passes. bar: diameter [mm], NaN if not known.
    """
    gone = _gone(swept)
    if gone is None:
        return None
    around = shapely.box(*shapely.bounds(gone)).buffer(radius)
    left_over = areas.difference(around, areas.union(gone, part, grid_size=GRID), grid_size=GRID)
    if not np.isnan(bar):
        round_bar = shapely.Point(0, 0).buffer(bar / 2, quad_segs=4 * _CORNERS)
        left_over = areas.intersection(left_over, round_bar, grid_size=GRID)
    found = []
    for piece in shapely.get_parts(left_over):
        if shapely.distance(piece, around.exterior) > _BESIDE:
            found.append((piece, False))
        else:
            thick = areas.buffer(
                areas.buffer(piece, -radius / 2, quad_segs=_COARSE), radius / 2 + _BESIDE, quad_segs=_COARSE
            )
            found += [(thin, True) for thin in shapely.get_parts(areas.difference(piece, thick, grid_size=GRID))]
    result = []
    middles = shapely.STRtree(shapely.points(coordinates((walls.start + walls.end) / 2)))
    for piece, runs_out in found:
        keep_time()
        strip = _strip(piece, part, walls, middles, row, left, swept, radius, runs_out)
        if strip is not None:
            result.append(strip)
    return result


def _gone(swept: Swept) -> Any:
    """What the tools sweep; None where their paths are too long to be looked at."""
    joined = swept.end[:-1] == swept.start[1:]
    joined &= (swept.radius[1:] == swept.radius[:-1]) & (swept.z[1:] == swept.z[:-1])
    lines, last = lines_through(swept.start, swept.end, joined)
    radius = swept.radius[last]
    # A pass that is written once more, deeper, sweeps nothing else.
    fresh = list({key: at for at, key in enumerate(zip(shapely.to_wkb(lines), radius.tolist(), strict=True))}.values())
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
    """This piece of what is left, if it is a strip."""
    length = max(piece.length / 2, ZERO)
    thickness = piece.area / length
    if not WITNESS < thickness < radius or shapely.distance(piece, part) < _BESIDE:
        return None
    middle = (walls.start + walls.end) / 2
    behind = np.sort(middles.query(piece, "dwithin", _BESIDE))
    on = np.abs(walls.end - walls.start)[behind]
    if runs_out:
        widest = 2 * areas.maximum_inscribed_circle(piece).length
        if length < _LONG * radius or thickness < _EVEN * widest or on.sum() < length / 2:
            return None
    if on.sum() < radius:
        # A ramp or a link cuts through a ring, as wide as the cutter.
        if not shapely.get_num_interior_rings(areas.buffer(piece, _CLOSING * radius, quad_segs=_COARSE)):
            return None
        point = complex(*shapely.get_coordinates(piece.representative_point())[0])
        nearest = int(np.argmin(np.abs((swept.start + swept.end) / 2 - point)))
        return Strip(thickness, int(swept.row[nearest]), point)
    way = (walls.end - walls.start)[behind]
    back = np.where(left[behind], -1j, 1j) * way / np.abs(way)
    begin = middle[behind] + _BESIDE * back
    across = first_tool(swept, swept.radius, begin, back) + _BESIDE
    order = np.argsort(across)
    at = order[np.searchsorted(np.cumsum(on[order]), on.sum() / 2)]
    place = complex(middle[behind][at] + back[at] * across[at] / 2)
    return Strip(float(across[at]), int(row[behind][at]), place) if across[at] < radius else None
