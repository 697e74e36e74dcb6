"""
The largest deviation of two paths that a tool runs, with lines and arcs on the polar plane, and Z.

It is the Fréchet distance: how far apart two points must come that run along the paths, neither of them backwards. So
it hangs on the order of the path and on nothing else: not on how blocks divide it. A path run backwards, or a loop run
twice, differs.

Corners that both paths have pair them piece by piece. Two points that run along a pair of pieces at their own even
speeds give a bound, for all pieces at once; the pieces with the largest bounds are then measured exactly.
"""

from __future__ import annotations

import heapq

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Rows, last_in_run, side_by_side
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.comparison.anchors import anchors
from polarcheck.geometry.comparison.free_space import Budget, Corner, Meeting, OverBudgetError, frechet, is_within
from polarcheck.geometry.comparison.necessary_pairs import are_necessary, distances
from polarcheck.geometry.comparison.polyline import Polyline, polyline
from polarcheck.geometry.plane_path import SpacePath

#: Grids by which corners are paired, as a multiple of the tolerance, the finest first.
_CELLS = (2.0, 16.0, 128.0, 1024.0)
#: A grid is too coarse where its width is that many times the best bound.
_COARSER = 4
#: Chords leave their arcs by this share of the tolerance; results are exact up to it.
_SHARE = 0.02
#: The same as a share of a large deviation.
_COARSE = 2e-4
#: The search for a deviation ends within this share of it.
_PRECISION = 1e-6
#: Pairs of segments that may be looked at: to measure pieces, to measure the whole, to prove that it differs.
_CELLS_OF_PIECES, _CELLS_OF_WHOLE, _CELLS_OF_PROOF = 300_000, 200_000, 1_500_000


class Location(msgspec.Struct, frozen=True):
    """
    Where two paths are farthest apart.

    old, new: plane points on both [mm, X as radius]. old_z, new_z: [mm]. old_move, new_move: the moves, from 0.
    """

    old: complex
    new: complex
    old_z: float
    new_z: float
    old_move: int
    new_move: int


class PathDeviation(msgspec.Struct, frozen=True):
    """
    How far apart two paths are.

    largest: the largest deviation [mm]. is_exact: it is so up to `rounding`; else it is no more than that, and may be
    less: up to the tolerance, and for long paths, which are measured piece by piece. is_within: no more than the
    tolerance. rounding: what chords in the place of arcs and the end of the search add or take away at most [mm].
    place: where; None where a path is empty.
    """

    largest: float
    is_exact: bool
    is_within: bool
    rounding: float
    place: Location | None


def path_deviation(old: SpacePath, new: SpacePath, tolerance: float) -> PathDeviation:
    """
    Return the largest deviation of two paths, measured along both in order.

    tolerance: what is the same [mm], above 0.
    Every move must be known (`SpacePath.is_known`): ValueError if not. An empty path against another one deviates by
    inf. Raises TooHardError.
    """
    if not (old.is_known.all() and new.is_known.all()):
        raise ValueError("a move is not known")
    if not len(old) or not len(new):
        apart = 0.0 if len(old) == len(new) else np.inf
        return PathDeviation(apart, True, not apart, 0.0, None)
    rounding = tolerance * _SHARE
    pieces, of_chords = _in_chords(old, new, tolerance, rounding)
    if pieces.largest * _COARSE > rounding:
        # Fewer chords tell a large deviation well enough.
        pieces, of_chords = _in_chords(old, new, tolerance, pieces.largest * _COARSE)
    largest, location, piece = _measured(pieces, tolerance)
    is_exact = False
    if largest > tolerance:
        largest, location, is_exact = _proven(pieces, largest, location, piece, tolerance)
    return PathDeviation(largest, is_exact, largest <= tolerance, rounding + of_chords, location)


def _in_chords(old: SpacePath, new: SpacePath, tolerance: float, sagitta: float) -> tuple[_Pieces, float]:
    """The paths in pieces, and how far their chords may lie from their arcs [mm]."""
    (first, of_old), (second, of_new) = (polyline(path, sagitta) for path in (old, new))
    return _best_pieces(first, second, tolerance), of_old + of_new


class _Pieces(msgspec.Struct, frozen=True):
    """
    Pieces of two polylines between paired corners, k of them.

    old_at, new_at: int[k + 1], the paired corners.
    bound: float64[k], no piece deviates by more [mm].
    share: float64[k], where two points at even speeds are farthest apart, from 0 to 1 of the piece.
    """

    old: Polyline
    new: Polyline
    old_at: Rows
    new_at: Rows
    bound: Floats
    share: Floats

    @property
    def largest(self) -> float:
        return float(self.bound.max())


