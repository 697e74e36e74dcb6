"""
The deviation of a part from a drawing, to either side; lengths in mm, plane points complex, x + 1j*c.

The outline of the part is measured to the drawing, and the drawing to the outline: either one alone would miss a notch
in the other. If the nearest point of the drawing lies inside the part, too much material remains; else too much is cut.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, column_at, folded, runs
from polarcheck.geometry.comparison.measured_path import MeasuredPath, path_of_outline
from polarcheck.geometry.comparison.rounds import Rounds, rounds_of
from polarcheck.geometry.outline import Outline

#: Points up to this distance [mm] from a circle about the axis are on it.
_ON_CIRCLE = 2e-3
#: Greatest distance of the chords of the bar from its circle [mm].
_CHORDS = 0.01
#: An arc whose center is nearer to the axis than this [mm] is an arc about the axis.
_ABOUT_AXIS = 0.1
#: Points farther than this [mm] beyond the round of the drawing are the path of the tool in the air.
_IN_AIR = 0.1
#: Sine of the angle between lines that are parallel, at most.
_PARALLEL = 0.05
#: The search for an extreme of each side: candidates, rounds of refinement, and parts per round.
_PLACES, _TURNS, _PARTS = 8, 6, 8
#: Deviations that are smaller than the largest by less than this [mm] count as equal to it.
_AS_LARGE = 5e-4


class Difference(NamedTuple):
    """
    How a part differs from a drawing.

    proud: greatest excess of material [mm], 0 for none.
    proud_at: the point of it, on the part or on the drawing [mm].
    proud_of: the element of the outline at that point, -1 for none.
    deep: greatest lack of material [mm], 0 for none.
    deep_at, deep_of: the point of it, and the element.
    mean: mean deviation [mm].
    length: length of the outline that was compared [mm].
    turned: radius of the round of the drawing that is turned, not milled [mm]; inf for none.
    is_broken: a cut runs along a share of the round only.
    is_beyond: the drawing lies beyond the bar, and nowhere within it.
    outside: the element that runs along the round, but outside of it where there may be metal; -1 for none.
    """

    proud: float = 0.0
    proud_at: complex = complex(np.nan)
    proud_of: int = -1
    deep: float = 0.0
    deep_at: complex = complex(np.nan)
    deep_of: int = -1
    mean: float = np.inf
    length: float = 0.0
    turned: float = np.inf
    is_broken: bool = False
    is_beyond: bool = False
    outside: int = -1

    @property
    def largest(self) -> float:
        """The greatest deviation to either side [mm]."""
        return max(self.proud, self.deep)

    @property
    def at(self) -> complex:
        """The point of the greatest deviation [mm]."""
        return self.proud_at if self.proud >= self.deep else self.deep_at

    @property
    def of(self) -> int:
        """The element at that point."""
        return self.proud_of if self.proud >= self.deep else self.deep_of


class MachinedPart(NamedTuple):
    """
    The outline of a part, ready to be compared.

    outline: its chains of lines and arcs.
    way: the outline as chords.
    about_axis: bool[elements], arcs about the axis.
    polygon: the part, prepared by shapely.
    bar: radius of the stock [mm], inf if unknown.
    """

    outline: Outline
    way: MeasuredPath
    about_axis: Mask
    polygon: Any
    bar: float


def machined_part(outline: Outline, polygon: Any, bar: float) -> MachinedPart:
    """The outline of a part, prepared for comparison. bar: radius of the stock [mm], NaN if unknown."""
    about = outline.is_arc & (np.abs(np.where(outline.is_arc, outline.center, np.inf)) <= _ABOUT_AXIS)
    shapely.prepare(polygon)
    return MachinedPart(outline, path_of_outline(outline), about, polygon, np.inf if np.isnan(bar) else bar)


def difference(
    part: MachinedPart, drawn: MeasuredPath, tolerance: float, *, both_ways: bool, metal: float = np.inf
) -> Difference:
    """
    The deviation of the chains of a part from the curves of a drawing.

    tolerance: up to this a cut runs along the round of the drawing [mm]. both_ways: the chains should cover all of
    these curves; else only the chains are measured to the curves. metal: of curves without an end, the radius up to
    which there is metal for certain [mm]: what lies beyond and is no wall may be the way of the tool from one wall to
    the next.
    """
    rounds = rounds_of(drawn, part.way, tolerance)
    places, outside, skips_gaps = _compared(part, drawn, rounds, tolerance)
    if np.isfinite(metal):
        between = _between_walls(part, drawn, metal)[part.way.of[part.way.at(places[0])[1]]]
        places = places[0], places[1] & ~between
    first = _extremes(part.way, lambda points: _from_part(part, drawn, points, skips_gaps), places)
    of_part = _difference(first, lambda points: part.way.of[part.way.nearest(points)[2]])
    of_part = of_part._replace(turned=rounds.turned_radius, is_broken=rounds.is_broken, outside=outside)
    of_part = of_part._replace(is_beyond=_lies_beyond(drawn, part.bar, tolerance))
    if not both_ways:
        return of_part
    along = drawn.samples()
    points, which = drawn.at(along)
    # What lies on the round of the drawing is turned, where the part is not milled there.
    on_round = rounds.turned[which]
    inward = np.where(on_round, points * (1 - _CHORDS / np.maximum(np.abs(points), _CHORDS)), points)
    compared = ~(on_round & _within(part.polygon, inward))
    second = _extremes(drawn, lambda points: _from_drawing(part, points), (along, compared))
    if not second.length:
        return of_part
    of_drawing = _difference(second, lambda points: part.way.of[part.way.nearest(points)[2]])
    proud = of_part if of_part.proud >= of_drawing.proud else of_drawing
    deep = of_part if of_part.deep >= of_drawing.deep else of_drawing
    return of_part._replace(
        proud=proud.proud,
        proud_at=proud.proud_at,
        proud_of=proud.proud_of,
        deep=deep.deep,
        deep_at=deep.deep_at,
        deep_of=deep.deep_of,
        mean=(of_part.mean + of_drawing.mean) / 2,
    )


def _lies_beyond(drawn: MeasuredPath, bar: float, tolerance: float) -> bool:
    (nearest,), _, _ = drawn.nearest(np.zeros(1, complex))
    return bool(nearest > bar - tolerance and np.abs(drawn.start).max() > bar + tolerance)


def _within(polygon: Any, points: Points) -> Mask:
    return np.asarray(shapely.contains_xy(polygon, points.real, points.imag))


def _from_part(part: MachinedPart, drawn: MeasuredPath, points: Points, skips_gaps: bool) -> Floats:
    far, closest, _ = drawn.nearest(points)
    if skips_gaps:
        far = np.where(_is_in_gap(drawn, closest, far), 0, far)
    return np.where(_within(part.polygon, closest), far, -far)


def _from_drawing(part: MachinedPart, points: Points) -> Floats:
    far, _, _ = part.way.nearest(points)
    return np.where(_within(part.polygon, points), far, -far)


def _compared(
    part: MachinedPart, drawn: MeasuredPath, rounds: Rounds, tolerance: float
) -> tuple[tuple[Floats, Mask], int, bool]:
    """
    Distances of sample points along the chains [mm], and a mask of the points to compare; the element that runs along
    the round outside of it, where there may be metal, -1 for none; and whether gaps of the drawing are left out.
    """
    along, turned, outside = part.way.samples(), rounds.turned_radius, -1
    points, which = part.way.at(along)
    size, compared = np.abs(points), np.ones(len(points), bool)
    compared &= size <= part.bar + _ON_CIRCLE
    far, closest, nearest = drawn.nearest(points)
    # Beyond a round that is milled the arcs are compared, but no wall that runs on in the air.
    about_axis = part.about_axis[part.way.of[which]]
    beyond = (size > turned + _ON_CIRCLE) & ~(about_axis & rounds.milled[nearest])
    if beyond.any():
        run: Rows = np.cumsum(np.diff(beyond, prepend=False) | np.diff(about_axis, prepend=False))
        excess = folded(np.maximum, run, size - turned, run[-1] + 1, 0.0)
        in_air = beyond & (excess[run] > np.where(about_axis, tolerance, _IN_AIR))
        along_round = np.flatnonzero(in_air & about_axis & compared)
        outside = int(part.way.of[which[along_round[0]]]) if len(along_round) else -1
        compared &= ~in_air
    compared &= ~_is_in_gap(drawn, closest, far)
    if np.isinf(min(turned, part.bar)):
        compared &= ~_leading(part, which, far)
    skips_gaps = bool(compared.any())
    return (along, compared if skips_gaps else size <= part.bar + _ON_CIRCLE), outside, skips_gaps


def _between_walls(part: MachinedPart, drawn: MeasuredPath, metal: float) -> Mask:
    """Elements of an outline that lie beyond this radius, and are parallel to no line of the drawing."""
    outline = part.outline
    nearest = outline.nearest
    walls = drawn.end - drawn.start
    chord = outline.end - outline.start
    across = np.abs((chord[:, None].conj() * walls).imag) / np.maximum(np.abs(chord[:, None] * walls), 1e-9)
    return np.asarray((nearest > metal) & (outline.is_arc | (across.min(axis=1) > _PARALLEL)))


def _is_in_gap(drawn: MeasuredPath, closest: Points, far: Floats) -> Mask:
    """True for points beside a curve of the drawing: the closest point of it, so far from them, is an open end."""
    begins, last = runs(drawn.of)
    is_open = np.abs(drawn.start[begins] - drawn.end[last]) > 0
    ends = np.concatenate([drawn.start[begins][is_open], drawn.end[last][is_open]])
    return np.asarray(np.isin(np.round(closest, 6), np.round(ends, 6)) & (far > _ON_CIRCLE))


def _leading(part: MachinedPart, which: Rows, far: Floats) -> Mask:
    """
    The points at either end of a chain that is open from which on it comes nearer to the drawing: a wall goes on beyond
    the bar, of which the drawing may show anything.
    """
    chain = part.outline.chain[part.way.of[which]]
    is_open = ~part.outline.closed[chain]
    result = np.zeros(len(far), bool)
    for number in np.unique(chain[is_open]).tolist():
        points_of_chain = np.flatnonzero(chain == number)
        for order in (points_of_chain, points_of_chain[::-1]):
            stops = np.append(far[order[1:]] >= far[order[:-1]], True)
            result[order[: int(np.argmax(stops))]] = True
    return result


class _Extremes(NamedTuple):
    """
    The greatest deviations to both sides.

    proud, deep: the greatest deviation [mm] and its point [mm].
    mean: mean deviation [mm].
    length: length that was compared [mm].
    """

    proud: tuple[float, complex]
    deep: tuple[float, complex]
    mean: float
    length: float


def _extremes(path: MeasuredPath, measured: Callable[[Points], Floats], places: tuple[Floats, Mask]) -> _Extremes:
    """The greatest deviations along a path, refined. places: distances along the path [mm], mask to compare."""
    along, compared = places
    if not compared.any():
        return _Extremes((0.0, complex(np.nan)), (0.0, complex(np.nan)), np.inf, 0.0)
    value = column_at(len(along), compared, measured(path.at(along[compared])[0]), np.nan)
    share = np.gradient(along) if len(along) > 1 else np.ones(1)
    length = float(share[compared].sum())
    mean = float((np.abs(value[compared]) * share[compared]).sum() / length) if length else np.inf
    # The search ends at a neighbour that is not compared.
    low = np.where(np.append(False, compared[:-1]), np.append(along[0], along[:-1]), along)
    high = np.where(np.append(compared[1:], False), np.append(along[1:], along[-1]), along)
    extremes: list[tuple[float, complex]] = []
    for sign in (1, -1):
        best = np.argsort(np.where(compared, -sign * value, np.inf), kind="stable")[:_PLACES]
        best = best[compared[best]]
        peak, least, most = along[best], low[best], high[best]
        for _ in range(_TURNS):
            tried = least[:, None] + (most - least)[:, None] * np.linspace(0, 1, _PARTS + 1)
            tried = np.concatenate([tried, peak[:, None]], axis=1)
            values = sign * measured(path.at(tried.ravel())[0]).reshape(tried.shape)
            peak = tried[np.arange(len(peak)), values.argmax(axis=1)]
            part = (most - least) / _PARTS
            least, most = np.maximum(least, peak - part), np.minimum(most, peak + part)
        values = sign * measured(path.at(peak)[0])
        top = int(values.argmax())
        size = float(values[top])
        where = _middle(along, compared & (sign * np.nan_to_num(value) >= size - _AS_LARGE), float(peak[top]))
        extremes.append((max(size, 0.0), complex(path.at(np.array([where]))[0][0])))
    return _Extremes(extremes[0], extremes[1], mean, length)


def _middle(along: Floats, largest: Mask, otherwise: float) -> float:
    """The middle of the longest stretch with the greatest deviation: it is reported on a side, not at a corner."""
    ends = np.flatnonzero(np.diff(np.concatenate([[False], largest, [False]])))
    if not len(ends):
        return otherwise
    low, high = along[ends[::2]], along[ends[1::2] - 1]
    longest = int(np.argmax(high - low))
    return float(low[longest] + high[longest]) / 2 if high[longest] > low[longest] else otherwise


def _difference(extremes: _Extremes, element: Callable[[Points], Rows]) -> Difference:
    of = [int(element(np.array([point]))[0]) if size > 0 else -1 for size, point in (extremes.proud, extremes.deep)]
    return Difference(*extremes.proud, of[0], *extremes.deep, of[1], extremes.mean, extremes.length)
