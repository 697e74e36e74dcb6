"""
Straight walls cut where they cross or touch, so that they meet at common nodes only; groups of walls by themselves.

Points that are nearer than TOUCH are one node. Nothing is said of a group whose walls cross again and again: a path
that does is no contour, and its faces would grow with the square of its blocks.
"""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, first_of_each, ranges
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.plane import cross
from polarcheck.geometry.tolerances import CROSSINGS, FREE_CROSSINGS, TOUCH

#: Pairs of walls to compare for each wall of a group, and beyond that, before it is taken to cross too often.
_PAIRS, _FREE_PAIRS = 64, 4_000_000
#: Walls of a run at most, and how far it may turn [rad]; a run or two neighbours below half a turn cross nowhere.
_RUN, _BEND, _HALF_TURN = 16, np.pi / 4, 3.0
#: Runs and about how many pairs to work on at a time, for the sake of memory.
_LEAST_AT_A_TIME, _PAIRS_AT_A_TIME = 16, 100_000


class Edges(msgspec.Struct, frozen=True):
    """
    Parts of walls between nodes, in the order of the walls.

    nodes: complex128[m] [mm]. start, end: int[n], nodes. wall: int[n], the wall that each is part of.
    tangled: bool[groups], groups that cross too often; they have no edges.
    """

    nodes: Points
    start: Rows
    end: Rows
    wall: Rows
    tangled: Mask


def noded(start: Points, end: Points, group: Rows) -> Edges:
    """
    The walls from start to end [mm], cut at every point that they have in common with others of their group.

    group: int[n], from 0, rising. Walls of different groups must not come near each other.
    """
    long, walls, tangled = _walls(start, end, group)
    remaining = CROSSINGS * np.bincount(group, minlength=len(tangled)) + FREE_CROSSINGS
    meetings = [_nothing_in_common()]
    for first, second in _pairs(walls, tangled):
        meetings.append(_meetings(walls, first, second))
        _, crossings, _ = meetings[-1]
        remaining -= np.bincount(walls.group[crossings.first], minlength=len(tangled))
        tangled |= remaining < 0
        keep_time()
    edges = _cut(walls, meetings, tangled)
    return msgspec.structs.replace(edges, wall=long[edges.wall])


def _walls(start: Points, end: Points, group: Rows) -> tuple[Rows, _Walls, Mask]:
    """The walls that have a length, which of all walls they are, and a mask of groups, none of them tangled yet."""
    goes_on = np.append(end[:-1] == start[1:], False)[: len(end)]
    nodes, number = _vertices(np.concatenate([start, end[~goes_on]]))
    a = number[: len(start)]
    b = np.append(a[1:], -1)[: len(a)]
    b[~goes_on] = number[len(start) :]
    long = np.flatnonzero(a != b)
    tangled = np.zeros(int(group[-1]) + 1 if len(group) else 0, bool)
    return long, _Walls(nodes, a[long], b[long], group[long]), tangled


def may_share_stretches(start: Points, end: Points, group: Rows) -> Mask:
    """
    True for walls that may run along another wall of their group, and for all of a group that crosses too often.

    The arguments are those of `noded`. Walls that only cross or touch are not among them.
    """
    long, walls, tangled = _walls(start, end, group)
    vector = walls.nodes[walls.b] - walls.nodes[walls.a]
    result = np.zeros(len(start), bool)
    for first, second in _pairs(walls, tangled):
        along, other = vector[first], vector[second]
        parallel = np.abs((along.conj() * other).imag) <= TOUCH * np.maximum(np.abs(along), np.abs(other))
        result[long[first[parallel]]] = result[long[second[parallel]]] = True
    return result | tangled[group]


def _vertices(points: Points) -> tuple[Points, Rows]:
    """The different ones of these points, to a tenth of TOUCH, and which of them each is."""
    unit = TOUCH / 10
    across, up = np.rint(points.real / unit).astype(np.int64), np.rint(points.imag / unit).astype(np.int64)
    # Two odd numbers without a common pattern: different points have different sums but for a chance of 2 ** -64.
    key = across.view(np.uint64) * np.uint64(0x9E3779B97F4A7C15) + up.view(np.uint64) * np.uint64(0xC2B2AE3D27D4EB4F)
    first, which = first_of_each(key)
    return points[first], which


class _Walls(msgspec.Struct, frozen=True):
    """nodes: points [mm]; a, b: the nodes of both ends of each wall; group."""

    nodes: Points
    a: Rows
    b: Rows
    group: Rows


