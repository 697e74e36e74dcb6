"""F of the lines and arcs of a section, from the speed that the tool had along the plain moves of X and C."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.conversion.rolling.elements import Element
from polarcheck.conversion.rolling.ways import Way
from polarcheck.geometry import rates
from polarcheck.geometry.tolerances import ZERO
from polarcheck.machines.machine import Machine
from polarcheck.machines.modal import Motion

#: C that turns with more than this share of its limit has slowed the CAM down.
_AT_LIMIT = 0.97
#: Speeds that differ by less than this share are one F.
_SAME = 0.04
#: Speeds along one element that spread by more than this share were not meant to be one.
_EVEN = 0.15
#: F is written with so many digits, and so much below what a limit allows.
_DIGITS, _BELOW = 3, 1e-3
#: No more different F than this are looked for.
_MOST = 20


class Feeds(msgspec.Struct, frozen=True):
    """
    F of the elements of a stretch.

    of_element: [mm/min]. meant: those that the blocks had where nothing slowed them, the longest way first [mm/min].
    slowest, fastest: of the tool along its way, but for a twentieth at each end [mm/min].
    is_even: the tool ran at even speed along each element. limited: elements whose F C or a limit of F makes lower.
    slowed: the share of the way on which C was at its limit.
    """

    of_element: list[float]
    meant: list[float]
    slowest: float
    fastest: float
    is_even: bool
    limited: list[int]
    slowed: float


def feeds_of(way: Way, elements: list[Element], machine: Machine, unit: float) -> Feeds:
    """
    Return F of each element; unit: mm per unit of length that F counts.

    F is the median by length of the speeds of the blocks where C was below its limit, one for all elements that were
    run alike; it is lower where C would be above its limit.
    """
    in_space = machine.polar.feed_measures == "space"
    length = np.hypot(way.length, way.rise) if in_space else way.length
    length = np.where(way.length > ZERO, length, way.rise)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = length / way.time
        rate = np.abs(way.turn) / way.time
    on_plane = way.length > ZERO
    limit = machine.limits.c_feed
    free = ~(rate > _AT_LIMIT * limit) | ~on_plane
    own = np.full(len(elements), np.nan)
    is_even = True
    for index, each in enumerate(elements):
        moves = slice(each.first, each.until)
        unslowed = free[moves]
        if unslowed.any():
            values, weights = speed[moves][unslowed], length[moves][unslowed]
            own[index] = _median(values, weights)
            spread = np.abs(values / own[index] - 1) > _EVEN
            is_even &= bool(weights[spread].sum() <= 0.1 * weights.sum())
    plane = np.array([each.kind != Motion.NONE for each in elements], bool)
    weight = np.array([length[each.first : each.until].sum() for each in elements])
    both = on_plane & free if (on_plane & free).any() else on_plane
    overall = _median(speed[both], length[both])
    meant = _grouped(own, weight, plane, overall) if is_even else np.where(plane, overall, own)
    written = [_nice(feed, unit) if on else feed for feed, on in zip(meant.tolist(), plane.tolist(), strict=True)]
    limited = []
    for index, each in enumerate(elements):
        if not plane[index]:
            continue
        highest = _highest(each, machine)
        if written[index] > highest:
            written[index] = _nice(highest * (1 - _BELOW), unit, down=True)
            limited.append(index)
    low, high = _quantiles(speed[on_plane], length[on_plane])
    chosen = [_nice(feed, unit) for feed in meant[plane].tolist()]
    ways: dict[float, float] = {}
    for feed, long in zip(chosen, weight[plane].tolist(), strict=True):
        ways[feed] = ways.get(feed, 0.0) + long
    slowed = float(length[~free].sum() / max(float(length[on_plane].sum()), ZERO))
    return Feeds(written, sorted(ways, key=lambda feed: -ways[feed]), low, high, is_even, limited, slowed)


def _grouped(own: Floats, weight: Floats, plane: Mask, overall: float) -> Floats:
    """One F for elements whose speeds are nearly the same, by the median of the way."""
    result = np.where(np.isnan(own), overall, own)
    left = plane & ~np.isnan(own)
    center = overall
    for _ in range(_MOST):
        alike = left & (np.abs(own / center - 1) <= _SAME)
        if alike.any():
            result[alike] = _median(own[alike], weight[alike])
            left &= ~alike
        if not left.any():
            break
        center = _median(own[left], weight[left])
    return result


def _median(values: Floats, weights: Floats) -> float:
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(total, total[-1] / 2)])


def _quantiles(values: Floats, weights: Floats) -> tuple[float, float]:
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    at = np.searchsorted(total, [0.05 * total[-1], 0.95 * total[-1]])
    low, high = values[order][np.minimum(at, len(values) - 1)].tolist()
    return low, high


def _highest(each: Element, machine: Machine) -> float:
    """The highest F along an element by the limits of the machine [mm/min]; inf without any."""
    limits = machine.limits
    highest = limits.polar_feed if not np.isnan(limits.polar_feed) else math.inf
    # Where the control slows down by itself, F is that of the rest of the way.
    if not np.isnan(limits.c_feed) and not limits.automatic_override:
        start, end, center = (np.array([value], complex) for value in (each.start, each.end, each.center))
        allowed = rates.feed_allowed(start, end, center, np.array([each.kind], np.int16), limits.c_feed)
        highest = min(highest, float(allowed[0]))
    return highest


def _nice(feed: float, unit: float, *, down: bool = False) -> float:
    """F of three digits as it is written, in mm/min."""
    written = feed / unit
    if not written > 0:
        return feed
    step = 10.0 ** (math.floor(math.log10(written)) - _DIGITS + 1)
    count = math.floor(written / step * (1 + 1e-12)) if down else round(written / step)
    return max(count, 1) * step * unit