def _best_pieces(old: Polyline, new: Polyline, tolerance: float) -> _Pieces:
    """The pieces with the least bound: corners paired one by one, where both have as many, or by where they lie."""
    corners = [np.flatnonzero(line.ends_move) for line in (old, new)]
    best = _pieces(old, new, corners[0], corners[1]) if len(corners[0]) == len(corners[1]) else None
    width = tolerance
    for cell in _CELLS:
        # A much coarser grid pairs corners that lie farther apart than those paired already.
        if best is not None and best.largest <= max(tolerance, width / _COARSER):
            break
        keep_time()
        width = tolerance * cell
        places = [(line.point[corner], line.z[corner]) for line, corner in zip((old, new), corners, strict=True)]
        paired = anchors(places[0], places[1], width)
        by_place = _pieces(old, new, corners[0][paired[0]], corners[1][paired[1]])
        best = by_place if best is None or by_place.largest < best.largest else best
    assert best is not None
    return best


def _pieces(old: Polyline, new: Polyline, old_at: Rows, new_at: Rows) -> _Pieces:
    """Pieces between paired corners; the ends of the lines are paired."""
    ends = len(old) - 1, len(new) - 1
    inner = (old_at > 0) & (new_at > 0) & (old_at < ends[0]) & (new_at < ends[1])
    old_at, new_at = (
        np.concatenate(([0], corners[inner], [end])) for corners, end in zip((old_at, new_at), ends, strict=True)
    )
    along = [_along(line, corners) for line, corners in zip((old, new), (old_at, new_at), strict=True)]
    moment = np.concatenate(along)
    distance = _distance(old, along[0], new, along[1], moment)
    piece = np.minimum(moment.astype(np.int64), len(old_at) - 2)
    # A paired corner ends one piece and begins the next, and is as far apart in both.
    order = np.lexsort((distance, piece))
    last = np.flatnonzero(last_in_run(piece[order]))
    bound, share = np.zeros(len(old_at) - 1), np.zeros(len(old_at) - 1)
    bound[piece[order][last]] = distance[order][last]
    share[piece[order][last]] = (moment - piece)[order][last]
    at_corner = _distance(old, along[0], new, along[1], np.arange(1.0, len(old_at)))
    share = np.where(at_corner > bound, 1.0, share)
    return _Pieces(old, new, old_at, new_at, np.maximum(bound, at_corner), share)


def _along(line: Polyline, corners: Rows) -> Floats:
    """When a point comes to each corner: at k to the paired corner k, at an even speed between two of them."""
    length = line.length
    if len(line) == 1:
        return np.zeros(1)
    rising = np.append(np.diff(length[corners]) > 0, True)
    moments = np.arange(float(len(corners)))
    return np.asarray(np.interp(length, length[corners][rising], moments[rising]))


def _distance(old: Polyline, old_along: Floats, new: Polyline, new_along: Floats, moment: Floats) -> Floats:
    """The distance of the two points at these moments [mm]."""
    (a, a_z), (b, b_z) = (_interpolated(line, along, moment) for line, along in ((old, old_along), (new, new_along)))
    return np.hypot(np.abs(a - b), a_z - b_z)


def _interpolated(
    line: Polyline, along: Floats, moment: Floats
) -> tuple[np.ndarray[tuple[int], np.dtype[np.complex128]], Floats]:
    x, c, z = (np.interp(moment, along, part) for part in (line.point.real, line.point.imag, line.z))
    return x + 1j * c, z


def _measured(pieces: _Pieces, tolerance: float) -> tuple[float, Location, int]:
    """The largest deviation of all pieces, its place and piece: the piece with the largest bound is measured first."""
    budget = Budget(_CELLS_OF_PIECES)
    waiting = [(-bound, number) for number, bound in enumerate(pieces.bound.tolist())]
    heapq.heapify(waiting)
    locations: dict[int, Location] = {}
    while True:
        keep_time()
        bound, number = -waiting[0][0], waiting[0][1]
        if number in locations or bound <= tolerance:
            return bound, locations.get(number) or _location_of_bound(pieces, number), number
        old, new = (_corners(pieces.old, pieces.old_at, number), _corners(pieces.new, pieces.new_at, number))
        precision = max(tolerance * _SHARE, bound * _PRECISION)
        try:
            exact, meeting = frechet(old, new, bound, precision, budget)
        except OverBudgetError:
            return bound, _location_of_bound(pieces, number), number
        locations[number] = _location(pieces, number, meeting)
        heapq.heapreplace(waiting, (-exact, number))


