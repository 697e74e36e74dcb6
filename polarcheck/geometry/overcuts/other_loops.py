"""
Loops of one section at one depth against each other: what one of them cuts of what another one keeps.

All loops that lie beside each other make one part, as the faces between their walls show it. So passes inside each
other, in a loop each, and flats whose leads cross each other's walls cut nothing; the two walls of a slot do where the
tool does not fit between them. Floats in mm, plane points complex, x + 1j*c. Import late.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Rows
from polarcheck.geometry.overcuts.cuts import Cuts, cuts_into, endless, shortened, with_walls
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import lines_of
from polarcheck.geometry.polygons.finished_part import Contours, finished_parts
from polarcheck.geometry.segments import Curves, boxes, first_of_its_kind, segments


def cuts_into_others(contour: Contours, level: Rows, path: Curves, radius: Floats, is_ramp: Mask) -> tuple[Cuts, Rows]:
    """
    Where the tool center comes nearer than R to a wall of another loop that bounds the part of both; the worst place of
    each of its moves; and the loops that cross each other too often to tell.

    contour: the programmed blocks in offset mode, its loops, groups and radius are not asked. level: int[curves], the
    same number for loops of one section and depth. path, radius, is_ramp: the tool center's moves and ramps, each with
    the loop whose wall it is for, |R| [mm].
    """
    loops, group = _together(contour.curves, level, path, float(radius.max(initial=0.0)))
    if not len(loops):
        return Cuts.none(), loops
    place = np.minimum(np.searchsorted(loops, path.loop), len(loops) - 1)
    chosen = np.flatnonzero(loops[place] == path.loop)
    of_move = np.full(len(path), -1)
    of_move[chosen] = group[place[chosen]]
    smallest = np.full(int(group.max()) + 1, np.inf)
    np.minimum.at(smallest, of_move[chosen], radius[chosen])
    order = np.argsort(group, kind="stable")
    smallest = np.where(np.isfinite(smallest), smallest, 0.0)
    part = finished_parts(msgspec.structs.replace(contour, loop=loops[order], group=group[order], radius=smallest))
    tangled = loops[part.tangled[group]]
    ways = segments(path, contour.tolerance)
    ways = ways[of_move[ways.move] >= 0]
    by_walls = part.open | endless(part)
    found = []
    for of_ramps, outline in ((False, part), (True, shortened(part, smallest))):
        pieces = ways[is_ramp[ways.move] == of_ramps]
        cuts = cuts_into(outline, by_walls, pieces, of_move[pieces.move], smallest, contour.tolerance)
        found.append(with_walls(outline, cuts))
    cuts = Cuts.concatenated(found)
    return cuts[contour.curves.loop[cuts.wall] != path.loop[cuts.move]].worst(), tangled


def _together(curves: Curves, level: Rows, path: Curves, reach: float) -> tuple[Rows, Rows]:
    """
    The loops that the tool may come near on the way along another one of their level, but for what is written once
    more, and the group of each.
    """
    loops, first, which = np.unique(curves.loop, return_index=True, return_inverse=True)
    of_level, number = np.unique(level[first], return_inverse=True)
    several = np.bincount(number, minlength=len(of_level))[number] > 1
    if not several.any():
        return loops[several], loops[several]
    fresh = first_of_its_kind(msgspec.structs.replace(curves, loop=number[which]))
    distinct = np.bincount(which[fresh], minlength=len(loops)) > 0
    several &= np.bincount(number[distinct], minlength=len(of_level))[number] > 1
    box = _joined_boxes(boxes(curves, first), path, loops)
    far = 2 * float(np.abs(box).max()) + 4 * reach
    shift = 2 * far * number
    area = shapely.box(box[0] + shift - reach, box[1] - reach, box[2] + shift + reach, box[3] + reach)
    piece = shapely.get_parts(areas.union_all(area[several & distinct]))
    middle = lines_of(
        box[0][several] + shift[several] + 1j * box[1][several], box[2][several] + shift[several] + 1j * box[3][several]
    )
    of_loop, group = shapely.STRtree(piece).query(middle, predicate="intersects")
    of_loop = np.flatnonzero(several)[of_loop]
    shared = np.bincount(group[distinct[of_loop]], minlength=len(piece)) > 1
    kept = shared[group]
    of_loop, group = of_loop[kept], group[kept]
    _, group = np.unique(group, return_inverse=True)
    order = np.argsort(of_loop)
    return loops[of_loop[order]], group[order]


def _joined_boxes(box: Floats, path: Curves, loops: Rows) -> Floats:
    """The boxes of these loops with the path of the tool center along each, ramps included."""
    order = np.argsort(path.loop, kind="stable")
    path = path[order]
    begins = np.flatnonzero(np.diff(path.loop, prepend=-1))
    if not len(begins):
        return box
    of_path, at = boxes(path, begins), np.searchsorted(loops, path.loop[begins])
    box[:2, at] = np.minimum(box[:2, at], of_path[:2])
    box[2:, at] = np.maximum(box[2:, at], of_path[2:])
    return box