# ---- which walls may meet ----


class _Runs(msgspec.Struct, frozen=True):
    """
    Walls that go on from each other and bend little, from `first` on, `size` of them.

    bend: how far each run bends [rad]; joint: how far it turns away from the one before, which counts for its bend as
    well; joined: it goes on from that at all. begin, end: complex128 [mm]; along: unit vector between; right, left: how
    far it reaches to either side of the line through the center of C along that, to the left above 0 [mm]; wide: its
    greatest distance from the line between, and TOUCH [mm].
    """

    first: Rows
    size: Rows
    bend: Floats
    joint: Floats
    joined: Mask
    begin: Points
    end: Points
    along: Points
    right: Floats
    left: Floats
    wide: Floats


def _runs(walls: _Walls) -> _Runs:
    start, vector = walls.nodes[walls.a], walls.nodes[walls.b] - walls.nodes[walls.a]
    joined = np.zeros(len(vector), bool)
    joined[1:] = (walls.b[:-1] == walls.a[1:]) & (walls.group[1:] == walls.group[:-1])
    bend = np.zeros(len(vector))
    bend[1:] = np.abs(np.angle(vector[1:] * vector[:-1].conj()))
    total = np.cumsum(bend)
    begins = ~joined | (np.arange(len(vector)) % _RUN == 0)
    begins[1:] |= np.floor(total[1:] / _BEND) != np.floor(total[:-1] / _BEND)
    first = np.flatnonzero(begins)
    size = np.diff(np.append(first, len(vector)))
    begin, end = start[first], walls.nodes[walls.b[first + size - 1]]
    along = (end - begin) / np.abs(end - begin)
    aside = ((start - np.repeat(begin, size)) * np.repeat(along.conj(), size)).imag
    low, high = np.minimum.reduceat(aside, first), np.maximum.reduceat(aside, first)
    line, wide = cross(along, begin), np.maximum(high, -low) + TOUCH
    bend_of_run, sides = np.add.reduceat(bend, first), (line + low, line + high)
    return _Runs(first, size, bend_of_run, bend[first], joined[first], begin, end, along, *sides, wide)


def _apart(runs: _Runs, run: Rows, second: Rows) -> Mask:
    """A boolean per pair: the second run lies wholly to one side of the strip along the line of the first."""
    along, wide = runs.along[run], runs.wide[second]
    first, last = cross(along, runs.begin[second]), cross(along, runs.end[second])
    return np.asarray(
        (np.minimum(first, last) - wide > runs.left[run]) | (np.maximum(first, last) + wide < runs.right[run])
    )


