"""
The area that a cutter clears along a path of its center, and the outline of that area. Lengths in mm,
plane points complex, x + 1j*c.

Each point of the outline is at R from what of the path is nearest to it: beside a line there is a parallel, beside an
arc one about the same center, and round a corner one about that. So the chords of shapely give what bounds the area in
which order, and the path gives the exact curves. Import late: shapely takes its time.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import msgspec
import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, ranges
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.states import Motion
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.outline import Outline, outline_of
from polarcheck.geometry.polygons.faces import coordinates, edges_of, lines_of
from polarcheck.geometry.polygons.widened import widened
from polarcheck.geometry.segments import Curves, Segments, first_of_its_kind, segments
from polarcheck.geometry.tolerances import ROUNDING, TOUCH

#: Arcs of the path have chords with a quarter of this as sagitta at most, and round corners too [mm].
_TOLERANCE = 0.004
#: Chords of a path at one Z, and points whose nearest chord is searched at a time.
_MOST_CHORDS, _POINTS = 1_000_000, 1000
#: Gaps between passes that are narrower than this are rounding and no part [mm].
_SLIT = 0.008
#: Most samples of one chord, R apart, beside which material is searched.
_SAMPLES = 50
#: Rounds in which the common end of two curves is moved to either curve by turns.
_TURNS = 30


class Cleared(NamedTuple):
    """
    A cleared area.

    polygon: the area as a shapely geometry, with chords.
    outline: its boundary as lines and arcs, with the cleared area on the right.
    across: share of the path with material on both sides, which makes a groove.
    """

    polygon: Any
    outline: Outline
    across: float


def cleared(path: Curves, radius: float) -> Cleared:
    """
    The area that a cutter with this R [mm] clears on this path of its center. Moves without a length do not count.

    Raises TooHardError for too many chords, and where the time is over.
    """
    path = path[_distinct(path)]
    chords = segments(path, _TOLERANCE)
    if len(chords) > _MOST_CHORDS:
        raise TooHardError(
            f"a path of {len(chords)} chords at one Z is too long to look at: check its passes separately"
        )
    polygon = _without_slits(widened(path, chords, radius, _TOLERANCE))
    return Cleared(polygon, _outline(polygon, path, chords, radius), _across(polygon, chords, radius))


def _distinct(path: Curves) -> Mask:
    """The first of the moves that run along the same line or arc, whichever way; a boolean per move."""
    back, is_line = path.start - path.end, np.isnan(path.center)
    backward = (path.kind == Motion.CW) | (is_line & ((back.real > 0) | ((back.real == 0) & (back.imag > 0))))
    start, end = np.where(backward, path.end, path.start), np.where(backward, path.start, path.end)
    kind = np.where(is_line, path.kind, np.int16(Motion.CCW))
    return first_of_its_kind(msgspec.structs.replace(path, start=start, end=end, kind=kind))


def _without_slits(area: Any) -> Any:
    """The polygons of an area without holes narrower than _SLIT."""
    kept = []
    for polygon in shapely.get_parts(area):
        holes = shapely.get_rings(polygon)[1:]
        width = 2 * shapely.area(shapely.polygons(holes)) / np.maximum(shapely.length(holes), _SLIT)
        kept.append(shapely.polygons(shapely.get_exterior_ring(polygon), holes[width > _SLIT]))
    return shapely.multipolygons(kept)


def _across(polygon: Any, chords: Segments, radius: float) -> float:
    keep_time()
    vector = chords.end - chords.start
    count = np.clip(np.ceil(np.abs(vector) / radius), 1, _SAMPLES).astype(np.int64)
    of, index = ranges(count)
    share = (index + 0.5) / count[of]
    point = chords.start[of] + share * vector[of]
    aside = 1j * (vector / np.abs(vector))[of] * (radius + _TOLERANCE)
    length = (np.abs(vector) / count)[of]
    shapely.prepare(polygon)
    left, right = (~shapely.intersects_xy(polygon, side.real, side.imag) for side in (point + aside, point - aside))
    return float(length[left & right].sum() / length.sum())


# ---- the outline ----


def _outline(polygon: Any, path: Curves, chords: Segments, radius: float) -> Outline:
    """Its elements are of the moves of the path and, from len(path) on, of the points where these meet."""
    start, end = edges_of(_part_on_left(polygon))
    # Where walls that are in line meet, rounding leaves an edge that would be of a corner.
    has_length = np.abs(end - start) > TOUCH
    start, end = start[has_length], end[has_length]
    middle = (start + end) / 2
    near = _nearest(chords, middle)
    move, corner, at_corner = _sources(middle, near, path, chords)
    source = np.where(at_corner, len(path) + corner, move)
    curves = _curves(path, radius)
    outline = outline_of(start, end, source, curves)
    of = outline.row
    exact = _exact_ends(outline, _exact_curves(outline, of, path, curves, radius))
    return msgspec.structs.replace(exact, row=np.append(path.row, np.repeat(path.row, 2))[exact.row])


def _nearest(chords: Segments, points: Points) -> Rows:
    """The chord that is nearest to each point."""
    tree = shapely.STRtree(lines_of(chords.start, chords.end))
    places = shapely.points(coordinates(points))
    near = np.empty(len(points), np.int64)
    for first in range(0, len(points), _POINTS):
        keep_time()
        point, chord = tree.query_nearest(places[first : first + _POINTS], all_matches=False)
        near[first + point] = chord
    return near


def _part_on_left(area: Any) -> Any:
    """The polygons of an area, oriented with the outside on the left of their edges."""
    polygons = shapely.get_parts(shapely.normalize(area))
    exterior = shapely.get_exterior_ring(polygons)
    # Normalized polygons have holes that run against their exteriors.
    return np.where(shapely.is_ccw(exterior), shapely.reverse(polygons), polygons)


def _sources(middle: Points, near: Rows, path: Curves, chords: Segments) -> tuple[Rows, Rows, Mask]:
    """
    The move beside which each edge lies, and the point of the path round which it does.

    A point is told by the first of all ends of moves that lie there: 2 * move, and 2 * move + 1 for its end.
    """
    move = chords.move[near]
    begin, vector = chords.start[near], chords.end[near] - chords.start[near]
    along = ((middle - begin) * vector.conj()).real / np.abs(vector)
    before, after = along <= ROUNDING, along >= np.abs(vector) - ROUNDING
    # Ends of chords within an arc are no corners: what is round there is the arc.
    at_start = before & (np.abs(begin - path.start[move]) <= ROUNDING)
    at_end = after & (np.abs(begin + vector - path.end[move]) <= ROUNDING)
    ends = np.stack([path.start, path.end], axis=-1).ravel()
    keys = np.round(ends / (10 * ROUNDING))
    _, first, number = np.unique(keys, return_index=True, return_inverse=True)
    corner = first[number][2 * move + at_end]
    return move, corner, np.asarray(at_start | at_end)


def _curves(path: Curves, radius: float) -> Curves:
    """The moves and, behind them, the circles round their starts and ends; the row of each is its own number."""
    ends = np.stack([path.start, path.end], axis=-1).ravel()
    return Curves(
        start=np.append(path.start, ends + radius),
        end=np.append(path.end, ends + radius),
        center=np.append(path.center, ends),
        kind=np.append(path.kind, np.full(len(ends), Motion.CCW)).astype(np.int16),
        loop=np.zeros(3 * len(path), np.int64),
        row=np.arange(3 * len(path)),
    )


class _ExactCurves(NamedTuple):
    """
    The exact curve of each element: a circle by its center and R, or a line by a point of it and its direction.

    corner: the point of the path round which it runs, NaN for what lies beside a move. begin, end: of that move.
    beyond: the circle is on the far side of its center, since R of the move is less than that of the cutter.
    """

    center: Points
    radius: Floats
    point: Points
    along: Points
    corner: Points
    begin: Points
    end: Points
    beyond: Mask

    def nearest(self, point: Points, of: Rows) -> Points:
        """The point of each curve that is nearest to the given point."""
        foot = self.point[of] + ((point - self.point[of]) * self.along[of].conj()).real * self.along[of]
        spoke = point - self.center[of]
        far = np.fmax(np.abs(spoke), ROUNDING)
        return np.where(np.isnan(self.radius[of]), foot, point + spoke * (self.radius[of] / far - 1))

    def touched(self, element: Rows, adjacent: Rows) -> Points:
        """The point where the curve beside a move meets the circle round an end of that move; NaN where it does not."""
        corner = self.corner[adjacent]
        point = self.nearest(corner, element)
        point = np.where(self.beyond[element], 2 * self.center[element] - point, point)
        at_end = np.minimum(np.abs(self.begin[element] - corner), np.abs(self.end[element] - corner)) <= 10 * ROUNDING
        return np.where(at_end & np.isnan(self.corner[element]), point, np.nan)


def _exact_curves(outline: Outline, of: Rows, path: Curves, curves: Curves, radius: float) -> _ExactCurves:
    """Parallel to its source, at R; on the side and at the distance at which the chords are."""
    about = np.abs(outline.start - outline.center)
    arc_radius = np.where(of < len(path), np.abs(curves.start[of] - curves.center[of]), 0.0)
    outside, inside = arc_radius + radius, np.abs(arc_radius - radius)
    circle = np.where(np.abs(about - outside) <= np.abs(about - inside), outside, inside)
    vector = curves.end[of] - curves.start[of]
    along = vector / np.maximum(np.abs(vector), ROUNDING)
    aside = ((outline.start + outline.end) / 2 - curves.start[of]) * along.conj()
    point = curves.start[of] + 1j * along * np.sign(aside.imag) * radius
    is_move = of < len(path)
    return _ExactCurves(
        center=outline.center,
        radius=np.where(outline.is_arc, circle, np.nan),
        point=point,
        along=along,
        corner=np.where(is_move, np.nan, outline.center),
        begin=curves.start[of],
        end=curves.end[of],
        beyond=is_move & outline.is_arc & (circle == inside) & (arc_radius < radius),
    )


def _exact_ends(outline: Outline, curves: _ExactCurves) -> Outline:
    """
    The same elements, with ends where the exact curves of two of them meet: on one and on the other by turns.

    Round the points of a smooth path there is nothing but what its chords make: such elements are left out.
    """
    number = np.arange(len(outline))
    before, following = _adjacent_in_chain(outline)
    point = outline.end
    for _ in range(_TURNS):
        point = curves.nearest(curves.nearest(point, following), number)
    # Curves that hardly cross meet nowhere for sure; what is far from the chords is not where they meet.
    point = np.where(np.abs(point - outline.end) <= 10 * _TOLERANCE, point, outline.end)
    for touched in (curves.touched(number, following), curves.touched(following, number)):
        point = np.where(np.isnan(touched), point, touched)
    exact = msgspec.structs.replace(outline, start=point[before], end=point)
    kept = exact[~(outline.is_arc & (np.abs(exact.sweep - outline.sweep) > np.pi))]
    before, _ = _adjacent_in_chain(kept)
    return msgspec.structs.replace(kept, start=kept.end[before])


def _adjacent_in_chain(outline: Outline) -> tuple[Rows, Rows]:
    """The previous and the next element of each element in its closed chain."""
    number = np.arange(len(outline))
    first = np.searchsorted(outline.chain, outline.chain, side="left")
    last = np.searchsorted(outline.chain, outline.chain, side="right") - 1
    return np.where(number == first, last, number - 1), np.where(number == last, first, number + 1)
