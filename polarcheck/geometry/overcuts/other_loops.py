"""
Overcuts of a loop into the walls of other loops of the same section and depth.

Neighbouring loops bound one common part, which consists of faces between their walls. Nested passes with a loop each
cut nothing of it, nor do flats whose leads cross each other's walls. The loops of a slot cut each other's walls if the
tool does not fit between them. Floats in mm, plane points complex, x + 1j*c. Import late.
"""

from __future__ import annotations

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Rows, column_at, folded
from polarcheck.geometry.overcuts.cuts import Cuts, assign_walls, cuts_into, endless, shortened
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import lines_of
from polarcheck.geometry.polygons.finished_part import Contours, finished_parts
from polarcheck.geometry.segments import Curves, boxes, first_of_its_kind, segments


def cuts_into_others(contour: Contours, level: Rows, path: Curves, radius: Floats, is_ramp: Mask) -> tuple[Cuts, Rows]:
    """
    The deepest cut of each move into a wall of another loop of the common part, and the loops that cross too often.

    contour: the programmed blocks in offset mode; its loops, groups and radius are not used.
    level: int[curves], the same number for loops of one section and depth.
    path: the tool center's moves with ramps, each with the loop that it machines.
    radius: float64[moves of path] [mm], |R|.
    is_ramp: bool[moves of path], start-ups and offset cancels.
    """
    loops, group = _neighbours(contour.curves, level, path, float(radius.max(initial=0.0)))
    if not len(loops):
        return Cuts.none(), loops
    index = np.minimum(np.searchsorted(loops, path.loop), len(loops) - 1)
    chosen = np.flatnonzero(loops[index] == path.loop)
    group_of_move = column_at(len(path), chosen, group[index[chosen]], -1)
    smallest = folded(np.minimum, group_of_move[chosen], radius[chosen], int(group.max()) + 1, np.inf)
    order = np.argsort(group, kind="stable")
    smallest = np.where(np.isfinite(smallest), smallest, 0.0)
    part = finished_parts(msgspec.structs.replace(contour, loop=loops[order], group=group[order], radius=smallest))
    tangled = loops[part.tangled[group]]
    chords = segments(path, contour.tolerance)
    chords = chords[group_of_move[chords.move] >= 0]
    by_walls = part.open | endless(part)
    batches = []
    for of_ramps, outline in ((False, part), (True, shortened(part, smallest))):
        pieces = chords[is_ramp[chords.move] == of_ramps]
        cuts = cuts_into(outline, by_walls, pieces, group_of_move[pieces.move], smallest, contour.tolerance)
        batches.append(assign_walls(outline, cuts))
    cuts = Cuts.concatenated(batches)
    return cuts[contour.curves.loop[cuts.wall] != path.loop[cuts.move]].worst(), tangled


def _neighbours(curves: Curves, level: Rows, path: Curves, reach: float) -> tuple[Rows, Rows]:
    """
    The loops that the tool may approach while it machines another loop of their level, and the group of each.

    A repeated loop counts as one.
    """
    loops, first, loop_of_curve = np.unique(curves.loop, return_index=True, return_inverse=True)
    of_level, number = np.unique(level[first], return_inverse=True)
    is_candidate = np.bincount(number, minlength=len(of_level))[number] > 1
    if not is_candidate.any():
        return loops[is_candidate], loops[is_candidate]
    fresh = first_of_its_kind(msgspec.structs.replace(curves, loop=number[loop_of_curve]))
    distinct = np.bincount(loop_of_curve[fresh], minlength=len(loops)) > 0
    is_candidate &= np.bincount(number[distinct], minlength=len(of_level))[number] > 1
    box = _joined_boxes(boxes(curves, first), path, loops)
    spacing = 2 * float(np.abs(box).max()) + 4 * reach
    shift = 2 * spacing * number
    area = shapely.box(box[0] + shift - reach, box[1] - reach, box[2] + shift + reach, box[3] + reach)
    piece = shapely.get_parts(areas.union_all(area[is_candidate & distinct]))
    middle = lines_of(
        box[0][is_candidate] + shift[is_candidate] + 1j * box[1][is_candidate],
        box[2][is_candidate] + shift[is_candidate] + 1j * box[3][is_candidate],
    )
    loop_number, group = shapely.STRtree(piece).query(middle, predicate="intersects")
    loop_number = np.flatnonzero(is_candidate)[loop_number]
    shared = np.bincount(group[distinct[loop_number]], minlength=len(piece)) > 1
    has_neighbour = shared[group]
    loop_number, group = loop_number[has_neighbour], group[has_neighbour]
    _, group = np.unique(group, return_inverse=True)
    order = np.argsort(loop_number)
    return loops[loop_number[order]], group[order]


def _joined_boxes(box: Floats, path: Curves, loops: Rows) -> Floats:
    """The boxes of these loops, enlarged to hold the tool center path along each, with its ramps."""
    order = np.argsort(path.loop, kind="stable")
    path = path[order]
    begins = np.flatnonzero(np.diff(path.loop, prepend=-1))
    if not len(begins):
        return box
    of_path, index = boxes(path, begins), np.searchsorted(loops, path.loop[begins])
    box[:2, index] = np.minimum(box[:2, index], of_path[:2])
    box[2:, index] = np.maximum(box[2:, index], of_path[2:])
    return box
