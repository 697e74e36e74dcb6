"""
By how much a part differs from what is drawn, to either side; lengths in mm, plane points complex, x + 1j*c.

What the program bounds is measured to the drawing, and the drawing to that: either alone would not see a notch that the
other has. Where the nearest of the drawing lies within the part, too much stays there; else too much is cut away.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.comparison.measured_path import Way, way_of_outline
from polarcheck.geometry.outline import Outline

#: Points that lie so far [mm] from a circle about the axis are on it.
_ON_CIRCLE = 2e-3
#: By so much [mm] the chords of the bar leave it, at most.
_CHORDS = 0.01
#: An arc whose center is so near to the axis [mm] is meant to be about it.
_ABOUT_AXIS = 0.1
#: What reaches farther beyond the round of the drawing than this [mm] is the way of the tool in the air.
_IN_AIR = 0.1
#: Of each side the places that are looked at more closely, how often, and into how many parts each time.
_PLACES, _TURNS, _PARTS = 8, 6, 8
#: Places that are off by so little less than the largest [mm] are as far off.
_AS_LARGE = 5e-4


class Difference(NamedTuple):
    """
    How a part differs from a drawing.

    proud, deep: by how much too much stays, and too much is cut away, at most [mm]; 0 for none. proud_at, deep_at:
    where, on the part or on the drawing. proud_of, deep_of: the element of the outline there, -1 for none. mean: of all
    [mm]. length: of what could be compared [mm].
    """

    proud: float = 0.0
    proud_at: complex = complex(np.nan)
    proud_of: int = -1
    deep: float = 0.0
    deep_at: complex = complex(np.nan)
    deep_of: int = -1
    mean: float = np.inf
    length: float = 0.0

    @property
    def largest(self) -> float:
        """Of both sides [mm]."""
        return max(self.proud, self.deep)

    @property
    def at(self) -> complex:
        """Where that is."""
        return self.proud_at if self.proud >= self.deep else self.deep_at

    @property
    def of(self) -> int:
        """The element there."""
        return self.proud_of if self.proud >= self.deep else self.deep_of


class Made(NamedTuple):
    """
    Chains of the outline of a part. way: of_outline. closed: bool[elements]. about_axis: bool[elements], arcs about the
    axis. polygon: the part, prepared. bar: radius of the stock [mm], inf where it is not known.
    """

    outline: Outline
    way: Way
    about_axis: Mask
    polygon: Any
    bar: float


def made_of(outline: Outline, polygon: Any, bar: float) -> Made:
    """What is to be compared. bar: radius of the stock [mm], NaN if unknown."""
    about = outline.is_arc & (np.abs(np.where(outline.is_arc, outline.center, np.inf)) <= _ABOUT_AXIS)
    shapely.prepare(polygon)
    return Made(outline, way_of_outline(outline), about, polygon, np.inf if np.isnan(bar) else bar)


def difference(made: Made, drawn: Way, *, both_ways: bool) -> Difference:
    """
    How chains differ from curves of a drawing.

    both_ways: whether the chains should make all of these curves; else only what they make is compared.
    """
    turned = turned_radius(drawn)
    first = _extremes(made.way, lambda points: _from_part(made, drawn, points), _compared(made, drawn, turned))
    found = _difference(made, first, lambda points: made.way.of[made.way.nearest(points)[2]])
    if not both_ways:
        return found
    along = drawn.samples()
    points, _ = drawn.at(along)
    # What lies on the round of the drawing is turned, where the part is not milled there.
    on_round = np.abs(points) >= turned - _ON_CIRCLE
    inward = np.where(on_round, points * (1 - _CHORDS / np.maximum(np.abs(points), _CHORDS)), points)
    compared = ~(on_round & _within(made.polygon, inward))
    second = _extremes(drawn, lambda points: _from_drawing(made, points), (along, compared))
    if not second.length:
        return found
    other = _difference(made, second, lambda points: made.way.of[made.way.nearest(points)[2]])
    proud = found if found.proud >= other.proud else other
    deep = found if found.deep >= other.deep else other
    return Difference(*proud[:3], *deep[3:6], (found.mean + other.mean) / 2, found.length)


def _within(polygon: Any, points: Points) -> Mask:
    return np.asarray(shapely.contains_xy(polygon, points.real, points.imag))


def _from_part(made: Made, drawn: Way, points: Points) -> Floats:
    far, there, _ = drawn.nearest(points)
    return np.where(_within(made.polygon, there), far, -far)


def _from_drawing(made: Made, points: Points) -> Floats:
    far, _, _ = made.way.nearest(points)
    return np.where(_within(made.polygon, points), far, -far)


def turned_radius(drawn: Way) -> float:
    """The radius of the outermost circle about the axis that a drawing has an arc of [mm]; inf for none."""
    reach = float(np.abs(drawn.start).max(initial=0))
    on = (np.abs(drawn.start) > reach - _ON_CIRCLE) & (np.abs(drawn.end) > reach - _ON_CIRCLE)
    # A chord that is seen under a large angle is no part of an arc.
    on &= np.abs(drawn.start + drawn.end) / 2 > reach - _ON_CIRCLE
    # Of a whole circle nothing says whether it is turned or milled; a part that is compared with it is.
    is_turned = not on.all() and np.abs(drawn.end - drawn.start)[on].sum() > reach * _LEAST_ARC
    return reach if is_turned else np.inf


#: An arc about the axis is at least so long, as a share of its radius.
_LEAST_ARC = 0.01


def _compared(made: Made, drawn: Way, turned: float) -> tuple[Floats, Mask]:
    """How far along the chains points lie [mm], and which of them are compared."""
    along = made.way.samples()
    points, which = made.way.at(along)
    size, compared = np.abs(points), np.ones(len(points), bool)
    compared &= size <= made.bar + _ON_CIRCLE
    beyond = (size > turned + _ON_CIRCLE) & ~made.about_axis[made.way.of[which]]
    if beyond.any():
        run = np.cumsum(np.diff(beyond, prepend=False))
        excess = np.zeros(run[-1] + 1)
        np.maximum.at(excess, run, size - turned)
        compared &= ~(beyond & (excess[run] > _IN_AIR))
    far, there, _ = drawn.nearest(points)
    compared &= ~_is_open_end(drawn, there) | (far <= _ON_CIRCLE)
    if np.isinf(min(turned, made.bar)):
        compared &= ~_leading(made, which, far)
    return along, compared if compared.any() else size <= made.bar + _ON_CIRCLE


def _is_open_end(drawn: Way, points: Points) -> Mask:
    """The points at which a curve of a drawing ends, and nobody knows how it goes on."""
    begins = np.flatnonzero(np.diff(drawn.of, prepend=-1))
    last = np.append(begins[1:], len(drawn.of)) - 1
    is_open = np.abs(drawn.start[begins] - drawn.end[last]) > 0
    ends = np.concatenate([drawn.start[begins][is_open], drawn.end[last][is_open]])
    return np.asarray(np.isin(np.round(points, 6), np.round(ends, 6)))


def _leading(made: Made, which: Rows, far: Floats) -> Mask:
    """
    The points at either end of a chain that is open from which on it comes nearer to the drawing: a wall goes on beyond
    the bar, of which the drawing may show anything.
    """
    chain = made.outline.chain[made.way.of[which]]
    is_open = ~made.outline.closed[chain]
    found = np.zeros(len(far), bool)
    for number in np.unique(chain[is_open]).tolist():
        own = np.flatnonzero(chain == number)
        for order in (own, own[::-1]):
            stops = np.append(far[order[1:]] >= far[order[:-1]], True)
            found[order[: int(np.argmax(stops))]] = True
    return found


class _Extremes(NamedTuple):
    """The largest of both sides, each with its point; the mean, and the length of what is compared [mm]."""

    proud: tuple[float, complex]
    deep: tuple[float, complex]
    mean: float
    length: float


def _extremes(way: Way, measured: Callable[[Points], Floats], places: tuple[Floats, Mask]) -> _Extremes:
    """The extremes along a way, looked at more closely where they are. places: how far along, and which are asked."""
    along, asked = places
    if not asked.any():
        return _Extremes((0.0, complex(np.nan)), (0.0, complex(np.nan)), np.inf, 0.0)
    value = np.full(len(along), np.nan)
    value[asked] = measured(way.at(along[asked])[0])
    share = np.gradient(along) if len(along) > 1 else np.ones(1)
    length = float(share[asked].sum())
    mean = float((np.abs(value[asked]) * share[asked]).sum() / length) if length else np.inf
    # Nothing is looked for beyond a neighbour that is not compared.
    low = np.where(np.append(False, asked[:-1]), np.append(along[0], along[:-1]), along)
    high = np.where(np.append(asked[1:], False), np.append(along[1:], along[-1]), along)
    found: list[tuple[float, complex]] = []
    for sign in (1, -1):
        best = np.argsort(np.where(asked, -sign * value, np.inf), kind="stable")[:_PLACES]
        best = best[asked[best]]
        at, least, most = along[best], low[best], high[best]
        for _ in range(_TURNS):
            tried = least[:, None] + (most - least)[:, None] * np.linspace(0, 1, _PARTS + 1)
            tried = np.concatenate([tried, at[:, None]], axis=1)
            values = sign * measured(way.at(tried.ravel())[0]).reshape(tried.shape)
            at = tried[np.arange(len(at)), values.argmax(axis=1)]
            part = (most - least) / _PARTS
            least, most = np.maximum(least, at - part), np.minimum(most, at + part)
        values = sign * measured(way.at(at)[0])
        top = int(values.argmax())
        size = float(values[top])
        where = _middle(along, asked & (sign * np.nan_to_num(value) >= size - _AS_LARGE), float(at[top]))
        found.append((max(size, 0.0), complex(way.at(np.array([where]))[0][0])))
    return _Extremes(found[0], found[1], mean, length)


def _middle(along: Floats, largest: Mask, otherwise: float) -> float:
    """The middle of the longest stretch that is as far off as any: a side is told there, and not at a corner."""
    ends = np.flatnonzero(np.diff(np.concatenate([[False], largest, [False]])))
    if not len(ends):
        return otherwise
    low, high = along[ends[::2]], along[ends[1::2] - 1]
    longest = int(np.argmax(high - low))
    return float(low[longest] + high[longest]) / 2 if high[longest] > low[longest] else otherwise


def _difference(made: Made, found: _Extremes, element: Callable[[Points], Rows]) -> Difference:
    of = [int(element(np.array([at]))[0]) if size > 0 else -1 for size, at in (found.proud, found.deep)]
    return Difference(*found.proud, of[0], *found.deep, of[1], found.mean, found.length)