def _corners(line: Polyline, corners: Rows, piece: int) -> list[Corner]:
    part = line[int(corners[piece]) : int(corners[piece + 1]) + 1]
    return list(side_by_side(part.point.real, part.point.imag, part.z))


def _location(pieces: _Pieces, piece: int, meeting: Meeting) -> Location:
    numbers = (pieces.old_at[piece] + meeting.in_old + 1, pieces.new_at[piece] + meeting.in_new + 1)
    old_move, new_move = (
        int(line.move[min(int(number), len(line) - 1)])
        for line, number in zip((pieces.old, pieces.new), numbers, strict=True)
    )
    (x, c, z), (new_x, new_c, new_z) = meeting.old, meeting.new
    return Location(complex(x, c), complex(new_x, new_c), z, new_z, old_move, new_move)


def _location_of_bound(pieces: _Pieces, piece: int) -> Location:
    """Where two points at even speeds are farthest apart."""
    moment = np.array([piece + pieces.share[piece]])
    sides = []
    for line, corners in ((pieces.old, pieces.old_at), (pieces.new, pieces.new_at)):
        along = _along(line, corners)
        point, z = _interpolated(line, along, moment)
        corner = min(int(np.searchsorted(along, moment[0])), len(line) - 1)
        sides.append((complex(point[0]), float(z[0]), int(line.move[corner])))
    (old, old_z, old_move), (new, new_z, new_move) = sides
    return Location(old, new, old_z, new_z, old_move, new_move)


def _proven(
    pieces: _Pieces, largest: float, location: Location, piece: int, tolerance: float
) -> tuple[float, Location, bool]:
    """
    The deviation for any pairing of corners, its place, and whether it is exact: long paths take too many cells.

    location, piece: where two points are farthest apart in the pieces.
    """
    precision = max(tolerance * _SHARE, largest * _PRECISION)
    # However the corners are paired, a point is never nearer to the other path than to the nearest point of it.
    sides = (pieces.new, location.old, location.old_z), (pieces.old, location.new, location.new_z)
    least = max(float(distances(*side).min()) for side in sides)
    parts = _between_necessary(pieces, largest, tolerance)
    worst = int(np.searchsorted(parts.old_at[1:-1], pieces.old_at[piece], side="right"))
    budget, enough = Budget(_CELLS_OF_WHOLE), tolerance
    hits: dict[int, tuple[float, Meeting]] = {}
    try:
        for number in (worst, *np.flatnonzero(parts.bound > tolerance).tolist()):
            if number in hits or parts.bound[number] <= enough:
                continue
            old, new = (_corners(parts.old, parts.old_at, number), _corners(parts.new, parts.new_at, number))
            lower = max(enough, least) if number == worst else enough
            if lower <= enough and is_within(old, new, enough, Budget(_CELLS_OF_PROOF)):
                continue
            hits[number] = frechet(old, new, largest, precision, budget, lower)
            # Of places that deviate as much, but for the precision, the first one counts.
            enough = max(enough, hits[number][0] - 2 * precision)
    except OverBudgetError:
        return largest, location, False
    if not hits:
        return tolerance, location, False
    exact = max(deviation for deviation, _ in hits.values())
    first = min(number for number, (deviation, _) in hits.items() if deviation >= exact - 2 * precision)
    return exact, _location(parts, first, hits[first][1]), True


def _between_necessary(pieces: _Pieces, largest: float, tolerance: float) -> _Pieces:
    """Pieces joined between the corners beside large deviations that every pairing within the largest one has."""
    is_small = pieces.bound <= tolerance
    corner = 1 + np.flatnonzero(is_small[1:] != is_small[:-1])
    pairs = pieces.old_at[corner], pieces.new_at[corner]
    corner = corner[are_necessary(pieces.old, pieces.new, *pairs, largest)] if len(corner) else corner
    ends = np.concatenate(([0], corner, [len(is_small)]))
    bound = np.maximum.reduceat(pieces.bound, ends[:-1])
    return _Pieces(pieces.old, pieces.new, pieces.old_at[ends], pieces.new_at[ends], bound, np.zeros(len(bound)))
