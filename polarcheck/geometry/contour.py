"""
The tool center path against the programmed contour: where the tool cuts what the contour keeps.

The only module that uses shapely; import it late. Floats in mm, plane points complex, x + 1j*c.

What an overcut is. The tool center must stay at R or more from every programmed block of its loop, on whichever side;
that test needs no knowledge of corners. But a loop may hold several turns of one contour: roughing passes, a spiral,
leads that the last blocks cross. A block of one turn then lies where another turn removes the material anyway, and it
is no fault to come near it. So a place on the contour counts only where it bounds the finished part, that is where no
block of its loop asks for the material behind it. Seen from just behind the contour, a block asks for that material if
it shows its tool side. Behind a contour that is gone round once one sees nothing but the backs of blocks, whatever its
shape; a tool side comes into view only where turns lie inside each other. So nothing is taken out of the test in a
contour of one turn, and in no other is an order of the turns assumed. Open contours are treated alike: only what lies
behind a block is looked at, not what lies round its ends. The same contour once more (a spring pass) is nowhere behind
itself. A wall thinner than the tolerance is none. The walls of a groove that is too narrow face each other, not away:
a lead in and a lead out that cross like that are such a groove, and found.

What is exact. Arcs become chords with their ends on the arc and a sagitta of a quarter of the tolerance; contour and
path together shift a distance by half the tolerance at most. At 0.002 mm a path in its proper place is never found, one
that is 0.003 mm too near always, and depths are right to 0.001 mm. Nothing is decided by areas.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]
from numpy.typing import NDArray

from polarcheck.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.segments import ZERO, Curves, Segments, members, segments

Lines = NDArray[Any]

__all__ = ["TOLERANCE", "Curves", "Overcut", "overcuts", "sweeps"]

#: Depth [mm] up to which nothing is said; two roundings to the least increment.
TOLERANCE = 0.002

#: A point within this of a line [mm] is on it.
_TOUCH = 1e-6
#: Longest piece of contour that is judged as one, in R; how many pieces a segment may become; how many to test at once.
_PIECE, _PIECES, _CHUNK = 0.25, 64, 16
#: How far behind the contour to look for other turns, in R, since a tool reaches 2R from its own block; where first.
_REACH, _NEAR = 2.5, 0.05
#: Directions of that look against the normal [deg], beside straight ahead.
_ASIDE = (20.0, -20.0, 40.0, -40.0, 60.0, -60.0, 80.0, -80.0)
#: How far off a corner to look, in units of how far behind the contour; right for edges down to half a degree.
_OFF_CORNER = 100
#: Looks worked on at a time, for the sake of memory.
_BATCH = 16384


@dataclass(frozen=True, slots=True)
class Overcut:
    """
    Cuts into contours, k of them.

    row: int64[k], programmed row that is cut into. move: int64[k], index of the move of the tool center.
    depth: float64[k] [mm]. place: complex128[k] [mm], the point of the contour that is cut deepest.
    """

    row: Rows
    move: Rows
    depth: Floats
    place: Points


def overcuts(contour: Curves, left: Mask, path: Curves, radius: Floats, tolerance: float = TOLERANCE) -> Overcut:
    """
    Where the tool center path comes nearer than R to the contour of its loop; the worst place of each row.

    contour: the programmed blocks in offset mode. left: bool[moves of contour], the tool runs left of the block: G41
    with R above 0, G42 with R below. path: the tool center's moves in offset mode, corners included, each with the row
    of its block. radius: float64[moves of path] [mm], |R|; the smallest of a loop is taken. `move` counts the path.
    Curves with anything unknown are left out.
    """
    walls, ways = segments(contour, tolerance), segments(path, tolerance)
    ways = ways[(radius[ways.move] > tolerance) & np.isin(ways.loop, walls.loop)]
    loops, first = np.unique(ways.loop, return_index=True)
    smallest = np.minimum.reduceat(radius[ways.move], first) if len(first) else np.zeros(0)
    close = _close(walls, loops, _polylines(ways), smallest - tolerance)
    if not len(close):
        return _nothing()

    pieces = _pieces(walls, loops[close], smallest[close], left, tolerance)
    here, group = members(ways.loop, loops[close])
    ways = ways[here].shifted(pieces.pitch * group)
    paths = _polylines(ways)
    shapely.prepare(paths)
    rows = _close_pieces(pieces, paths, tolerance)
    cuts = _cuts(pieces, rows, paths[pieces.group[rows]])
    cuts = cuts[cuts.depth > tolerance]
    if not len(cuts.piece):
        return _nothing()
    way = _on_way(ways, cuts.tool)
    cuts, way = cuts[way >= 0], way[way >= 0]
    real = _bounds_part(pieces, cuts, _touching(contour, path.row[ways.move[way]], pieces, cuts))
    return _worst(contour, pieces, cuts[real], ways.move[way[real]], by_row=True)


def sweeps(contour: Curves, left: Mask, ramps: Curves, radius: Floats, tolerance: float = TOLERANCE) -> Overcut:
    """
    Start-ups and offset cancels that cut the contour of their loop on their way; the worst place of each ramp.

    contour, left: as for overcuts. ramps: the tool center's moves of start-up and cancel, `row` theirs; `move` of the
    result counts them. radius: float64[ramps] [mm], |R|.
    A ramp touches the contour at one end and comes there at a slant, whereby it nicks the corner of a contour that
    ends in the open. So within R of that end, along the contour, only what the tool center cuts from behind the block
    counts, and only where it is more than the slant makes unavoidable.
    """
    walls, ways = segments(contour, tolerance), segments(ramps, tolerance)
    ways = ways[(radius[ways.move] > tolerance) & np.isin(ways.loop, walls.loop)]
    ways = ways[_close(walls, ways.loop, _lines(ways.start, ways.end), radius[ways.move] - tolerance)]
    if not len(ways.move):
        return _nothing()

    pieces = _pieces(walls, ways.loop, radius[ways.move], left, tolerance)
    ways = ways.shifted(pieces.pitch * np.arange(len(ways.move)))
    group = pieces.group
    begins = ramps.row[ways.move[group]] < contour.row[pieces.move]
    touched = _length_from_end(pieces, begins) < pieces.radius[group]
    behind, counts = _behind(pieces, ways[group], touched, tolerance)
    rows = np.flatnonzero(counts & _may_reach(pieces, behind))
    cuts = _cuts(pieces, rows, _lines(behind.start[rows], behind.end[rows]))
    allowed = np.where(touched, _slant(ways.end - ways.start, pieces.radius)[group], 0)
    cuts = cuts[cuts.depth > tolerance + allowed[rows]]
    if not len(cuts.piece):
        return _nothing()

    begins, group = begins[cuts.piece], group[cuts.piece]
    last = np.searchsorted(pieces.group, group, side="right") - 1
    ends = np.where(begins, np.searchsorted(pieces.group, group), last)
    touching = _off_corner(pieces, ends, np.where(begins, pieces.start[ends], pieces.end[ends]))
    real = _bounds_part(pieces, cuts, touching)
    return _worst(contour, pieces, cuts[real], ways.move[group[real]], by_row=False)


def _nothing() -> Overcut:
    none = np.zeros(0, dtype=np.int64)
    return Overcut(none, none, np.zeros(0), np.zeros(0, dtype=np.complex128))


# ---- segments to lines ----


def _polylines(parts: Segments) -> Lines:
    """One line for each loop; where segments do not join, a line between bridges the gap."""
    start, end = parts.start, parts.end
    if not len(start):
        return np.zeros(0, dtype=object)
    _, number = np.unique(parts.loop, return_inverse=True)
    goes_on = (end[:-1] == start[1:]) & (number[1:] == number[:-1])
    ends = np.flatnonzero(np.append(~goes_on, True))
    numbers = np.insert(number, ends + 1, number[ends])
    return np.asarray(shapely.linestrings(_coordinates(np.insert(start, ends + 1, end[ends])), indices=numbers))


def _lines(start: Points, end: Points) -> Lines:
    return np.asarray(shapely.linestrings(_coordinates(np.stack([start, end], axis=1))))


def _coordinates(points: Points) -> Floats:
    return np.ascontiguousarray(points).view(np.float64).reshape(*points.shape, 2)


def _close(walls: Segments, loops: Rows, paths: Lines, limit: Floats) -> Rows:
    """Which paths come nearer than the limit to the contour of their loop."""
    contours = _polylines(walls)
    shapely.prepare(contours)
    of_path = contours[np.searchsorted(np.unique(walls.loop), loops)]
    return np.flatnonzero(shapely.dwithin(of_path, paths, limit))


# ---- the contour in pieces ----


@dataclass(frozen=True)
class _Pieces:
    """
    The contours of several paths or ramps, `group`, in short straight pieces.

    They lie side by side, each shifted by pitch * group along X, so that one search tree serves all.
    normal: unit vector to the tool's side. move: of the contour. radius: R by group. behind: how far behind the contour
    to stand when looking for what lies there; beyond rounding, below what is an overcut.
    """

    start: Points
    end: Points
    normal: Points
    move: Rows
    group: Rows
    radius: Floats
    pitch: float
    behind: float

    @cached_property
    def tree(self) -> shapely.STRtree:
        return shapely.STRtree(_lines(self.start, self.end))

    def middle(self, rows: Rows) -> Points:
        result: Points = (self.start[rows] + self.end[rows]) / 2
        return result

    def lines(self, rows: Rows) -> Lines:
        return _lines(self.start[rows], self.end[rows])


def _pieces(walls: Segments, loops: Rows, radius: Floats, left: Mask, tolerance: float) -> _Pieces:
    here, group = members(walls.loop, loops)
    walls = walls[here]
    way = walls.end - walls.start
    count = np.clip(np.ceil(np.abs(way) / (_PIECE * radius[group])), 1, _PIECES).astype(np.int64)
    which = np.repeat(np.arange(len(way)), count)
    place = np.arange(len(which)) - (np.cumsum(count) - count)[which]
    extent = np.abs([walls.start.real, walls.end.real]).max()
    pitch = float(2 * extent + 2 * (_REACH + 1) * radius.max())
    start = walls.start[which] + way[which] * (place / count[which]) + pitch * group[which]
    end = np.where(place + 1 == count[which], walls.end[which] + pitch * group[which], np.append(start[1:], 0))
    move = walls.move[which]
    normal = np.where(left[move], 1j, -1j) * (way / np.abs(way))[which]
    return _Pieces(start, end, normal, move, group[which], radius, pitch, tolerance / 8)


def _length_from_end(pieces: _Pieces, from_start: Mask) -> Floats:
    """Length along the contour from its start, or else from its end, to each piece."""
    length = np.abs(pieces.end - pieces.start)
    total = np.cumsum(length)
    first = np.searchsorted(pieces.group, pieces.group)
    last = np.searchsorted(pieces.group, pieces.group, side="right") - 1
    return np.asarray(np.where(from_start, total - length - (total - length)[first], total[last] - total))


def _may_reach(pieces: _Pieces, ways: Segments) -> Mask:
    """Which pieces could be within R of their way, judged from their middle."""
    way = ways.end - ways.start
    to_middle = (pieces.start + pieces.end) / 2 - ways.start
    share = np.clip((to_middle * way.conj()).real / np.maximum(np.abs(way) ** 2, ZERO), 0, 1)
    reach = pieces.radius[pieces.group] + np.abs(pieces.end - pieces.start) / 2
    return np.asarray(np.abs(to_middle - share * way) < reach)


def _behind(pieces: _Pieces, ways: Segments, only_there: Mask, tolerance: float) -> tuple[Segments, Mask]:
    """The parts of ways that lie behind a piece of contour, where only those count; False where none is left."""
    before = ((ways.start - pieces.start) * pieces.normal.conj()).real + tolerance
    after = ((ways.end - pieces.start) * pieces.normal.conj()).real + tolerance
    cut_start, cut_end = only_there & (before > 0), only_there & (after > 0)
    share = np.divide(before, before - after, where=before != after, out=np.zeros(len(before)))
    crossing = ways.start + (ways.end - ways.start) * share
    start, end = np.where(cut_start, crossing, ways.start), np.where(cut_end, crossing, ways.end)
    return Segments(start, end, ways.move, ways.loop), ~(cut_start & cut_end)


def _slant(way: Points, radius: Floats) -> Floats:
    """How deep a ramp nicks the point that it leads to if it ends perpendicular to its own programmed direction."""
    length = np.abs(way)
    return np.asarray(radius * (1 - np.sqrt(np.maximum(length**2 - radius**2, 0)) / length))


# ---- what is cut ----


@dataclass(frozen=True, slots=True)
class _Cuts:
    """Pieces that are cut into, the deepest place of each, where the tool center is then, and the depth."""

    piece: Rows
    place: Points
    tool: Points
    depth: Floats

    def __getitem__(self, rows: Rows | Mask) -> _Cuts:
        return _Cuts(self.piece[rows], self.place[rows], self.tool[rows], self.depth[rows])


def _cuts(pieces: _Pieces, rows: Rows, ways: Lines) -> _Cuts:
    """How the tool center on these ways comes to the pieces, one way for each."""
    ends = shapely.get_coordinates(shapely.shortest_line(ways, pieces.lines(rows))).view(np.complex128).reshape(-1, 2)
    depth = pieces.radius[pieces.group[rows]] - np.abs(ends[:, 1] - ends[:, 0])
    return _Cuts(rows, ends[:, 1], ends[:, 0], depth)


def _close_pieces(pieces: _Pieces, paths: Lines, tolerance: float) -> Rows:
    """Pieces that may be cut by the path of their group and have no other turn straight behind their middle."""
    begins = np.diff(pieces.group, prepend=-1) != 0
    place = np.arange(len(begins)) - np.flatnonzero(begins)[np.cumsum(begins) - 1]
    chunk = np.cumsum(place % _CHUNK == 0) - 1
    ends = np.stack([pieces.start, pieces.end], axis=1).ravel()
    chunks = shapely.linestrings(_coordinates(ends), indices=np.repeat(chunk, 2))
    group = pieces.group[place % _CHUNK == 0]
    rows = np.flatnonzero(shapely.dwithin(paths[group], chunks, pieces.radius[group] - tolerance)[chunk])
    rows = rows[~_another_turn(pieces, rows, pieces.middle(rows), _NEAR, (0.0,))]
    return np.asarray(rows[~_another_turn(pieces, rows, pieces.middle(rows), _REACH, (0.0,))])


def _on_way(ways: Segments, point: Points) -> Rows:
    """The way that each point lies on; -1 where that is but the bridge over a gap."""
    tree = shapely.STRtree(_lines(ways.start, ways.end))
    aside = (1 + 1j) * _TOUCH
    which, way = tree.query(_lines(point - aside, point + aside))
    along = ways.end[way] - ways.start[way]
    share = np.clip(((point[which] - ways.start[way]) * along.conj()).real / np.abs(along) ** 2, 0, 1)
    on = np.abs(ways.start[way] + share * along - point[which]) <= _TOUCH
    result = np.full(len(point), -1)
    result[which[on][::-1]] = way[on][::-1]
    return result


def _touching(contour: Curves, row: NDArray[np.integer], pieces: _Pieces, cuts: _Cuts) -> Points:
    """Where the tool that cuts touches its own block, given by row, if that is a line; else the tool center itself."""
    order = np.argsort(contour.row, kind="stable")
    own = order[np.minimum(np.searchsorted(contour.row[order], row), len(order) - 1)]
    start, way = contour.start[own] + pieces.pitch * pieces.group[cuts.piece], contour.end[own] - contour.start[own]
    long = np.maximum(np.abs(way), ZERO)
    margin = np.minimum(_OFF_CORNER * pieces.behind / long, 0.5)
    share = np.clip(((cuts.tool - start) * way.conj()).real / long**2, margin, 1 - margin)
    is_line = (contour.row[own] == row) & np.isnan(contour.center[own])
    return np.where(is_line, start + share * way, cuts.tool)


def _worst(contour: Curves, pieces: _Pieces, cuts: _Cuts, move: Rows, by_row: bool) -> Overcut:
    """The deepest cut of each row or of each move."""
    block = pieces.move[cuts.piece]
    owner = block if by_row else move
    order = np.lexsort((-cuts.depth, owner))
    worst = order[np.flatnonzero(np.diff(owner[order], prepend=-1))]
    place = cuts.place - pieces.pitch * pieces.group[cuts.piece]
    return Overcut(contour.row[block[worst]].astype(np.int64), move[worst], cuts.depth[worst], place[worst])


# ---- whether the part ends there ----


def _bounds_part(pieces: _Pieces, cuts: _Cuts, touching: Points) -> Mask:
    """
    Whether the finished part ends where it is cut: no block asks for the material behind, whichever way one looks from
    there, above all towards the point where the tool touches its own block.
    """
    place = _off_corner(pieces, cuts.piece, cuts.place)
    result = ~_another_turn(pieces, cuts.piece, place, _REACH, (0.0, *_ASIDE))
    left = np.flatnonzero(result)
    result[left] = ~_in_view(pieces, cuts.piece[left], place[left], touching[left])
    left = np.flatnonzero(result)
    result[left] = ~_is_blade(pieces, cuts.piece[left], place[left])
    return result


def _off_corner(pieces: _Pieces, rows: Rows, place: Points) -> Points:
    """These places of pieces, but not right at their ends; behind one side of a sharp edge is in front of the other."""
    inwards = pieces.middle(rows) - place
    share = np.minimum(1, _OFF_CORNER * pieces.behind / np.maximum(np.abs(inwards), ZERO))
    return np.asarray(place + share * inwards)


def _another_turn(pieces: _Pieces, rows: Rows, point: Points, reach: float, looks: tuple[float, ...]) -> Mask:
    """Whether a tool side is seen from behind these points of these pieces, at one of the angles [deg], in reach."""
    seen = np.zeros(len(rows), dtype=np.bool_)
    for angle in looks:
        for first in range(0, len(rows), _BATCH):
            left = first + np.flatnonzero(~seen[first : first + _BATCH])
            normal, radius = pieces.normal[rows[left]], pieces.radius[pieces.group[rows[left]]]
            ray = -np.exp(1j * np.radians(angle)) * reach * radius * normal
            seen[left] = _shows_tool_side(pieces, point[left] - pieces.behind * normal, ray)
    return seen


def _in_view(pieces: _Pieces, rows: Rows, point: Points, target: Points) -> Mask:
    """Whether a tool side is seen from behind these points of these pieces in the direction of the target."""
    start = point - pieces.behind * pieces.normal[rows]
    ray = target - start
    # A little beyond, to be sure to cross what is there.
    beyond = 0.01 * pieces.radius[pieces.group[rows]] / np.maximum(np.abs(ray), ZERO)
    return _shows_tool_side(pieces, start, ray * (1 + beyond))


def _shows_tool_side(pieces: _Pieces, start: Points, ray: Points) -> Mask:
    """Whether the first piece that each ray meets turns its tool side to the start; False where there is none."""
    which, piece, distance = _crossings(pieces, start, start + ray)
    first = np.full(len(ray), np.inf)
    np.minimum.at(first, which, distance)
    met = distance <= first[which] + 1e-9
    faces = ((start[which] - pieces.start[piece]) * pieces.normal[piece].conj()).real > 0
    backs = np.bincount(which[met & ~faces], minlength=len(ray))
    return np.asarray((first < np.inf) & (backs == 0))


def _is_blade(pieces: _Pieces, rows: Rows, point: Points) -> Mask:
    """Whether these points of these pieces have the back of another one within the tolerance behind them."""
    normal = pieces.normal[rows]
    which, piece, _ = _crossings(pieces, point + pieces.behind * normal, point - 8 * pieces.behind * normal)
    apart = np.abs(piece - rows[which]) > 1
    against = (pieces.normal[piece] * normal[which].conj()).real < -0.5
    return np.bincount(which[apart & against], minlength=len(rows)) > 0


def _crossings(pieces: _Pieces, start: Points, end: Points) -> tuple[Rows, Rows, Floats]:
    """Where these lines cross pieces: which line, which piece, at what share of the line."""
    which, piece = pieces.tree.query(_lines(start, end))
    ray, wall = (end - start)[which], (pieces.end - pieces.start)[piece]
    to_wall = pieces.start[piece] - start[which]
    both = (ray.conj() * wall).imag
    both[both == 0] = np.nan
    along, across = (to_wall.conj() * wall).imag / both, (to_wall.conj() * ray).imag / both
    hit = (along >= 0) & (along <= 1) & (across >= -1e-9) & (across <= 1 + 1e-9)
    return which[hit], piece[hit], along[hit]