def _pairs(walls: _Walls, tangled: Mask) -> Iterator[tuple[Rows, Rows]]:
    """Pairs of walls that may have more in common than a joint; groups with too many of them become tangled."""
    if not len(walls.a):
        return
    runs = _runs(walls)
    group, size = walls.group[runs.first], runs.size
    boxes = _boxes(walls, runs.first)
    rectangles = shapely.box(*boxes[0])
    tree = shapely.STRtree(rectangles)
    remaining = _PAIRS * np.bincount(walls.group, minlength=len(tangled)) + _FREE_PAIRS
    begin, step = 0, _LEAST_AT_A_TIME
    batches, count = [], 0
    while begin < len(group):
        keep_time()
        queried = np.arange(begin, min(begin + step, len(group)))
        queried = queried[~tangled[group[queried]]]
        which, second = tree.query(rectangles[queried])
        begin += step
        step = int(np.clip(step * _PAIRS_AT_A_TIME // (len(which) + 1), _LEAST_AT_A_TIME, 2 * step))
        run = queried[which]
        kept = run < second
        run, second = run[kept], second[kept]
        kept = ~_apart(runs, run, second)
        run, second = run[kept], second[kept]
        kept = ~_apart(runs, second, run)
        run, second = run[kept], second[kept]
        bent = runs.bend[run] + runs.bend[second] - runs.joint[run]
        follows = (second == run + 1) & runs.joined[second] & (bent < _HALF_TURN)
        kept = (group[run] == group[second]) & ~follows
        run, second = run[kept], second[kept]
        remaining -= np.bincount(group[run], size[run] * size[second], len(tangled)).astype(np.int64)
        tangled |= remaining < 0
        # Most groups with too many pairs of runs become tangled here, before any pair of walls is compared.
        batches.append((run, second))
        count += len(run)
        if count < _PAIRS_AT_A_TIME and begin < len(group):
            continue
        run, second = (np.concatenate(column) for column in zip(*batches, strict=True))
        kept = ~tangled[group[run]]
        run, second, batches, count = run[kept], second[kept], [], 0
        for part in _shares(size[run] * size[second]):
            kept = part[~tangled[group[run[part]]]]
            yield _each_wall(walls, boxes, runs, run[kept], second[kept])


#: Least x and c, greatest x and c [mm].
_Boxes = list[Floats]


def _boxes(walls: _Walls, first: Rows) -> tuple[_Boxes, _Boxes]:
    """Boxes of runs of walls and of the walls, widened by TOUCH."""
    a, b = walls.nodes[walls.a], walls.nodes[walls.b]
    low = [np.minimum(part(a), part(b)) - TOUCH for part in (np.real, np.imag)]
    high = [np.maximum(part(a), part(b)) + TOUCH for part in (np.real, np.imag)]
    of_runs = [np.minimum.reduceat(side, first) for side in low] + [np.maximum.reduceat(side, first) for side in high]
    return of_runs, [*low, *high]


def _shares(count: Rows) -> list[Rows]:
    """The pairs of runs in batches with about _PAIRS_AT_A_TIME pairs of walls each."""
    share = np.cumsum(count) // _PAIRS_AT_A_TIME
    return np.split(np.arange(len(count)), np.flatnonzero(np.diff(share)) + 1)


def _each_wall(walls: _Walls, boxes: tuple[_Boxes, _Boxes], runs: _Runs, run: Rows, second: Rows) -> tuple[Rows, Rows]:
    """Pairs of a wall of one run and a wall of the other that may meet. boxes: of the runs, and of the walls."""
    of_runs, of_walls = boxes
    i, count = _within(of_walls, of_runs, runs, run, second)
    j, second_count = _within(of_walls, of_runs, runs, second, run)
    pair, index = ranges(count * second_count)
    i = i[(np.cumsum(count) - count)[pair] + index // second_count[pair]]
    j = j[(np.cumsum(second_count) - second_count)[pair] + index % second_count[pair]]
    kept = _overlap(of_walls, i, of_walls, j)
    i, j = i[kept], j[kept]
    kept = ~_lies_aside(walls, i, j)
    i, j = i[kept], j[kept]
    kept = ~_lies_aside(walls, j, i)
    return i[kept], j[kept]


def _within(of_walls: _Boxes, of_runs: _Boxes, runs: _Runs, run: Rows, other: Rows) -> tuple[Rows, Rows]:
    """The walls of each run whose boxes overlap that of the other run, run after run, and how many each run has."""
    pair, index = ranges(runs.size[run])
    wall = runs.first[run][pair] + index
    kept = _overlap(of_walls, wall, of_runs, other[pair])
    return wall[kept], np.bincount(pair[kept], minlength=len(run))


def _overlap(boxes: _Boxes, i: Rows, others: _Boxes, j: Rows) -> Mask:
    """True where box i overlaps box j of the others."""
    (left, below, right, above), (least, lowest, most, highest) = boxes, others
    result = (left[i] <= most[j]) & (least[j] <= right[i])
    rest = np.flatnonzero(result)  # most pairs end here
    i, j = i[rest], j[rest]
    result[rest] = (below[i] <= highest[j]) & (lowest[j] <= above[i])
    return np.asarray(result)


def _lies_aside(walls: _Walls, i: Rows, j: Rows) -> Mask:
    """True where wall j lies completely on one side of the line through wall i."""
    begin, c, d = walls.nodes[walls.a[i]], walls.nodes[walls.a[j]], walls.nodes[walls.b[j]]
    vector = walls.nodes[walls.b[i]] - begin
    far = TOUCH * np.abs(vector)
    first, last = ((c - begin) * vector.conj()).imag, ((d - begin) * vector.conj()).imag
    return np.asarray(((first > far) & (last > far)) | ((first < -far) & (last < -far)))


# ---- where they meet ----


class _Touches(Table, frozen=True):
    """
    Nodes that lie inside a wall.

    node: int[n], the node.
    wall: int[n], the wall that it lies in.
    share: float64[n], how far along the wall it lies, 0 to 1.
    """

    node: Rows
    wall: Rows
    share: Floats


class _Crossings(Table, frozen=True):
    """
    Pairs of walls that cross.

    first, second: int[n], the two walls.
    along_first, along_second: float64[n], how far along each wall the crossing lies, 0 to 1.
    """

    first: Rows
    second: Rows
    along_first: Floats
    along_second: Floats


class _SameNodes(Table, frozen=True):
    """
    Pairs of nodes that are nearer to each other than TOUCH.

    node, other: int[n], the two nodes.
    """

    node: Rows
    other: Rows


_Meetings = tuple[_Touches, _Crossings, _SameNodes]


def _nothing_in_common() -> _Meetings:
    none, nowhere = np.zeros(0, np.int64), np.zeros(0)
    return _Touches(none, none, nowhere), _Crossings(none, none, nowhere, nowhere), _SameNodes(none, none)


def _meetings(walls: _Walls, i: Rows, j: Rows) -> _Meetings:
    """The points that walls i and walls j have in common."""
    nodes, ends = walls.nodes, (walls.a[i], walls.b[i], walls.a[j], walls.b[j])
    a, b, c, d = (nodes[end] for end in ends)
    first, second = b - a, d - c
    touching: list[_Touches] = []
    same: list[_SameNodes] = []
    touches = np.zeros(len(i), bool)
    for wall, tips, begin, along, of_other in ((i, ends[:2], a, first, ends[2:]), (j, ends[2:], c, second, ends[:2])):
        length = np.abs(along)
        for node in of_other:
            local = (nodes[node] - begin) * along.conj() / length
            foot = np.clip(local.real, 0, length)
            near = np.abs(local - foot) <= TOUCH
            at_start, at_end = foot <= TOUCH, foot >= length - TOUCH
            inside = np.flatnonzero(near & ~at_start & ~at_end)
            touching.append(_Touches(node[inside], wall[inside], foot[inside] / length[inside]))
            for close, end in ((at_start, tips[0]), (at_end, tips[1])):
                pair = np.flatnonzero(near & close & (node != end))
                same.append(_SameNodes(node[pair], end[pair]))
            touches |= near
    across = (first.conj() * second).imag
    with np.errstate(all="ignore"):  # walls along each other cross nowhere
        t, s = ((c - a).conj() * second).imag / across, ((c - a).conj() * first).imag / across
    crosses = ~touches & (t > 0) & (t < 1) & (s > 0) & (s < 1)
    return _Touches.concatenated(touching), _Crossings(i, j, t, s)[crosses], _SameNodes.concatenated(same)


# ---- the walls cut there ----


def _cut(walls: _Walls, meetings: list[_Meetings], tangled: Mask) -> Edges:
    """The walls in parts, those of tangled groups left out."""
    touches = _Touches.concatenated([part for part, _, _ in meetings])
    touches = touches[~tangled[walls.group[touches.wall]]]
    crossings = _Crossings.concatenated([part for _, part, _ in meetings])
    crossings = crossings[~tangled[walls.group[crossings.first]]]
    same = _SameNodes.concatenated([part for _, _, part in meetings])
    begin, end = walls.nodes[walls.a[crossings.first]], walls.nodes[walls.b[crossings.first]]
    nodes = np.concatenate([walls.nodes, begin + (end - begin) * crossings.along_first])
    new = np.arange(len(walls.nodes), len(nodes))
    wall = np.concatenate([touches.wall, crossings.first, crossings.second])
    share = np.concatenate([touches.share, crossings.along_first, crossings.along_second])
    node = np.concatenate([touches.node, new, new])
    order = np.lexsort((share, wall))
    wall, node = wall[order], node[order]

    parts = np.bincount(wall, minlength=len(walls.a)) + 1
    of = np.repeat(np.arange(len(walls.a)), parts)
    first_part = np.cumsum(parts) - parts
    first, last = walls.a[of], walls.b[of]
    inner = np.ones(len(of), bool)
    inner[first_part] = False
    first[inner] = node
    last[np.flatnonzero(inner) - 1] = node
    common = np.arange(len(nodes))
    if len(new) or len(same):
        # Where three walls meet in a point, each pair of them has found it.
        nodes, which = _vertices(nodes)
        common = merged(len(nodes), which[same.node], which[same.other])[which]
    first, last = common[first], common[last]
    kept = (first != last) & ~tangled[walls.group[of]]
    return Edges(nodes, first[kept], last[kept], of[kept], tangled)


def merged(count: int, first: Rows, second: Rows) -> Rows:
    """The least equal number for each number below count, if the two numbers of each pair are equal."""
    least = np.arange(count)
    while (least[first] != least[second]).any():
        lower = np.minimum(least[first], least[second])
        np.minimum.at(least, first, lower)
        np.minimum.at(least, second, lower)
        least = least[least]
    return least
