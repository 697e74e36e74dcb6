"""F that is lower where C would turn too fast: near the center, where lines and arcs are divided for it."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Points
from polarcheck.foundation.states import Motion
from polarcheck.geometry import rates
from polarcheck.geometry.plane import quiet
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.roll.rolled_elements import Element
from polarcheck.rewrite.roll.rolled_feeds import Feeds, nice
from polarcheck.rewrite.roll.ways import AxisMoves

#: F stays below what a limit allows by this share: FANUC has F < L * R * pi / 180.
_BELOW = 2e-3
#: If the limit of C is not known, C may turn by this share faster than in the plain moves.
_FASTER = 0.1
#: The ratio of one F to the next higher one, and the most steps.
_STEP, _MOST = 0.7, 6
#: An element is divided only for an F below this share of its own.
_ONE = 0.9
#: The number of points sampled along an element, and the shortest part of it [mm].
_PLACES, _SHORTEST = 2001, 0.05


class Parts(msgspec.Struct, frozen=True):
    """
    Elements with F [mm/min], divided where F changes.

    limited: how many elements have a lower F.
    lowest: the lowest F of them.
    by: what limits them: `limit` of C, `before` (highest rate of C in the plain moves), `feed` (limits.polar_feed).
    """

    elements: list[Element]
    feeds: list[float]
    limited: int
    lowest: float
    by: str


def parts_of(moves: AxisMoves, elements: list[Element], feeds: Feeds, machine: Machine, unit: float) -> Parts:
    """Return the elements with an F that keeps C and F within their limits."""
    limits = machine.limits
    highest_feed = limits.polar_feed if limits.polar_feed > 0 else math.inf
    by = "limit" if limits.c_feed > 0 else "before"
    # A control that slows down by itself uses F on the rest of the path.
    limit = math.inf if limits.automatic_override else limits.c_feed if limits.c_feed > 0 else feeds.c_rate
    reserve = 1.0 if by == "limit" else 1.0 + _FASTER
    result: list[Element] = []
    written: list[float] = []
    limited, is_by_feed = 0, True
    lowest = math.inf
    for element, intended in zip(elements, feeds.of_element, strict=True):
        feed = nice(highest_feed, unit, down=True) if intended > highest_feed else intended
        parts, lower = [element], [feed]
        allowed = _allowed(element, limit) if element.kind != Motion.NONE else math.inf
        if allowed * reserve < feed:
            if element.z is None and allowed < _ONE * feed:
                parts = _divided(moves, element, limit, feed)
            lower = [_lower(feed, _allowed(part, limit), unit) for part in parts]
        if min(lower) < intended:
            limited += 1
            is_by_feed &= min(lower) >= feed
            lowest = min(lowest, *lower)
        result += parts
        written += lower
    return Parts(result, written, limited, lowest, "feed" if limited and is_by_feed else by)


def _lower(feed: float, allowed: float, unit: float) -> float:
    """Return F lowered to what C allows [mm/min]; F itself if C allows more, or nothing, as through the center."""
    below = allowed * (1 - _BELOW)
    return nice(below, unit, down=True) if 0 < below < feed else feed


def _allowed(element: Element, limit: float) -> float:
    """The highest F along an element at which C keeps its limit [mm/min]; 0 through the center."""
    if not math.isfinite(limit):
        return math.inf
    return float(rates.feed_allowed(*element.path.shape, limit)[0])


def _divided(moves: AxisMoves, element: Element, limit: float, feed: float) -> list[Element]:
    """The parts of an element from one F to the next lower one."""
    share = np.linspace(0, 1, _PLACES)
    points = element.path.points(np.zeros(_PLACES, np.int64), share)
    allowed = _allowed_at(points, limit)
    lowest = max(float(allowed.min()), feed * 1e-3)
    count = min(math.ceil(math.log(feed / lowest) / -math.log(_STEP)), _MOST)
    levels = feed * (lowest / feed) ** (np.arange(count + 1) / max(count, 1))
    level = np.searchsorted(-levels, -allowed)
    cuts = [0, *(np.flatnonzero(np.diff(level)) + 1).tolist(), _PLACES - 1]
    length = float(np.abs(np.diff(points)).sum())
    least = max(math.ceil(_SHORTEST / length * _PLACES), 1)
    places = [0]
    for cut in cuts[1:-1]:
        if cut - places[-1] >= least and _PLACES - 1 - cut >= least:
            places.append(cut)
    return _parts(moves, element, points[[*places, _PLACES - 1]])


def _parts(moves: AxisMoves, element: Element, joints: Points) -> list[Element]:
    """Divide an element at points on it; each part gets the blocks whose ends lie along it."""
    ends = moves.radius[element.first : element.until] * np.exp(1j * moves.angle[element.first : element.until])
    end_shares, joint_shares = _along(element, ends), _along(element, joints[1:-1])
    until = [*(element.first + np.searchsorted(end_shares, joint_shares, side="right")).tolist(), element.until]
    parts = []
    first = element.first
    for number, last in enumerate(until):
        last = max(last, element.first + 1)
        start, end = complex(joints[number]), complex(joints[number + 1])
        parts.append(Element(element.kind, start, end, element.center, None, min(first, last), last))
        first = last
    return parts


@quiet
def _allowed_at(points: Points, limit: float) -> Floats:
    """Return the highest F at points along a path for C to keep its limit [mm/min]."""
    step = np.gradient(points)
    turn = np.abs((np.conj(points) * step).imag) / np.abs(step) / np.abs(points) ** 2
    return np.asarray(np.where(turn > 0, limit / np.degrees(turn), np.inf))


def _along(element: Element, points: Points) -> Floats:
    """How far along an element points are, as a share that never falls."""
    if element.kind == Motion.LINE:
        chord = element.end - element.start
        share = ((points - element.start) * chord.conjugate()).real / abs(chord) ** 2
    else:
        sweep = float(element.path.sweep[0])
        turned = np.angle((points - element.center) / (element.start - element.center)) * math.copysign(1, sweep)
        share = np.where(turned < -0.05, turned + 2 * math.pi, turned) / abs(sweep)
    return np.asarray(np.maximum.accumulate(share))
